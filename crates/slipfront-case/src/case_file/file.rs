//! The case file as a whole.

use std::path::Path;

use serde::Serialize;
use slipfront::Edges;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::check::Check;
use super::depth::limit_nesting;
use super::diagnose::syntax_error;
use super::drive::{Attached, Drive};
use super::error::CaseError;
use super::friction::Friction;
use super::initial::Initial;
use super::key_table::keys_of;
use super::keys;
use super::load::Load;
use super::output::Output;
use super::overrides::Override;
use super::shapes::Shape;
use super::slider::{Damping, Slider};
use super::source::Source;
use super::tables::Tables;
use super::text::read_text;
use super::texture::Texture;
use super::time::Time;
use super::words::{Body, Loading};

/// A whole case file. The default is the baseline of Fig. 3, Table 1 case 8.
///
/// A parsed case is within all bounds. A case that was changed in code can be [checked](CaseFile::check)
/// again.
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
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseFile {
    /// `[slider]`: the lattice of blocks and its material.
    pub slider: Slider,
    /// `[load]`: the normal load, and a dead shear load.
    pub load: Load,
    /// `[drive]`: how the slider is pulled.
    pub drive: Drive,
    /// `[friction]`: the law and the local coefficients.
    pub friction: Friction,
    /// `[[texture]]`: the parts of the surface that do not touch; a block inside any of them is textured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub texture: Vec<Texture>,
    /// `[initial]`: the state at the start.
    #[serde(skip_serializing_if = "Initial::is_empty")]
    pub initial: Initial,
    /// `[time]`: duration, step, end and averaging window.
    pub time: Time,
    /// `[output]`: the results that are written.
    pub output: Output,
    /// Text of the case for errors found later: see [`Source::error`].
    #[serde(skip)]
    pub source: Source,
}

impl CaseFile {
    /// Reads a case from the text of a TOML file, changed by `overrides` of the form `drive.v_star=0.05`.
    ///
    /// `name` is the name of the file in messages. The value of an override is TOML, or otherwise a literal
    /// string. It replaces a key that excludes it, such as `drive.v_star` of the file when `drive.speed` is
    /// set.
    ///
    /// # Errors
    /// [`CaseError::Invalid`], with its place, for text that is not TOML, unknown keys and values out of
    /// their bounds.
    pub fn parse(text: &str, name: &str, overrides: &[String]) -> Result<Self, CaseError> {
        let base = ParsedCase::parse(text, name)?;
        let overrides = overrides.iter().map(|entry| Override::parse(entry));
        let overrides = overrides.collect::<Result<Vec<_>, _>>()?;
        base.with(&overrides.iter().collect::<Vec<_>>())
    }

