//! `CaseFile` -> [`Case`]: a case that can be run, with every length counted in blocks and every file read.

mod budget;
mod bulk;
mod coarse;
mod coefficients;
mod derived;
mod drive;
mod few_blocks;
mod files;
mod groups;
mod inputs;
mod lengths;
mod model;
mod other_blocks;
mod output;
mod ranks;
mod runnable;
mod slider;
mod stick_slip;
mod textures;
mod time_plan;
mod topography;
mod warnings;
mod whole_slider;

pub use self::budget::{Budget, PICTURES, PROGRAM, memory_of_movie};
pub use self::derived::scales;
pub use self::files::{Files, FilesInMemory, OpenFile, Watch};
pub use self::groups::Groups;
pub use self::inputs::{Input, name_of_copy};
pub use self::lengths::CaseLength;
pub use self::model::TextureReport;
pub use self::output::{MAX_MAPS, MAX_PICTURES, Output, Snapshots, mapped_field};
pub use self::ranks::Ranks;
pub use self::runnable::{Case, Expected};
pub use self::time_plan::TimePlan;
pub use self::topography::Topography;
pub use self::whole_slider::WholeSlider;
