//! The plan of a study: its points, and the runs of each point.

use std::ops::Range;

use rayon::prelude::*;

use crate::axis::{self, Axis};
use crate::error::StudyError;
use crate::identity::physics;
use crate::plan_warnings::{Warning, Warnings, note_on_seeds};
use crate::project_file::Base;
use crate::shard::Shard;
use crate::study_file::{RetainRuns, Settings, StudyFile};
use crate::summary_values::REDUCTION;
use crate::work_memory::WorkMemory;
use slipfront_base::machine::available_of;
use slipfront_base::number_format::byte_size;
use slipfront_base::text::display_path;
use slipfront_case::case::{Case, ExpectedSteps, PICTURES, PROGRAM, Ranks, Watch};
use slipfront_case::case_file::{AutoOr, CaseError, CaseFile, Override, ParsedCase, Snapshots};

/// Every run that a study may need.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Name of the study.
    pub name: String,
    /// Repetition, reference and kept folders.
    pub settings: Settings,
    /// The axes of the study.
    pub axes: Vec<Axis>,
    /// Every combination of levels, the last axis fastest.
    pub points: Vec<Point>,
    /// Data of the runs of the points, one for each role.
    specs: Vec<RunSpec>,
    warnings: Vec<Warning>,
    base: Base,
    reference: Option<Vec<Override>>,
}

/// A combination of levels. There may be a million of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the point in the whole study, from 0: equal in every shard.
    pub index: usize,
}

/// Data of the runs of a point before any is made.
#[derive(Clone, Copy, Debug, PartialEq)]
struct RunSpec {
    /// Seed of replicate 0.
    seed: u64,
    /// Hash of everything except the seed that determines the numbers of a run.
    physics: blake3::Hash,
    /// Expected number of steps.
    steps: ExpectedSteps,
    n_blocks: usize,
    /// Whether the drive stops while blocks slide, for an additional time that `steps` do not include.
    is_held: bool,
    /// Memory of a run that is made at the same time as others, in bytes.
    memory: f64,
    /// Memory of only the case of a run, in bytes.
    memory_of_case: f64,
    /// Disk space for the files of a run, in bytes.
    disk: f64,
    /// Textured area A* as meshed, %.
    texture_percent: f64,
    /// Area of the shapes of the only texture as meshed, %; none for several textures.
    meshed_coverage: Option<f64>,
}

/// Number of blocks above which planning makes cases one at a time, because one for each thread might not fit
/// into memory.
const LARGE: u64 = 250_000;

/// Data of a run and the warnings about it, or the error of its case.
type Spec = Result<(RunSpec, Vec<String>), (Role, CaseError)>;

/// Number of points for which cases are made before the data of their runs are collected.
const POINTS_AT_ONCE: usize = 4096;

/// Number of consecutive points with cases made from the same base.
const POINTS_OF_A_BASE: usize = 64;

/// Bytes of a line of the records and a row of the tables.
const RECORD_BYTES: f64 = 4096.0;

/// Bytes that a run keeps in memory: its identity and its numbers, in the records, in the results and for the
/// pictures.
const RESULT_BYTES: f64 = 2048.0;

/// Number of pictures of the study that are drawn at the same time.
pub(crate) const PICTURES_AT_ONCE: usize = 2;

/// The purpose of a run of a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// The point itself.
    Point,
    /// The reference for the reduction of the point.
    Reference,
}

/// One run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RunKey {
    /// Position of the point in the plan.
    pub point: usize,
    /// Replicate, from 0.
    pub replicate: usize,
    /// Purpose of the run.
    pub role: Role,
}

impl Plan {
    /// Makes the points of all combinations of levels and the case of each. The error names the first invalid
    /// one.
    pub fn new(file: &StudyFile, shard: Option<Shard>) -> Result<Self, StudyError> {
        let points = (0..file.count_points()?)
            .filter(|&index| shard.is_none_or(|shard| shard.holds(index)))
            .map(|index| Point { index })
            .collect();
        let mut plan = Self {
            name: file.name.clone(),
            settings: file.settings.clone(),
            axes: file.axes.clone(),
            points,
            specs: Vec::new(),
            warnings: Vec::new(),
            base: file.base.clone(),
            reference: file.settings.reference.as_ref().map(axis::overrides),
        };
        plan.make_specs()?;
        Ok(plan)
    }

