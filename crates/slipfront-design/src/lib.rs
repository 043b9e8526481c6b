//! From a wish to a texture: the search for a mask with the wished friction, within limits, and the verdict on it.
//!
//! ```text
//! wish, limits -> drafts of patches -> masks -> runs on one surface -> the best on several -> the verdict on fresh ones
//! ```
//!
//! A search sees some surfaces, and its result is good on these. The values in a verdict are measured on fresh surfaces.

mod adaptation;
mod design;
mod evaluate;
mod file;
mod folder;
mod front;
mod grid;
mod judge;
mod limits;
mod named;
mod open_search;
mod patch;
mod report;
mod search;
mod sensitivity;
mod stages;
mod start;
mod subject;
mod verdict;
mod wish;

pub use design::{Design, Outcome};
pub use evaluate::{Ended, Keep, Known, MadeRun, RunId};
pub use file::{DesignFile, DesignKeys};
pub use folder::{DESIGNS, DesignFolder};
pub use grid::Grid;
pub use judge::Mean;
pub use limits::{Illegal, Limits};
pub use open_search::OpenSearch;
pub use sensitivity::{Changed, LeftOut, Sensitivity};
pub use stages::{Bounds, Cut, DesignStage, SearchProgress, Work};
pub use verdict::{Given, OnFresh, Verdict};
pub use wish::{Measured, Quantity, Wish};
