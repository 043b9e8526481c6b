//! Reads the tables of a parsed file one after the other; errors name their place.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::diagnose::value_error;
use super::error::CaseError;
use super::keys;
use super::probe::keys_of;
use super::source::Source;

/// The tables of a parsed file that are still to be read.
pub struct Tables<'a, 'i> {
    /// The tables that have not been read yet.
    pub root: DeTable<'i>,
    /// The text, for places of errors.
    pub source: &'a Source,
}

impl<'i> Tables<'_, 'i> {
    /// The table `[name]`, or its default where the file has none.
    pub fn read<T: Default + DeserializeOwned>(&mut self, name: &str) -> Result<T, CaseError> {
        match self.root.remove(name) {
            None => Ok(T::default()),
            Some(value) if value.get_ref().is_table() => {
                self.read_table(value, &keys::header(name), keys_of::<T>())
            }
            Some(value) => {
                let sentence = format!("`{name}` must be a table: write its keys below a line [{name}]");
                Err(self.source.error_at(value.span(), sentence))
            }
        }
    }

    /// A table that stands under `header` and has the `known` keys.
    pub fn read_table<T: DeserializeOwned>(
        &self,
        table: Spanned<DeValue<'i>>,
        header: &str,
        known: &[&str],
    ) -> Result<T, CaseError> {
        let span = table.span();
        let read = T::deserialize(ValueDeserializer::from(table));
        read.map_err(|error| {
            // An error about the table as a whole, such as a size that is missing, comes without a span.
            let span = error.span().unwrap_or(span);
            value_error(self.source, span, error.message(), header, known)
        })
    }
}