    /// Makes the cases of all points, and collects the data of their runs.
    fn make_specs(&mut self) -> Result<(), StudyError> {
        let invalid = |point: Option<&Point>, (role, source)| {
            let point = point.map_or_else(String::new, |point| self.describe(point));
            match role {
                Role::Point => StudyError::Point { point, source },
                Role::Reference => StudyError::ReferencePoint { point, source },
            }
        };
        let base = self.base.parse();
        let base = base.map_err(|error| invalid(self.points.first(), (Role::Point, error)))?;
        let (slow, length) = self.slow_axes();
        let roles = self.roles().count();
        let mut specs = Vec::with_capacity(self.points.len() * roles);
        let mut warnings = Warnings::default();
        for (chunk, points) in self.points.chunks(POINTS_AT_ONCE).enumerate() {
            let rows = points.chunk_by(|a, b| a.index / length == b.index / length);
            let rows: Vec<&[Point]> = rows.flat_map(|row| row.chunks(POINTS_OF_A_BASE)).collect();
            let make = |row: &&[Point], most| self.make_row(&base, row, slow, most);
            let made: Vec<_> = rows.par_iter().map(|row| make(row, LARGE)).collect();
            let made = made.into_iter().zip(rows);
            let made = made.filter_map(|(made, row)| made.or_else(|| make(&row, u64::MAX)));
            // In order, so that the error names the first invalid point.
            for (run, made) in made.flatten().enumerate() {
                let position = chunk * POINTS_AT_ONCE + run / roles;
                let (spec, sentences) = made.map_err(|error| invalid(Some(&self.points[position]), error))?;
                warnings.add(position, sentences);
                specs.push(spec);
            }
        }
        self.specs = specs;
        self.warnings = warnings.found;
        Ok(())
    }

    /// Number of leading axes that keep their levels over several points in a row, so that these points can
    /// share a base; and the number of these points.
    fn slow_axes(&self) -> (usize, usize) {
        let (mut slow, mut length) = (self.axes.len(), 1);
        while slow > 0 && length < POINTS_OF_A_BASE {
            slow -= 1;
            length *= self.axes[slow].levels.len();
        }
        (slow, length)
    }

    /// Makes the cases of points with the same levels of the first `slow` axes; none if one of them has more
    /// blocks than `most`.
    fn make_row(&self, base: &ParsedCase, row: &[Point], slow: usize, most: u64) -> Option<Vec<Spec>> {
        let bases = self.roles().map(|role| {
            let overrides = self.overrides(&row[0], role, 0..slow);
            let prepared = base.prepared(&overrides);
            prepared.map(|base| (role, base)).map_err(|error| (role, error))
        });
        let bases = match bases.collect::<Result<Vec<_>, _>>() {
            Ok(bases) => bases,
            // The error is that of the first point.
            Err(error) => return Some(vec![Err(error)]),
        };
        let mut specs = Vec::with_capacity(row.len() * bases.len());
        for point in row {
            for (role, base) in &bases {
                let file = base.with(&self.overrides(point, *role, slow..self.axes.len()));
                let file = file.and_then(|file| self.check_seeds(&file).map(|()| file));
                let n_blocks =
                    |file: &CaseFile| file.slider.blocks.into_iter().map(u64::from).product::<u64>();
                if file.as_ref().is_ok_and(|file| n_blocks(file) > most) {
                    return None;
                }
                let spec = file.and_then(|file| self.spec(file, *role));
                specs.push(spec.map_err(|error| (*role, error)));
            }
        }
        Some(specs)
    }

    /// The roles of the runs of a point: the point itself, and its reference if the study has one.
    pub fn roles(&self) -> impl Iterator<Item = Role> + use<> {
        let reference = self.reference.as_ref().map(|_| Role::Reference);
        [Role::Point].into_iter().chain(reference)
    }

    /// Whether reductions are measured.
    pub fn has_reference(&self) -> bool {
        self.reference.is_some()
    }

    /// The main quantity: the one that decides on replicates, otherwise the reduction if there is a
    /// reference, otherwise mu_s*.
    pub fn main_quantity(&self) -> &str {
        match &self.settings.until {
            Some(until) => &until.key,
            None if self.has_reference() => REDUCTION,
            None => "static_friction_star",
        }
    }

