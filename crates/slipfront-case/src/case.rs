//! `CaseFile` -> [`Case`]: a case that can be run, with every length counted in blocks and every file read.

use std::path::{Path, PathBuf};

use slipfront::lattice::dt_star_limit;
use slipfront::observe::KineticStart;
use slipfront::scales::damping;
use slipfront::surface::{self, Coefficients, Distribution, Load, mesh};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Scales, Stop, Surface};

use crate::arrays;
use crate::budget::{Budget, Excess};
use crate::case_file::{self, AutoOr, CaseError, CaseFile};
use crate::fields::{self, FieldName};
use crate::folder::read_whole;
use crate::quantity::Length;

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
    pub schedule: Schedule,
    /// What is written.
    pub output: Output,
    /// What the run needs.
    pub budget: Budget,
}

/// The dimensionless groups on which the model depends (Eq. 11).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groups {
    /// V*.
    pub v_star: f64,
    /// R*.
    pub r_star: f64,
    /// Omega*.
    pub omega_star: f64,
    /// sigma_s*.
    pub sigma_static_star: f64,
    /// sigma_k*.
    pub sigma_kinetic_star: f64,
    /// eps = P mu_s/E.
    pub epsilon: f64,
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

/// Time and its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// dt*.
    pub dt_star: f64,
    /// Number of steps.
    pub last_step: u64,
    /// When the run ends.
    pub stop: Stop,
    /// Where the kinetic window begins.
    pub kinetic: KineticStart,
}

impl Schedule {
    /// t* of the last step.
    pub fn end_star(&self) -> f64 {
        self.last_step as f64 * self.dt_star
    }
}

/// What is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// When fields are kept.
    pub snapshots: Snapshots,
    /// Which fields.
    pub fields: Vec<FieldName>,
    /// Every n-th block of each axis in the fields file.
    pub stride: usize,
    /// Steps between rows of the series.
    pub series_stride: u64,
}

/// When fields are kept.
#[derive(Clone, Debug, PartialEq)]
pub enum Snapshots {
    /// At the instants A-F.
    Instants,
    /// At these steps.
    At(Vec<u64>),
    /// Every n-th step from 0.
    Every(u64),
}

/// A file that a case reads, kept so that the run folder can hold a copy.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// Path in the run folder.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Longest series that is written unless a spacing is asked for.
const SERIES_ROWS: u64 = 20_000;

/// Longest run, in steps.
const MAX_STEPS: f64 = 1e11;

