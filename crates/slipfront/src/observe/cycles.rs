//! The peaks of mu* in a program of speeds, one for each segment in which the drive moves forwards.

use serde::{Deserialize, Serialize};

use super::observer::Observer;
use crate::error::RunError;
use crate::snapshot::Snapshot;

/// A segment of a program with a speed above zero, up to the end of the run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cycle {
    /// t* of the drive at which the segment begins.
    pub from_star: f64,
    /// Speed of the drive in the segment.
    pub v_star: f64,
    /// Largest mu* in the segment, over the instants after its beginning up to and including its end.
    pub mu_star: f64,
    /// t* of the drive at the largest mu*, the first if it occurs several times.
    pub time_star: f64,
}

/// Peaks of a run under a program. The observer must be called at every step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Cycles {
    cycles: Vec<Cycle>,
}

impl Cycles {
    /// The peaks in order of time.
    pub fn cycles(&self) -> &[Cycle] {
        &self.cycles
    }

    /// Whether the recording can belong to a run up to this time of the drive.
    pub fn is_consistent_with(&self, drive_time_star: f64) -> bool {
        let times = self
            .cycles
            .iter()
            .flat_map(|cycle| [cycle.from_star, cycle.time_star]);
        times.chain([drive_time_star]).is_sorted()
    }
}

impl Observer for Cycles {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let Some(program) = &now.model.drive.program else {
            return Ok(());
        };
        // The values at an instant result from the step that ends there.
        let segment = program.segment_at(now.clock.drive_time_before());
        if segment.v_star <= 0.0 {
            return Ok(());
        }
        let mu_star = now.point.mu_star;
        match self.cycles.last_mut() {
            Some(cycle) if cycle.from_star == segment.from_star => {
                if mu_star > cycle.mu_star {
                    (cycle.mu_star, cycle.time_star) = (mu_star, now.drive_time_star);
                }
            }
            _ => self.cycles.push(Cycle {
                from_star: segment.from_star,
                v_star: segment.v_star,
                mu_star,
                time_star: now.drive_time_star,
            }),
        }
        Ok(())
    }
}