    /// The overrides of a point's levels on these axes. The overrides of the reference follow the last axis.
    fn overrides(&self, point: &Point, role: Role, axes: Range<usize>) -> Vec<&Override> {
        let levels = self.levels(point);
        let overrides = axes
            .clone()
            .flat_map(|axis| &self.axes[axis].levels[levels[axis]].overrides);
        let mut overrides: Vec<&Override> = overrides.collect();
        if let (Some(reference), Role::Reference) = (&self.reference, role) {
            let replaces = |other: &Override, set: &Override| axis::replaces_key(other.key(), set.key());
            overrides.retain(|set| !reference.iter().any(|other| replaces(other, set)));
            if axes.end == self.axes.len() {
                overrides.extend(reference);
            }
        }
        overrides
    }

    /// The case file of replicate 0: the base with the overrides of the point's levels, and of the reference.
    fn case_file(&self, base: &ParsedCase, point: &Point, role: Role) -> Result<CaseFile, CaseError> {
        base.with(&self.overrides(point, role, 0..self.axes.len()))
    }

    /// The case file of the first point.
    pub(crate) fn first_case_file(&self) -> Result<CaseFile, CaseError> {
        self.case_file(&self.base.parse()?, &self.points[0], Role::Point)
    }

    /// The case of a combination of levels, for its computed model.
    pub(crate) fn case_of(&self, levels: &[usize]) -> Result<Case, CaseError> {
        let axes = self.axes.iter().zip(levels);
        let point = Point {
            index: axes.fold(0, |index, (axis, level)| index * axis.levels.len() + level),
        };
        let file = self.case_file(&self.base.parse()?, &point, Role::Point)?;
        self.trimmed(file, "point", &mut |_| true)
    }

    /// Makes the case of a point; returns the data of its runs, and the warnings about it.
    fn spec(&self, file: CaseFile, role: Role) -> Result<(RunSpec, Vec<String>), CaseError> {
        let case = self.trimmed(file, "point", &mut |_| true)?;
        let writes = self.settings.keep == RetainRuns::All;
        let spec = RunSpec {
            seed: case.file.friction.seed,
            physics: physics(&case)?,
            steps: case.expected_steps(),
            n_blocks: case.model.lattice.n_blocks(),
            is_held: case.model.drive.is_held(),
            memory: case.budget.beside_others(writes),
            memory_of_case: case.budget.making(),
            disk: if writes { case.budget.disk() } else { 0.0 },
            texture_percent: case.texture.meshed_percent,
            meshed_coverage: meshed_coverage(&case),
        };
        let mut warnings = case.warnings();
        if role == Role::Point && self.settings.max_replicates() > 1 {
            warnings.extend(note_on_seeds(&case).map(str::to_owned));
        }
        Ok((spec, warnings))
    }

    /// Refuses a seed if the seeds of the replicates would exceed the largest seed.
    fn check_seeds(&self, file: &CaseFile) -> Result<(), CaseError> {
        const MAX_SEED: u64 = i64::MAX.unsigned_abs();
        let (seed, replicates) = (file.friction.seed, self.settings.max_replicates());
        if seed + (replicates - 1) as u64 <= MAX_SEED {
            return Ok(());
        }
        let sentence = format!(
            "`friction.seed` = {seed} is too large for {replicates} replicates, which use this and the following seeds: the \
             last must be at most {MAX_SEED}"
        );
        Err(file.source.error("friction.seed", sentence))
    }

    /// Warnings about the cases of the study, the first of each kind.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// The case of a run, ready to run, unless a file that it reads has changed since the plan was made.
    /// `watch` receives the progress of meshing its texture.
    pub fn case(&self, run: RunKey, watch: &mut Watch) -> Result<Case, CaseError> {
        let mut file = self.case_file(&self.base.parse()?, &self.points[run.point], run.role)?;
        file.friction.seed = self.seed(run);
        let case = self.trimmed(file, &self.folder_name(run), watch)?;
        // Only files can have changed.
        if !case.inputs.is_empty() && physics(&case)? != self.spec_of(run).physics {
            let originals = case.inputs.iter().map(|input| display_path(&input.original));
            let names: Vec<String> = originals.collect();
            let sentence = format!(
                "a file that a run reads was changed after the study began: run the study again, and do not change {} meanwhile",
                names.join(", ")
            );
            return Err(case.file.source.error("", sentence));
        }
        Ok(case)
    }

