//! Runs of designs in memory: needed and known runs, and the loss of each design.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::{Deserialize, Serialize};
use slipfront::RunError;
use slipfront::device::Device;
use slipfront::parallel::*;
use slipfront_case::case::Case;
use slipfront_case::case_file::CaseError;
#[cfg(not(target_family = "wasm"))]
use slipfront_run::device::device_summaries;
use slipfront_run::run_summary::run_summary_unless;
use slipfront_run::running::{RunData, run_unless};
use slipfront_run::summary::Summary;

use crate::search::hash;
use crate::slider_blocks::SliderBlocks;
use crate::subject::{Fidelity, Subject};
use crate::trial::Trial;
use crate::wish::{Measured, Wish};
use slipfront_study::StudyError;

/// A run that is needed.
#[derive(Clone)]
pub(crate) struct Wanted {
    /// Index of the case.
    pub(crate) subject: usize,
    /// The texture; none for the slider without texture.
    pub(crate) texture: Option<Arc<Vec<bool>>>,
    /// Number of the surface; 0 is the surface of the search.
    pub(crate) surface: u64,
    /// Accuracy of the run.
    pub(crate) fidelity: Fidelity,
}

/// Identity of a run: a hash of everything that determines its numbers.
pub type RunId = String;

/// Numbers of a run, or a sentence with the reason why it has none: it diverged, never came to rest while the
/// drive was held, or its case refuses the texture.
pub type RunOutcome = Result<Measured, String>;

/// Outcomes of runs by their identities.
pub type RunCache = HashMap<RunId, RunOutcome>;

/// A run that was made, a line of the journal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct MadeRun {
    /// Identity of the run.
    pub id: RunId,
    /// Outcome of the run.
    pub ended: RunOutcome,
    /// Cost of the run in this process, in steps times blocks; 0 for a run from the journal.
    #[serde(skip)]
    pub(crate) work: f64,
}

/// Numbers that a design needs of a run.
fn measured(summary: Result<Summary, RunError>) -> RunOutcome {
    let measured = summary.map(|summary| Measured::from_summary(&summary));
    measured.map_err(|error| error.to_string())
}

/// Callback that receives finished runs, in their order.
pub type Keep<'a> = dyn FnMut(&[MadeRun]) -> Result<(), StudyError> + 'a;

/// The known runs, and what becomes of new ones.
pub(crate) struct Runs<'a> {
    /// Outcomes of the runs so far.
    pub(crate) known: &'a mut RunCache,
    /// Callback that keeps new runs.
    pub(crate) keep: &'a mut Keep<'a>,
    /// Flag that ends all runs.
    pub(crate) stop: &'a AtomicBool,
}

/// The cases in which designs are tried, and the rule that combines their losses.
#[derive(Debug)]
pub(crate) struct Evaluator {
    /// The cases, all with the same blocks.
    pub(crate) subjects: Vec<Subject>,
    /// The blocks.
    pub(crate) grid: SliderBlocks,
    /// Whether the worst case counts, in place of the mean.
    pub(crate) is_worst: bool,
    /// Device that makes the runs; none for the cores of this machine.
    pub(crate) device: Option<Arc<dyn Device>>,
}

impl Evaluator {
    /// The wish, in units of the first case.
    pub(crate) fn wish(&self) -> &Wish {
        &self.subjects[0].wish
    }

    /// Memory of the largest run, in bytes.
    pub(crate) fn bytes_of_run(&self) -> Result<f64, CaseError> {
        self.subjects.iter().try_fold(0.0, |largest: f64, subject| {
            let case = subject.case(None, 0, Fidelity::Verdict)?;
            Ok(largest.max(case.budget.beside_others(false)))
        })
    }

    /// Mean cost of a run over the cases, in steps times blocks.
    pub(crate) fn work(&self, fidelity: Fidelity) -> f64 {
        let work: f64 = self.subjects.iter().map(|subject| subject.work(fidelity)).sum();
        work / self.subjects.len() as f64
    }

    /// An evaluator with other cases and the same rule.
    pub(crate) fn with_subjects(&self, subjects: Vec<Subject>, grid: SliderBlocks) -> Self {
        Self {
            subjects,
            grid,
            is_worst: self.is_worst,
            device: self.device.clone(),
        }
    }

    /// Whether surfaces with different seeds differ in any of the cases.
    pub(crate) fn scatters(&self) -> bool {
        self.subjects.iter().any(|subject| subject.scatters)
    }

