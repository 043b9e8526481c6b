//! The whole paper: every figure and table run again, and every claim judged.
//!
//! ```text
//! cases/*.toml -> runs -> Found (numbers, pictures, tables) -> verdicts -> report
//! ```
//!
//! A figure is a file of its own (`figures/fig12.rs`), its cases stand in `cases/fig12.toml`, and the claims about it in
//! `cases/claims.toml`. Read by the command `slipfront paper`.

mod cache;
mod claims;
mod drawing;
mod embedded_cases;
mod error;
mod figures;
mod measurements;
mod paper;
mod report;
mod runner;

pub use cache::Saved;
pub use claims::{Claim, Condition, Judged, Verdict, claims};
pub use drawing::Drawing;
pub use error::PaperError;
pub use figures::{FIGURES, Figure, figures};
pub use measurements::{Found, Number, Panel, Table};
pub use paper::{Options, Paper, Stage, run};
pub use report::{docs_page, foreign_docs, summary, write, write_docs};
pub use runner::StepRule;
