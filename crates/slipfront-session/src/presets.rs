//! Presets: cases to choose from, which the host of a session provides.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use slipfront_base::text::truncated;

use crate::base64;
use crate::document::Document;
use crate::protocol::PresetEntry;
use crate::sentence::sentence;

/// A case to choose from.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Preset {
    /// The name by which the case is chosen.
    pub name: String,
    /// The group of the list to which the case belongs, such as `grooves` or `paper`.
    pub group: String,
    /// The small picture of the case in the list: 32 x 32 values of half a byte, in Base64.
    pub picture: String,
    /// Whether the case is the base of a study of many runs.
    pub is_study: bool,
    /// A sentence on what the case shows.
    pub title: String,
    /// The text of the case.
    pub toml: String,
    /// Contents of the files that the text names.
    #[serde(with = "base64::files")]
    pub files: BTreeMap<String, Vec<u8>>,
}

/// Cases to choose from, in the order of the list. They can be sent as JSON.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Presets(pub Vec<Preset>);

impl Presets {
    /// Returns a case by name.
    ///
    /// # Errors
    /// A sentence, if there is no case of that name, or it cannot be made.
    pub fn document(&self, name: &str) -> Result<Document, String> {
        let found = self.0.iter().find(|preset| preset.name == name);
        let preset = found.ok_or_else(|| format!("there is no case `{}`", truncated(name)))?;
        let read = |file: &str| {
            let contents = preset.files.get(file).cloned();
            contents.ok_or_else(|| "there is no such file".to_owned())
        };
        // The case gets the last part of a name in a group, such as `paper/fig03`.
        let plain = name.rsplit('/').next().unwrap_or(name);
        Document::new(plain, &preset.toml, read).map_err(sentence)
    }

    /// The list that the page shows.
    pub(crate) fn entries(&self) -> Vec<PresetEntry<'_>> {
        fn entry(preset: &Preset) -> PresetEntry<'_> {
            PresetEntry {
                name: &preset.name,
                group: &preset.group,
                picture: &preset.picture,
                is_study: preset.is_study,
                title: &preset.title,
            }
        }
        self.0.iter().map(entry).collect()
    }
}
