//! A case that can be run.

use std::path::Path;
use std::sync::Arc;

use slipfront::surface::{CorrelatedField, Texture};
use slipfront::{
    Communicator, Execution, Increments, Lattice, Loading, Model, Program, Scales, Search, State,
};

use super::budget::Budget;
use super::coefficients::correlated_field;
use super::derived::Derived;
use super::dimensionless_groups::Groups;
use super::drive::{program, refuse_endless_slip, refuse_large_angles};
use super::files::{Files, FilesInMemory, Watch};
use super::inputs::{Input, Inputs, NamedFiles};
use super::model::{self, TextureReport};
use super::output::Output;
use super::ranks::Ranks;
use super::shear::AtOnce;
use super::textures;
use super::time_plan::{TimePlan, auto_onset_end, largest_load};
use crate::arrays::Slab;
use crate::case_file::{CaseError, CaseFile};
use crate::same_on_ranks::expect_same;

/// A case that is ready to run, and valid by construction.
#[derive(Clone, Debug)]
pub struct Case {
    /// Name of the case and of its results.
    pub name: String,
    /// The case file with all defaults filled in and its input files in `inputs/`, as in the run folder.
    pub file: CaseFile,
    /// Files that the case reads.
    pub inputs: Vec<Input>,
    /// Units of the dimensionless quantities.
    pub scales: Scales,
    /// Dimensionless groups.
    pub groups: Groups,
    /// The slider, and the surface of the rows of this process: all rows, unless it is one of several ranks.
    pub model: Arc<Model>,
    /// State of these rows in which a run begins; none if it begins at rest.
    pub initial: Option<Arc<State>>,
    /// Estimates of the run before it begins.
    pub expected: Expected,
    /// Texture as asked and as meshed.
    pub texture: TextureReport,
    /// Duration and steps.
    pub time_plan: TimePlan,
    /// The results that are written.
    pub output: Output,
    /// Memory and disk space of a run of the case.
    pub budget: Budget,
}

/// Estimates of the model for a run, made before it begins, for the whole lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// Level of steady sliding, see [`Model::steady_level`].
    pub steady_level: f64,
    /// Drag of the damping, see [`Model::steady_drag`].
    pub steady_drag: f64,
    /// Time t* of the first slip, if it is known, see [`Model::first_slip_estimate`].
    pub first_slip_star: Option<f64>,
    /// Earliest and latest t* of the onset, see [`Model::onset_estimate`].
    pub onset_star: [f64; 2],
    /// Lower and upper bound of the critical size of slip in blocks, see [`Model::critical_size`].
    pub critical_size: Option<[f64; 2]>,
    /// t* up to which the largest mu* is static friction: twice the t* of the onset, and more where only some
    /// blocks touch or adhesion delays it.
    pub onset_end_star: f64,
    /// Blocks in contact that slip at t = 0.
    pub at_once: AtOnce,
}

impl Expected {
    fn new(file: &CaseFile, scales: &Scales, model: &Model, ranks: &dyn Communicator) -> Self {
        Self {
            steady_level: model.steady_level(ranks),
            steady_drag: model.steady_drag(ranks),
            first_slip_star: model.first_slip_estimate(ranks),
            onset_star: model.onset_estimate(largest_load(file, model)),
            critical_size: model.critical_size(ranks),
            onset_end_star: auto_onset_end(file, scales, model),
            at_once: AtOnce::count(model, ranks),
        }
    }
}

impl Case {
    /// Loads a case file and its input files, with names relative to the case file. If there is too little
    /// memory to step the model, the case is refused before any array is allocated. `watch` gets the progress
    /// of reading files and of laying the texture over the blocks, and can stop both. All `ranks` make the
    /// case at once, as in [`to_run`](Self::to_run).
    pub fn load(
        path: &Path,
        overrides: &[String],
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        Self::load_with(path, overrides, None, watch, ranks)
    }

