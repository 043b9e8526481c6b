//! Keys that apply to an upright sheet, with friction along its edge, and keys that do not.

use super::check::Check;
use super::error::CaseError;
use super::file::CaseFile;
use super::friction::{ContactModel, Law};
use super::key_table::keys_of;
use super::motion::Redistribute;
use super::words::{Body, FrictionAlong, Motion};

impl CaseFile {
    /// Refuses keys that do not apply to an upright sheet, and keys that apply only to it.
    pub(super) fn check_interface(&self) -> Result<(), CaseError> {
        let check = |table| Check::new(&self.source, keys_of(table), table);
        let has_foundation = self.load.foundation.is_some() || self.load.foundation_star.is_some();
        let foundation = match self.load.foundation {
            Some(_) => "foundation",
            None => "foundation_star",
        };
        if self.friction.along == FrictionAlong::Plane {
            if has_foundation {
                return check("load").refuse(foundation, |key| {
                    format!(
                        "`{key}` belongs to an upright sheet: set `friction.along` = \"x\", or leave it out"
                    )
                });
            }
            return Ok(());
        }
        let (friction, load) = (&self.friction, &self.load);
        let nearby = matches!(load.redistribute, Redistribute::Near(_));
        let with_adhesion = friction.adhesion.si() != 0.0 || friction.adhesion_kinetic.si() != 0.0;
        let keys = [
            (
                "friction",
                "law",
                friction.law != Law::Projection,
                "only \"projection\" is derived for it",
            ),
            (
                "friction",
                "ageing",
                friction.ageing.is_some(),
                "it is not derived for it",
            ),
            (
                "friction",
                "contact",
                friction.contact == ContactModel::Springs,
                "springs in contact act in the plane",
            ),
            (
                "friction",
                "adhesion",
                with_adhesion && has_foundation,
                "it holds blocks that the foundation has let go, too",
            ),
            (
                "load",
                "redistribute",
                nearby,
                "how its load is shared within a distance is not derived",
            ),
            (
                "slider",
                "body",
                self.slider.body == Body::Bulk,
                "a bulk body lies on its substrate",
            ),
            (
                "drive",
                "motion",
                self.drive.motion == Motion::Rotation,
                "it would turn out of its substrate",
            ),
        ];
        // The direction is within a degree of y.
        let [along, _] = slipfront::Drive::at_angle(0.0, self.drive.direction).direction;
        if along.abs() < 0.0174 {
            return check("drive").refuse("direction", |key| {
                format!(
                    "`{key}` is {}: a drive across an upright sheet (`friction.along` = \"x\") does not load friction, which \
                     acts along x; use a direction at least 1 degree away from y",
                    self.drive.direction
                )
            });
        }
        let wrong = keys.iter().find(|(_, _, is_wrong, _)| *is_wrong);
        wrong.map_or(Ok(()), |(table, key, _, why)| {
            check(table).refuse(key, |path| {
                format!(
                    "`{path}` cannot be combined with `friction.along` = \"x\", an upright sheet: {why}; leave it out, or use \"plane\""
                )
            })
        })
    }
}
