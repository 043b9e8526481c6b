//! The output of `slipfront paper`: pictures, tables, `claims.csv`, `report.html`, and the page of
//! `docs/validation`.

mod html;
mod markdown;
mod summary;
mod symbols;
mod tables;
mod write;

pub use markdown::page as docs_page;
pub use summary::summary;
pub use write::{foreign_docs, write, write_docs};