    /// Loads a case file as [`load`](Self::load) does. Files that the case or an override names may be in
    /// memory.
    pub fn load_with(
        path: &Path,
        overrides: &[String],
        in_memory: Option<&FilesInMemory>,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        let file = ranks.agree(CaseFile::load(path, overrides))?;
        let name = path
            .file_stem()
            .map_or_else(|| "case".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        let files = Files { folder, in_memory };
        Self::to_run(file, &name, files, watch, ranks)
    }

    /// Makes a case from text, as [`load`](Self::load) does, with names of files relative to `folder`.
    pub fn parse(
        text: &str,
        name: &str,
        folder: impl AsRef<Path>,
        overrides: &[String],
    ) -> Result<Self, CaseError> {
        let file = CaseFile::parse(text, name, overrides)?;
        Self::to_run(file, name, folder.as_ref(), &mut |_| true, Ranks::ALONE)
    }

    /// Makes a case for a run from a parsed case file; `files` is the folder of its input files, or holds
    /// them in memory. All `ranks` make the case at once: each makes the surface of its own rows, and knows
    /// the rest of the case. If one of them fails, or has a different case or different files, all return the
    /// same error.
    ///
    /// ```
    /// use std::path::Path;
    /// use slipfront_case::arrays::npy_of_mask;
    /// use slipfront_case::case::{Case, Files, FilesInMemory, Ranks};
    /// use slipfront_case::case_file::CaseFile;
    /// let text = "slider.blocks = [2, 2]\ntexture = [{ shape = 'mask', file = 'drawn.npy' }]";
    /// let drawn = npy_of_mask(2, &[true, false, false, false]);
    /// let in_memory = FilesInMemory::from([("drawn.npy".to_owned(), drawn.into())]);
    /// let files = Files { folder: Path::new(""), in_memory: Some(&in_memory) };
    /// let file = CaseFile::parse(text, "case", &[])?;
    /// let case = Case::to_run(file, "case", files, &mut |_| true, Ranks::ALONE)?;
    /// assert_eq!(case.model.surface.textured, [true, false, false, false]);
    /// # Ok::<(), slipfront_case::case_file::CaseError>(())
    /// ```
    pub fn to_run<'f>(
        file: CaseFile,
        name: &str,
        files: impl Into<Files<'f>>,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        Self::make(file, name, files.into(), true, watch, ranks)
    }

