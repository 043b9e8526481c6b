//! From a wish to a texture: the search for a mask, or for the numbers of shapes, that gives the requested
//! friction within limits; and the verdict on the result.
//!
//! ```text
//! wish, limits -> drafts of patches, or numbers -> masks -> runs on one surface -> the best on several -> the verdict on fresh ones
//! ```
//!
//! A search uses a few surfaces, and its result may be good only on these. The verdict therefore measures its
//! values on fresh surfaces.

mod design;
mod evaluate;
mod file;
mod folder;
mod judge;
mod limits;
mod mean;
mod named_patterns;
mod numbers;
mod open_search;
mod pareto_front;
mod patch;
mod plan;
mod ranges;
mod report;
mod search;
mod sensitivity;
mod shapes;
mod slider_blocks;
mod space;
mod stages;
mod start;
mod subject;
mod tolerance;
mod trial;
mod verdict;
mod wish;

pub use design::{Design, Outcome};
pub use evaluate::{Keep, MadeRun, RunCache, RunId, RunOutcome};
pub use file::{DesignFile, DesignKeys};
pub use folder::{DESIGNS, DesignFolder};
pub use limits::{Illegal, Limits};
pub use mean::Mean;
pub use open_search::OpenSearch;
pub use plan::DesignPlan;
pub use sensitivity::{Changed, LeftOut, Sensitivity};
pub use slider_blocks::SliderBlocks;
pub use stages::{Bounds, Cut, DesignStage, RunCost, SearchProgress};
pub use tolerance::WithinTolerance;
pub use verdict::{FreshValues, OnFresh, Verdict};
pub use wish::{FrictionUnit, Measured, Quantity, Target, Wish};
