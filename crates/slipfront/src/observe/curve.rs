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
    /// Time t*.
    pub time_star: f64,
    /// Number of steps in which the drive has moved by then: all, unless it is held.
    pub drive_steps: u64,
    /// t* of the drive, on which its path depends.
    pub drive_time_star: f64,
    /// Friction coefficient mu* and percentage N*.
    pub point: CurvePoint,
    /// Energies stored at this instant, and supplied and lost up to it.
    pub energies: Energies,
    /// Mean state variable of the blocks in contact, t*; 0 under laws without a state.
    pub mean_state: f64,
}

/// Records the curve and keeps the energy balance. The observer must be called at every step.
#[derive(Debug, Serialize, Deserialize)]
pub struct Curve {
    /// One row for every `stride`-th step of the drive from 0, and for the last step.
    pub rows: Vec<CurveRow>,
    stride: u64,
    ledger: Ledger,
}

impl Curve {
    /// Records every `stride`-th step of the drive.
    pub fn every(stride: u64) -> Self {
        Self {
            rows: Vec::new(),
            stride,
            ledger: Ledger::default(),
        }
    }

    /// The row of the latest instant, whether or not it is recorded. The energies stored in blocks and
    /// springs are left out, since they may not be known there.
    pub fn counts(&self, now: &Snapshot) -> CurveRow {
        CurveRow {
            step: now.step,
            time_star: now.time_star,
            drive_steps: now.drive_steps,
            drive_time_star: now.drive_time_star,
            point: now.point,
            energies: self.ledger.counts(now),
            mean_state: now.contact.mean_state,
        }
    }

    /// Whether the recording can have begun as `new` and been called at every step until the drive had moved
    /// in `drive_steps`.
    pub fn is_consistent_with(&self, new: &Self, drive_steps: u64) -> bool {
        let stride = new.stride.max(1);
        let of_stride = || (0..=drive_steps).step_by(stride as usize);
        // A run that has ended has a row for its last step, at any stride.
        let with_last = of_stride().chain((!drive_steps.is_multiple_of(stride)).then_some(drive_steps));
        let rows = || self.rows.iter().map(|row| row.drive_steps);
        self.stride == new.stride && (rows().eq(of_stride()) || rows().eq(with_last))
    }
}

impl Observer for Curve {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        self.ledger.add(now);
        let is_due = now.clock.drive_moved() && now.drive_steps.is_multiple_of(self.stride);
        if now.last || is_due {
            let mut row = self.counts(now);
            row.energies.stored = now.stored_energy();
            self.rows.push(row);
        }
        Ok(())
    }

    fn needs_energies(&self, drive_steps: u64) -> bool {
        drive_steps.is_multiple_of(self.stride)
    }
}
