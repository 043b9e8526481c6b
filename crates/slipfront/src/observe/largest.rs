//! The largest mu* until the drive has moved by a given path, measured during a run.

use super::observer::Observer;
use crate::error::RunError;
use crate::measure::Largest;
use crate::snapshot::Snapshot;

/// The largest mu* as an observer, which must be called at every step.
impl Observer for Largest {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let path = now.model.drive.path(now.drive_time_star);
        self.update(
            path,
            now.drive_time_star,
            now.point.mu_star,
            now.point.mu_lateral_star,
        );
        Ok(())
    }
}
