//! A page, without a browser.

use std::net::TcpStream;
use std::time::Instant;

use hmac::{Hmac, Mac};
use serde_json::{Value, json};
use sha2::Sha256;
use tungstenite::client::IntoClientRequest;
use tungstenite::protocol::CloseFrame;
use tungstenite::{Error, Message, WebSocket};

use crate::laboratory::{Served, TIMEOUT};

/// Connection of a page to the server.
pub(crate) struct Page {
    pub(crate) socket: WebSocket<TcpStream>,
    /// Number of pictures received so far; the last one follows.
    pub(crate) pictures: usize,
    pub(crate) picture: Vec<u8>,
}

/// Arbitrary name of a tab, and an arbitrary nonce.
pub(crate) const TAB: &str = "00112233445566778899aabbccddeeff";
pub(crate) const NONCE: &str = "0123456789abcdef0123456789abcdef";

/// HMAC-SHA256 in hexadecimal digits.
fn code(key: &str, text: &str) -> String {
    let code = Hmac::<Sha256>::new_from_slice(key.as_bytes()).unwrap();
    let bytes = Mac::chain_update(code, text).finalize().into_bytes();
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The proof of `who`, page or server, that it knows the token.
pub(crate) fn proof(token: &str, who: &str) -> String {
    code(&code(token, TAB), &format!("{who} {NONCE}"))
}

/// The subprotocols of a page with this proof.
pub(crate) fn protocols(proof: &str) -> String {
    format!("slipfront.lab.v2, tab.{TAB}, nonce.{NONCE}, proof.{proof}")
}

/// Tries to connect; returns the page, or the status of the refusal.
pub(crate) fn try_connect(of: &Served, token: &str, headers: &[(&'static str, &str)]) -> Result<Page, u16> {
    let mut request = format!("ws://{}/ws", of.host()).into_client_request().unwrap();
    let protocols = protocols(&proof(token, "page"));
    let all = [("sec-websocket-protocol", protocols.as_str())];
    for (name, value) in all.iter().chain(headers) {
        request.headers_mut().insert(*name, value.parse().unwrap());
    }
    match tungstenite::client(request, of.connect()) {
        Ok((socket, _)) => Ok(Page {
            socket,
            pictures: 0,
            picture: Vec::new(),
        }),
        Err(tungstenite::HandshakeError::Failure(Error::Http(response))) => Err(response.status().as_u16()),
        Err(error) => panic!("{error}"),
    }
}

impl Page {
    pub(crate) fn open(of: &Served) -> Self {
        try_connect(of, &of.token, &[]).unwrap_or_else(|status| panic!("refused with {status}"))
    }

    /// A page that shows a small case.
    pub(crate) fn with_case(of: &Served, toml: &str) -> Self {
        let mut page = Self::open(of);
        page.send(&json!({ "do": "open", "source": { "toml": toml } }));
        page
    }

    pub(crate) fn send(&mut self, request: &Value) {
        self.socket.send(Message::text(request.to_string())).unwrap();
    }

    /// Reads the next message; none if it is not a reply.
    pub(crate) fn read(&mut self) -> Result<Option<Value>, Error> {
        match self.socket.read()? {
            Message::Text(text) => Ok(Some(serde_json::from_str(&text).unwrap())),
            Message::Binary(bytes) => {
                if bytes[0] == 1 {
                    self.pictures += 1;
                    self.picture = bytes.to_vec();
                }
                Ok(None)
            }
            Message::Close(frame) => Err(closed(frame)),
            _ => Ok(None),
        }
    }

    /// Waits for the next reply that fulfils a condition.
    pub(crate) fn wait_for(&mut self, what: &str, holds: impl Fn(&Value) -> bool) -> Value {
        let began = Instant::now();
        while began.elapsed() < TIMEOUT {
            let reply = self
                .read()
                .unwrap_or_else(|error| panic!("waiting for {what}: {error}"));
            match reply {
                Some(reply) if holds(&reply) => return reply,
                Some(reply) => assert_ne!(reply["is"], "refused", "waiting for {what}: {reply}"),
                None => {}
            }
        }
        panic!("{what} did not come");
    }

    /// The next reply of this name.
    pub(crate) fn reply(&mut self, is: &str) -> Value {
        self.wait_for(is, |reply| reply["is"] == is)
    }

    /// The next picture.
    pub(crate) fn next_picture(&mut self) -> &[u8] {
        let before = self.pictures;
        while self.pictures == before {
            self.read()
                .unwrap_or_else(|error| panic!("waiting for a picture: {error}"));
        }
        &self.picture
    }

    /// Sends a request, and returns the sentence that refuses it.
    pub(crate) fn refusal(&mut self, request: &Value) -> String {
        self.send(request);
        self.reply("refused")["sentence"].as_str().unwrap().to_owned()
    }

    /// Waits for the end of the connection; returns its code and reason, or none if it just breaks.
    pub(crate) fn end(&mut self) -> Option<(u16, String)> {
        loop {
            match self.socket.read() {
                Ok(Message::Close(frame)) => {
                    return frame.map(|frame| (frame.code.into(), frame.reason.to_string()));
                }
                Ok(_) => {}
                Err(_) => return None,
            }
        }
    }
}

fn closed(frame: Option<CloseFrame>) -> Error {
    let reason = frame.map_or(String::new(), |frame| frame.reason.to_string());
    Error::Io(std::io::Error::other(format!("closed: {reason}")))
}
