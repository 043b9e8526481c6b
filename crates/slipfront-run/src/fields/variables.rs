//! Names of dimensions, variables and attributes in the file, shared by the writer and the reader.

pub(super) const TIME: &str = "time";
pub(super) const X: &str = "x";
pub(super) const Y: &str = "y";
pub(super) const LABEL_LENGTH: &str = "instant_length";
pub(super) const TIME_STAR: &str = "time_star";
pub(super) const STEP: &str = "step";
pub(super) const LABEL: &str = "instant";
pub(super) const TEXTURED: &str = "textured";
pub(super) const MU_STATIC: &str = "mu_static";
pub(super) const MU_KINETIC: &str = "mu_kinetic";
pub(super) const FIRST_SLIP: &str = "first_slip_time_star";
pub(super) const BLOCKS: &str = "blocks";
pub(super) const STRIDE: &str = "stride";
pub(super) const BLOCK_SIZE: &str = "block_size_m";
pub(super) const TIME_UNIT: &str = "time_unit_s";
