//! A case that can be run.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use slipfront::scales::damping;
use slipfront::surface::Texture;
use slipfront::{Communicator, Friction, Lattice, Model, Scales, Surface};

use super::budget::Budget;
use super::coefficients::{coefficients, contact};
use super::drive::{attach, attached, drive, program, refuse_large_angles};
use super::groups::Groups;
use super::inputs::Watch;
use super::inputs::{Input, Inputs, NamedFiles};
use super::options::options;
use super::output::Output;
use super::ranks::Ranks;
use super::slider::GivenBlocks;
use super::textures;
use super::time_plan::{Dynamics, TimePlan, load_factor};
use super::topography::Topography;
use crate::arrays::Slab;
use crate::case_file::{CaseError, CaseFile};
use crate::same::expect_same;

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
    /// The slider, and the surface of the rows that this process holds: all, unless it is one rank of several.
    pub model: Arc<Model>,
    /// What is known of the run before it.
    pub expected: Expected,
    /// Texture as asked and as meshed.
    pub texture: TextureReport,
    /// Duration and steps.
    pub time_plan: TimePlan,
    /// Which results are written.
    pub output: Output,
    /// Memory that making and stepping it takes. What its results take is added in slipfront-run.
    pub budget: Budget,
}

/// What the model says of a run before it, of the whole lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Expected {
    /// [`Model::steady_level`].
    pub steady_level: f64,
    /// [`Model::steady_drag`].
    pub steady_drag: f64,
    /// [`Model::first_slip_estimate`], t*.
    pub first_slip_star: f64,
    /// [`Model::onset_estimate`], the earliest and the latest t*.
    pub onset_star: [f64; 2],
}

impl Expected {
    fn of(file: &CaseFile, model: &Model, ranks: &dyn Communicator) -> Self {
        Self {
            steady_level: model.steady_level(ranks),
            steady_drag: model.steady_drag(ranks),
            first_slip_star: model.first_slip_estimate(ranks),
            onset_star: model.onset_estimate(load_factor(file, model)),
        }
    }
}

/// The texture as asked and as meshed.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureReport {
    /// A* as asked for, %; none if there is a mask, a polygon or the depth of a height map, whose area is known only after meshing.
    pub asked_percent: Option<f64>,
    /// A* as meshed, % (Eq. 15).
    pub meshed_percent: f64,
    /// The height maps.
    pub topographies: Vec<Topography>,
    /// Positions in the case file, from 0, of the textures that a free edge clips.
    pub clipped: Vec<usize>,
    /// Positions of those that cover no block.
    pub empty: Vec<usize>,
}

