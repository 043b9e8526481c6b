//! Sensitivity of a design to deviations in manufacturing and use.

use serde::Serialize;
use slipfront::Lattice;
use slipfront_case::case_file::{CaseError, DriveSpeed};
use slipfront_case::quantity::Speed;
use slipfront_case::texture_file::textured_blocks;

use crate::evaluate::Evaluator;
use crate::judge::{Contender, Judge, Surfaces};
use crate::mean::Mean;
use crate::slider_blocks::SliderBlocks;
use crate::subject::{Fidelity, Subject};
use crate::tolerance::WithinTolerance;
use slipfront_study::StudyError;

/// Number of surfaces for each change.
const SURFACES: u64 = 8;

/// A design under a change.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Changed {
    /// Description of the change.
    pub change: String,
    /// Loss of the design under the change, the mean over surfaces; infinite if the design is lost.
    pub loss: Mean,
    /// The quantity of the wish in the first case under the change, in units of mu_s, if the runs have it.
    pub wished_star: Option<Mean>,
    /// Parts within the tolerance of the wish under the change, if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub within_tolerance: Option<WithinTolerance>,
    /// Reason why the design is lost, if it is: one of its runs does not have the numbers of the wish.
    pub lost: Option<String>,
    /// The loss of the other texture under this change minus that of the design, paired by surface: above 0
    /// if the design is better.
    pub better_by: Option<Mean>,
}

/// A change under which a design could not be run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeftOut {
    /// The change.
    pub change: String,
    /// Reason, in a sentence without a full stop.
    pub why: String,
}

/// A design under changes.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Sensitivity {
    /// The changes under which the design was run.
    pub changed: Vec<Changed>,
    /// The changes under which it could not be run.
    pub left_out: Vec<LeftOut>,
}

impl Sensitivity {
    fn leave_out(&mut self, change: &str, error: &CaseError) {
        self.left_out.push(LeftOut {
            change: change.to_owned(),
            why: error.without_place(),
        });
    }
}

/// Changes of the texture itself: a shift by one block to every side. Parts beyond a free edge of the slider
/// are cut off.
const SHIFTS: [(&str, [isize; 2]); 4] = [
    ("one block towards +x", [1, 0]),
    ("one block towards -x", [-1, 0]),
    ("one block towards +y", [0, 1]),
    ("one block towards -y", [0, -1]),
];

/// Changes of the speed of the drive.
const SPEEDS: [(&str, f64); 2] = [
    ("a third of the speed", 1.0 / 3.0),
    ("three times the speed", 3.0),
];

impl<'r> Judge<'_, 'r> {
    /// All changes, for the design and another texture.
    pub(crate) fn sensitivity(
        &mut self,
        design: &Contender,
        other: Option<&Contender>,
    ) -> Result<Sensitivity, StudyError> {
        let mut found = Sensitivity::default();
        for (change, shift) in SHIFTS {
            let shifted = Contender {
                name: design.name.clone(),
                texture: moved(&self.evaluator.grid, &design.texture, shift).into(),
                shapes: None,
            };
            let changed = self.under(change, &shifted, other)?;
            found.changed.push(changed);
        }
        for (change, factor) in SPEEDS {
            match self.evaluator.at_speed(factor) {
                Ok(evaluator) => {
                    let changed = self.with(&evaluator).under(change, design, other)?;
                    found.changed.push(changed);
                }
                Err(error) => found.leave_out(change, &error),
            }
        }
        let change = "blocks of half the size";
        match self.on_finer_blocks(design, other) {
            Ok((evaluator, design, other)) => {
                let other = other.as_ref();
                let changed = self.with(&evaluator).under(change, &design, other)?;
                found.changed.push(changed);
            }
            Err(error) => found.leave_out(change, &error),
        }
        Ok(found)
    }

    /// The cases, a design and another texture on blocks of half the size. Shapes are meshed again; a mask
    /// keeps its outline.
    fn on_finer_blocks(
        &self,
        design: &Contender,
        other: Option<&Contender>,
    ) -> Result<(Evaluator, Contender, Option<Contender>), CaseError> {
        let evaluator = self.evaluator.on_finer_blocks()?;
        let finer = |contender: &Contender| -> Result<Contender, CaseError> {
            let texture = match &contender.shapes {
                Some(shapes) => textured_blocks(&evaluator.subjects[0].with_textures(shapes)?),
                None => doubled(self.evaluator.grid.size(), &contender.texture),
            };
            Ok(Contender {
                texture: texture.into(),
                ..contender.clone()
            })
        };
        let (design, other) = (finer(design)?, other.map(finer).transpose()?);
        Ok((evaluator, design, other))
    }

    /// A judge of other cases.
    fn with<'a>(&'a mut self, evaluator: &'a Evaluator) -> Judge<'a, 'r> {
        Judge {
            evaluator,
            runs: self.runs,
            asks_for_numbers: self.asks_for_numbers,
        }
    }

    /// A texture and another one under a change.
    fn under(
        &mut self,
        change: &str,
        design: &Contender,
        other: Option<&Contender>,
    ) -> Result<Changed, StudyError> {
        let surfaces = &surfaces(self.evaluator);
        let both: Vec<&Contender> = std::iter::once(design).chain(other).collect();
        self.run(&both, surfaces)?;
        let trial = self.trial(design, surfaces);
        Ok(Changed {
            change: change.to_owned(),
            loss: trial.mean_loss(),
            wished_star: self.fresh_values(Some(design), 0, surfaces).wished_star,
            within_tolerance: trial.within(),
            lost: trial.lost(),
            better_by: other.map(|other| self.difference(other, design, surfaces)),
        })
    }
}