/// Largest strain of the load: beyond it the springs of this model mean nothing.
const MAX_EPSILON: f64 = 0.5;

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
        let Numbers {
            lattice,
            output,
            budget,
            ..
        } = Numbers::of(&file)?;
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
        let Numbers {
            scales,
            groups,
            lattice,
            schedule,
            output,
            budget,
        } = Numbers::of(&file)?;
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
            law(&file),
        );
        Ok(Self {
            name: name.to_owned(),
            file,
            budget: inputs.budget,
            inputs: inputs.read,
            scales,
            groups,
            model,
            texture,
            negative_draws,
            schedule,
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
    /// With the figures, and which key to change.
    pub fn check_memory_resumed(&self) -> Result<(), CaseError> {
        within_budget(&self.file, self.budget.resumed().check_memory(true))
    }

    /// Steps times blocks: what the run costs.
    pub fn block_steps(&self) -> f64 {
        self.schedule.last_step as f64 * self.model.lattice.n_blocks() as f64
    }

    /// Steps between two looks at a running case, for its progress or for a reason to stop: some milliseconds' worth.
    pub fn steps_per_look(&self) -> u64 {
        const BLOCK_STEPS: u64 = 200_000;
        (BLOCK_STEPS / self.model.lattice.n_blocks() as u64).max(1)
    }
}

/// All that a case file says without its files, before any array of the lattice is made.
struct Numbers {
    scales: Scales,
    groups: Groups,
    lattice: Lattice,
    schedule: Schedule,
    output: Output,
    budget: Budget,
}

fn law(file: &CaseFile) -> FrictionLaw {
    match file.friction.law {
        case_file::Law::Projection => FrictionLaw::Projection,
        case_file::Law::Reversal => FrictionLaw::Reversal,
        case_file::Law::Literal => FrictionLaw::Literal,
    }
}

impl Numbers {
    fn of(file: &CaseFile) -> Result<Self, CaseError> {
        let scales = scales(file);
        let groups = groups(file, &scales)?;
        let lattice = lattice(file);
        let schedule = schedule(file, &scales, &groups)?;
        let output = output(file, &schedule)?;
        let budget = Budget::new(&lattice, law(file), &schedule, &output);
        Ok(Self {
            scales,
            groups,
            lattice,
            schedule,
            output,
            budget,
        })
    }
}

fn within_budget(file: &CaseFile, checked: Result<(), Excess>) -> Result<(), CaseError> {
    checked.map_err(|excess| file.source.error(excess.key, excess.sentence))
}

/// Refuses fields that their file could not hold when the run is over.
pub(crate) fn check_fields(file: &CaseFile, lattice: &Lattice, output: &Output) -> Result<(), CaseError> {
    let Lattice { nx, ny, .. } = lattice;
    let needed = fields::smallest_stride(*nx, *ny, output.stride);
    if needed == output.stride {
        return Ok(());
    }
    let sentence = format!(
        "one field of {nx} x {ny} blocks takes more than the 2 GiB that the format of fields.nc holds: set \
         `output.stride` to {needed} or more"
    );
    Err(file.source.error("output.stride", sentence))
}

fn scales(file: &CaseFile) -> Scales {
    Scales {
        block_size: file.slider.block_size.si(),
        young_modulus: file.slider.young_modulus.si(),
        density: file.slider.density.si(),
        pressure: file.load.pressure.si(),
        mu_static_mean: file.friction.mu_static,
    }
}

fn groups(file: &CaseFile, scales: &Scales) -> Result<Groups, CaseError> {
    let epsilon = scales.epsilon();
    if epsilon > MAX_EPSILON {
        let sentence = format!(
            "the load strains the slider by P mu_s/E = {epsilon:.3}, more than {MAX_EPSILON}: lower `pressure` or raise \
             `young_modulus`"
        );
        return Err(file.source.error("load.pressure", sentence));
    }
    let v_star = match &file.drive.speed {
        case_file::DriveSpeed::VStar(v_star) => *v_star,
        case_file::DriveSpeed::Speed(speed) => speed.si() / scales.speed(),
    };
    within(file, "drive.speed", "V*", v_star, MIN_V_STAR, MAX_V_STAR)?;
    let r_star = match file.friction.kinetic {
        case_file::KineticFriction::RStar(r_star) => r_star,
        case_file::KineticFriction::MuKinetic(mu) => mu / scales.mu_static_mean,
    };
    let omega_star = match &file.slider.damping {
        case_file::Damping::OmegaStar(omega_star) => *omega_star,
        case_file::Damping::Rate(rate) => scales.omega_star(rate.si()),
    };
    within(
        file,
        "slider.damping_rate",
        "Omega*",
        omega_star,
        0.0,
        MAX_OMEGA_STAR,
    )?;
    Ok(Groups {
        v_star,
        r_star,
        omega_star,
        sigma_static_star: file.friction.sigma_static_star,
        sigma_kinetic_star: file.friction.sigma_kinetic_star,
        epsilon,
    })
}
const MIN_V_STAR: f64 = 1e-9;
const MAX_V_STAR: f64 = 10.0;
const MAX_OMEGA_STAR: f64 = 1000.0;

fn within(
    file: &CaseFile,
    key: &str,
    symbol: &str,
    value: f64,
    low: f64,
    high: f64,
) -> Result<(), CaseError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(file.source.error(
        key,
        format!("this makes {symbol} = {value:?}, which must lie between {low:?} and {high:?}"),
    ))
}

fn lattice(file: &CaseFile) -> Lattice {
    let edges = file.slider.edges.map(|edge| match edge {
        case_file::Edge::Free => Edges::Free,
        case_file::Edge::Periodic => Edges::Periodic,
    });
    let [nx, ny] = file.slider.blocks.map(|count| count as usize);
    Lattice::with_edges(nx, ny, edges)
}

struct Textures {
    shapes: Vec<surface::Texture>,
    asked_percent: Option<f64>,
}