impl Case {
    /// Loads a case file and the files it names, which stand relative to it. A case whose model needs more memory to be stepped than
    /// there is gets refused before any array is allocated. `watch` is shown how its texture is laid over the blocks. It is made on all
    /// `ranks` at once, as [`to_run`](Self::to_run) does.
    pub fn load(
        path: &Path,
        overrides: &[String],
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        let file = ranks.agree(CaseFile::load(path, overrides))?;
        let name = path
            .file_stem()
            .map_or_else(|| "case".to_owned(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::to_run(file, &name, folder, watch, ranks)
    }

    /// Makes a case of text alone, as [`load`](Self::load) does; the files it names stand relative to `folder`.
    pub fn parse(
        text: &str,
        name: &str,
        folder: impl AsRef<Path>,
        overrides: &[String],
    ) -> Result<Self, CaseError> {
        let file = CaseFile::parse(text, name, overrides)?;
        Self::to_run(file, name, folder.as_ref(), &mut |_| true, Ranks::ALONE)
    }

    /// Makes a case of a case file that was read already, to be run; the files it names stand relative to `folder`. It is made on all
    /// `ranks` at once: each makes the surface of its own rows, and knows the rest of the case. If one fails, or was given another case
    /// or other files, all give the same error.
    pub fn to_run(
        file: CaseFile,
        name: &str,
        folder: &Path,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        Self::make(file, name, folder, true, watch, ranks)
    }

    /// Makes a case of a case file on all `ranks` at once; the files it names stand relative to `folder`. The memory in
    /// which its model is stepped is not checked.
    pub fn new(
        file: CaseFile,
        name: &str,
        folder: &Path,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        Self::make(file, name, folder, false, watch, ranks)
    }

    fn make(
        mut file: CaseFile,
        name: &str,
        folder: &Path,
        to_run: bool,
        watch: &mut Watch,
        ranks: Ranks,
    ) -> Result<Self, CaseError> {
        expect_same(ranks.communicator, || file.values())?;
        let [nx, ny] = file.slider.blocks.map(|count| count as usize);
        let lattice = Lattice::with_edges(nx, ny, file.slider.edges);
        let rows = lattice.rows_of(ranks.communicator);
        // Nothing is allocated before all ranks have looked at the memory that they share.
        let planned = Derived::of(&file, &lattice, &rows, &ranks, to_run)
            .and_then(|derived| Ok((derived, NamedFiles::find(&mut file, folder)?)));
        let (derived, named) = ranks.agree(planned)?;
        let Derived {
            scales,
            groups,
            mut budget,
            friction,
            plan,
        } = derived;
        let inputs = Inputs {
            files: named.read(&mut file, &lattice, &ranks)?,
            slab: Slab {
                nx,
                ny,
                rows: rows.clone(),
            },
        };

        let blocks = ranks.agree_on_rows(GivenBlocks::read(&file, &lattice, &inputs, watch))?;
        let mut slider = blocks.slider(&file, ranks.communicator)?;
        let n_blocks = slider.n_blocks(&lattice);
        let made = textures::mesh(&file, &scales, &lattice, n_blocks, &inputs, watch).and_then(|meshed| {
            let coefficients = coefficients(&file, &groups, &lattice, &inputs)?;
            let contact = contact(&file, &scales, &lattice, &inputs)?;
            Ok((meshed, coefficients, contact, attached(&file, &inputs, watch)?))
        });
        let ((meshed, in_blocks), coefficients, contact, attached) = ranks.agree_on_rows(made)?;
        ranks.agree(named.expect_unchanged(&file))?;
        attach(&mut slider, &file, &lattice, &rows, attached, ranks.communicator)?;
        let surface = Surface::of_ranks(
            coefficients,
            meshed.textured,
            contact,
            &slider,
            ranks.communicator,
        )
        .map_err(|error| file.source.error("texture", error.to_string()))?;
        let texture = TextureReport {
            asked_percent: in_blocks.asked_percent,
            topographies: in_blocks.topographies,
            meshed_percent: surface.texture_percent(),
            clipped: meshed.clipped,
            empty: empty_on_all(&meshed.empty, file.texture.len(), ranks.communicator),
        };
        let drive = drive(
            &file,
            &scales,
            &groups,
            (&lattice, &rows),
            &slider,
            ranks.communicator,
        )?;
        let mut model = Model::of_rows(
            lattice,
            rows,
            surface,
            drive,
            damping(groups.omega_star),
            groups.epsilon,
            friction,
        )
        .with_slider(slider);
        let plan = ranks.agree(plan.of_model(&file, &model, &scales, &groups, &ranks))?;
        let Plan {
            time_plan, output, ..
        } = plan;
        model.drive.program = program(&file, time_plan.dt_star)?;
        refuse_large_angles(&file, &model.drive, groups.epsilon, time_plan.end_star())?;
        let expected = Expected::of(&file, &model, ranks.communicator);
        budget.inputs = inputs.files.iter().map(|input| input.length as f64).sum();
        Ok(Self {
            name: name.to_owned(),
            file,
            budget,
            inputs: inputs.files,
            scales,
            groups,
            model: Arc::new(model),
            expected,
            texture,
            time_plan,
            output,
        })
    }

    /// The textures of the file in blocks, in their order, with their masks read again.
    ///
    /// # Errors
    /// When a mask cannot be read any more.
    pub fn textures_in_blocks(&self) -> Result<Vec<Texture>, CaseError> {
        let lattice = &self.model.lattice;
        let inputs = Inputs {
            files: self.inputs.clone(),
            slab: Slab::whole(lattice.nx, lattice.ny),
        };
        let n_blocks = self.model.n_blocks();
        let made =
            textures::shapes_in_blocks(&self.file, &self.scales, lattice, n_blocks, &inputs, &mut |_| {
                true
            });
        made.map(|in_blocks| in_blocks.textures)
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

/// Units of the dimensionless quantities of a case file.
pub fn scales(file: &CaseFile) -> Scales {
    Scales {
        block_size: file.slider.block_size.si(),
        young_modulus: file.slider.young_modulus.si(),
        density: file.slider.density.si(),
        pressure: file.load.pressure.si(),
        mu_static_mean: file.friction.mu_static,
    }
}

/// What follows from a case file without the files that it names.
struct Derived {
    scales: Scales,
    groups: Groups,
    budget: Budget,
    friction: Friction,
    plan: Plan,
}

/// Steps and results.
struct Plan {
    dynamics: Dynamics,
    time_plan: TimePlan,
    output: Output,
}

impl Plan {
    /// This plan, or another one if blocks that differ need it.
    fn of_model(
        self,
        file: &CaseFile,
        model: &Model,
        scales: &Scales,
        groups: &Groups,
        ranks: &Ranks,
    ) -> Result<Self, CaseError> {
        let dynamics = Dynamics::of(file, model, ranks.communicator);
        let plan = if dynamics == self.dynamics {
            self
        } else {
            Self::new(file, dynamics, TimePlan::of(file, scales, groups, dynamics)?)?
        };
        plan.time_plan.check_end(file)?;
        Ok(plan)
    }

    fn new(file: &CaseFile, dynamics: Dynamics, time_plan: TimePlan) -> Result<Self, CaseError> {
        Ok(Self {
            dynamics,
            output: Output::of(file, &time_plan)?,
            time_plan,
        })
    }
}

impl Derived {
    /// Refuses numbers out of the range of the model, and what there is no memory for.
    fn of(
        file: &CaseFile,
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &Ranks,
        to_run: bool,
    ) -> Result<Self, CaseError> {
        let scales = scales(file);
        let groups = Groups::of(file, &scales)?;
        let n_ranks = ranks.communicator.size();
        if n_ranks > lattice.ny {
            let sentence = format!(
                "there are more ranks ({n_ranks}) than rows of blocks ({}), of which each takes at least one: take fewer ranks, \
                 or more blocks along y",
                lattice.ny
            );
            return Err(file.source.error("slider.blocks", sentence));
        }
        if let Some((key, why)) = file.friction.takes_one_rank().filter(|_| n_ranks > 1) {
            return Err(file.source.error(key, why));
        }
        let dynamics = Dynamics::of_file(file, &scales, &groups, lattice);
        let time_plan = TimePlan::of(file, &scales, &groups, dynamics)?;
        let plan = Plan::new(file, dynamics, time_plan)?;
        let friction = file.friction.in_model(groups.v_star);
        let budget = Budget::new(lattice, rows, ranks, file, &options(file, friction));
        if to_run {
            budget.check_running(file)?;
        } else {
            budget.check_making(file)?;
        }
        Ok(Self {
            scales,
            groups,
            budget,
            friction,
            plan,
        })
    }
}

/// The textures out of `n_textures` that cover no block of any rank, of those that cover none of this one.
fn empty_on_all(empty: &[usize], n_textures: usize, communicator: &dyn Communicator) -> Vec<usize> {
    let mut covers = vec![1.0; n_textures];
    for &texture in empty {
        covers[texture] = 0.0;
    }
    communicator.largest(&mut covers);
    (0..n_textures)
        .filter(|&texture| covers[texture] == 0.0)
        .collect()
}
