//! Runs of designs in memory: the wanted and the known runs, and the loss of each design.

use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use slipfront::StopReason;
use slipfront::parallel::*;
use slipfront_case::arrays::npy_of_mask;
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::{
    Attached, AttachedEdge, AutoOr, CaseError, CaseFile, DEFAULT_THRESHOLD, Mask, Pattern, RunTime, Shape,
    Snapshots, Texture, TimeStep,
};
use slipfront_run::run_summary::run_summary_unless;
use slipfront_run::running::{Record, run_unless};

use super::grid::Grid;
use super::search::hash;
use super::wish::{Measured, Wish};
use crate::error::StudyError;
use crate::identity::physics;
use crate::statistics::mean;

/// The step with which designs are tried: it orders reductions as a quarter of the step does, at a third of the cost.
const COARSE_STEP: f64 = 0.4;

/// Ratio of two times: up to the first the largest mu* of a design counts as its static friction; the second is that of the
/// slider without texture times the load factor of as much texture as the limits allow. The second is twice the time of the
/// onset (Eq. 12), so that the first is 1.2 times the latest onset that is expected. A block that only its own drive spring
/// pulls until it slips, without its neighbours, slips at 2.67/2.5 = 1.07 of the onset.
const SEARCHED: f64 = 0.6;

/// Multiple of the time of a search up to which verdicts run, so that no design is good only because the search has ended.
const JUDGED: f64 = 2.0;

/// Accuracy of a run of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fidelity {
    /// With a coarse step.
    Coarse,
    /// With the step of the case.
    Fine,
    /// With the step of the case, for longer.
    Verdict,
}

/// A case in which designs are tried.
#[derive(Debug)]
pub(crate) struct Subject {
    /// The case, without textures.
    file: CaseFile,
    name: String,
    /// The files that the case names, with a place for the mask: no run reads the disk.
    files: FilesInMemory,
    /// Steps dt*: the coarse one, and the step of the case.
    steps: [f64; 2],
    /// Ends of runs, t*: in the search, and in verdicts.
    ends: [f64; 2],
    /// Hash of all that decides its numbers but texture, seed, step and end.
    physics: blake3::Hash,
    /// Seed of the subject's surface in the search.
    seed: u64,
    /// Whether surfaces differ by their seeds.
    scatters: bool,
    /// Largest share of texture, %.
    most: f64,
}

/// A run that is wanted.
#[derive(Clone)]
pub(crate) struct Wanted {
    /// Index of the case.
    pub(crate) subject: usize,
    /// The texture; none for the slider without.
    pub(crate) texture: Option<Arc<Vec<bool>>>,
    /// Number of the surface; 0 is the surface of the search.
    pub(crate) surface: u64,
    /// Accuracy of the run.
    pub(crate) fidelity: Fidelity,
}

/// Identity of a run: a hash of all that decides its numbers.
pub type RunId = String;

/// Results of runs by their identities; none for a run that diverged.
pub type Known = HashMap<RunId, Option<Measured>>;

/// Takes runs that have ended, in their order.
pub type Keep<'a> = dyn FnMut(&[(RunId, Option<Measured>)]) -> Result<(), StudyError> + 'a;

impl Subject {
    /// A case in which designs with up to `most` % of texture are tried, for the quantity of the wish.
    pub(crate) fn new(case: &Case, wish: &Wish, most: f64) -> Result<Self, CaseError> {
        let mut file = case.file.clone();
        file.texture.clear();
        file.output.snapshots = Snapshots::At(Vec::new());
        file.output.series = AutoOr::Auto;
        file.time.stop = StopReason::End;
        let own = case.time_plan.dt_star;
        let coarse = own.max(COARSE_STEP.min(0.5 * case.time_plan.step_limit));
        let whole = case.time_plan.end_star();
        let mut subject = Self {
            name: case.name.clone(),
            files: case
                .inputs
                .iter()
                .map(|input| Ok((input.name.clone(), input.read_again()?)))
                .collect::<Result<_, CaseError>>()?,
            steps: [coarse, own],
            ends: [whole; 2],
            physics: blake3::Hash::from_bytes([0; 32]),
            seed: file.friction.seed,
            scatters: case.groups.sigma_static_star > 0.0 || case.groups.sigma_kinetic_star > 0.0,
            most,
            file,
        };
        let bare = subject.case(None, 0, Fidelity::Fine)?;
        // When a drive at some blocks alone makes the others slip is not known before.
        let is_on_all = bare.file.drive.attached == Attached::At(AttachedEdge::All);
        let is_short = is_on_all && !wish.needs_sliding() && bare.model.drive.program.is_none();
        if let Wish::Curve(points) = wish {
            let last = points.last().map_or(whole, |&[time, _]| time);
            (subject.file.time.kinetic_from_star, subject.ends) = (AutoOr::Auto, [last; 2]);
        } else if is_short {
            // No window of kinetic friction may begin after the end.
            subject.file.time.kinetic_from_star = AutoOr::Auto;
            let load_factor = 1.0 / (1.0 - 0.01 * most);
            let onset_end = bare.expected.onset_end_star * load_factor;
            subject.ends = [SEARCHED, JUDGED * SEARCHED].map(|times| times * onset_end);
        }
        subject.physics = physics(&subject.case(None, 0, Fidelity::Fine)?, None)?;
        Ok(subject)
    }