    /// Reads a case file of at most 16 MiB, as [`parse`](Self::parse) does.
    ///
    /// # Errors
    /// As for `parse`, and when the path is missing, a folder, too large or not UTF-8 text.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, CaseError> {
        let text = read_text(path)?;
        Self::parse(&text, &path.display().to_string(), overrides)
    }

    /// All files that the case names, and the source of the case, for errors about a file.
    pub fn files_mut(&mut self) -> (impl Iterator<Item = NamedFile<'_>>, &Source) {
        let named = |key: &str, name, holds| NamedFile {
            key: key.to_owned(),
            name,
            holds,
        };
        let of_textures = self.texture.iter_mut().enumerate();
        let of_textures = of_textures.filter_map(move |(index, texture)| {
            let key = format!("texture.{index}.file");
            match &mut texture.shape {
                Shape::Mask(mask) => Some(named(&key, &mut mask.file, FileUse::Blocks)),
                Shape::HeightMap(map) => Some(named(&key, &mut map.file, FileUse::HeightMap)),
                Shape::Drawing(drawing) => Some(named(&key, &mut drawing.file, FileUse::Drawing)),
                _ => None,
            }
        });
        let fields = [
            ("slider.stiffness_field", &mut self.slider.stiffness_field),
            ("slider.density_field", &mut self.slider.density_field),
            ("load.pressure_field", &mut self.load.pressure_field),
            ("load.shear_field", &mut self.load.shear_field),
            ("friction.mu_static_field", &mut self.friction.mu_static_field),
            ("friction.mu_kinetic_field", &mut self.friction.mu_kinetic_field),
            ("initial.displacement_x", &mut self.initial.displacement_x),
            ("initial.displacement_y", &mut self.initial.displacement_y),
            ("initial.velocity_x", &mut self.initial.velocity_x),
            ("initial.velocity_y", &mut self.initial.velocity_y),
        ];
        let fields = fields.into_iter();
        let attached = match &mut self.drive.attached {
            Attached::File(name) => Some(named("drive.attach_file", name, FileUse::Blocks)),
            Attached::At(_) => None,
        };
        let of_fields =
            fields.filter_map(move |(key, name)| Some(named(key, name.as_mut()?, FileUse::Numbers)));
        let outline = self.slider.outline_file.as_mut();
        let outline = outline.map(|name| named("slider.outline_file", name, FileUse::Blocks));
        let state = self.initial.state_file.as_mut();
        let state = state.map(|name| named("initial.state_file", name, FileUse::State));
        (
            of_textures
                .chain(attached)
                .chain(outline)
                .chain(of_fields)
                .chain(state),
            &self.source,
        )
    }

    /// Checks every bound that depends only on the file. [`parse`](Self::parse) has already done so.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] at the place of the value, with the value, its bound and the remedy.
    pub fn check(&self) -> Result<(), CaseError> {
        let check = |table| Check::new(&self.source, keys_of(table), table);
        self.slider.check(&check("slider"))?;
        self.load.check(&check("load"))?;
        self.drive.check(&check("drive"), &self.slider)?;
        self.friction.check(&check("friction"))?;
        self.load.check_shear(&check("load"), self.drive.motion)?;
        self.check_interface()?;
        if self.drive.loading == Loading::Held {
            self.friction.check_held(&check("friction"))?;
        }
        if self.output.events {
            self.friction.check_events(&check("friction"))?;
        }
        for (index, texture) in self.texture.iter().enumerate() {
            let path = format!("texture.{index}");
            texture.check(&Check::new(&self.source, keys_of(texture.shape.name()), &path))?;
        }
        self.initial.check(&check("initial"), self.friction.contact)?;
        self.time.check(&check("time"), &self.drive.speed)?;
        self.output.check(&check("output"))
    }

    /// Sets the keys that have another default for a bulk body, unless the file gives them: a bulk body is a
    /// periodic piece of a larger part, and the strength of one that weakens with slip is found under slow
    /// loading.
    fn choose_defaults_of_body(&mut self) {
        let is_bulk = self.slider.body == Body::Bulk;
        if !self.source.has("slider.edges") {
            self.slider.edges = [if is_bulk { Edges::Periodic } else { Edges::Free }; 2];
        }
        if !self.source.has("slider.omega_star") && !self.source.has("slider.damping_rate") {
            self.slider.damping = Damping::OmegaStar(self.slider.critical_damping().unwrap_or(0.1));
        }
        if !self.source.has("drive.loading") {
            let weakens = self.friction.falls_with_slip();
            self.drive.loading = if is_bulk && weakens {
                Loading::Held
            } else {
                Loading::Constant
            };
        }
    }

    /// Writes the case with all defaults filled in, in the order of the design. Reading it back gives an
    /// equal case.
    ///
    /// # Errors
    /// Errors of [`check`](Self::check), so that the written text of a case that was changed in code can be
    /// read.
    pub fn to_toml(&self) -> Result<String, CaseError> {
        self.check()?;
        // Written through a table, so that the keys of every struct need only one writer.
        Ok(toml::to_string(&self.to_table()?)?)
    }

    /// The tables of the case, without keys that do not apply to its friction.
    fn to_table(&self) -> Result<toml::Value, toml::ser::Error> {
        let mut tables = toml::Value::try_from(self)?;
        let friction = tables.get_mut("friction").and_then(toml::Value::as_table_mut);
        if let Some(friction) = friction.filter(|_| !self.friction.has_kinetic_coefficient()) {
            friction.retain(|key, _| !Friction::KINETIC.contains(&key));
        }
        Ok(tables)
    }

    /// Every key, in backticks, with its value; defaults are filled in.
    ///
    /// ```
    /// use slipfront_case::case_file::CaseFile;
    /// let values = CaseFile::default().values();
    /// assert!(values.contains(&("`slider.blocks`".to_owned(), "[25, 25]".to_owned())));
    /// ```
    pub fn values(&self) -> Vec<(String, String)> {
        let mut values = Vec::new();
        // A loaded case can always be written.
        let tables = self.to_table();
        flatten("", &tables.unwrap_or(toml::Value::Boolean(false)), &mut values);
        values
    }
}

/// Adds all values below a key, with their full keys. An array of plain values is one value.
fn flatten(key: &str, value: &toml::Value, values: &mut Vec<(String, String)>) {
    let below = |name: &str| match key {
        "" => name.to_owned(),
        _ => format!("{key}.{name}"),
    };
    match value {
        toml::Value::Table(table) => {
            for (name, value) in table {
                flatten(&below(name), value, values);
            }
        }
        toml::Value::Array(array) if array.iter().any(|value| value.is_table() || value.is_array()) => {
            for (index, value) in array.iter().enumerate() {
                flatten(&below(&index.to_string()), value, values);
            }
        }
        plain => values.push((format!("`{key}`"), plain.to_string())),
    }
}

/// A file that a case names.
pub struct NamedFile<'a> {
    /// The key that names the file.
    pub key: String,
    /// Path of the file, relative to the case file.
    pub name: &'a mut String,
    /// Use of the file.
    pub holds: FileUse,
}

