//! Keys that apply to an upright sheet, with friction along its edge, and keys that do not.

use super::error::CaseError;
use super::file::CaseFile;
use super::friction::{ContactModel, Law};
use super::load::Redistribute;
use super::words::{Body, FrictionAlong, Motion};

impl CaseFile {
    /// Refuses keys that do not apply to an upright sheet, and keys that apply only to it.
    pub(super) fn check_interface(&self) -> Result<(), CaseError> {
        let (friction, load) = (&self.friction, &self.load);
        let star = load.foundation_star.map(|_| "load.foundation_star");
        let foundation = load.foundation.as_ref().map(|_| "load.foundation").or(star);
        if friction.along == FrictionAlong::Plane {
            return foundation.map_or(Ok(()), |key| {
                let sentence = format!(
                    "`{key}` belongs to an upright sheet: set `friction.along` = \"x\", or leave it out"
                );
                Err(self.source.error(key, sentence))
            });
        }
        // The direction is within a degree of y.
        let [along, _] = slipfront::Drive::at_angle(0.0, self.drive.direction).direction;
        if along.abs() < 0.0174 {
            let sentence = format!(
                "`drive.direction` is {}: a drive across an upright sheet (`friction.along` = \"x\") does not load friction, \
                 which acts along x; use a direction at least 1 degree away from y",
                self.drive.direction
            );
            return Err(self.source.error("drive.direction", sentence));
        }
        let other_law = friction.law != Law::Projection;
        let ages = friction.ageing.is_some();
        let springs = friction.contact == ContactModel::Springs;
        let adheres = friction.adhesion.si() != 0.0 || friction.adhesion_kinetic.si() != 0.0;
        let is_pulled = adheres && foundation.is_some();
        let nearby = matches!(load.redistribute, Redistribute::Near(_));
        let is_bulk = self.slider.body == Body::Bulk;
        let turns = self.drive.motion == Motion::Rotation;
        let adhesion = "it holds blocks that the foundation has let go, too";
        let sharing = "how its load is shared within a distance is not derived";
        let keys = [
            ("friction.law", other_law, "only \"projection\" is derived for it"),
            ("friction.ageing", ages, "it is not derived for it"),
            ("friction.contact", springs, "springs in contact act in the plane"),
            ("friction.adhesion", is_pulled, adhesion),
            ("load.redistribute", nearby, sharing),
            ("slider.body", is_bulk, "a bulk body lies on its substrate"),
            ("drive.motion", turns, "it would turn out of its substrate"),
        ];
        let wrong = keys.into_iter().find(|(_, is_wrong, _)| *is_wrong);
        wrong.map_or(Ok(()), |(key, _, why)| {
            let sentence = format!(
                "`{key}` cannot be combined with `friction.along` = \"x\", an upright sheet: {why}; leave it out, or use \"plane\""
            );
            Err(self.source.error(key, sentence))
        })
    }
}