    /// Identity of a run.
    pub(crate) fn id(&self, wanted: &Wanted) -> RunId {
        let subject = &self.subjects[wanted.subject];
        let mut hasher = blake3::Hasher::new();
        hasher.update(subject.physics.as_bytes());
        // This crate computes the recorded numbers from the output of a run, so its sources count, too.
        hasher.update(env!("SLIPFRONT_SOURCE_HASH").as_bytes());
        if let Some(texture) = &wanted.texture {
            hasher.update(&hash(texture));
        }
        hasher.update(&(subject.seed + wanted.surface).to_le_bytes());
        for number in subject.step_and_end(wanted.fidelity) {
            hasher.update(&number.to_le_bytes());
        }
        if let Wish::Curve(points) = &subject.wish {
            for number in points.as_flattened() {
                hasher.update(&number.to_le_bytes());
            }
        }
        hasher.finalize().to_hex()[..32].to_owned()
    }

    /// The runs of some textures on some surfaces, each with the run of the slider without texture.
    pub(crate) fn wanted(
        &self,
        textures: &[Arc<Vec<bool>>],
        surfaces: Range<u64>,
        fidelity: Fidelity,
    ) -> Vec<Wanted> {
        let textures: Vec<Option<&Arc<Vec<bool>>>> =
            std::iter::once(None).chain(textures.iter().map(Some)).collect();
        let mut wanted = Vec::new();
        for surface in surfaces {
            for texture in &textures {
                wanted.extend((0..self.subjects.len()).map(|subject| Wanted {
                    subject,
                    texture: texture.cloned(),
                    surface,
                    fidelity,
                }));
            }
        }
        wanted
    }

    /// Makes the runs that are not known yet, on the device or on the threads of rayon's pool, and passes
    /// them on in the order of `wanted`. After a stop, it passes none on.
    pub(crate) fn run(&self, wanted: &[Wanted], runs: &mut Runs) -> Result<(), StudyError> {
        // Textures and cases may share runs, above all the run of the slider without texture.
        let mut asked = HashSet::new();
        let missing: Vec<(RunId, &Wanted)> = wanted
            .iter()
            .map(|wanted| (self.id(wanted), wanted))
            .filter(|(id, _)| !runs.known.contains_key(id) && asked.insert(id.clone()))
            .collect();
        let outcomes = self.outcomes(&missing, runs.stop)?;
        // In the order of the request, whichever thread was first, so the journal is the same for any number
        // of threads.
        let made = missing.into_iter().zip(outcomes).map(|((id, wanted), ended)| {
            Ok(MadeRun {
                id,
                ended: ended.ok_or(StudyError::Interrupted)?,
                work: self.subjects[wanted.subject].work(wanted.fidelity),
            })
        });
        let made: Vec<MadeRun> = made.collect::<Result<_, StudyError>>()?;
        (runs.keep)(&made)?;
        runs.known
            .extend(made.into_iter().map(|made| (made.id, made.ended)));
        Ok(())
    }

    /// Makes runs on the device or on the threads of rayon's pool; none after a stop.
    fn outcomes(
        &self,
        runs: &[(RunId, &Wanted)],
        stop: &AtomicBool,
    ) -> Result<Vec<Option<RunOutcome>>, StudyError> {
        #[cfg(not(target_family = "wasm"))]
        if let Some(device) = &self.device {
            return self.measure_on_device(runs, &**device, stop);
        }
        // Each run is its own task: some end early, and no thread may be left with several long runs.
        let runs = runs.par_iter().with_max_len(1);
        Ok(runs.map(|(_, wanted)| self.measure(wanted, stop)).collect())
    }

    /// Makes runs on a device; none after a stop. A wish for a curve is for the CPU alone.
    #[cfg(not(target_family = "wasm"))]
    fn measure_on_device(
        &self,
        runs: &[(RunId, &Wanted)],
        device: &dyn Device,
        stop: &AtomicBool,
    ) -> Result<Vec<Option<RunOutcome>>, StudyError> {
        let cases: Vec<Result<Arc<Case>, String>> = runs
            .par_iter()
            .map(|(_, wanted)| self.case(wanted).map(Arc::new))
            .collect();
        let to_run: Vec<Arc<Case>> = cases.iter().flatten().cloned().collect();
        let summaries = device_summaries(&to_run, device, &|| stop.load(Ordering::Relaxed))?;
        let mut summaries = summaries.into_iter();
        let outcome = |case: Result<Arc<Case>, String>| match case {
            Ok(_) => summaries.next().flatten().map(measured),
            Err(why) => Some(Err(why)),
        };
        Ok(cases.into_iter().map(outcome).collect())
    }

    /// The case of a run, or the reason why the case refuses the texture.
    fn case(&self, wanted: &Wanted) -> Result<Case, String> {
        let texture = wanted.texture.as_ref().map(|texture| texture.as_slice());
        let case = self.subjects[wanted.subject].case(texture, wanted.surface, wanted.fidelity);
        case.map_err(|error| error.without_place())
    }