/// Use of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileUse {
    /// A number of each block.
    Numbers,
    /// Chosen blocks, in an image or an array.
    Blocks,
    /// Measured heights, with any number of points.
    HeightMap,
    /// Outlines in true size.
    Drawing,
    /// Displacements and velocities of each block, four numbers.
    State,
}

impl Default for CaseFile {
    fn default() -> Self {
        Self::parse("", "", &[]).expect("the defaults of the table of keys are a case")
    }
}

/// A case file parsed as TOML, from which overrides make cases.
#[derive(Clone, Debug)]
pub struct ParsedCase<'t> {
    root: DeTable<'t>,
    source: Source,
    /// The case without overrides, if it was read and is valid.
    plain: Option<CaseFile>,
}

impl<'t> ParsedCase<'t> {
    /// Parses the text of a case file, which messages call `name`.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for text that is not TOML.
    pub fn parse(text: &'t str, name: &str) -> Result<Self, CaseError> {
        Self::parse_from(text, Source::new(name, text))
    }

    /// Parses the text of a case file; `source` is that text, with the known places of its keys.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for text that is not TOML.
    pub fn parse_from(text: &'t str, source: Source) -> Result<Self, CaseError> {
        let root = DeTable::parse(limit_nesting(&source, 0, text)?);
        let root = root.map_err(|error| syntax_error(&source, 0, &error))?;
        Ok(Self {
            root: root.into_inner(),
            source,
            plain: None,
        })
    }

    /// Sets these keys of the file in order, as `--set` does.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for an override that does not fit; errors of the case come from
    /// [`with`](Self::with).
    pub fn set(mut self, overrides: &'t [Override]) -> Result<Self, CaseError> {
        for change in overrides {
            change.apply(&mut self.root, &mut self.source)?;
        }
        Ok(self)
    }

    /// The keys of the file, without defaults.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for a value that no table of TOML can hold.
    pub fn to_table(&self) -> Result<toml::Table, CaseError> {
        let tables = Tables {
            root: DeTable::default(),
            source: &self.source,
        };
        let root = Spanned::new(0..0, DeValue::Table(self.root.clone()));
        tables.read_table(root, "a case")
    }

    /// Makes the case with these overrides the base of many cases. The base is read once, so that
    /// [`with`](Self::with) reads only the tables that change further.
    ///
    /// # Errors
    /// [`CaseError::Invalid`] for an override that does not fit; errors of the case come from `with`.
    pub fn prepared<'a>(&'a self, overrides: &[&'a Override]) -> Result<ParsedCase<'a>, CaseError> {
        let mut prepared = ParsedCase {
            root: self.root.clone(),
            source: self.source.clone(),
            plain: None,
        };
        for change in overrides {
            change.apply(&mut prepared.root, &mut prepared.source)?;
        }
        prepared.plain = prepared.with(&[]).ok();
        Ok(prepared)
    }

    /// The case with these overrides, applied in order.
    ///
    /// # Errors
    /// [`CaseError::Invalid`], with its place, for an unknown key or a value out of its bounds.
    pub fn with(&self, overrides: &[&Override]) -> Result<CaseFile, CaseError> {
        let plain = self.plain.as_ref();
        let changed: Vec<&str> = overrides.iter().map(|change| change.table()).collect();
        let is_read = |table: &str| plain.is_none() || changed.contains(&table);
        let tables = self.root.iter().filter(|(key, _)| is_read(key.get_ref()));
        let mut root: DeTable<'_> = tables.map(|(key, table)| (key.clone(), table.clone())).collect();
        let mut source = match plain {
            Some(plain) => plain.source.without(&changed),
            None => self.source.clone(),
        };
        for change in overrides {
            change.apply(&mut root, &mut source)?;
        }
        source.note_places(&root);
        keys::refuse_both(&root, &source)?;
        let mut tables = Tables {
            root,
            source: &source,
        };
        /// Expands to a table of the case, which is read only if an override has changed it.
        macro_rules! table {
            ($name:ident, $read:expr) => {
                match plain {
                    Some(plain) if !is_read(stringify!($name)) => plain.$name.clone(),
                    _ => $read,
                }
            };
        }
        let mut case = CaseFile {
            slider: table!(slider, tables.read("slider")?),
            load: table!(load, tables.read("load")?),
            drive: table!(drive, tables.read("drive")?),
            friction: table!(friction, tables.read("friction")?),
            texture: table!(texture, tables.read_textures()?),
            initial: table!(initial, tables.read("initial")?),
            time: table!(time, tables.read("time")?),
            output: table!(output, tables.read("output")?),
            source: Source::default(),
        };
        // The first in the file, not in the alphabet.
        let first = || tables.root.keys().min_by_key(|key| key.span().start);
        // A design file may begin with the tables of a study file.
        let of_design = || tables.root.keys().find(|key| *key.get_ref() == keys::DESIGN);
        if let Some(key) = of_design().or_else(first) {
            return Err(source.error_at(key.span(), keys::unknown_table(key.get_ref())));
        }
        case.source = source;
        case.choose_defaults_of_body();
        case.check()?;
        Ok(case)
    }
}