fn textures(
    file: &mut CaseFile,
    scales: &Scales,
    lattice: &Lattice,
    inputs: &mut Inputs,
) -> Result<Textures, CaseError> {
    let mut shapes = Vec::new();
    let mut asked = Some(0.0);
    for index in 0..file.texture.len() {
        let (shape, percent) = match &file.texture[index] {
            case_file::Texture::Cavity(cavity) => cavity_in_blocks(cavity, scales, lattice),
            case_file::Texture::Groove(groove) => groove_in_blocks(groove, scales, lattice),
            case_file::Texture::Polygon(polygon) => {
                let points = polygon
                    .points
                    .iter()
                    .map(|point| in_blocks(scales, point))
                    .collect();
                (surface::Texture::Polygon(points), None)
            }
            case_file::Texture::Mask(mask) => {
                let key = format!("texture.{index}.file");
                let path = inputs.find(file, &key, &mask.file)?;
                let shape = read_mask(&path, mask.threshold, lattice)
                    .map_err(|error| file.source.error(&key, error.to_string()))?;
                inputs.budget.add_mask(match &shape {
                    surface::Texture::Image(image) => image.dark.len(),
                    _ => lattice.n_blocks(),
                });
                let copy = inputs.keep(file, &key, &path, lattice)?;
                if let case_file::Texture::Mask(mask) = &mut file.texture[index] {
                    mask.file = copy;
                }
                (shape, None)
            }
        };
        within_reach(&shape, lattice).map_err(|sentence| {
            let key = format!("texture.{index}");
            file.source.error(&key, sentence)
        })?;
        shapes.push(shape);
        asked = asked.zip(percent).map(|(sum, percent)| sum + percent);
    }
    Ok(Textures {
        shapes,
        asked_percent: asked,
    })
}

/// How far a texture may reach, in slider lengths: farther off it is a slip of the pen, and where edges wrap, its place
/// is lost to rounding.
const REACH: f64 = 100.0;

fn within_reach(shape: &surface::Texture, lattice: &Lattice) -> Result<(), String> {
    let farthest = |lengths: &[f64]| {
        lengths
            .iter()
            .fold(0.0, |most: f64, length| most.max(length.abs()))
    };
    let reach = match shape {
        surface::Texture::Cavity(cavity) => farthest(&cavity.center) + 2.0 * cavity.lambda,
        surface::Texture::Groove(groove) => groove.offset.abs() + groove.width,
        surface::Texture::Polygon(points) => farthest(points.as_flattened()),
        surface::Texture::Image(_) | surface::Texture::Blocks(_) => 0.0,
    };
    let slider = lattice.nx.max(lattice.ny) as f64;
    if reach <= REACH * slider {
        return Ok(());
    }
    Err(format!(
        "the texture reaches {reach:.1e} blocks far, more than {REACH} times the slider's {slider} blocks: look at its \
         units, and at `slider.block_size`"
    ))
}

fn in_blocks(scales: &Scales, [x, y]: &[Length; 2]) -> [f64; 2] {
    [scales.in_blocks(x.si()), scales.in_blocks(y.si())]
}

fn cavity_in_blocks(
    cavity: &case_file::Cavity,
    scales: &Scales,
    lattice: &Lattice,
) -> (surface::Texture, Option<f64>) {
    let n_blocks = lattice.n_blocks();
    let array = cavity.array.map(|count| count as usize);
    let count = array[0] * array[1];
    let (lambda, percent) = match &cavity.size {
        case_file::CavitySize::Coverage(percent) => (
            surface::cavity_lambda(*percent, n_blocks, cavity.s, cavity.w, count),
            *percent,
        ),
        case_file::CavitySize::Lambda(lambda) => {
            let lambda = scales.in_blocks(lambda.si());
            (
                lambda,
                surface::cavity_percent(lambda, n_blocks, cavity.s, cavity.w, count),
            )
        }
    };
    let center = match &cavity.center {
        case_file::Center::Middle => [0.5 * lattice.nx as f64, 0.5 * lattice.ny as f64],
        case_file::Center::At(center) => in_blocks(scales, center),
    };
    let &case_file::Cavity {
        s, w, across, rotate, ..
    } = cavity;
    (
        surface::Texture::Cavity(surface::Cavity {
            center,
            lambda,
            s,
            w,
            across,
            rotate,
            array,
        }),
        Some(percent),
    )
}

