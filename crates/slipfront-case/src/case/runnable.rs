//! A case that can be run.

use std::path::Path;
use std::sync::Arc;

use slipfront::scales::damping;
use slipfront::surface::Load;
use slipfront::{Drive, Lattice, Model, Scales, Surface};

use super::budget::Budget;
use super::coefficients::coefficients;
use super::groups::Groups;
use super::inputs::{Input, Inputs};
use super::output::Output;
use super::textures::{self, Watch};
use super::time_plan::TimePlan;
use crate::case_file::{CaseError, CaseFile};

/// A case that can be run. It is valid by construction.
#[derive(Debug)]
pub struct Case {
    /// Name of the case and of its results.
    pub name: String,
    /// The case file with every default filled in and its input files in `inputs/`, as the run folder holds it.
    pub file: CaseFile,
    /// Files that the case reads.
    pub inputs: Vec<Input>,
    /// Units of the dimensionless quantities.
    pub scales: Scales,
    /// Dimensionless groups.
    pub groups: Groups,
    /// The slider and its surface.
    pub model: Arc<Model>,
    /// Texture as asked and as meshed.
    pub texture: TextureReport,
    /// Negative draws of the coefficients that were set to 0.
    pub negative_draws: usize,
    /// Duration and steps.
    pub time_plan: TimePlan,
    /// Which results are written.
    pub output: Output,
    /// Memory and disk space that the run needs.
    pub budget: Budget,
}

/// The texture as asked and as meshed.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureReport {
    /// A* as asked for, %; none if there is a mask or polygon, whose area is known only after meshing.
    pub asked_percent: Option<f64>,
    /// A* as meshed, % (Eq. 15).
    pub meshed_percent: f64,
    /// Positions in the case file, from 0, of the textures that a free edge clips.
    pub clipped: Vec<usize>,
    /// Positions of those that cover no block.
    pub empty: Vec<usize>,
}

impl Case {
    /// Loads a case file and the files it names, which stand relative to it. A run that needs more
    /// memory than there is gets refused before any array is allocated. `watch` is shown how its texture is laid over the
    /// blocks.
    pub fn load(path: &Path, overrides: &[String], watch: &mut Watch) -> Result<Self, CaseError> {
        let file = CaseFile::load(path, overrides)?;
        let name = path
            .file_stem()
            .map_or_else(|| "case".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::to_run(file, &name, folder, watch)
    }

    /// Makes a case of text, as [`load`](Self::load) does; the files it names stand in the working directory.
    pub fn parse(text: &str, name: &str, overrides: &[String]) -> Result<Self, CaseError> {
        Self::parse_in(text, name, Path::new(""), overrides)
    }

    /// Makes a case of text, as [`load`](Self::load) does; the files it names stand relative to `folder`.
    pub fn parse_in(text: &str, name: &str, folder: &Path, overrides: &[String]) -> Result<Self, CaseError> {
        Self::to_run(CaseFile::parse(text, name, overrides)?, name, folder, &mut |_| {
            true
        })
    }

    /// Makes a case of a case file that was read already, to be run; the files it names stand relative to `folder`.
    pub fn to_run(file: CaseFile, name: &str, folder: &Path, watch: &mut Watch) -> Result<Self, CaseError> {
        let case = Self::make(file, name, folder, true, watch)?;
        // Once more, with the files that it reads.
        case.budget.check_memory(&case.file, true)?;
        Ok(case)
    }

    /// Makes a case of a case file; the files it names stand relative to `folder`. The memory for a run of it is not
    /// checked.
    pub fn new(file: CaseFile, name: &str, folder: &Path, watch: &mut Watch) -> Result<Self, CaseError> {
        Self::make(file, name, folder, false, watch)
    }

    fn make(
        mut file: CaseFile,
        name: &str,
        folder: &Path,
        to_run: bool,
        watch: &mut Watch,
    ) -> Result<Self, CaseError> {
        let scales = Scales {
            block_size: file.slider.block_size.si(),
            young_modulus: file.slider.young_modulus.si(),
            density: file.slider.density.si(),
            pressure: file.load.pressure.si(),
            mu_static_mean: file.friction.mu_static,
        };
        let groups = Groups::of(&file, &scales)?;
        let [nx, ny] = file.slider.blocks.map(|count| count as usize);
        let lattice = Lattice::with_edges(nx, ny, file.slider.edges);
        let time_plan = TimePlan::of(&file, &scales, &groups)?;
        let output = Output::of(&file, &time_plan)?;
        let budget = Budget::new(&lattice, file.friction.law, &time_plan, &output);
        if to_run {
            budget.check_memory(&file, false)?;
        }
        budget.check_making(&file)?;
        let mut inputs = Inputs {
            folder,
            kept: Vec::new(),
            budget,
        };
        let (meshed, asked_percent) = textures::mesh(&mut file, &scales, &lattice, &mut inputs, watch)?;
        let coefficients = coefficients(&mut file, &groups, &lattice, &mut inputs)?;
        let negative_draws = coefficients.negative_draws;
        let load = match file.load.redistribute {
            true => Load::Redistributed,
            false => Load::Kept,
        };
        let surface = Surface::new(coefficients, meshed.textured, load, scales.mu_static_mean)
            .map_err(|error| file.source.error("texture", error.to_string()))?;
        let texture = TextureReport {
            asked_percent,
            meshed_percent: surface.texture_percent(),
            clipped: meshed.clipped,
            empty: meshed.empty,
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
            model: Arc::new(model),
            texture,
            negative_draws,
            time_plan,
            output,
        })
    }

    /// Steps times blocks, the measure of what the run costs.
    pub fn block_steps(&self) -> f64 {
        self.time_plan.last_step as f64 * self.model.lattice.n_blocks() as f64
    }

    /// Steps of a running case between two checks of its progress and of reasons to stop: some milliseconds.
    pub fn steps_per_poll(&self) -> u64 {
        const BLOCK_STEPS: u64 = 200_000;
        (BLOCK_STEPS / self.model.lattice.n_blocks() as u64).max(1)
    }
}
