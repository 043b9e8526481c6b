//! The content of a fields file, the names in it, and the errors of writing and reading it.

use std::io;
use std::path::PathBuf;

use slipfront::Scales;
use slipfront::observe::frames::kept;
use slipfront::observe::{Field, Frame};

// Dimensions, variables and attributes.
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

/// The fields of one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct FieldFrame {
    /// Time t*.
    pub time_star: f64,
    /// Name of the instant: `A` to `F`, several letters if they coincide, or empty.
    pub label: String,
    /// Number of the time step.
    pub step: u64,
    /// One array per name in [`FieldsData::names`], in the unit of
    /// [`FieldInfo::unit`](slipfront_case::field_info::FieldInfo::unit), thinned by [`thin`] and row-major.
    pub values: Vec<Vec<f32>>,
}

impl FieldFrame {
    /// A dimensionless frame of these fields in the units of
    /// [`FieldInfo::unit`](slipfront_case::field_info::FieldInfo::unit). The contact stress becomes tau_c*:
    /// it is divided by `contact_stress_max`, its largest value so far (see
    /// [`Simulation::contact_stress_max`](slipfront::Simulation::contact_stress_max)).
    pub fn in_si_units(
        frame: Frame,
        label: String,
        names: &[Field],
        scales: &Scales,
        contact_stress_max: f64,
    ) -> Self {
        let mut values = frame.values;
        for (field, values) in names.iter().zip(&mut values) {
            let unit = match field {
                // A run in which no block was ever loaded has no largest stress to divide by.
                Field::ContactStress if contact_stress_max > 0.0 => 1.0 / contact_stress_max,
                Field::ContactStress | Field::Sliding => 1.0,
                Field::Traction => scales.stress(),
                Field::DisplacementX | Field::DisplacementY => scales.displacement(),
                Field::VelocityX | Field::VelocityY => scales.speed(),
            };
            for value in values {
                *value = (f64::from(*value) * unit) as f32;
            }
        }
        Self {
            time_star: frame.time_star,
            label,
            step: frame.step,
            values,
        }
    }
}

/// The content of a `fields.nc`; every array is row-major and thinned to `columns() * rows()` values, unless
/// it was reduced further, or only some rows were read or are held by a process that shares the lattice.
#[derive(Debug, Default, Clone, PartialEq)]
pub struct FieldsData {
    /// Number of blocks along x, before thinning.
    pub nx: usize,
    /// Number of blocks along y, before thinning.
    pub ny: usize,
    /// Every n-th block is in the file, in both directions, from block 0 on.
    pub stride: usize,
    /// The row of the file with which the arrays begin.
    pub first_row: usize,
    /// Edge of a block, in m.
    pub block_size: f64,
    /// Duration of one unit of t*, in s.
    pub time_unit_s: f64,
    /// The fields of every frame, each once, in the order of [`FieldFrame::values`]; a file without frames
    /// has none.
    pub names: Vec<Field>,
    /// Whether the block is texture.
    pub textured: Vec<bool>,
    /// Static friction coefficients.
    pub mu_static: Vec<f64>,
    /// Kinetic friction coefficients.
    pub mu_kinetic: Vec<f64>,
    /// Time t* of the first slip; NaN = never slipped.
    pub first_slip_time_star: Vec<f64>,
    /// The instants, in order of time; NetCDF requires that no time occurs twice.
    pub frames: Vec<FieldFrame>,
}

impl FieldsData {
    /// Number of values along x.
    pub fn columns(&self) -> usize {
        kept(0..self.nx, self.stride.max(1)).len()
    }

    /// Number of values along y.
    pub fn rows(&self) -> usize {
        kept(0..self.ny, self.stride.max(1)).len()
    }

    /// Length of the labels, at least 1, because NetCDF has no length 0.
    pub(super) fn label_length(&self) -> usize {
        let lengths = self.frames.iter().map(|frame| frame.label.len());
        lengths.max().unwrap_or(0).max(1)
    }
}

/// Keeps every `stride`-th value of every `stride`-th row, from the first on.
///
/// `values` is row-major with rows of `nx`; a `stride` of 0 counts as 1. The result has rows of
/// `nx.div_ceil(stride)`.
///
/// ```
/// # use slipfront_run::fields::thin;
/// assert!(thin(&[0, 1, 2, 10, 11, 12, 20, 21, 22], 3, 2).eq([0, 2, 20, 22]));
/// ```
pub fn thin<T: Copy>(values: &[T], nx: usize, stride: usize) -> impl Iterator<Item = T> {
    let stride = stride.max(1);
    let rows = values.chunks(nx.max(1)).step_by(stride);
    rows.flat_map(move |row| row.iter().step_by(stride)).copied()
}

/// An error of writing or reading `fields.nc`: one sentence that ends with the remedy.
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum FieldsError {
    #[error("cannot write `{path}`: {source}; check that the folder exists, is writable and has room")]
    Write { path: PathBuf, source: io::Error },
    #[error("cannot read `{path}`: {source}; check the path and its permissions")]
    Read { path: PathBuf, source: io::Error },
    #[error("`{path}` is not a fields file of slipfront: {detail}; run the case again")]
    Broken { path: PathBuf, detail: String },
}
