//! Files inside messages.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;

pub(crate) fn encode(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// Decodes a text of the page.
///
/// # Errors
/// A sentence, if it is not Base64.
pub(crate) fn decode(text: &str) -> Result<Vec<u8>, String> {
    BASE64_STANDARD
        .decode(text)
        .map_err(|error| format!("a file of the message is not Base64 ({error})"))
}

/// Files by name, in Base64.
pub(crate) mod files {
    use std::collections::BTreeMap;

    use serde::de::Error as _;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(
        files: &BTreeMap<String, Vec<u8>>,
        to: S,
    ) -> Result<S::Ok, S::Error> {
        let files = files.iter();
        to.collect_map(files.map(|(name, contents)| (name, super::encode(contents))))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        from: D,
    ) -> Result<BTreeMap<String, Vec<u8>>, D::Error> {
        let files: BTreeMap<String, String> = Deserialize::deserialize(from)?;
        let mut contents = BTreeMap::new();
        for (name, text) in files {
            contents.insert(name, super::decode(&text).map_err(D::Error::custom)?);
        }
        Ok(contents)
    }
}
