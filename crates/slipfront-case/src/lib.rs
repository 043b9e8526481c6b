//! Text and files in, a case out: everything between what a user writes and the physics of [`slipfront`].
//!
//! ```text
//! text -> CaseFile -> Case (valid by construction)
//! ```
//!
//! Each arrow is one function: [`case_file::CaseFile::load`], [`case::Case::new`].

pub mod arrays;
pub mod case;
pub mod case_file;
pub mod disk;
pub mod field_info;
pub mod machine;
pub mod number_format;
pub mod quantity;
pub mod text;
