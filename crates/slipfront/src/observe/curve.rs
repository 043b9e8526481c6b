//! The recorded curve: mu*, N* and energies against time.

use serde::{Deserialize, Serialize};

use super::energy::{Energies, Ledger};
use super::observer::Observer;
use crate::error::RunError;
use crate::measure::CurvePoint;
use crate::snapshot::Snapshot;

/// One row of the recorded curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CurveRow {
    /// Step.
    pub step: u64,
    /// t*.
    pub time_star: f64,
    /// mu* and N*.
    pub point: CurvePoint,
    /// Energies stored at this instant, and supplied and lost up to it.
    pub energies: Energies,
    /// Mean state variable of the blocks in contact, t*; 0 under laws that have none.
    pub mean_state: f64,
}

/// Records the curve and keeps the energy balance. It must be called at every step.
#[derive(Debug, Serialize, Deserialize)]
pub struct Curve {
    /// One row for every `stride`-th step from 0, and for the last step.
    pub rows: Vec<CurveRow>,
    stride: u64,
    ledger: Ledger,
}

impl Curve {
    /// Records every `stride`-th step.
    pub fn every(stride: u64) -> Self {
        Self {
            rows: Vec::new(),
            stride,
            ledger: Ledger::default(),
        }
    }

    /// Whether this can be the recording that began as `new` and was called at every step up to `step`.
    pub fn is_consistent_with(&self, new: &Self, step: u64) -> bool {
        let stride = new.stride.max(1);
        let of_stride = || (0..=step).step_by(stride as usize);
        // A run that has ended has a row of its last step, whatever the stride.
        let with_last = of_stride().chain((!step.is_multiple_of(stride)).then_some(step));
        let rows = || self.rows.iter().map(|row| row.step);
        self.stride == new.stride && (rows().eq(of_stride()) || rows().eq(with_last))
    }
}

impl Observer for Curve {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.ledger.add(now);
        if now.last || now.step.is_multiple_of(self.stride) {
            self.rows.push(CurveRow {
                step: now.step,
                time_star: now.time_star,
                point: now.point,
                energies: self.ledger.energies(now),
                mean_state: now.contact.mean_state,
            });
        }
        Ok(())
    }

    fn needs_energies(&self, step: u64) -> bool {
        step.is_multiple_of(self.stride)
    }
}
