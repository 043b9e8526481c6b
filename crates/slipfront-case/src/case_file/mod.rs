//! The case file: every key that a user can write, with its default, and the text it is read from.
//!
//! Reading goes: text -> TOML table -> overrides (`--set`) -> these structs -> checks of every bound that the file
//! alone can tell. What remains, from units to the lattice, is the work of the case that is built from it next.

mod check;
mod depth;
mod error;
mod keys;
mod motion;
mod output;
mod overrides;
mod slider;
mod source;
mod tables;
mod texture;
mod time;
mod values;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

pub use depth::limit_nesting;
pub use error::{CaseError, Invalid};
pub use keys::{
    STUDY_TABLES, TABLES as CASE_TABLES, exclude_each_other, header_below, keys_of, partners_of,
    unknown as unknown_key,
};
pub use motion::{Drive, DriveSpeed, Friction, KineticFriction, Law, Load};
pub use output::{Output, Snapshots};
pub use slider::{Damping, Edge, Slider};
pub use source::{Place, Source};
pub use tables::Tables;
pub use texture::{
    Cavity, CavitySize, Center, DEFAULT_THRESHOLD, Groove, GrooveSize, Mask, Orientation, Polygon, Texture,
};
pub use time::{RunTime, Step, Stop, Time};
pub use values::AutoOr;

/// The largest file that is read as a case, in MiB.
pub const MAX_MIB: u64 = 16;

/// A whole case file. The default is the baseline of Fig. 3, Table 1 case 8.
///
/// A parsed case is within all bounds; one that was changed in code can be [checked](CaseFile::check) again.
///
/// ```
/// use slipfront_case::case_file::{CaseFile, DriveSpeed};
/// let text = "[slider]\nblocks = [50, 50]\n";
/// let case = CaseFile::parse(text, "case.toml", &["drive.speed=1 mm/s".to_owned()])?;
/// assert_eq!(case.slider.blocks, [50, 50]);
/// assert!(matches!(&case.drive.speed, DriveSpeed::Speed(speed) if speed.si() == 1e-3));
/// assert_eq!(case.friction, CaseFile::default().friction);
/// assert_eq!(CaseFile::parse(&case.to_toml()?, "printed", &[])?, case);
/// # Ok::<(), slipfront_case::case_file::CaseError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct CaseFile {
    /// `[slider]`: the lattice of blocks and its material.
    pub slider: Slider,
    /// `[load]`: the normal load.
    pub load: Load,
    /// `[drive]`: how the slider is pulled.
    pub drive: Drive,
    /// `[friction]`: the law and the local coefficients.
    pub friction: Friction,
    /// `[[texture]]`: the parts of the surface that do not touch; they unite.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub texture: Vec<Texture>,
    /// `[time]`: duration, step, end and averaging window.
    pub time: Time,
    /// `[output]`: what is written.
    pub output: Output,
    /// What the case was read from, for errors found later: see [`Source::error`].
    #[serde(skip)]
    pub source: Source,
}

impl CaseFile {
    /// Reads a case from the text of a TOML file, changed by `overrides` of the form `drive.v_star=0.05`.
    ///
    /// `name` stands for the file in messages. An override's value is TOML, or else a string as it stands; it displaces
    /// a key that excludes it, such as `drive.v_star` of the file when `drive.speed` is set.
    ///
    /// # Errors
    /// [`CaseError::Invalid`], with its place, for what is not TOML, not a known key, or out of its bounds.
    pub fn parse(text: &str, name: &str, overrides: &[String]) -> Result<Self, CaseError> {
        let mut source = Source::new(name, text, overrides);
        let text = source.text();
        let root = DeTable::parse(limit_nesting(&text[..source.file_len()]));
        let mut root = root
            .map_err(|error| CaseError::syntax(&source, 0, &error))?
            .into_inner();
        for span in source.overrides() {
            overrides::apply(&mut root, &source, &text, span)?;
        }
        source.note_places(&root);
        keys::refuse_both(&root, &source)?;
        let mut tables = Tables {
            root,
            source: &source,
        };
        let mut case = Self {
            slider: tables.read("slider")?,
            load: tables.read("load")?,
            drive: tables.read("drive")?,
            friction: tables.read("friction")?,
            texture: tables.read_textures()?,
            time: tables.read("time")?,
            output: tables.read("output")?,
            source: Source::default(),
        };
        tables.refuse_rest()?;
        case.source = source;
        case.check()?;
        Ok(case)
    }

