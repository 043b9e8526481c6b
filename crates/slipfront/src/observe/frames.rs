//! Fields over the lattice, recorded at chosen steps.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::observer::Observer;
use crate::error::RunError;
use crate::kernel::block::Field;
use crate::measure::CurvePoint;
use crate::model::Model;
use crate::snapshot::Snapshot;

/// Fields of one instant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame {
    /// Step.
    pub step: u64,
    /// Time t* of the blocks.
    pub time_star: f64,
    /// Time t* of the drive.
    pub drive_time_star: f64,
    /// Friction coefficient mu* and percentage N*.
    pub point: CurvePoint,
    /// One array per field, row by row from y = 0, every `stride`-th block of each axis from the first on.
    /// The arrays are as large as the lattice: code that serializes a frame writes them separately.
    #[serde(skip)]
    pub values: Vec<Vec<f32>>,
}

/// Selection of the fields to record, and of the blocks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Selection {
    /// The fields, in the order in which they are recorded.
    pub fields: Vec<Field>,
    /// Every n-th block along each axis is recorded.
    pub stride: usize,
}

/// Positions of the members of `indices` among all kept indices, if every `stride`-th index from 0 is kept.
///
/// ```
/// # use slipfront::observe::frames::kept;
/// // Of 0, 3, 6, 9 and 12 the second and the third lie in it.
/// assert_eq!(kept(1..8, 3), 1..3);
/// ```
pub fn kept(indices: Range<usize>, stride: usize) -> Range<usize> {
    indices.start.div_ceil(stride)..indices.end.div_ceil(stride)
}

impl Selection {
    /// Number of recorded blocks along x, and the recorded rows among the rows of a model.
    fn counts(&self, model: &Model) -> (usize, Range<usize>) {
        let columns = kept(0..model.lattice.nx, self.stride);
        (columns.len(), kept(model.rows.clone(), self.stride))
    }

    /// The selected fields at this instant.
    pub fn capture(&self, now: &Snapshot) -> Frame {
        let (nx, rows) = self.counts(now.model);
        let mut frame = Frame {
            step: 0,
            time_star: 0.0,
            drive_time_star: 0.0,
            point: now.point,
            values: vec![vec![0.0; nx * rows.len()]; self.fields.len()],
        };
        self.capture_into(now, &mut frame);
        frame
    }

    /// Overwrites a frame of the same selection, without allocating.
    pub(crate) fn capture_into(&self, now: &Snapshot, frame: &mut Frame) {
        (frame.step, frame.time_star, frame.point) = (now.step, now.time_star, now.point);
        frame.drive_time_star = now.drive_time_star;
        let (nx, rows) = self.counts(now.model);
        for (&field, values) in self.fields.iter().zip(&mut frame.values) {
            now.read_rows(field, self.stride, |j, i, part| {
                let row = (now.model.rows.start + j) / self.stride - rows.start;
                let columns = kept(i..i + part.len(), self.stride);
                let read = part.iter().skip(columns.start * self.stride - i);
                let values = &mut values[row * nx..][columns];
                for (value, &read) in values.iter_mut().zip(read.step_by(self.stride)) {
                    *value = read;
                }
            });
        }
    }
}

/// Records the selected fields at every call.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    /// Fields and blocks that are recorded.
    pub selection: Selection,
    /// Frames in order of time.
    pub frames: Vec<Frame>,
}

impl Frames {
    /// An empty recording.
    pub fn new(selection: Selection) -> Self {
        Self {
            selection,
            frames: Vec::new(),
        }
    }

    /// Whether the recording can have begun as `new` and been called up to `step`.
    pub fn is_consistent_with(&self, new: &Self, step: u64) -> bool {
        let steps = self.frames.iter().map(|frame| frame.step);
        self.selection == new.selection && steps.chain([step + 1]).is_sorted_by(|one, next| one < next)
    }
}

impl Observer for Frames {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.frames.push(self.selection.capture(now));
        Ok(())
    }
}