    /// Returns the plan for the study in a results folder. It reads the copies of the files there, so later
    /// changes of the original files have no effect on its runs.
    #[must_use]
    pub fn reading_copies(self, study: &StudyFile) -> Self {
        Self {
            axes: study.axes.clone(),
            base: study.base.clone(),
            reference: study.settings.reference.as_ref().map(axis::overrides),
            ..self
        }
    }

    /// A case that records only what the study keeps.
    fn trimmed(&self, mut file: CaseFile, name: &str, watch: &mut Watch) -> Result<Case, CaseError> {
        let keeps_all = self.settings.keep == RetainRuns::All;
        if !keeps_all {
            // Fields and curves are not kept, and the numbers do not depend on them.
            file.output.snapshots = Snapshots::At(Vec::new());
            file.output.series = AutoOr::Auto;
        }
        let mut case = Case::new(file, name, self.base.files(), watch, Ranks::ALONE)?;
        if !keeps_all {
            case.output.series_stride = case.time_plan.last_step;
        }
        Ok(case)
    }

    fn spec_of(&self, run: RunKey) -> &RunSpec {
        &self.specs[run.point * self.roles().count() + usize::from(run.role == Role::Reference)]
    }

    /// Seed of a run. Replicates differ only by their seed, so replicate r has the same surface at all
    /// points.
    pub fn seed(&self, run: RunKey) -> u64 {
        self.spec_of(run).seed + run.replicate as u64
    }

    /// Identity of a run, from its physics and seed. Points share runs with equal identities, such as their
    /// reference.
    pub fn identity(&self, run: RunKey) -> String {
        let mut hasher = blake3::Hasher::new();
        hasher.update(self.spec_of(run).physics.as_bytes());
        hasher.update(&self.seed(run).to_le_bytes());
        hasher.finalize().to_hex()[..32].to_owned()
    }

    /// Name of the folder of a run, if it is kept: the beginning of its identity, so that the name does not
    /// change when the study grows.
    pub fn folder_name(&self, run: RunKey) -> String {
        folder_of_run(&self.identity(run)).unwrap_or_default()
    }

    /// Expected number of steps of a run, and its number of blocks: the measure of its cost.
    pub fn cost(&self, run: RunKey) -> (ExpectedSteps, usize) {
        let spec = self.spec_of(run);
        (spec.steps, spec.n_blocks)
    }

    /// Steps times blocks of all runs with the fewest replicates, at most.
    pub fn block_steps(&self) -> f64 {
        let of_run = |run| {
            let (expected, n_blocks) = self.cost(run);
            expected.steps[1] * n_blocks as f64
        };
        self.settings.min_replicates() as f64 * self.runs(1).map(of_run).sum::<f64>()
    }

    /// Whether the drive of any run stops while blocks slide, so that the cost is a lower bound.
    pub fn has_held_drive(&self) -> bool {
        self.runs(1).any(|run| self.spec_of(run).is_held)
    }

    /// Memory of the largest `threads` simultaneous runs, the results of all runs and the pictures of the
    /// study, in bytes.
    pub fn memory(&self, threads: usize) -> f64 {
        self.work().on_threads(threads)
    }

    fn work(&self) -> WorkMemory {
        let runs = self.points.len() * self.settings.min_replicates() * self.roles().count();
        // Planning has made these cases, and the allocator keeps that memory for others of their size.
        let made = self.specs.iter().map(|spec| spec.memory_of_case);
        let largest = self.largest_run().map_or(0.0, |(_, bytes)| bytes);
        WorkMemory {
            beside: PROGRAM + PICTURES + runs as f64 * RESULT_BYTES + made.fold(0.0, f64::max),
            pieces: vec![(largest, self.runs(self.settings.max_replicates()).count())],
        }
    }

