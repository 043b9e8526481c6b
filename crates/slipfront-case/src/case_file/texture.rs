//! `[[texture]]`: the parts of the surface that do not touch the plane (Eqs. 15, 17 and 18).

use serde::Serialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::check::Check;
use super::error::CaseError;
use super::key_table::SECTIONS;
use super::keys::{texture_header, unknown, unknown_shape};
use super::pattern::Pattern;
use super::serde_names::names_of;
use super::shapes::Shape;
use super::tables::Tables;

/// One `[[texture]]` of the file; a block is textured when its centre lies inside any of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Texture {
    /// `shape` and its keys.
    #[serde(flatten)]
    pub shape: Shape,
    /// The keys common to all shapes.
    #[serde(flatten)]
    pub pattern: Pattern,
}

impl Texture {
    pub(super) fn check(&self, check: &Check) -> Result<(), CaseError> {
        self.shape.check(check)?;
        self.pattern.check(check)
    }
}

impl<'i> Tables<'_, 'i> {
    /// An error about the first key that no shape has, in a texture without `shape`; none if there is no such
    /// key.
    fn unknown_to_all_shapes(&self, table: &DeTable<'i>) -> Option<CaseError> {
        let mut known: Vec<&str> = vec!["shape"];
        let shapes = SECTIONS.iter().filter(|section| section.is_shape);
        for name in shapes.flat_map(|section| section.keys.iter().map(|key| key.name)) {
            if !known.contains(&name) {
                known.push(name);
            }
        }
        let others = table
            .keys()
            .filter(|key| !known.contains(&key.get_ref().as_ref()));
        let first = others.min_by_key(|key| key.span().start)?;
        let sentence = unknown(first.get_ref(), "[[texture]]", &known);
        Some(self.source.error_at(first.span(), sentence))
    }

    pub(super) fn read_textures(&mut self) -> Result<Vec<Texture>, CaseError> {
        let Some(value) = self.root.remove("texture") else {
            return Ok(Vec::new());
        };
        let span = value.span();
        let values = match value.into_inner() {
            DeValue::Array(values) => values,
            other => {
                let key = other.as_table().and_then(|table| table.keys().next());
                let first = key.map_or(String::new(), |key| {
                    format!("; `texture.0.{}` is that of the first one", key.get_ref())
                });
                let sentence = format!(
                    "`texture` must be a list of tables: write [[texture]] above the keys of each{first}"
                );
                return Err(self.source.error_at(span, sentence));
            }
        };
        values.into_iter().map(|value| self.read_texture(value)).collect()
    }

    /// Reads a texture according to its `shape`. Serde's internally tagged enums would lose the places of all
    /// keys.
    fn read_texture(&self, value: Spanned<DeValue<'i>>) -> Result<Texture, CaseError> {
        let span = value.span();
        let DeValue::Table(mut table) = value.into_inner() else {
            let sentence = "a texture must be a table: write [[texture]] above its keys";
            return Err(self.source.error_at(span, sentence));
        };
        let shape = table.remove("shape");
        let shape_span = shape.as_ref().map_or(span.clone(), Spanned::span);
        let name = shape.as_ref().and_then(|shape| shape.get_ref().as_str());
        let section = SECTIONS
            .iter()
            .find(|section| section.is_shape && Some(section.name) == name);
        let Some(section) = section else {
            if shape.is_none()
                && let Some(error) = self.unknown_to_all_shapes(&table)
            {
                return Err(error);
            }
            // A table that an override has added has the span of the override.
            let made = match self.source.override_at(span.start) {
                Some(_) if shape.is_none() => ". The case has no such texture, so that this begins one",
                _ => "",
            };
            let sentence = unknown_shape(name) + made;
            return Err(self.source.error_at(shape_span, sentence));
        };
        section.fill_in(&mut table);
        // The keys of the pattern, which are common to all shapes, are read separately.
        let mut pattern = DeTable::default();
        for key in names_of::<Pattern>() {
            if let Some((key, value)) = table.remove_entry(*key) {
                pattern.insert(key, value);
            }
        }
        let header = texture_header(section.name);
        let table = Spanned::new(span.clone(), DeValue::Table(table));
        let shape = Shape::read(self, section, table, &header)?;
        let shape = shape.ok_or_else(|| self.source.error_at(shape_span, unknown_shape(name)))?;
        let pattern = Spanned::new(span, DeValue::Table(pattern));
        Ok(Texture {
            shape,
            pattern: self.read_keys(pattern, &header, Some(section))?,
        })
    }
}
