//! Reads the tables of a parsed file one by one; errors name their place.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

use super::diagnose::value_error;
use super::error::CaseError;
use super::key::Key;
use super::key_table::{SECTIONS, Section, fill_in_all};
use super::keys::header;
use super::reader::Reader;
use super::serde_names::names_of;
use super::source::Source;

/// The tables of a parsed file that remain to be read.
pub struct Tables<'a, 'i> {
    /// The tables that have not been read yet.
    pub root: DeTable<'i>,
    /// The text, for places of errors.
    pub source: &'a Source,
}

impl<'i> Tables<'_, 'i> {
    /// The table `[name]` of a case, or an empty one if the file has none.
    pub(super) fn read<T: DeserializeOwned>(&mut self, name: &str) -> Result<T, CaseError> {
        let table = self.table(name)?;
        self.read_section(table, name, &header(name))
    }

    /// The table `[name]`, which has these keys, or an empty one if the file has none.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for a value that is not a table, unknown keys, and values of another type.
    pub fn read_with<T: DeserializeOwned>(&mut self, name: &str, keys: &[Key]) -> Result<T, CaseError> {
        let mut table = self.table(name)?;
        if let DeValue::Table(given) = table.get_mut() {
            fill_in_all(given, keys);
        }
        self.read_keys(table, &header(name), None)
    }

    /// Takes the table `[name]` out of the file.
    fn table(&mut self, name: &str) -> Result<Spanned<DeValue<'i>>, CaseError> {
        let table = self.root.remove(name);
        let table = table.unwrap_or_else(|| Spanned::new(0..0, DeValue::Table(DeTable::default())));
        if !table.get_ref().is_table() {
            let sentence = format!("`{name}` must be a table: write its keys below a line [{name}]");
            return Err(self.source.error_at(table.span(), sentence));
        }
        Ok(table)
    }

    /// The table under `header`, with the defaults of a table or shape of texture called `section`.
    pub(super) fn read_section<T: DeserializeOwned>(
        &self,
        mut table: Spanned<DeValue<'i>>,
        section: &str,
        header: &str,
    ) -> Result<T, CaseError> {
        let section = SECTIONS.iter().find(|found| found.name == section);
        if let (Some(section), DeValue::Table(keys)) = (section, table.get_mut()) {
            section.fill_in(keys);
        }
        self.read_keys(table, header, section)
    }

    /// The table under `header`, of any type that toml can read.
    pub fn read_table<T: DeserializeOwned>(
        &self,
        table: Spanned<DeValue<'i>>,
        header: &str,
    ) -> Result<T, CaseError> {
        let span = table.span();
        T::deserialize(ValueDeserializer::from(table)).map_err(|error| {
            let span = error.span().unwrap_or(span);
            value_error(self.source, span, error.message(), header, names_of::<T>(), None)
        })
    }

    /// Reads the table under `header`, which has the keys of `section` if it belongs to a case.
    pub(super) fn read_keys<T: DeserializeOwned>(
        &self,
        table: Spanned<DeValue<'i>>,
        header: &str,
        section: Option<&Section>,
    ) -> Result<T, CaseError> {
        let span = table.span();
        T::deserialize(Reader::from(table)).map_err(|error| {
            // An error about the whole table, such as a missing size, has no span.
            let span = error.span.unwrap_or(span);
            value_error(
                self.source,
                span,
                &error.message,
                header,
                names_of::<T>(),
                section,
            )
        })
    }
}