    /// The run that takes the most memory, and this memory in bytes.
    fn largest_run(&self) -> Option<(RunKey, f64)> {
        self.runs(1)
            .map(|run| (run, self.spec_of(run).memory))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Refuses `threads` simultaneous runs if memory is too small. The error gives the number of runs that it
    /// is large enough for. With no runs, only the memory of tables and pictures counts.
    pub fn check_memory(&self, threads: usize) -> Result<(), StudyError> {
        self.compare_memory(threads, available_of(self.memory(threads)))
    }

    fn compare_memory(&self, threads: usize, available: f64) -> Result<(), StudyError> {
        let Some((run, largest)) = self.largest_run() else {
            return Ok(());
        };
        let results = self.memory(0);
        self.work().compare(threads, available, |_, left| {
            if results <= available {
                StudyError::PointMemory {
                    point: self.describe(&self.points[run.point]),
                    needed: byte_size(largest),
                    available: left,
                }
            } else {
                StudyError::ResultsMemory {
                    needed: byte_size(results),
                    available: left,
                }
            }
        })
    }

    /// Disk space for these runs, in bytes.
    pub fn disk(&self, runs: impl Iterator<Item = RunKey>) -> f64 {
        runs.map(|run| RECORD_BYTES + self.spec_of(run).disk).sum()
    }

    /// Textured area A* as meshed at the point at `position`, %.
    pub fn texture_percent(&self, position: usize) -> f64 {
        self.spec_of(first_run(position)).texture_percent
    }

    /// Meshed area of the shapes of the only texture at the point at `position`, %; none for several
    /// textures.
    pub(crate) fn meshed_coverage(&self, position: usize) -> Option<f64> {
        self.spec_of(first_run(position)).meshed_coverage
    }

    /// Level of each axis at a point.
    pub fn levels(&self, point: &Point) -> Vec<usize> {
        let mut index = point.index;
        let mut levels = vec![0; self.axes.len()];
        for (level, axis) in levels.iter_mut().zip(&self.axes).rev() {
            *level = index % axis.levels.len();
            index /= axis.levels.len();
        }
        levels
    }

    /// Description of a point by its levels, for a reader.
    pub fn describe(&self, point: &Point) -> String {
        let columns = self.columns(point).into_iter();
        let levels: Vec<String> = columns.map(|(name, value)| format!("{name} = {value}")).collect();
        if levels.is_empty() {
            "of the base case".to_owned()
        } else {
            levels.join(", ")
        }
    }

    /// Columns of the axes, and their cells at a point.
    pub fn columns(&self, point: &Point) -> Vec<(&str, &str)> {
        let levels = self.axes.iter().zip(self.levels(point));
        let columns = levels.flat_map(|(axis, level)| axis.columns.iter().zip(&axis.levels[level].labels));
        let columns = columns.map(|(name, value)| (name.as_str(), value.as_str()));
        columns.collect()
    }

    /// Every run of `replicates` replicates; references that points share are counted for each.
    pub fn runs(&self, replicates: usize) -> impl Iterator<Item = RunKey> {
        (0..self.points.len()).flat_map(move |point| self.runs_of(point, 0..replicates))
    }

    /// The runs of some replicates of a point.
    pub(crate) fn runs_of(&self, point: usize, replicates: Range<usize>) -> impl Iterator<Item = RunKey> {
        replicates.flat_map(move |replicate| {
            self.roles().map(move |role| RunKey {
                point,
                replicate,
                role,
            })
        })
    }
}

/// The first run of the point at this position.
fn first_run(point: usize) -> RunKey {
    RunKey {
        point,
        replicate: 0,
        role: Role::Point,
    }
}

fn meshed_coverage(case: &Case) -> Option<f64> {
    let [texture] = case.file.texture.as_slice() else {
        return None;
    };
    let textured = case.texture.meshed_percent;
    Some(if texture.pattern.invert {
        100.0 - textured
    } else {
        textured
    })
}

/// Name of the folder of the run with this identity; none if it is no identity of a run.
pub(crate) fn folder_of_run(id: &str) -> Option<String> {
    Some(id.get(..12)?.to_owned())
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    /// If replicates differ in little, their interval is too optimistic, and a note says so.
    #[test]
    fn what_differs_between_replicates_is_said() {
        let notes = |keys: &str| -> Vec<String> {
            let text =
                format!("base.slider.blocks = [25, 25]\nbase.friction = {{ {keys} }}\nstudy.replicates = 2");
            let file = StudyFile::parse(&text, "study.toml", "study", Path::new("")).unwrap();
            let plan = Plan::new(&file, None).unwrap();
            let sentences = plan.warnings().iter().map(|warning| &warning.sentence);
            sentences.cloned().collect()
        };
        assert!(notes("").is_empty());
        assert!(notes("sigma_kinetic_star = 0").is_empty());
        assert!(notes("sigma_static_star = 0")[0].contains("only the kinetic coefficients differ"));
        // The drag of a slider without kinetic friction has its own note.
        assert!(notes("sigma_static_star = 0, r_star = 0")[1].contains("the same run"));
        assert!(notes("sigma_static_star = 0, sigma_kinetic_star = 0")[0].contains("the same run"));
    }

    /// Threads also share the work on the blocks of a large case, so no thread may wait for another to finish
    /// one. The data of the runs and the named invalid point do not depend on the number of threads.
    #[test]
    fn large_cases_are_planned_on_any_number_of_threads() {
        // Some large cases, unevenly spread over 16 rows, so that threads run out of rows at different times.
        let blocks = (0..16 * POINTS_OF_A_BASE).map(|point| match (point * 7919 / 13) % 97 {
            7 => format!("[300, {}]", 900 + point),
            _ => format!("[{}, 2]", 2 + point),
        });
        let blocks = blocks.collect::<Vec<_>>().join(", ");
        let plan = |threads, sigma: f64| {
            let text = format!(
                "[[axes]]\nkey = 'slider.blocks'\nlist = [{blocks}]\n\
                 [[axes]]\nkey = 'friction.sigma_static_star'\nlist = [{sigma}]"
            );
            let file = StudyFile::parse(&text, "study.toml", "study", Path::new("")).unwrap();
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.unwrap().install(|| Plan::new(&file, None))
        };
        let one = plan(1, 0.05).unwrap();
        let six = plan(6, 0.05).unwrap();
        assert!(one.specs == six.specs && one.specs.len() == 16 * POINTS_OF_A_BASE);
        let large = one.specs.iter().filter(|spec| spec.n_blocks as u64 > LARGE);
        assert!(large.count() > 5);
        let invalid = |threads| plan(threads, -1.0).unwrap_err().to_string();
        assert_eq!(invalid(1), invalid(6));
    }

    /// Memory counts the largest runs, and no more of them than there are.
    #[test]
    fn threads_are_held_against_the_memory() {
        let text = "[study]\nreplicates = 2\n[[axes]]\nkey = 'slider.blocks'\nlist = [[4, 4], [800, 800]]";
        let file = StudyFile::parse(text, "study.toml", "study", Path::new("")).unwrap();
        let plan = Plan::new(&file, None).unwrap();
        let one = plan.memory(2) - plan.memory(1);
        assert_eq!(plan.memory(3), plan.memory(1) + 2.0 * one);
        assert_eq!(plan.memory(64), plan.memory(4));
        let available = plan.memory(2) + 0.5 * one;
        assert!(plan.compare_memory(2, available).is_ok());
        assert!(matches!(
            plan.compare_memory(3, available),
            Err(StudyError::Memory {
                threads: 3,
                fit: 2,
                ..
            })
        ));
        let said = plan
            .compare_memory(2, plan.memory(1) - 0.5 * one)
            .unwrap_err()
            .to_string();
        assert!(
            said.contains("slider.blocks = [800, 800]") && said.contains("reduce `slider.blocks`"),
            "{said}"
        );
        // Every kept run holds five fields at six instants in memory until they are written.
        let kept = text.replace("replicates = 2", "replicates = 2\nkeep = 'all'");
        let kept = StudyFile::parse(&kept, "study.toml", "study", Path::new("")).unwrap();
        let kept = Plan::new(&kept, None).unwrap();
        let fields = 6.0 * 5.0 * 800.0 * 800.0 * size_of::<f32>() as f64;
        assert!(kept.memory(1) > plan.memory(1) + fields);
        let disk = |plan: &Plan| plan.disk(plan.runs(2));
        assert!(disk(&kept) > 100.0 * disk(&plan));
    }
}
