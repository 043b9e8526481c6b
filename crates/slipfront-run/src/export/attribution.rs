//! The author of exported runs, and the licence for their use.

use std::str::FromStr;

/// The author of results and the licence for their use, which only the user knows.
#[derive(Clone, Debug, Default)]
pub struct Attribution {
    /// The author of the runs.
    pub author: Option<Author>,
    /// Terms under which others may use the results.
    pub licence: Option<Licence>,
}

impl Attribution {
    /// Sentences about information that a crate lacks because the user did not give it.
    pub fn notes(&self) -> Vec<&'static str> {
        let mut notes = Vec::new();
        if self.author.is_none() {
            notes.push("the crate has no author: add --author \"NAME\"");
        }
        if self.licence.is_none() {
            notes.push(
                "the crate has no licence, so others may not use the results: add --licence, such as --licence CC-BY-4.0",
            );
        }
        notes
    }
}

/// Name of an author, with the address of an ORCID record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Author {
    pub(super) name: String,
    pub(super) orcid: Option<String>,
}

/// A licence, by its identifier in the list of SPDX or by its address.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Licence {
    pub(super) name: String,
    pub(super) url: String,
}

impl FromStr for Author {
    type Err = String;

    /// Reads `NAME`, or `NAME <https://orcid.org/0000-0000-0000-0000>`.
    fn from_str(text: &str) -> Result<Self, String> {
        const FORM: &str = "write a name, or \"NAME <https://orcid.org/0000-0000-0000-0000>\"";
        let (name, orcid) = match text.split_once('<') {
            Some((name, orcid)) => (name, Some(orcid.strip_suffix('>').ok_or(FORM)?)),
            None => (text, None),
        };
        let is_orcid = |address: &str| {
            address.strip_prefix("https://orcid.org/").is_some_and(|digits| {
                let parts = digits.split('-').collect::<Vec<_>>();
                let is_part =
                    |part: &&str| part.len() == 4 && part.bytes().all(|c| c.is_ascii_digit() || c == b'X');
                parts.len() == 4 && parts.iter().all(is_part)
            })
        };
        if name.trim().is_empty() || name.contains(char::is_control) || !orcid.is_none_or(is_orcid) {
            return Err(FORM.to_owned());
        }
        Ok(Self {
            name: name.trim().to_owned(),
            orcid: orcid.map(str::to_owned),
        })
    }
}

impl FromStr for Licence {
    type Err = String;

    /// Reads an identifier such as `CC-BY-4.0`, or an address.
    fn from_str(text: &str) -> Result<Self, String> {
        let is_address = ["https://", "http://"]
            .iter()
            .any(|start| text.starts_with(start));
        let is_identifier = |c: char| c.is_ascii_alphanumeric() || "-.+".contains(c);
        if text.is_empty()
            || (!is_address && !text.chars().all(is_identifier))
            || text.contains(char::is_whitespace)
        {
            return Err(
                "write an identifier of https://spdx.org/licenses, such as CC-BY-4.0, or an address"
                    .to_owned(),
            );
        }
        let url = if is_address {
            text.to_owned()
        } else {
            format!("https://spdx.org/licenses/{text}")
        };
        Ok(Self {
            name: text.to_owned(),
            url,
        })
    }
}