    /// Reads a case file of at most 16 MiB, as [`parse`](Self::parse) does.
    ///
    /// # Errors
    /// As for `parse`, and when the path is missing, a folder, too large or not UTF-8 text.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, CaseError> {
        let text = read_text(path)?;
        Self::parse(&text, &path.display().to_string(), overrides)
    }

    /// Every file that the case names, relative to the case file, and the key that names it.
    pub fn files_mut(&mut self) -> impl Iterator<Item = (String, &mut String)> {
        let masks = self
            .texture
            .iter_mut()
            .enumerate()
            .filter_map(|(index, texture)| match texture {
                Texture::Mask(mask) => Some((format!("texture.{index}.file"), &mut mask.file)),
                Texture::Cavity(_) | Texture::Groove(_) | Texture::Polygon(_) => None,
            });
        let fields = [
            ("friction.mu_static_field", &mut self.friction.mu_static_field),
            ("friction.mu_kinetic_field", &mut self.friction.mu_kinetic_field),
        ];
        masks.chain(
            fields
                .into_iter()
                .filter_map(|(key, name)| Some((key.to_owned(), name.as_mut()?))),
        )
    }

    /// Writes the case with every default filled in, in the order of the design; reading it back gives an equal case.
    ///
    /// # Errors
    /// Those of [`check`](Self::check) for a case that was changed in code: what is written can be read.
    pub fn to_toml(&self) -> Result<String, CaseError> {
        self.check()?;
        Ok(toml::to_string(self)?)
    }
}

/// Reads a case or study file of at most 16 MiB.
///
/// # Errors
/// When the path is missing, a folder, too large or not UTF-8 text.
pub fn read_text(path: &Path) -> Result<String, CaseError> {
    let unreadable = |source| CaseError::Unreadable {
        path: path.to_owned(),
        source,
    };
    if path.is_dir() {
        return Err(CaseError::Folder {
            path: path.to_owned(),
        });
    }
    let limit = MAX_MIB << 20;
    let mut bytes = Vec::new();
    // The limit holds for what is read, since a device or a pipe tells no size.
    File::open(path)
        .and_then(|file| file.take(limit + 1).read_to_end(&mut bytes))
        .map_err(unreadable)?;
    if bytes.len() as u64 > limit {
        return Err(CaseError::TooLarge {
            path: path.to_owned(),
            limit_mib: MAX_MIB,
        });
    }
    String::from_utf8(bytes).map_err(|error| {
        let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = good.iter().filter(|byte| **byte == b'\n').count() + 1;
        CaseError::NotText {
            path: path.to_owned(),
            line,
        }
    })
}

impl<'i> Tables<'_, 'i> {
    fn read_textures(&mut self) -> Result<Vec<Texture>, CaseError> {
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
        let table = Spanned::new(span, DeValue::Table(table));
        let name = shape.as_ref().and_then(|shape| shape.get_ref().as_str());
        match name {
            Some("cavity") => self.read_shape(table, "cavity").map(Texture::Cavity),
            Some("groove") => self.read_shape(table, "groove").map(Texture::Groove),
            Some("polygon") => self.read_shape(table, "polygon").map(Texture::Polygon),
            Some("mask") => self.read_shape(table, "mask").map(Texture::Mask),
            _ => Err(self.source.error_at(shape_span, keys::unknown_shape(name))),
        }
    }

    fn read_shape<T: DeserializeOwned>(
        &self,
        table: Spanned<DeValue<'i>>,
        shape: &str,
    ) -> Result<T, CaseError> {
        self.read_table(table, &keys::texture_header(shape), keys::keys_of::<T>())
    }

    fn refuse_rest(self) -> Result<(), CaseError> {
        // The first in the file, not the first of the alphabet.
        match self.root.keys().min_by_key(|key| key.span().start) {
            None => Ok(()),
            Some(key) => Err(self
                .source
                .error_at(key.span(), keys::unknown_table(key.get_ref()))),
        }
    }
}

#[cfg(test)]
mod tests;