    /// The case, without textures.
    pub(crate) fn file(&self) -> &CaseFile {
        &self.file
    }

    /// The case with other keys.
    pub(crate) fn with(&self, change: impl FnOnce(&mut CaseFile), wish: &Wish) -> Result<Self, CaseError> {
        let mut file = self.file.clone();
        change(&mut file);
        Self::new(&self.made_of(file, &self.files)?, wish, self.most)
    }

    /// The case on blocks of half the size.
    ///
    /// # Errors When the case cannot be put on such blocks.
    pub(crate) fn on_finer_blocks(&self, wish: &Wish) -> Result<Self, CaseError> {
        let case = self.made_of(self.file.clone(), &self.files)?;
        let set = case.on_other_blocks(2.0)?;
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        let finer = CaseFile::parse(&self.file.to_toml()?, &self.name, &set)?;
        Self::new(&self.made_of(finer, &self.files)?, wish, self.most)
    }

    /// Makes the case of a file.
    fn made_of(&self, file: CaseFile, in_memory: &FilesInMemory) -> Result<Case, CaseError> {
        let files = Files {
            folder: Path::new(""),
            in_memory: Some(in_memory),
        };
        Case::to_run_with(file, &self.name, files, &mut |_| true, Ranks::ALONE)
    }

    fn step_and_end(&self, fidelity: Fidelity) -> [f64; 2] {
        let [coarse, own] = self.steps;
        let [searched, judged] = self.ends;
        match fidelity {
            Fidelity::Coarse => [coarse, searched],
            Fidelity::Fine => [own, searched],
            Fidelity::Verdict => [own, judged],
        }
    }

    /// The case with a texture.
    pub(crate) fn case(
        &self,
        texture: Option<&[bool]>,
        surface: u64,
        fidelity: Fidelity,
    ) -> Result<Case, CaseError> {
        let mut file = self.file.clone();
        let [step, end] = self.step_and_end(fidelity);
        file.time.step = TimeStep::Number(step);
        file.time.duration = RunTime::Star(AutoOr::Number(end));
        file.friction.seed = self.seed + surface;
        let Some(texture) = texture else {
            return self.made_of(file, &self.files);
        };
        file.texture.push(masked(MASK));
        let columns = file.slider.blocks[0] as usize;
        // Copies of the case stand in a folder of their own, where no file has the name of the mask.
        let mut files = self.files.clone();
        files.insert(MASK.to_owned(), npy_of_mask(columns, texture).into());
        self.made_of(file, &files)
    }
}

/// Name of the mask of a design, in cases and in its folder.
pub(crate) const MASK: &str = "mask.npy";

/// The texture of a case whose mask is a file.
pub(crate) fn masked(file: &str) -> Texture {
    Texture {
        shape: Shape::Mask(Mask {
            file: file.to_owned(),
            threshold: DEFAULT_THRESHOLD,
        }),
        pattern: Pattern::default(),
    }
}

/// The cases in which designs are tried, and the rule by which their losses become one.
#[derive(Debug)]
pub(crate) struct Evaluator {
    /// The cases, all with the same blocks.
    pub(crate) subjects: Vec<Subject>,
    /// The blocks.
    pub(crate) grid: Grid,
    /// The wish.
    pub(crate) wish: Wish,
    /// Whether the worst case counts, in place of the mean.
    pub(crate) is_worst: bool,
}

