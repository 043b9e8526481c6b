//! Fields over the lattice kept from chosen instants.

use serde::{Deserialize, Serialize};

use super::{CurvePoint, Observer, stress};
use crate::kernel::{Block, TOGETHER};
use crate::{Lattice, RunError, Snapshot};

/// A quantity with one value per block. Values are dimensionless, as everywhere in this crate.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    /// Contact stress tau_c (Eq. 10), in units of `P mu_s`; not yet scaled by its maximum.
    #[serde(rename = "contact_stress_star")]
    ContactStress,
    /// True traction `|F_f|/l^2`, in units of `P mu_s`; not a number over a texture.
    Traction,
    /// Displacement along x.
    DisplacementX,
    /// Displacement along y.
    DisplacementY,
    /// Velocity along x half a step later.
    VelocityX,
    /// Velocity along y half a step later.
    VelocityY,
    /// 1 for a block that slides, 0 for one that is stuck.
    Sliding,
}

impl Field {
    /// Every field.
    pub const ALL: [Field; 7] = [
        Field::ContactStress,
        Field::Traction,
        Field::DisplacementX,
        Field::DisplacementY,
        Field::VelocityX,
        Field::VelocityY,
        Field::Sliding,
    ];

    fn value(self, block: &Block, textured: bool) -> f64 {
        match self {
            Field::ContactStress => stress::contact_stress(block),
            Field::Traction if textured => f64::NAN,
            Field::Traction => stress::traction(block),
            Field::DisplacementX => block.displacement[0],
            Field::DisplacementY => block.displacement[1],
            Field::VelocityX => block.velocity[0],
            Field::VelocityY => block.velocity[1],
            Field::Sliding => f64::from(u8::from(block.slides())),
        }
    }
}

/// Fields of one instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Step.
    pub step: u64,
    /// t*.
    pub time_star: f64,
    /// mu* and N*.
    pub point: CurvePoint,
    /// One array per field, row by row from y = 0, every `stride`-th block of each axis from the first on.
    pub values: Vec<Vec<f32>>,
}

/// Which fields to keep, and of how many blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Selection {
    /// The fields, in this order.
    pub fields: Vec<Field>,
    /// Every n-th block along each axis.
    pub stride: usize,
}

impl Selection {
    /// Blocks of this lattice that are kept.
    fn n_kept(&self, lattice: &Lattice) -> usize {
        lattice.nx.div_ceil(self.stride) * lattice.ny.div_ceil(self.stride)
    }

    /// Whether a frame holds the chosen fields of this lattice.
    pub(crate) fn fits(&self, frame: &Frame, lattice: &Lattice) -> bool {
        let n_kept = self.n_kept(lattice);
        frame.values.len() == self.fields.len() && frame.values.iter().all(|values| values.len() == n_kept)
    }

    /// The chosen fields of this instant.
    pub fn capture(&self, now: &Snapshot) -> Frame {
        let room = || Vec::with_capacity(self.n_kept(&now.model.lattice));
        let mut frame = Frame {
            step: 0,
            time_star: 0.0,
            point: now.point,
            values: self.fields.iter().map(|_| room()).collect(),
        };
        self.capture_into(now, &mut frame);
        frame
    }

    /// Overwrites a frame of the same selection, without allocating.
    pub(crate) fn capture_into(&self, now: &Snapshot, frame: &mut Frame) {
        (frame.step, frame.time_star, frame.point) = (now.step, now.time_star, now.point);
        let (lattice, textured) = (&now.model.lattice, &now.model.surface.textured);
        frame.values.iter_mut().for_each(Vec::clear);
        let mut blocks = [Block::default(); TOGETHER];
        for j in (0..lattice.ny).step_by(self.stride) {
            for begin in (0..lattice.nx).step_by(TOGETHER) {
                let n = TOGETHER.min(lattice.nx - begin);
                let first = lattice.block(begin, j);
                now.look(first, &mut blocks[..n]);
                for k in (0..n).filter(|k| (begin + k).is_multiple_of(self.stride)) {
                    for (field, values) in self.fields.iter().zip(&mut frame.values) {
                        values.push(field.value(&blocks[k], textured[first + k]) as f32);
                    }
                }
            }
        }
    }
}

/// Keeps the selected fields of every instant it is shown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    /// What is kept.
    pub selection: Selection,
    /// In the order of time.
    pub frames: Vec<Frame>,
}

impl Frames {
    /// Nothing kept yet.
    pub fn new(selection: Selection) -> Self {
        Self {
            selection,
            frames: Vec::new(),
        }
    }

    /// Whether it can have come of this new one, on this lattice, up to `step`.
    pub fn continues(&self, new: &Self, lattice: &Lattice, step: u64) -> bool {
        let steps = self.frames.iter().map(|frame| frame.step);
        let mut frames = self.frames.iter();
        self.selection == new.selection
            && steps.chain([step + 1]).is_sorted_by(|one, next| one < next)
            && frames.all(|frame| self.selection.fits(frame, lattice))
    }
}

impl Observer for Frames {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.frames.push(self.selection.capture(now));
        Ok(())
    }
}