fn groove_in_blocks(
    groove: &case_file::Groove,
    scales: &Scales,
    lattice: &Lattice,
) -> (surface::Texture, Option<f64>) {
    let (orientation, breadth) = match groove.orientation {
        case_file::Orientation::Across => (surface::Orientation::Across, lattice.nx as f64),
        case_file::Orientation::Along => (surface::Orientation::Along, lattice.ny as f64),
    };
    let (width, percent) = match &groove.size {
        case_file::GrooveSize::Coverage(percent) => (breadth * percent / 100.0, *percent),
        case_file::GrooveSize::Width(width) => {
            let width = scales.in_blocks(width.si());
            (width, 100.0 * width / breadth)
        }
    };
    let offset = scales.in_blocks(groove.offset.si());
    (
        surface::Texture::Groove(surface::Groove {
            orientation,
            width,
            offset,
        }),
        Some(percent),
    )
}

fn read_mask(path: &Path, threshold: f64, lattice: &Lattice) -> Result<surface::Texture, arrays::ArrayError> {
    if path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("npy"))
    {
        return Ok(surface::Texture::Blocks(arrays::read_mask_npy(
            path, lattice.nx, lattice.ny,
        )?));
    }
    Ok(surface::Texture::Image(arrays::read_mask_png(path, threshold)?))
}

fn coefficients(
    file: &mut CaseFile,
    groups: &Groups,
    lattice: &Lattice,
    inputs: &mut Inputs,
) -> Result<Coefficients, CaseError> {
    let mean = file.friction.mu_static;
    let mut given = |key: &str, name: &mut Option<String>, file: &CaseFile| -> Result<_, CaseError> {
        let Some(written) = name.as_ref() else {
            return Ok(None);
        };
        let path = inputs.find(file, key, written)?;
        let field = arrays::read_field(&path, lattice.nx, lattice.ny)
            .map_err(|error| file.source.error(key, error.to_string()))?;
        *name = Some(inputs.keep(file, key, &path, lattice)?);
        Ok(Some(field))
    };
    let (mut static_name, mut kinetic_name) = (
        file.friction.mu_static_field.clone(),
        file.friction.mu_kinetic_field.clone(),
    );
    let mu_static = given("friction.mu_static_field", &mut static_name, file)?;
    let mu_kinetic = given("friction.mu_kinetic_field", &mut kinetic_name, file)?;
    file.friction.mu_static_field = static_name;
    file.friction.mu_kinetic_field = kinetic_name;
    // A given field takes the place of its draws; the other stream is not shifted by it.
    let spread = |mean: f64, sigma_star: f64, given: bool| Distribution {
        mean,
        deviation: if given { 0.0 } else { sigma_star * mean },
    };
    let mut drawn = Coefficients::draw(
        lattice.n_blocks(),
        spread(mean, groups.sigma_static_star, mu_static.is_some()),
        spread(
            groups.r_star * mean,
            groups.sigma_kinetic_star,
            mu_kinetic.is_some(),
        ),
        file.friction.seed,
    );
    drawn.mu_static = mu_static.unwrap_or(drawn.mu_static);
    drawn.mu_kinetic = mu_kinetic.unwrap_or(drawn.mu_kinetic);
    Ok(drawn)
}

/// Files read so far, and what the case needs with them.
struct Inputs {
    folder: PathBuf,
    read: Vec<Input>,
    budget: Budget,
}

impl Inputs {
    fn new(folder: &Path, budget: Budget) -> Self {
        Self {
            folder: folder.to_owned(),
            read: Vec::new(),
            budget,
        }
    }

    /// The path of a file that the case names.
    fn find(&self, file: &CaseFile, key: &str, written: &str) -> Result<PathBuf, CaseError> {
        let path = self.folder.join(written);
        let metadata = std::fs::metadata(&path).map_err(|error| unreadable(file, key, &path, &error))?;
        // A pipe would be waited for, and a device such as /dev/zero never ends.
        if !metadata.is_file() {
            let sentence = format!("{} is not a regular file: name a file that is", path.display());
            return Err(file.source.error(key, sentence));
        }
        Ok(path)
    }

