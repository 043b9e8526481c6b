//! The case file: every key that a user can write, with its default, and the text that it is read from.
//!
//! Text is parsed as TOML, changed by overrides (`--set`), read into these structs, and checked against every
//! bound that depends only on the file. Everything else, from units to the lattice, is done when a case is
//! built from the file.
//!
//! A key is a row of the struct of its table, with its meaning, unit, bounds, default and title. A test
//! writes `docs/reference/case-file.md` from these rows.

mod check;
mod depth;
mod diagnose;
mod drive;
mod error;
mod file;
mod friction;
mod initial;
mod interface;
mod key;
mod key_rows;
mod key_table;
mod keys;
mod length_of_a_block;
mod load;
mod output;
mod overrides;
mod pattern;
mod reader;
mod serde_names;
mod shapes;
mod slider;
mod source;
mod synonyms;
mod tables;
mod text;
mod texture;
mod time;
mod values;
mod words;

pub use depth::{limit_nesting, parts_of};
pub use diagnose::syntax_error;
pub use drive::{Attached, AutoOrStiffness, Drive, DriveSpeed, DriveStiffness, SpeedSegment};
pub use error::{CaseError, Invalid, Place};
pub use file::{CaseFile, FileUse, NamedFile, ParsedCase};
pub use friction::*;
pub use initial::Initial;
pub use key::{Bounds, Key, KeyKind, StarUnit, Title, key, whole};
pub(crate) use key_table::star_unit;
pub use key_table::{SECTIONS, Section, names_a_file, title_of};
pub use keys::{
    STUDY_TABLES, TABLES as CASE_TABLES, exclude_each_other, header_below, partners_of,
    unknown as unknown_key, unknown_table as unknown_case_table,
};
pub use length_of_a_block::LengthOfABlock;
pub use load::{Along, Load, Near, Profile, Redistribute};
pub use output::{Output, Snapshots};
pub use overrides::Override;
pub(crate) use pattern::MAX_COUNT;
pub use pattern::{Array, Count, Pattern, Pitch};
pub use serde_names::names_of;
pub use shapes::*;
pub use slider::{Damping, Grade, Slider};
pub(crate) use slider::{MAX_BLOCKS, MAX_BLOCKS_TOTAL, MAX_RELATIVE, MIN_RELATIVE};
pub use source::Source;
pub use tables::Tables;
pub use text::{read_text, read_text_from};
pub use texture::Texture;
pub use time::{RunTime, Time, TimeStep};
pub use values::AutoOr;
pub use words::{Arrangement, AttachedEdge, Body, EdgeSprings, FrictionAlong, Loading, Motion, Outline};

#[cfg(test)]
mod tests;