    /// Makes a case from a case file on all `ranks` at once; `files` is the folder of its input files, or
    /// holds them in memory. The memory for stepping the model is not checked.
    pub fn new<'f>(
        file: CaseFile,
        name: &str,
        files: impl Into<Files<'f>>,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        Self::make(file, name, files.into(), false, watch, ranks)
    }

    /// Makes a case: the file, the quantities derived from it alone, its inputs, the model, and the time
    /// plan.
    fn make(
        mut file: CaseFile,
        name: &str,
        files: Files,
        to_run: bool,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        expect_same(ranks.communicator, || file.values())?;
        let [nx, ny] = file.slider.blocks.map(|count| count as usize);
        let lattice = Lattice::with_edges(nx, ny, file.slider.edges);
        let rows = lattice.rows_of(ranks.communicator);
        // All ranks check the memory that they share before anything is allocated.
        let derived = Derived::new(&file, &lattice, &rows, &ranks, to_run)
            .and_then(|derived| Ok((derived, NamedFiles::find(&mut file, files)?)));
        let (derived, named) = ranks.agree(derived)?;
        let files = named.read(&mut file, &lattice, watch, &ranks)?;
        let mut inputs = Inputs {
            file: &file,
            scales: &derived.scales,
            lattice: &lattice,
            files: &files,
            slab: Slab { nx, ny, rows },
            watch,
        };
        let (mut model, texture, initial) = model::make(&derived, &named, &mut inputs, &ranks)?;
        let Derived {
            scales,
            groups,
            budget,
            ..
        } = derived;
        let planned = TimePlan::new(&file, &scales, &groups, &mut model, ranks.communicator)
            .and_then(|plan| Ok((plan, Output::new(&file, &plan)?)));
        let (time_plan, output) = ranks.agree(planned)?;
        let model = model
            .with_program(program(&file, time_plan.dt_star)?)
            .with_loading(time_plan.loading);
        ranks.agree(refuse_endless_slip(&file, &model, ranks.communicator))?;
        refuse_large_angles(&file, &model.drive, groups.epsilon, time_plan.end_star())?;
        Ok(Self {
            name: name.to_owned(),
            budget: budget.with_results(&file, &model, &output, time_plan.last_step, &files),
            inputs: files,
            scales,
            groups,
            expected: Expected::new(&file, &scales, &model, ranks.communicator),
            model: Arc::new(model),
            initial: initial.map(Arc::new),
            texture,
            time_plan,
            output,
            file,
        })
    }

    /// The search for the increments of the drive that lead a bulk body to its onset under slow loading; none
    /// for other cases.
    pub fn search(&self, execution: Execution) -> Option<Search> {
        let searches = self.model.rests_by_excess() && self.model.drive.program.is_none();
        let model = || Model::clone(&self.model);
        searches.then(|| Search::new(model(), self.time_plan.dt_star, self.state(), execution))
    }

    /// The increments of a held drive, if a search has found them.
    pub fn increments(&self) -> Option<Increments> {
        let Loading::Held { onset_steps } = self.time_plan.loading else {
            return None;
        };
        let program = Program::clone(self.model.drive.program.as_ref()?);
        self.model.rests_by_excess().then(|| Increments {
            v_star: self.model.drive.v_star,
            program,
            onset_steps,
        })
    }

    /// The case with the increments that its [search](Self::search) has found.
    pub fn with_increments(&self, increments: Increments) -> Self {
        let time_plan = self.time_plan.with_increments(&increments);
        let model = Model::clone(&self.model).with_loading(time_plan.loading);
        Self {
            model: Arc::new(model.with_program(Some(Arc::new(increments.program)))),
            time_plan,
            ..self.clone()
        }
    }

    /// Ratio of the dead load along the drive to the static friction of the blocks; none without a load, or
    /// under a law without static friction.
    pub fn share_of_shear(&self) -> Option<f64> {
        let model = &self.model;
        let has_share = model.dead_load().acts() && model.friction.has_thresholds();
        has_share.then(|| model.mean_dead_load()[0] / model.surface.mean_static_force())
    }

    /// The textures of the file in blocks, in their order; reads their masks again.
    ///
    /// # Errors
    /// When a mask can no longer be read.
    pub fn textures_in_blocks(&self) -> Result<Vec<Texture>, CaseError> {
        let lattice = &self.model.lattice;
        let mut inputs = Inputs {
            file: &self.file,
            scales: &self.scales,
            lattice,
            files: &self.inputs,
            slab: Slab::whole(lattice.nx, lattice.ny),
            watch: &mut |_| true,
        };
        let (textures, _) = textures::shapes_in_blocks(&mut inputs, self.model.n_blocks())?;
        Ok(textures)
    }

    /// The field that gives the random coefficients as means over blocks; none if every block draws its own.
    pub fn correlated_field(&self) -> Option<CorrelatedField> {
        correlated_field(&self.file, &self.model.lattice)
    }

    /// The state in which a run begins; none if it begins at rest.
    pub fn state(&self) -> Option<State> {
        self.initial.as_deref().cloned()
    }

    /// Largest number of steps times blocks, without the steps in which a held drive stops.
    pub fn block_steps(&self) -> f64 {
        self.time_plan.last_step as f64 * self.model.lattice.n_blocks() as f64
    }

    /// Steps between two checks of the progress and of reasons to stop: some milliseconds of a run.
    pub fn steps_per_poll(&self) -> u64 {
        const BLOCK_STEPS: u64 = 200_000;
        (BLOCK_STEPS / self.model.lattice.n_blocks() as u64).max(1)
    }
}