    /// Notes a file that has been read; gives the path of its copy in the run folder.
    fn keep(
        &mut self,
        file: &CaseFile,
        key: &str,
        path: &Path,
        lattice: &Lattice,
    ) -> Result<String, CaseError> {
        let longest = arrays::longest(path, lattice.nx, lattice.ny);
        let bytes = read_whole(path, longest).map_err(|error| unreadable(file, key, path, &error))?;
        let plain = path
            .file_name()
            .map_or_else(|| "input".into(), |name| name.to_string_lossy().into_owned());
        let mut name = format!("inputs/{plain}");
        let mut copies = 1;
        // Two files of one name from different folders stay two files.
        while let Some(other) = self.read.iter().find(|input| input.name == name) {
            if other.bytes == bytes {
                return Ok(name);
            }
            copies += 1;
            name = format!("inputs/{copies}-{plain}");
        }
        self.budget.add_input(bytes.len());
        self.read.push(Input {
            name: name.clone(),
            bytes,
        });
        within_budget(file, self.budget.check_making())?;
        Ok(name)
    }
}

fn unreadable(file: &CaseFile, key: &str, path: &Path, error: &std::io::Error) -> CaseError {
    let sentence = format!(
        "cannot read {}: {error}; paths are relative to the case file",
        path.display()
    );
    file.source.error(key, sentence)
}

fn schedule(file: &CaseFile, scales: &Scales, groups: &Groups) -> Result<Schedule, CaseError> {
    let time = &file.time;
    let dt_star = match time.step {
        case_file::Step::Auto => 0.1,
        case_file::Step::Paper => 2.0 / 3.0 * groups.v_star,
        case_file::Step::Number(dt_star) => dt_star,
    };
    if dt_star >= dt_star_limit() {
        let sentence = format!(
            "the step dt* = {dt_star:.4} is not stable: it must be less than {:.4}; \"auto\" takes 0.1",
            dt_star_limit()
        );
        return Err(file.source.error("time.step", sentence));
    }
    let end_star = match &time.duration {
        case_file::RunTime::Auto => 8.0 / groups.v_star,
        case_file::RunTime::Star(duration) => *duration,
        case_file::RunTime::Duration(duration) => duration.si() / scales.time(),
    };
    // A duration that is a whole number of steps up to rounding must not gain one.
    let steps = (end_star / dt_star - 1e-6).ceil().max(1.0);
    if steps > MAX_STEPS {
        let sentence = format!(
            "a run to t* = {end_star:.4e} in steps of {dt_star} takes {steps:.2e} steps, more than {MAX_STEPS:.0e}: \
             shorten it or raise the step"
        );
        let key = if file.source.has("time.duration") {
            "time.duration"
        } else {
            "time.duration_star"
        };
        return Err(file.source.error(key, sentence));
    }
    let kinetic = match time.kinetic_from_star {
        AutoOr::Auto => KineticStart::Auto,
        AutoOr::Number(from) if from < end_star => KineticStart::At(from),
        AutoOr::Number(from) => {
            let sentence =
                format!("the kinetic window cannot begin at t* = {from}: the run ends at {end_star:.4}");
            return Err(file.source.error("time.kinetic_from_star", sentence));
        }
    };
    let last_step = steps as u64;
    let stop = match time.stop {
        case_file::Stop::End => Stop::at_step(last_step),
        case_file::Stop::AfterOnset => Stop::after_onset(last_step),
    };
    Ok(Schedule {
        dt_star,
        last_step,
        stop,
        kinetic,
    })
}

fn output(file: &CaseFile, schedule: &Schedule) -> Result<Output, CaseError> {
    let Schedule {
        dt_star, last_step, ..
    } = *schedule;
    let spacing = |key: &str, time: f64| -> Result<u64, CaseError> {
        let steps = (time / dt_star).round();
        if steps >= 1.0 {
            return Ok(steps as u64);
        }
        Err(file.source.error(
            key,
            format!("a spacing of {time} in t* is less than one step of {dt_star}: raise it"),
        ))
    };
    let snapshots = match &file.output.snapshots {
        case_file::Snapshots::Auto => Snapshots::Instants,
        case_file::Snapshots::Every(every) => Snapshots::Every(spacing("output.snapshots", *every)?),
        case_file::Snapshots::At(times) => {
            let mut steps: Vec<u64> = times.iter().map(|time| (time / dt_star).round() as u64).collect();
            if let Some((_, time)) = steps.iter().zip(times).find(|&(&step, _)| step > last_step) {
                let sentence = format!(
                    "no snapshot can be taken at t* = {time}: the run ends at {:.4}",
                    schedule.end_star()
                );
                return Err(file.source.error("output.snapshots", sentence));
            }
            steps.dedup();
            Snapshots::At(steps)
        }
    };
    let series_stride = match file.output.series {
        AutoOr::Auto => last_step.div_ceil(SERIES_ROWS),
        AutoOr::Number(time) => spacing("output.series", time)?,
    };
    let stride = file.output.stride as usize;
    Ok(Output {
        snapshots,
        fields: file.output.fields.clone(),
        stride,
        series_stride,
    })
}