/// Numbers of the surfaces of a change.
fn surfaces(evaluator: &Evaluator) -> std::ops::Range<u64> {
    let first = Surfaces::new(evaluator).judged.start;
    first..first + if evaluator.scatters() { SURFACES } else { 1 }
}

/// Largest number of runs of all changes, and their cost in steps times blocks.
pub(crate) fn most_runs(evaluator: &Evaluator) -> (usize, f64) {
    let surfaces = surfaces(evaluator);
    let at_once = evaluator.subjects.len() * (surfaces.end - surfaces.start) as usize;
    // A shift needs only runs of the shifted design: the slider without texture and the other texture have
    // been judged.
    let moved = SHIFTS.len() * at_once;
    let changed = SPEEDS.iter().map(|(_, factor)| evaluator.at_speed(*factor));
    let changed = changed.chain([evaluator.on_finer_blocks()]);
    let changed = changed.flatten().map(|changed| changed.work(Fidelity::Verdict));
    let (mut runs, mut work) = (moved, moved as f64 * evaluator.work(Fidelity::Verdict));
    for work_of_run in changed {
        // The slider without texture, the design, and the other texture.
        runs += 3 * at_once;
        work += (3 * at_once) as f64 * work_of_run;
    }
    (runs, work)
}

impl Evaluator {
    /// The evaluator with its cases at another speed of the drive.
    ///
    /// # Errors
    /// When a case has a program of speeds, or cannot be run at that speed.
    fn at_speed(&self, factor: f64) -> Result<Self, CaseError> {
        let faster = |speed: &DriveSpeed| match speed {
            DriveSpeed::VStar(v_star) => Ok(DriveSpeed::VStar(v_star * factor)),
            DriveSpeed::Speed(speed) => Ok(DriveSpeed::Speed(Speed::from_si(speed.si() * factor))),
            DriveSpeed::Program(_) => Err(CaseError::invalid(None, "the drive has a program of speeds")),
        };
        let subjects = self.subjects.iter().map(|subject| {
            let speed = faster(&subject.file().drive.speed)?;
            subject.with(|file| file.drive.speed = speed)
        });
        Ok(self.with_subjects(subjects.collect::<Result<_, _>>()?, self.grid.clone()))
    }

    /// The cases on blocks of half the size, by
    /// [`Case::on_other_blocks`](slipfront_case::case::Case::on_other_blocks).
    ///
    /// # Errors
    /// When a case cannot be put on such blocks.
    pub(crate) fn on_finer_blocks(&self) -> Result<Self, CaseError> {
        let subjects = self.subjects.iter().map(Subject::on_finer_blocks);
        let subjects = subjects.collect::<Result<_, _>>()?;
        let [nx, ny] = self.grid.size();
        let grid = SliderBlocks {
            lattice: Lattice::with_edges(2 * nx, 2 * ny, self.grid.lattice.edges),
            exists: doubled([nx, ny], &self.grid.exists),
        };
        Ok(self.with_subjects(subjects, grid))
    }
}

/// Shifts a set. Parts beyond a free edge of the slider are cut off.
fn moved(grid: &SliderBlocks, set: &[bool], shift: [isize; 2]) -> Vec<bool> {
    let at = |block: usize| {
        let from = grid.neighbour(block, shift.map(|step| -step));
        grid.exists[block] && from.is_some_and(|from| set[from])
    };
    (0..set.len()).map(at).collect()
}

/// A set on blocks of half the size.
fn doubled([nx, ny]: [usize; 2], set: &[bool]) -> Vec<bool> {
    let blocks = (0..2 * ny).flat_map(|y| (0..2 * nx).map(move |x| y / 2 * nx + x / 2));
    blocks.map(|block| set[block]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider_blocks::tests::whole;

    #[test]
    fn sets_are_moved_and_doubled() {
        let grid = whole([3, 2], [true, false]);
        let set = [true, false, false, false, false, true];
        assert_eq!(
            moved(&grid, &set, [1, 0]),
            [false, true, false, true, false, false]
        );
        assert_eq!(
            moved(&grid, &set, [0, 1]),
            [false, false, false, true, false, false]
        );
        let fine = doubled([2, 1], &[true, false]);
        assert_eq!(fine, [true, true, false, false, true, true, false, false]);
    }
}
