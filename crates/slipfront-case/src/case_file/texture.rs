//! `[[texture]]`: the parts of the surface that do not touch the plane (Eqs. 15, 17 and 18).

use serde::Serialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::check::Check;
use super::error::CaseError;
use super::key_table::SECTIONS;
use super::keys::{texture_header, unknown_shape};
use super::pattern::Pattern;
use super::probe::names_of;
use super::shapes::Shape;
use super::tables::Tables;

/// One `[[texture]]` of the file; a block is textured when its centre lies inside any of them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Texture {
    /// `shape` and the keys that it has.
    #[serde(flatten)]
    pub shape: Shape,
    /// The keys that every shape has.
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
    pub(super) fn read_textures(&mut self) -> Result<Vec<Texture>, CaseError> {
        let Some(value) = self.root.remove("texture") else {
            return Ok(Vec::new());
        };
        let span = value.span();
        let DeValue::Array(values) = value.into_inner() else {
            let sentence = "`texture` must be a list of tables: write [[texture]] above the keys of each";
            return Err(self.source.error_at(span, sentence));
        };
        values.into_iter().map(|value| self.read_texture(value)).collect()
    }

    /// Reads a texture by its `shape`. Serde's internally tagged enums would lose the places of all keys.
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
            return Err(self.source.error_at(shape_span, unknown_shape(name)));
        };
        section.fill_in(&mut table);
        // The keys of the pattern, which all shapes have, are read apart.
        let mut pattern = DeTable::default();
        for key in names_of::<Pattern>() {
            if let Some((key, value)) = table.remove_entry(*key) {
                pattern.insert(key, value);
            }
        }
        let header = texture_header(section.name);
        let table = Spanned::new(span.clone(), DeValue::Table(table));
        let shape = match section.name {
            "cavity" => Shape::Cavity(self.read_keys(table, &header, Some(section))?),
            "groove" => Shape::Groove(self.read_keys(table, &header, Some(section))?),
            "polygon" => Shape::Polygon(self.read_keys(table, &header, Some(section))?),
            "height_map" => Shape::HeightMap(self.read_keys(table, &header, Some(section))?),
            _ => Shape::Mask(self.read_keys(table, &header, Some(section))?),
        };
        let pattern = Spanned::new(span, DeValue::Table(pattern));
        Ok(Texture {
            shape,
            pattern: self.read_keys(pattern, &header, Some(section))?,
        })
    }
}