/// Difference between the texture as asked and as meshed, relative to what was asked, that deserves a word.
const LARGE_MISFIT: f64 = 0.25;
/// Relative difference between `mu_static` and the mean of given coefficients that deserves a word.
const LARGE_MISMATCH: f64 = 0.1;
/// Strain of the load from which the springs' bending of geometry shows in the third digit.
const LARGE_EPSILON: f64 = 1e-2;
/// Speed above which loading is faster than the slip front.
const LARGE_V_STAR: f64 = 0.2;
/// Fewest blocks for which the paper calls edge effects small.
const FEW_BLOCKS: usize = 625;

impl Case {
    /// Where the case leaves what the model is good for, or what was asked, before it is run.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let mut warn = |wrong: bool, sentence: String| {
            if wrong {
                warnings.push(sentence);
            }
        };
        let groups = &self.groups;
        for texture in &self.texture.clipped {
            warn(
                true,
                format!(
                    "texture {} reaches over a free edge and is clipped there",
                    texture + 1
                ),
            );
        }
        let meshed = self.texture.meshed_percent;
        match self.texture.asked_percent {
            Some(asked) => warn(
                (meshed - asked).abs() > LARGE_MISFIT * asked,
                format!(
                    "the texture covers {meshed:.2} % of the blocks instead of {asked:.2} %: it is clipped, overlaps, or is \
                     too fine for the blocks"
                ),
            ),
            None => warn(meshed == 0.0, "the texture covers no block".to_owned()),
        }
        warn(
            self.negative_draws > 0,
            format!(
                "{} negative draws of the friction coefficients were set to 0",
                self.negative_draws
            ),
        );
        let surface = &self.model.surface;
        let mean = surface.mu_static.iter().sum::<f64>() / surface.n_contact() as f64;
        let given = self.file.friction.mu_static_field.is_some();
        warn(
            given && (mean / self.scales.mu_static_mean - 1.0).abs() > LARGE_MISMATCH,
            format!(
                "the given static coefficients have a mean of {mean:.4}, mu_static is {}: what is starred is relative to \
                 mu_static",
                self.scales.mu_static_mean
            ),
        );
        warn(
            groups.epsilon > LARGE_EPSILON,
            format!(
                "the load strains the slider by {:.3}, more than {LARGE_EPSILON}: results depend on it",
                groups.epsilon
            ),
        );
        warn(
            groups.v_star > LARGE_V_STAR,
            format!(
                "V* = {} is above {LARGE_V_STAR}: the slider slips as a whole before any front can cross it",
                groups.v_star
            ),
        );
        warn(
            self.model.law == FrictionLaw::Literal,
            "law = \"literal\" is for comparison only: its results depend on the time step".to_owned(),
        );
        warn(
            self.schedule.dt_star > 0.5,
            format!(
                "dt* = {} is stable but coarse: with 0.1, mu_s* is good to 1e-3",
                self.schedule.dt_star
            ),
        );
        warn(
            self.model.lattice.n_blocks() < FEW_BLOCKS,
            format!(
                "{} blocks are few: edges weigh heavily below {FEW_BLOCKS} (Fig. 5 of the paper)",
                self.model.lattice.n_blocks()
            ),
        );
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_no_file_holds_are_refused_before_the_run() {
        let check = |text: &str| {
            let file = CaseFile::parse(text, "case.toml", &[]).unwrap();
            let Numbers { lattice, output, .. } = Numbers::of(&file).unwrap();
            check_fields(&file, &lattice, &output)
        };
        let large = "[slider]\nblocks = [40000, 20000]\n[output]\nstride =";
        assert!(check(&format!("{large} 2")).is_ok());
        let said = check(&format!("{large} 1")).unwrap_err().to_string();
        assert!(
            said.contains("case.toml:4:10: ") && said.contains("set `output.stride` to 2 or more"),
            "{said}"
        );
    }
}
