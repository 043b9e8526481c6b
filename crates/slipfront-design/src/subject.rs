//! A case in which designs are tried: its runs with a texture, their time steps and durations.

use std::path::Path;

use slipfront::StopReason;
use slipfront_case::arrays::npy_of_mask;
use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
use slipfront_case::case_file::{
    Attached, AttachedEdge, AutoOr, CaseError, CaseFile, DEFAULT_THRESHOLD, Mask, Pattern, RunTime, Shape,
    Snapshots, Texture, TimeStep,
};

use crate::wish::{FrictionUnit, Wish};
use slipfront_study::identity::physics;

/// Time step with which designs are tried: it ranks reductions in the same order as a quarter of this step,
/// at a third of the cost.
const COARSE_STEP: f64 = 0.4;

/// Duration of a run in the search, over `onset_end_star` of the slider without texture times the load factor
/// of the largest allowed coverage. The largest mu* within this duration counts as static friction.
/// `onset_end_star` is twice the onset time (Eq. 12), so the duration is 1.2 times the latest expected onset.
/// A block that is pulled only by its own drive spring, without its neighbours, slips at 2.67/2.5 = 1.07 of
/// the onset time.
const SEARCHED: f64 = 0.6;

/// Duration of a run of a verdict, as a multiple of that in the search, so that no design is good only
/// because the run ends early.
const JUDGED: f64 = 2.0;

/// Accuracy of a run of a design.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fidelity {
    /// With a coarse step.
    Coarse,
    /// With the step of the case.
    Fine,
    /// With the step of the case, for a longer time.
    Verdict,
}

/// A case in which designs are tried.
#[derive(Debug)]
pub(crate) struct Subject {
    /// The case, without textures.
    file: CaseFile,
    name: String,
    /// The files that the case names, and the mask, in memory: no run reads from disk.
    files: FilesInMemory,
    /// Steps dt*: the coarse one, and the step of the case.
    steps: [f64; 2],
    /// Durations of runs, t*: in the search, and in verdicts.
    ends: [f64; 2],
    /// The wish, in units of this case.
    pub(crate) wish: Wish,
    /// Unit of friction in the report: that of the wish.
    pub(crate) unit: FrictionUnit,
    /// Path of the drive in one unit of time, m.
    path_per_time: f64,
    /// Hash of everything that determines the numbers of its runs, except texture, seed, step and duration.
    pub(crate) physics: blake3::Hash,
    /// Seed of the subject's surface in the search.
    pub(crate) seed: u64,
    /// Whether surfaces with different seeds differ.
    pub(crate) scatters: bool,
    /// Largest coverage, %.
    most: f64,
}

impl Subject {
    /// A case in which designs with up to `most` % of texture are tried, for a wish in units of this case.
    pub(crate) fn new(case: &Case, wish: Wish, most: f64) -> Result<Self, CaseError> {
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
            path_per_time: case.groups.v_star * case.scales.displacement(),
            physics: blake3::Hash::from_bytes([0; 32]),
            seed: file.friction.seed,
            scatters: case.groups.sigma_static_star > 0.0 || case.groups.sigma_kinetic_star > 0.0,
            most,
            unit: match &wish {
                Wish::Value(target) => target.unit.clone(),
                _ => FrictionUnit::coefficient(case.scales.mu_static_mean),
            },
            wish,
            file,
        };
        let bare = subject.case(None, 0, Fidelity::Fine)?;
        // If the drive acts on some blocks only, the time at which the others slip is not known in advance.
        let is_on_all = bare.file.drive.attached == Attached::At(AttachedEdge::All);
        let is_short = is_on_all && !subject.wish.needs_sliding() && bare.model.drive.program.is_none();
        if let Wish::Curve(points) = &subject.wish {
            let last = points.last().map_or(whole, |&[time, _]| time);
            (subject.file.time.kinetic_from_star, subject.ends) = (AutoOr::Auto, [last; 2]);
        } else if is_short {
            // The window of kinetic friction must not begin after the end of the run.
            subject.file.time.kinetic_from_star = AutoOr::Auto;
            let load_factor = 1.0 / (1.0 - 0.01 * most);
            let onset_end = bare.expected.onset_end_star * load_factor;
            subject.ends = [SEARCHED, JUDGED * SEARCHED].map(|times| times * onset_end);
        }
        subject.physics = physics(&subject.case(None, 0, Fidelity::Fine)?)?;
        Ok(subject)
    }

    /// The case, without textures.
    pub(crate) fn file(&self) -> &CaseFile {
        &self.file
    }

    /// The case with other keys.
    pub(crate) fn with(&self, change: impl FnOnce(&mut CaseFile)) -> Result<Self, CaseError> {
        let mut file = self.file.clone();
        change(&mut file);
        self.changed_to(file)
    }

    /// The case on blocks of half the size.
    ///
    /// # Errors
    /// When the case cannot be put on such blocks.
    pub(crate) fn on_finer_blocks(&self) -> Result<Self, CaseError> {
        let case = self.made_of(self.file.clone(), &self.files)?;
        let set = case.on_other_blocks(2.0)?;
        let set: Vec<String> = set.iter().map(ToString::to_string).collect();
        self.changed_to(CaseFile::parse(&self.file.to_toml()?, &self.name, &set)?)
    }

    /// A case of another file with the wish of this one; a curve keeps the path of the drive.
    fn changed_to(&self, file: CaseFile) -> Result<Self, CaseError> {
        let case = self.made_of(file, &self.files)?;
        let times = self.path_per_time / (case.groups.v_star * case.scales.displacement());
        Self::new(&case, self.wish.with_times(times), self.most)
    }

    /// Makes the case of a file.
    fn made_of(&self, file: CaseFile, in_memory: &FilesInMemory) -> Result<Case, CaseError> {
        let files = Files {
            folder: Path::new(""),
            in_memory: Some(in_memory),
        };
        Case::to_run(file, &self.name, files, &mut |_| true, Ranks::ALONE)
    }

    /// Cost of a run in steps times blocks, without steps during which a held drive is stopped.
    pub(crate) fn work(&self, fidelity: Fidelity) -> f64 {
        let [step, end] = self.step_and_end(fidelity);
        let [nx, ny] = self.file.slider.blocks.map(f64::from);
        nx * ny * end / step
    }

    pub(crate) fn step_and_end(&self, fidelity: Fidelity) -> [f64; 2] {
        let [coarse, own] = self.steps;
        let [searched, judged] = self.ends;
        match fidelity {
            Fidelity::Coarse => [coarse, searched],
            Fidelity::Fine => [own, searched],
            Fidelity::Verdict => [own, judged],
        }
    }

    /// The case with shapes as textures.
    ///
    /// # Errors
    /// When the case refuses the textures.
    pub(crate) fn with_textures(&self, textures: &[Texture]) -> Result<Case, CaseError> {
        let mut file = self.file.clone();
        file.texture = textures.to_vec();
        self.made_of(file, &self.files)
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
        // Copies of the input files are in their own folder, where no file has the name of the mask.
        let mut files = self.files.clone();
        files.insert(MASK.to_owned(), npy_of_mask(columns, texture).into());
        self.made_of(file, &files)
    }
}

