//! `CaseFile` -> [`Case`]: a case that can be run, with every length counted in blocks and every file read.

mod budget;
mod coefficients;
mod groups;
mod inputs;
mod output;
mod parameters;
mod textures;
mod time_plan;
mod warnings;

use std::path::Path;

use slipfront::scales::damping;
use slipfront::surface::{Load, mesh};
use slipfront::{Drive, Model, Scales, Surface};

use self::budget::within_budget;
pub use self::budget::{Budget, PROGRAM, SERIES_ROW};
use self::coefficients::coefficients;
pub use self::groups::Groups;
pub use self::inputs::Input;
use self::inputs::Inputs;
pub use self::output::{MAX_MAPS, Output, Snapshots, VARIABLE_MAX_BYTES, smallest_stride};
use self::parameters::Parameters;
pub use self::parameters::check_fields;
use self::textures::textures;
pub use self::time_plan::TimePlan;
use crate::case_file::{CaseError, CaseFile};

/// A case, valid by construction.
#[derive(Debug)]
pub struct Case {
    /// Name of the case: what its results are called.
    pub name: String,
    /// As written, every default filled in, its files standing in `inputs/`: what a run folder holds.
    pub file: CaseFile,
    /// Files that the case reads.
    pub inputs: Vec<Input>,
    /// Units.
    pub scales: Scales,
    /// Dimensionless groups.
    pub groups: Groups,
    /// The slider, ready to run.
    pub model: Model,
    /// What the texture has come to.
    pub texture: TextureReport,
    /// Negative draws of the coefficients that were set to 0.
    pub negative_draws: usize,
    /// Time and its steps.
    pub time_plan: TimePlan,
    /// What is written.
    pub output: Output,
    /// What the run needs.
    pub budget: Budget,
}

/// The texture as asked and as meshed.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureReport {
    /// A* asked for, %; none where a mask or a polygon says so block by block only.
    pub asked_percent: Option<f64>,
    /// A* as meshed, % (Eq. 15).
    pub meshed_percent: f64,
    /// Positions in the case file, from 0, of the textures that a free edge clips.
    pub clipped: Vec<usize>,
}

impl Case {
    /// Loads a case file and the files it names, which stand relative to it. A run that this machine has no memory for
    /// is refused before anything of it is made.
    ///
    /// # Errors
    /// A sentence that names place, value, bound and remedy.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Self, CaseError> {
        let file = CaseFile::load(path, overrides)?;
        let name = path
            .file_stem()
            .map_or_else(|| "case".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::to_run(file, &name, folder)
    }

    /// Makes a case of text that stands in no folder, as [`load`](Self::load) does; files it names stand in the working
    /// directory.
    ///
    /// # Errors
    /// A sentence that names place, value, bound and remedy.
    pub fn parse(text: &str, name: &str, overrides: &[String]) -> Result<Self, CaseError> {
        Self::to_run(CaseFile::parse(text, name, overrides)?, name, Path::new(""))
    }

    fn to_run(file: CaseFile, name: &str, folder: &Path) -> Result<Self, CaseError> {
        let Parameters {
            lattice,
            output,
            budget,
            ..
        } = Parameters::of(&file)?;
        within_budget(&file, budget.check_memory(false))?;
        check_fields(&file, &lattice, &output)?;
        let case = Self::new(file, name, folder)?;
        // Once more, with the files that it reads.
        within_budget(&case.file, case.budget.check_memory(true))?;
        Ok(case)
    }

    /// Makes a case of a case file; the files it names stand relative to `folder`. It may be one that this machine has
    /// no memory to run.
    ///
    /// # Errors
    /// A sentence that names place, value, bound and remedy.
    pub fn new(mut file: CaseFile, name: &str, folder: &Path) -> Result<Self, CaseError> {
        let Parameters {
            scales,
            groups,
            lattice,
            time_plan,
            output,
            budget,
        } = Parameters::of(&file)?;
        within_budget(&file, budget.check_making())?;
        let mut inputs = Inputs::new(folder, budget);
        let textures = textures(&mut file, &scales, &lattice, &mut inputs)?;
        let meshed = mesh(&lattice, &textures.shapes);
        let coefficients = coefficients(&mut file, &groups, &lattice, &mut inputs)?;
        let negative_draws = coefficients.negative_draws;
        let load = if file.load.redistribute {
            Load::Redistributed
        } else {
            Load::Kept
        };
        let surface = Surface::new(coefficients, meshed.textured, load, scales.mu_static_mean)
            .map_err(|error| file.source.error("texture", error.to_string()))?;
        let texture = TextureReport {
            asked_percent: textures.asked_percent,
            meshed_percent: surface.texture_percent(),
            clipped: meshed.clipped,
        };
        let drive = Drive::at_angle(groups.v_star, file.drive.direction);
        let model = Model::new(
            lattice,
            surface,
            drive,
            damping(groups.omega_star),
            groups.epsilon,
            file.friction.law,
        );
        Ok(Self {
            name: name.to_owned(),
            file,
            budget: inputs.budget,
            inputs: inputs.kept,
            scales,
            groups,
            model,
            texture,
            negative_draws,
            time_plan,
            output,
        })
    }

    /// Refuses a run whose files, and checkpoints if it saves any, have no room in `folder`, even when `replaced` bytes
    /// there have gone before.
    ///
    /// # Errors
    /// With the figures, and which key to change.
    pub fn check_disk(&self, folder: &Path, replaced: u64, checkpoints: bool) -> Result<(), CaseError> {
        within_budget(&self.file, self.budget.check_disk(folder, replaced, checkpoints))
    }

    /// Refuses to go on from a checkpoint where there is no memory for that.
    ///
    /// # Errors
    /// With the figures.
    pub fn check_memory_resumed(&self) -> Result<(), CaseError> {
        within_budget(&self.file, self.budget.check_memory_resumed())
    }

    /// Steps times blocks: what the run costs.
    pub fn block_steps(&self) -> f64 {
        self.time_plan.last_step as f64 * self.model.lattice.n_blocks() as f64
    }

    /// Steps between two looks at a running case, for its progress or for a reason to stop: some milliseconds' worth.
    pub fn steps_per_look(&self) -> u64 {
        const BLOCK_STEPS: u64 = 200_000;
        (BLOCK_STEPS / self.model.lattice.n_blocks() as u64).max(1)
    }
}
