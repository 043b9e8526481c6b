//! The token of the address, and how page and server prove to each other that they know it without sending
//! it.
//!
//! After the server has ended, another user may listen on the port, and a page that tries to connect must
//! reveal nothing to them. A tab therefore draws a name, keeps the key derived from the token for this name,
//! and forgets the token. For every connection it draws a random number, the nonce. First the server proves
//! with the nonce that it knows the key, then the page does.

use std::io;

use hmac::{Hmac, Mac};
use sha2::Sha256;

/// A random number of the system as 32 hexadecimal digits.
pub(crate) struct Token(String);

/// Identity of a page: the name of its tab and a nonce, each of 32 hexadecimal digits.
#[derive(Clone, Copy)]
pub(crate) struct Caller<'a> {
    tab: &'a str,
    nonce: &'a str,
}

impl<'a> Caller<'a> {
    /// Returns a caller, or none if tab or nonce does not have the form that a page draws.
    pub(crate) fn new(tab: &'a str, nonce: &'a str) -> Option<Self> {
        let is_drawn = |text: &str| text.len() == 32 && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        (is_drawn(tab) && is_drawn(nonce)).then_some(Self { tab, nonce })
    }
}

impl Token {
    /// Draws a token.
    ///
    /// # Errors
    /// When the system gives no random numbers.
    pub(crate) fn draw() -> io::Result<Self> {
        let mut random = [0; 16];
        getrandom::fill(&mut random).map_err(io::Error::other)?;
        Ok(Self(hexadecimal(&random)))
    }

    pub(crate) fn as_str(&self) -> &str {
        &self.0
    }

    /// Proof of the server for a page, in hexadecimal digits: the code of "server NONCE", which only those
    /// who know the token can compute.
    pub(crate) fn proof_of_server(&self, caller: Caller) -> String {
        hexadecimal(&self.code("server", caller).finalize().into_bytes())
    }

    /// Whether a page proves that it knows the token: `proof` must be the code of "page NONCE", in
    /// hexadecimal digits.
    pub(crate) fn is_proof_of_page(&self, caller: Caller, proof: &str) -> bool {
        let bytes: Option<Vec<u8>> = (proof.len() == 64 && proof.is_ascii())
            .then(|| {
                (0..64)
                    .step_by(2)
                    .map(|i| u8::from_str_radix(&proof[i..i + 2], 16).ok())
                    .collect()
            })
            .flatten();
        bytes.is_some_and(|bytes| self.code("page", caller).verify_slice(&bytes).is_ok())
    }

    /// The code of "page NONCE" or "server NONCE" under the key of the tab.
    fn code(&self, who: &str, caller: Caller) -> Hmac<Sha256> {
        let key = hexadecimal(&hmac(&self.0, caller.tab).finalize().into_bytes());
        hmac(&key, &format!("{who} {}", caller.nonce))
    }
}

fn hmac(key: &str, text: &str) -> Hmac<Sha256> {
    let code = Hmac::new_from_slice(key.as_bytes()).expect("keys of any length are taken");
    Mac::chain_update(code, text)
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
