//! The paper behind the model: reproduces every figure and table, and judges every claim.
//!
//! ```text
//! cases/*.toml -> runs -> FigureData (numbers, pictures, tables) -> verdicts -> report
//! ```
//!
//! A figure has its own file (`figures/fig12.rs`); its cases are in `cases/fig12.toml`, and the claims about
//! it in `cases/claims.toml`. The command is `slipfront paper`.

mod cache;
mod claims;
mod drawing;
mod embedded_cases;
mod error;
mod figure_data;
mod figures;
mod number;
mod paper;
mod report;
mod run;
mod runner;
mod statistics;
mod step_rule;
mod sweep;
mod verify;

pub use cache::{FigureCache, sources};
pub use claims::{Claim, ClaimResult, ClaimVerdict, Reading, claims};
pub use drawing::Drawing;
pub use embedded_cases::cases;
pub use error::PaperError;
pub use figure_data::{FigureData, Panel, Table};
pub use figures::{FIGURES, Figure, figures};
pub use number::MeasuredNumber;
pub use paper::{Paper, PaperOptions, Stage, run};
pub use report::{docs_page, foreign_docs, summary, write, write_docs};
pub use step_rule::StepRule;
pub use verify::verify;