/// Name of the mask of a design, in cases and in its folder.
pub(crate) const MASK: &str = "mask.npy";

/// The texture of a case with a mask in a file.
pub(crate) fn masked(file: &str) -> Texture {
    Texture {
        shape: Shape::Mask(Mask {
            file: file.to_owned(),
            threshold: DEFAULT_THRESHOLD,
        }),
        pattern: Pattern::default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wish::Quantity;

    fn subject(text: &str) -> Subject {
        let case = Case::parse(text, "case", "", &[]).unwrap();
        Subject::new(&case, Wish::Least(Quantity::StaticFriction), 10.0).unwrap()
    }

    /// A ripple before the peak does not count as static friction. A search once placed bars so that mu*
    /// ripples at 0.5005, just above the level of sliding, and then rises to 0.59; the result must be the
    /// latter, with either step.
    #[test]
    fn a_ripple_before_the_peak_is_no_reduction() {
        let subject = subject(
            "slider.blocks = [50, 50]\ndrive.v_star = 0.005\n\
             friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }",
        );
        let rows = include_str!("../../slipfront/tests/physics/first_peak_mask.txt")
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

    /// A run of a search lasts until every block in contact has slipped, even if only its own drive spring
    /// pulls it.
    #[test]
    fn a_search_looks_until_every_block_has_slipped() {
        let subject = subject("slider.blocks = [4, 4]\ndrive.v_star = 0.1\ntime.kinetic_from_star = 70");
        let [searched, judged] = subject.ends;
        // A tenth of the blocks carries no load; the others carry it, and are pulled by springs of 3/8.
        assert!(searched > 1.0 / 0.9 / (0.375 * 0.1) && judged == 2.0 * searched);
        assert_eq!(subject.steps, [0.4, 0.1]);
        let case = subject.case(None, 3, Fidelity::Coarse).unwrap();
        assert_eq!((case.time_plan.dt_star, case.file.friction.seed), (0.4, 4));
        assert_eq!(case.time_plan.last_step, (searched / 0.4).ceil() as u64);
        // A verdict has a quarter of the step and twice the time. If the lengths of the material are
        // multiples of the block, a run on blocks of half the size has the same number of steps.
        let work = [Fidelity::Coarse, Fidelity::Verdict].map(|fidelity| subject.work(fidelity));
        let finer = subject.on_finer_blocks().unwrap().work(Fidelity::Verdict);
        let ratios = [work[1] / work[0], finer / work[1]];
        assert!(
            (ratios[0] - 8.0).abs() < 1e-9 && (ratios[1] - 4.0).abs() < 1e-9,
            "{ratios:?}"
        );
        // An adhesion equal to the load doubles the onset time.
        let adhesive = self::subject(
            "slider.blocks = [4, 4]\ndrive.v_star = 0.1\nfriction.adhesion = '100 kPa'\nload.pressure = '100 kPa'",
        );
        assert!((adhesive.ends[0] / searched - 2.0).abs() < 1e-12);
        // With a drive at an edge, runs last as long as the case says.
        let edge = self::subject(
            "slider.blocks = [4, 4]\ndrive = { attach = 'left', v_star = 0.1 }\ntime.duration_star = 300",
        );
        assert_eq!(edge.ends, [300.0; 2]);
        // A curve is followed to its end, whatever the duration of the case.
        let case = Case::parse("slider.blocks = [4, 4]", "case", "", &[]).unwrap();
        let curve = Wish::Curve(vec![[0.0, 0.0], [500.0, 0.5]]);
        assert_eq!(Subject::new(&case, curve, 10.0).unwrap().ends, [500.0; 2]);
    }
}
