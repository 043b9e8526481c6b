//! Pictures for screen and print. Pictures of a run: friction against time, maps of contact stress, the
//! spread of slip, and the sizes of its events. Pictures of a parametric study: response curves, heat maps,
//! bars, all with their confidence intervals.
//!
//! Every picture is drawn once, on a canvas, and exported as SVG, PNG and PDF of the same physical size. By
//! default, curves, heat maps and bars are as wide as a journal's column, and maps of stress as wide as its
//! text. The bytes depend only on the arguments: there is no date and no random identifier.

mod axis;
mod bars;
mod canvas;
mod category_axis;
mod cell_means;
mod color_bar;
mod color_image;
mod contour;
mod distributions;
mod estimate;
mod export;
mod field_maps;
mod font;
mod frame;
mod friction;
mod friction_curve;
mod friction_layout;
mod front;
mod geometry;
mod gif_file;
mod heat_map;
mod label_placement;
mod lattice_map;
mod legend;
mod look;
#[expect(unreachable_pub, reason = "a link to a file of slipfront, which exports it")]
mod mask_outline;
mod movie;
mod movie_colours;
mod note;
mod pdf;
mod pdf_font;
mod picture;
mod picture_error;
mod png_file;
mod polar;
mod quantity_labels;
mod raster;
mod response;
mod series;
mod shapes;
mod short_names;
mod size;
mod sketch;
mod stress;
mod style;
mod svg;
mod text;
mod ticks;
mod truetype;

pub use bars::{Bar, BarChart, BarGroup, bars};
pub use cell_means::CellMeans;
pub use distributions::{Distribution, distributions};
pub use estimate::Estimate;
pub use field_maps::{FieldMap, FieldMaps, field_maps};
pub use friction::friction;
pub use friction_curve::{FrictionAxes, FrictionCurve, Instant, KineticLine};
pub use front::{FrontMap, SpaceTime, front, kymograph};
pub use gif_file::MovieGif;
pub use heat_map::{HeatAxis, HeatMap, heat_map};
pub use lattice_map::{DrawnLattice, SnapshotMap, SnapshotMaps};
pub use look::{PictureFormat, PictureLook};
pub use movie::{Movie, MoviePictures, MovieSize};
pub use picture::Picture;
pub use picture_error::PictureError;
pub use polar::{Polar, polar};
pub use quantity_labels::{FIRST_SLIP, QuantityLabel, SLIDING_SHARE, has_glyphs};
pub use response::{Response, Responses, response};
pub use shapes::{Shape, shapes};
pub use size::PictureSize;
pub use sketch::{Sketch, Stroke, StrokeStyle, sketch};
pub use stress::stress;