impl Evaluator {
    /// An evaluator with other cases for this wish.
    pub(crate) fn with_subjects(&self, subjects: Vec<Subject>, grid: Grid) -> Self {
        Self {
            subjects,
            grid,
            wish: self.wish.clone(),
            is_worst: self.is_worst,
        }
    }

    /// Whether surfaces differ by their seeds in any case.
    pub(crate) fn scatters(&self) -> bool {
        self.subjects.iter().any(|subject| subject.scatters)
    }

    /// Identity of a run.
    pub(crate) fn id(&self, wanted: &Wanted) -> RunId {
        let subject = &self.subjects[wanted.subject];
        let mut hasher = blake3::Hasher::new();
        hasher.update(subject.physics.as_bytes());
        if let Some(texture) = &wanted.texture {
            hasher.update(&hash(texture));
        }
        hasher.update(&(subject.seed + wanted.surface).to_le_bytes());
        for number in subject.step_and_end(wanted.fidelity) {
            hasher.update(&number.to_le_bytes());
        }
        if let Wish::Curve(points) = &self.wish {
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

    /// Makes the runs that are not known yet, on the threads of rayon's pool, and hands them over in the order in which they
    /// are wanted. After a stop, no run is handed over.
    pub(crate) fn run(
        &self,
        wanted: &[Wanted],
        known: &mut Known,
        stop: &AtomicBool,
        keep: &mut Keep,
    ) -> Result<(), StudyError> {
        let mut asked = HashSet::new();
        let missing: Vec<(RunId, &Wanted)> = wanted
            .iter()
            .map(|wanted| (self.id(wanted), wanted))
            .filter(|(id, _)| !known.contains_key(id) && asked.insert(id.clone()))
            .collect();
        let runs = missing.into_par_iter().with_max_len(1);
        let ended: Result<Vec<_>, StudyError> = runs
            .map(|(id, wanted)| Ok((id, self.measure(wanted, stop)?.ok_or(StudyError::Interrupted)?)))
            .collect();
        let ended = ended?;
        keep(&ended)?;
        known.extend(ended);
        Ok(())
    }

    /// Makes one run: none after a stop, and within that none for a run that diverged.
    fn measure(&self, wanted: &Wanted, stop: &AtomicBool) -> Result<Option<Option<Measured>>, CaseError> {
        let ends = || stop.load(Ordering::Relaxed);
        let texture = wanted.texture.as_ref().map(|texture| texture.as_slice());
        let case = self.subjects[wanted.subject].case(texture, wanted.surface, wanted.fidelity)?;
        let Wish::Curve(points) = &self.wish else {
            let summary = run_summary_unless(&case, &ends);
            return Ok(summary.map(|summary| summary.ok().map(|summary| Measured::of(&summary))));
        };
        let record = run_unless(&Arc::new(case), &ends);
        Ok(record.map(|record| {
            record.ok().map(|record| Measured {
                misfit: Some(misfit(points, &record)),
                ..Measured::of(&record.summary)
            })
        }))
    }

    /// The numbers of a run; none for a run that diverged or was not made.
    pub(crate) fn found(&self, wanted: &Wanted, known: &Known) -> Option<Measured> {
        known.get(&self.id(wanted)).cloned().flatten()
    }

    /// The loss of a texture on some surfaces: the mean over the cases of the mean deviation of each, or the largest;
    /// infinite if a run diverged.
    pub(crate) fn loss(
        &self,
        texture: &Arc<Vec<bool>>,
        surfaces: Range<u64>,
        fidelity: Fidelity,
        known: &Known,
    ) -> f64 {
        let deviation = |subject: usize, surface: u64| {
            let found = |texture: Option<&Arc<Vec<bool>>>| {
                let wanted = Wanted {
                    subject,
                    texture: texture.cloned(),
                    surface,
                    fidelity,
                };
                self.found(&wanted, known)
            };
            let pair = found(Some(texture)).zip(found(None));
            pair.map_or(f64::NAN, |(with, without)| self.wish.deviation(&with, &without))
        };
        let losses = (0..self.subjects.len()).map(|subject| {
            let deviations: Vec<f64> = surfaces
                .clone()
                .map(|surface| deviation(subject, surface))
                .collect();
            let loss = self.wish.loss(mean(&deviations));
            if loss.is_nan() { f64::INFINITY } else { loss }
        });
        if self.is_worst {
            losses.fold(f64::NEG_INFINITY, f64::max)
        } else {
            losses.sum::<f64>() / self.subjects.len() as f64
        }
    }
}

/// Root of the mean square of mu* less the wished values at some times of the drive, with mu* linear between its rows.
fn misfit(points: &[[f64; 2]], record: &Record) -> f64 {
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
    use super::super::wish::Quantity;
    use super::*;

    fn subject(text: &str) -> Subject {
        let case = Case::parse(text, "case", "", &[]).unwrap();
        Subject::new(&case, &Wish::Least(Quantity::StaticFriction), 10.0).unwrap()
    }

    /// A ripple before the peak is no reduction: bars that a search once placed so that mu* ripples at 0.5005, just above
    /// the level of sliding, before it rises on to 0.59, do not count for the ripple, with either step.
    #[test]
    fn a_ripple_before_the_peak_is_no_reduction() {
        let subject = subject(
            "slider.blocks = [50, 50]\ndrive.v_star = 0.005\n\
             friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }",
        );
        let rows = include_str!("../../../slipfront/tests/physics/first_peak_mask.txt")
            .lines()
            .rev();
        let texture: Vec<bool> = rows
            .flat_map(|row| row.bytes().map(|mark| mark == b'#'))
            .collect();
        for fidelity in [Fidelity::Coarse, Fidelity::Fine] {
            let case = subject.case(Some(&texture), 0, fidelity).unwrap();
            let largest = slipfront_run::run_summary::run_summary(&case)
                .unwrap()
                .mu_star_max;
            assert!(largest > 0.59, "{fidelity:?}: {largest}");
        }
    }

    /// A search runs until every block in contact has slipped, as far as its own drive spring alone can make it.
    #[test]
    fn a_search_looks_until_every_block_has_slipped() {
        let subject = subject("slider.blocks = [4, 4]\ndrive.v_star = 0.1\ntime.kinetic_from_star = 70");
        let [searched, judged] = subject.ends;
        // A tenth of the blocks bears nothing; the others bear it by springs of 3/8.
        assert!(searched > 1.0 / 0.9 / (0.375 * 0.1) && judged == 2.0 * searched);
        assert_eq!(subject.steps, [0.4, 0.1]);
        let case = subject.case(None, 3, Fidelity::Coarse).unwrap();
        assert_eq!((case.time_plan.dt_star, case.file.friction.seed), (0.4, 4));
        assert_eq!(case.time_plan.last_step, (searched / 0.4).ceil() as u64);
        // Adhesion as large as the load delays the onset to twice the time.
        let adhesive = self::subject(
            "slider.blocks = [4, 4]\ndrive.v_star = 0.1\nfriction.adhesion = '100 kPa'\nload.pressure = '100 kPa'",
        );
        assert!((adhesive.ends[0] / searched - 2.0).abs() < 1e-12);
        // A drive at an edge pulls as long as the case says.
        let edge = self::subject(
            "slider.blocks = [4, 4]\ndrive = { attach = 'left', v_star = 0.1 }\ntime.duration_star = 300",
        );
        assert_eq!(edge.ends, [300.0; 2]);
        // A curve is followed to its end, however long the case is.
        let case = Case::parse("slider.blocks = [4, 4]", "case", "", &[]).unwrap();
        let curve = Wish::Curve(vec![[0.0, 0.0], [500.0, 0.5]]);
        assert_eq!(Subject::new(&case, &curve, 10.0).unwrap().ends, [500.0; 2]);
    }

    #[test]
    fn a_curve_is_compared_between_its_rows() {
        let case = Case::parse("slider.blocks = [4, 4]\noutput.series = 5", "case", "", &[]).unwrap();
        let record = slipfront_run::running::run(&Arc::new(case), 1).unwrap();
        let points = record.rows.windows(2).map(|rows| {
            let [time, mu] = [0, 1].map(|k| [rows[k].drive_time_star, rows[k].point.mu_star]);
            [0.5 * (time[0] + mu[0]), 0.5 * (time[1] + mu[1])]
        });
        let points: Vec<[f64; 2]> = points.collect();
        // The middle of two rows, rounded.
        assert!(misfit(&points, &record) < 1e-15);
        let raised: Vec<[f64; 2]> = points.iter().map(|[time, mu]| [*time, mu + 0.5]).collect();
        assert!((misfit(&raised, &record) - 0.5).abs() < 1e-15);
    }
}
