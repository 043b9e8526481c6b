//! The output of `slipfront paper`: pictures, tables, `claims.csv`, `report.html`, and the page of `docs/validation`.

mod drawn;
mod html;
mod markdown;
mod summary;
mod tables;
mod words;
mod write;

pub use markdown::page as docs_page;
pub use summary::summary;
pub use write::{foreign_docs, write, write_docs};