    /// Makes one run; none after a stop.
    fn measure(&self, wanted: &Wanted, stop: &AtomicBool) -> Option<RunOutcome> {
        let ends = || stop.load(Ordering::Relaxed);
        let case = match self.case(wanted) {
            Ok(case) => case,
            Err(why) => return Some(Err(why)),
        };
        let Wish::Curve(points) = &self.subjects[wanted.subject].wish else {
            return run_summary_unless(&case, &ends).map(measured);
        };
        let record = run_unless(&Arc::new(case), &ends)?;
        let measured = record.map(|record| Measured {
            misfit: Some(misfit(points, &record)),
            ..Measured::from_summary(&record.summary)
        });
        Some(measured.map_err(|error| error.to_string()))
    }

    /// Checks that all cases can be run with a texture.
    ///
    /// # Errors
    /// The reason why one of them refuses it.
    pub(crate) fn check(&self, texture: &[bool]) -> Result<(), CaseError> {
        let mut subjects = self.subjects.iter();
        subjects.try_for_each(|subject| subject.case(Some(texture), 0, Fidelity::Fine).map(drop))
    }

    /// Outcome of a run.
    pub(crate) fn ended(&self, wanted: &Wanted, known: &RunCache) -> RunOutcome {
        let ended = known.get(&self.id(wanted)).cloned();
        ended.unwrap_or_else(|| Err("the run was not made".to_owned()))
    }

    /// The runs of a texture on some surfaces, as far as they are known.
    pub(crate) fn trial<'a>(
        &'a self,
        texture: &'a Arc<Vec<bool>>,
        surfaces: Range<u64>,
        fidelity: Fidelity,
        known: &'a RunCache,
    ) -> Trial<'a> {
        Trial {
            evaluator: self,
            texture,
            surfaces,
            fidelity,
            known,
        }
    }

    /// Makes the runs of the slider without texture, and refuses it if it has no value to compare textures
    /// with.
    ///
    /// # Errors
    /// The reason; when runs cannot be made or kept, and after a stop.
    pub(crate) fn check_reference(&self, runs: &mut Runs) -> Result<(), StudyError> {
        if !self.wish().is_relative() {
            return Ok(());
        }
        let wanted = self.wanted(&[], 0..1, Fidelity::Coarse);
        self.run(&wanted, runs)?;
        for run in &wanted {
            let why = match self.ended(run, runs.known) {
                Ok(bare) => self.subjects[run.subject]
                    .wish
                    .deviation(&bare, Some(&bare))
                    .err(),
                Err(why) => Some(why),
            };
            if let Some(why) = why {
                return Err(StudyError::Reference { why });
            }
        }
        Ok(())
    }
}

/// Root mean square difference between mu* and the requested values at some times of the drive; mu* is
/// interpolated linearly between the rows of the record.
fn misfit(points: &[[f64; 2]], record: &RunData) -> f64 {
    let rows = &record.rows;
    let mut next = 0;
    let squares = points.iter().map(|&[time, wanted]| {
        while next + 1 < rows.len() && rows[next].drive_time_star < time {
            next += 1;
        }
        let [before, after] = [&rows[next.saturating_sub(1)], &rows[next]];
        let [from, to] = [before, after].map(|row| row.drive_time_star);
        let share = if to > from {
            ((time - from) / (to - from)).clamp(0.0, 1.0)
        } else {
            1.0
        };
        let found = before.point.mu_star + share * (after.point.mu_star - before.point.mu_star);
        (found - wanted) * (found - wanted)
    });
    (squares.sum::<f64>() / points.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use slipfront_case::case::Case;

    use super::*;

    #[test]
    fn a_curve_is_compared_between_its_rows() {
        let case = Case::parse("slider.blocks = [4, 4]\noutput.series = 5", "case", "", &[]).unwrap();
        let record = slipfront_run::running::run(&Arc::new(case), 1).unwrap();
        let points = record.rows.windows(2).map(|rows| {
            let [time, mu] = [0, 1].map(|k| [rows[k].drive_time_star, rows[k].point.mu_star]);
            [0.5 * (time[0] + mu[0]), 0.5 * (time[1] + mu[1])]
        });
        let points: Vec<[f64; 2]> = points.collect();
        // The mean of two rows, up to rounding.
        assert!(misfit(&points, &record) < 1e-15);
        let raised: Vec<[f64; 2]> = points.iter().map(|[time, mu]| [*time, mu + 0.5]).collect();
        assert!((misfit(&raised, &record) - 0.5).abs() < 1e-15);
    }
}
