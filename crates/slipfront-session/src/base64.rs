//! Files within messages.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;

pub(crate) fn encode(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// The bytes of a text of the page.
///
/// # Errors
/// A sentence, if it is not Base64.
pub(crate) fn decode(text: &str) -> Result<Vec<u8>, String> {
    BASE64_STANDARD
        .decode(text)
        .map_err(|error| format!("a file of the message is not Base64 ({error})"))
}
