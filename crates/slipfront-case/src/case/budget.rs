//! Memory and disk space that a run needs, estimated before it begins and compared with what the machine has.
//!
//! [`Budget::parts`] is the table of what takes how much. Memory is that of the largest of three phases: a case is made, it is
//! run and its results are written, its pictures are drawn. Of several ranks each takes memory for its own rows, and those of a
//! machine share what it has.

use std::ops::Range;
use std::path::Path;

use slipfront::observe::{CurveRow, Frame, Kymograph, SlipEvent, frames};
use slipfront::{Kernel, Lattice, PositionBins};

use super::kernel::kernel;
use super::output::{MAX_MAPS, Output, mapped_field};
use super::ranks::Ranks;
use super::textures::{count_height_maps, count_masks};
use super::time_plan::TimePlan;
use crate::case_file::{
    Attached, AttachedEdge, CaseError, CaseFile, Contact, Friction, Law, Motion, Outline,
};
use crate::machine::{available_memory, can_be_had, free_disk};
use crate::number_format::{byte_size, count};

/// A number of a block.
const NUMBER: f64 = size_of::<f64>() as f64;
/// Whether a block is textured; whether it slides.
const FLAG: f64 = size_of::<bool>() as f64;

/// [`slipfront::Surface`] under an equal pressure.
const SURFACE: f64 = FLAG + 2.0 * NUMBER;
/// Bytes of surface and slider per block.
fn surface_bytes(file: &CaseFile) -> f64 {
    let has_pressures = file.load.profile.is_some() || file.load.pressure_field.is_some();
    SURFACE + if has_pressures { NUMBER } else { 0.0 } + slider_bytes(file)
}

/// Bytes of [`slipfront::Slider`] per block: moduli, densities, and the blocks that exist; the stiffness of drive springs that follows
/// from moduli and outline.
fn slider_bytes(file: &CaseFile) -> f64 {
    let slider = &file.slider;
    let has = |property: bool| f64::from(u8::from(property));
    let stiffness = slider.stiffness_field.is_some() || slider.stiffness_grade.is_some();
    let density = slider.density_field.is_some() || slider.density_grade.is_some();
    let outline = slider.outline != Outline::Rectangle;
    let driven = stiffness || outline || file.drive.attached != Attached::At(AttachedEdge::All);
    NUMBER * (has(stiffness) + has(density) + has(driven)) + FLAG * has(outline)
}

/// Numbers of a block that springs which differ take: the stiffness along each of the four bonds.
fn spring_numbers(file: &CaseFile) -> f64 {
    let slider = &file.slider;
    let graded = slider.stiffness_field.is_some() || slider.stiffness_grade.is_some();
    match graded || slider.outline != Outline::Rectangle {
        true => 4.0,
        false => 0.0,
    }
}

/// Bytes of the general kernel per block, with springs that differ, with dampers, and with directions of a rotation.
fn general_bytes(file: &CaseFile) -> f64 {
    // Their sum, and that along each of the four bonds.
    let dampers = match file.slider.viscosity_time_star > 0.0 {
        true => 10.0 * NUMBER,
        false => 0.0,
    };
    let directions = match file.drive.motion {
        Motion::Translation => 0.0,
        Motion::Rotation => 2.0 * NUMBER,
    };
    GENERAL + spring_numbers(file) * NUMBER + dampers + directions
}

/// Bytes of the general kernel per block that bands of rows add, which several threads share out among them: each takes for itself what it
/// needs of the model, the motion from which the forces between blocks follow, and the rows beside its own.
fn band_bytes(file: &CaseFile) -> f64 {
    let is_viscous = file.slider.viscosity_time_star > 0.0;
    // Displacements, and velocities for dampers.
    let motion = if is_viscous { 4.0 } else { 2.0 };
    // Forces along the four bonds.
    let forces = if is_viscous { 16.0 } else { 8.0 };
    // The motion of the rows beside is passed on from the ends of each band, too.
    let repeated = REPEATED_ROWS * (2.0 * motion + forces + spring_numbers(file));
    surface_bytes(file) + NUMBER * (motion + repeated + SWEPT)
}

/// Rows that a band of the general kernel holds beside its own, over its own, at the most: 2 over 8.
const REPEATED_ROWS: f64 = 0.25;
/// Four numbers of each block of a row, which a band of eight rows sweeps at once.
const SWEPT: f64 = 0.5;

/// Bytes of the fused kernel per block, with what it keeps of blocks that differ.
fn fused_bytes(file: &CaseFile) -> f64 {
    let slider = &file.slider;
    let differ = slider.stiffness_field.is_some()
        || slider.stiffness_grade.is_some()
        || slider.density_field.is_some()
        || slider.density_grade.is_some()
        || file.friction.velocity.is_some()
        || file.drive.attached != Attached::At(AttachedEdge::All);
    match differ {
        // Four springs, the drive spring, mass and its inverse, kinetic friction at the present speed.
        true => FUSED + 8.0 * NUMBER,
        false => FUSED,
    }
}

/// The fused kernel: two vectors, two thresholds, a step; masks, vectors of eight and tiles take 3.6 together.
const FUSED: f64 = 6.5 * NUMBER + 3.6;
/// The general kernel: two vectors of state, eight of forces, two thresholds, a time.
const GENERAL: f64 = 23.0 * NUMBER + FLAG;
/// A block in a checkpoint: two vectors, a time; what the law of friction remembers is added.
const SAVED: f64 = 5.0 * NUMBER;

/// Numbers of a block that a law of friction adds to the general kernel, and those of them that a checkpoint keeps.
fn of_friction(friction: &Friction) -> [f64; 2] {
    let each = [
        // Kinetic friction at the present speed.
        (friction.velocity.is_some(), [1.0, 0.0]),
        // The threshold at the present age, whether age counts, and when the block has stopped.
        (friction.ageing.is_some(), [2.0 + FLAG / NUMBER, 1.0]),
        // State and load.
        (friction.law == Law::RateAndState, [2.0, 1.0]),
        // The anchor of its spring, and how often this has broken.
        (friction.contact == Contact::Springs, [3.0, 3.0]),
    ];
    let used = each.into_iter().filter(|(is_used, _)| *is_used);
    used.fold([0.0; 2], |[kept, saved], (_, [more, of_them])| {
        [kept + more, saved + of_them]
    })
}

/// Numbers of every block of the lattice that a height map takes: the means of the blocks, before that their sums in two numbers, and the
/// same in order of height; whether each block exists.
fn heights(file: &CaseFile) -> f64 {
    match (count_height_maps(file), file.slider.outline) {
        (0, _) => 0.0,
        (_, Outline::Rectangle) => 2.0,
        (_, Outline::Disc | Outline::Mask) => 2.0 + FLAG / NUMBER,
    }
}

/// Columns of the series that not every run has.
fn more_columns(file: &CaseFile) -> f64 {
    let of_friction = match (file.friction.contact, file.friction.law) {
        // Energy of springs, and what is lost with them.
        (Contact::Springs, _) => 2.0,
        // The state.
        (Contact::Rigid, Law::RateAndState) => 1.0,
        _ => 0.0,
    };
    // What is lost to dampers.
    of_friction + f64::from(u8::from(file.slider.viscosity_time_star > 0.0))
}

/// A value of a field.
const VALUE: f64 = size_of::<f32>() as f64;
/// Most cells of a map, into which blocks are averaged while it is read: 256 along a side.
const CELLS: f64 = 256.0 * 256.0;
/// Whether a cell is textured, and the sum and the count of its blocks while a field is read.
const AVERAGED: f64 = FLAG + NUMBER + VALUE;
/// What never changes in the file, where textured takes 16 bits.
const STATICS_ON_DISK: f64 = 2.0 + 3.0 * NUMBER;

/// Bytes of a column of `series.csv`: at most 24 characters and what separates it from the next.
pub const COLUMN_TEXT: usize = 25;
/// Columns of every series.
const COLUMNS: f64 = 16.0;
/// Stretches of the history of mu* and their copies while an uncertainty is sought.
const HISTORY: f64 = 1024.0 * 1024.0;

/// Columns of `precursors.csv`.
const EVENT_COLUMNS: f64 = 8.0;
/// Fewest steps from an event of slip to the next, on average (measured: 175 and more).
const EVENT_STEPS: f64 = 50.0;

/// What both pictures read of a row of the series, and its points of the curves.
const DRAWN_ROW: f64 = (3.0 + 2.0 + 3.0) * NUMBER;

/// Primitives and pixels of a picture as wide as a column. They do not depend on the lattice.
pub const PICTURE: f64 = 7.0 * 1024.0 * 1024.0;
/// The same of the pictures of the friction and of the stress, which are drawn at once: four bytes of a pixel, of which there are 0.9
/// and at most 3.6 million.
const PICTURES_WITH_MAPS: f64 = 20.0 * 1024.0 * 1024.0;
/// The same of the picture of the front: with its panels beside each other, and above each other, as those of long sliders are
/// (at most 1.8 and 2.6 million pixels).
const PICTURE_OF_FRONT: f64 = 8.0 * 1024.0 * 1024.0;
const PICTURE_OF_LONG_FRONT: f64 = 12.0 * 1024.0 * 1024.0;
/// All pictures as SVG and PNG, the summary and the manifest (measured: at most 0.7 MB), without the maps of the stress; and of these for
/// a cell (measured: 5.4 bytes where every cell has a colour of its own).
const PICTURE_FILES: f64 = 2e6;
const MAP_FILES: f64 = 6.0;

/// Most pictures of a movie that are drawn at once.
pub const MOVIE_BATCH: usize = 8;
/// Their pixels: four bytes of each of the 1.3 million that are drawn of a picture, and one of the 0.3 million that are kept.
const MOVIE_PIXELS: f64 = MOVIE_BATCH as f64 * 5.5e6;
/// A picture of a movie in its file (measured: 25 kB where all of a map changes).
const MOVIE_PICTURE: f64 = 25e3;

/// What the allocator holds of memory that has been given back, or cannot use between pieces that have not: resident
/// memory was up to 4 % above what was allocated.
const HEAP: f64 = 1.05;

/// The program itself.
pub const PROGRAM: f64 = 8.0 * 1024.0 * 1024.0;

/// What the first of several ranks takes for a block while it finds the front: its time twice, its place in their order, its cluster,
/// and the speed around it.
const FRONT: f64 = 5.0 * NUMBER;
/// Most blocks that are looked at for that.
const FRONT_BLOCKS: f64 = (1 << 22) as f64;

/// A number of the kymograph in memory: what is counted, and its share twice when that is written.
const COUNTED: f64 = 2.0 * NUMBER;
/// The same while it is drawn.
const DRAWN_SHARE: f64 = 2.0 * NUMBER;

/// Cases whose making takes less are not compared with the machine.
const SMALL: f64 = 64.0 * 1024.0 * 1024.0;

/// Memory and disk space that a run needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Blocks of the rows that this process holds.
    blocks: f64,
    /// Bytes of the surface and of the slider per block.
    surface: f64,
    /// Bytes of the kernel per block.
    kernel: f64,
    /// Bytes per block that the kernel takes beside these on several threads.
    bands: f64,
    /// Bytes of a block in a checkpoint.
    saved: f64,
    /// Those of them that are kept of a field.
    cells: f64,
    /// Blocks of the whole lattice.
    all_blocks: f64,
    /// Those that are kept of a field.
    all_cells: f64,
    /// Whether the lattice is shared by several ranks.
    is_shared: bool,
    /// Ranks on this machine.
    ranks_on_node: f64,
    frames: f64,
    fields: f64,
    rows: f64,
    /// Bytes of a row in its file.
    row_text: f64,
    /// Events of slip of a slider that is driven at an edge.
    events: f64,
    /// Maps that are drawn.
    maps: f64,
    /// Pictures of the movie.
    movie: f64,
    /// Places times instants of the kymograph.
    kymograph: f64,
    /// Bytes of the picture of the front.
    front_picture: f64,
    /// Bytes of the files that the case reads, of which there will be copies.
    pub(super) inputs: f64,
    /// Masks that are in memory at once, until they are laid over the lattice.
    masks: f64,
    /// Numbers of every block of the lattice that a height map takes while it is laid over them.
    heights: f64,
    /// Whether the run resumes from a checkpoint.
    is_resumed: bool,
}

/// What takes memory or disk space.
struct Part {
    /// The key of the case that it is due to.
    key: &'static str,
    what: fn(&Budget) -> String,
    remedy: &'static str,
    /// Bytes in each [`Phase`].
    bytes: [f64; 5],
}

/// The phases of a run that take memory, then what takes disk space.
#[derive(Clone, Copy, Debug)]
enum Phase {
    Making,
    /// What writing files takes for the blocks is less than the kernel's share.
    Running,
    /// Both pictures at once, by the first of several ranks.
    Drawing,
    Files,
    /// Blocks, snapshots and rows as they stand in memory, of all ranks.
    Checkpoint,
}

impl Budget {
    /// The budget of a run, from the parameters of its case alone, for a process that holds these rows.
    pub(super) fn new(
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &Ranks,
        file: &CaseFile,
        time_plan: &TimePlan,
        output: &Output,
    ) -> Self {
        let kept = |indices: Range<usize>| frames::kept(indices, output.stride).len() as f64;
        let last_step = time_plan.last_step;
        let [kept_by_law, saved_by_law] = of_friction(&file.friction);
        let n_frames = output.max_snapshots(last_step) as f64;
        Self {
            blocks: lattice.nx as f64 * rows.len() as f64,
            cells: kept(0..lattice.nx) * kept(rows.clone()),
            all_blocks: lattice.nx as f64 * lattice.ny as f64,
            all_cells: kept(0..lattice.nx) * kept(0..lattice.ny),
            is_shared: ranks.communicator.size() > 1,
            ranks_on_node: ranks.on_node as f64,
            surface: surface_bytes(file),
            kernel: match kernel(file) {
                Kernel::Fused => fused_bytes(file),
                Kernel::General => general_bytes(file) + kept_by_law * NUMBER,
            },
            bands: match kernel(file) {
                Kernel::Fused => 0.0,
                Kernel::General => band_bytes(file),
            },
            saved: SAVED + saved_by_law * NUMBER,
            frames: n_frames,
            fields: output.fields.len() as f64,
            rows: (last_step / output.series_stride) as f64 + 2.0,
            row_text: COLUMN_TEXT as f64 * (COLUMNS + more_columns(file)),
            events: match file.drive.edge() {
                Some(_) => (last_step as f64 / EVENT_STEPS).ceil(),
                None => 0.0,
            },
            maps: match output.fields.contains(&mapped_field(file)) {
                true => n_frames.min(MAX_MAPS as f64),
                false => 0.0,
            },
            movie: if output.movie { n_frames } else { 0.0 },
            front_picture: match lattice.nx > 3 * lattice.ny {
                true => PICTURE_OF_LONG_FRONT,
                false => PICTURE_OF_FRONT,
            },
            kymograph: {
                let samples = last_step / Kymograph::INTERVAL + 1;
                let places = (lattice.nx + lattice.ny).min(PositionBins::MAX);
                (samples.min(Kymograph::MAX_ROWS as u64) * places as u64) as f64
            },
            inputs: 0.0,
            heights: heights(file),
            masks: count_masks(file) as f64
                + f64::from(u8::from(matches!(file.drive.attached, Attached::File(_)))),
            is_resumed: false,
        }
    }

    /// What takes how many bytes in each phase.
    fn parts(&self) -> [Part; 5] {
        let (blocks, all_cells) = (self.blocks, self.all_cells);
        let (frames, fields, rows) = (self.frames, self.fields, self.rows);
        let drawn = all_cells.min(CELLS);
        let frame = size_of::<Frame>() as f64 + fields * size_of::<Vec<f32>>() as f64;
        let snapshots = |cells: f64| frames * fields * cells * VALUE + grown(frames) * frame;
        let row = size_of::<CurveRow>() as f64;
        let (event, event_text) = (size_of::<SlipEvent>() as f64, COLUMN_TEXT as f64 * EVENT_COLUMNS);
        [
            Part {
                key: "slider.blocks",
                what: |budget| count(budget.blocks as usize, "block"),
                remedy: "lower `slider.blocks`",
                bytes: [
                    blocks * self.surface,
                    blocks * (self.surface + self.kernel + self.bands),
                    // With the time of its first slip.
                    blocks * (self.surface + NUMBER) + drawn * AVERAGED,
                    all_cells * STATICS_ON_DISK,
                    self.all_blocks * self.saved,
                ],
            },
            Part {
                key: "output.snapshots",
                what: |budget| {
                    let (frames, fields) = (budget.frames as usize, budget.fields as usize);
                    format!("{} of {}", count(frames, "snapshot"), count(fields, "field"))
                },
                remedy: "take fewer `output.snapshots`, name fewer `output.fields`, or raise `output.stride`",
                bytes: [
                    0.0,
                    snapshots(self.cells),
                    // One after the other.
                    (self.maps * drawn * (VALUE + MAP_FILES))
                        .max(self.movie * (drawn * VALUE + MOVIE_PICTURE)),
                    frames * (fields * all_cells * VALUE + 4.0 * NUMBER)
                        + self.maps * drawn * MAP_FILES
                        + self.movie * MOVIE_PICTURE,
                    snapshots(all_cells),
                ],
            },
            Part {
                key: "output.series",
                what: |budget| format!("{} of the series", count(budget.rows as usize, "row")),
                remedy: "raise `output.series`",
                bytes: [
                    0.0,
                    grown(rows) * row + rows * self.row_text,
                    grown(rows) * (row + DRAWN_ROW),
                    rows * self.row_text,
                    rows * row,
                ],
            },
            Part {
                key: "drive.attach",
                what: |budget| count(budget.events as usize, "slip event"),
                remedy: "shorten the run",
                bytes: [
                    0.0,
                    grown(self.events) * event + grown(self.events * event_text),
                    // As numbers, then as points.
                    grown(self.events) * (EVENT_COLUMNS + 4.0) * NUMBER,
                    self.events * event_text,
                    self.events * event_text,
                ],
            },
            Part {
                key: "texture",
                what: |_| "the files that it reads".to_owned(),
                remedy: "scale them down, or name fewer",
                bytes: [
                    self.masks * blocks * FLAG + self.heights * self.all_blocks * NUMBER,
                    0.0,
                    0.0,
                    self.inputs,
                    0.0,
                ],
            },
        ]
    }

    /// Bytes of a phase, with those that no key of a case changes.
    fn total(&self, phase: Phase) -> f64 {
        let counts = grown(self.kymograph) * NUMBER;
        let with_maps = if self.maps > 0.0 { PICTURES_WITH_MAPS } else { 0.0 };
        let of_movie = if self.movie > 0.0 { MOVIE_PIXELS } else { 0.0 };
        let fixed = [
            0.0,
            HISTORY + counts + self.kymograph * COUNTED,
            (self.front_picture.max(with_maps) + self.kymograph * DRAWN_SHARE).max(of_movie),
            PICTURE_FILES + self.kymograph * VALUE,
            HISTORY + counts,
        ];
        let parts = self.parts();
        parts.iter().map(|part| part.bytes[phase as usize]).sum::<f64>() + fixed[phase as usize]
    }

    /// The phase that takes the most memory, in a run that writes no files if not `writes`.
    fn largest(&self, writes: bool) -> Phase {
        let phases = [Phase::Making, Phase::Running, Phase::Drawing];
        let phases = phases.into_iter().take(if writes { 3 } else { 2 });
        let most = phases.max_by(|a, b| self.on_node(*a).total_cmp(&self.on_node(*b)));
        most.unwrap_or(Phase::Running)
    }

    /// Bytes of a rank in a phase, with what the first of several has of the others' blocks.
    fn of_rank(&self, phase: Phase) -> f64 {
        let gathered = match (phase, self.is_shared) {
            (Phase::Running, true) => self.all_blocks.min(FRONT_BLOCKS) * FRONT,
            _ => 0.0,
        };
        PROGRAM + HEAP * (self.total(phase) + gathered)
    }

    /// Bytes of all ranks of this machine in a phase. While one draws, the others have at most what they ran with.
    fn on_node(&self, phase: Phase) -> f64 {
        let others = match phase {
            Phase::Drawing => Phase::Running,
            phase => phase,
        };
        self.of_rank(phase) + (self.ranks_on_node - 1.0) * self.of_rank(others)
    }

    /// Memory of a run with its files and pictures, in bytes; of each rank if there are several.
    pub fn memory(&self) -> f64 {
        self.of_rank(self.largest(true))
    }

    /// Memory of one of several runs at once, each on one thread, in bytes; of one that writes no files if not `writes`.
    pub fn memory_beside_others(&self, writes: bool) -> f64 {
        let on_one_thread = Self { bands: 0.0, ..*self };
        on_one_thread.of_rank(on_one_thread.largest(writes)) - PROGRAM
    }

    /// Memory of a case that is made and not run, in bytes.
    pub fn memory_of_case(&self) -> f64 {
        self.total(Phase::Making)
    }

    /// The budget of the run when it resumes from a checkpoint, which the kernel takes over without a copy.
    pub fn resumed(mut self) -> Self {
        self.is_resumed = true;
        self
    }

    /// Room for the files of a run, in bytes.
    pub fn disk(&self) -> f64 {
        self.total(Phase::Files)
    }

    /// Disk space for the snapshots alone, in bytes.
    pub fn disk_of_snapshots(&self) -> f64 {
        let [_, snapshots, ..] = self.parts();
        snapshots.bytes[Phase::Files as usize]
    }

    /// Room for checkpoints while the run goes on, in bytes: the latest one, the one before it, and one that is being written.
    pub fn disk_of_checkpoints(&self) -> f64 {
        3.0 * self.total(Phase::Checkpoint)
    }

    /// Refuses a case that cannot even be made.
    pub(super) fn check_making(&self, file: &CaseFile) -> Result<(), CaseError> {
        if self.total(Phase::Making) < SMALL {
            return Ok(());
        }
        self.compare_memory(file, "this case", Phase::Making, 0.0, available_memory())
    }

    /// Refuses a run, or to resume one, that needs more memory than there is; what a case takes is there already if it is
    /// `made`, by all ranks.
    pub fn check_memory(&self, file: &CaseFile, made: bool) -> Result<(), CaseError> {
        let made = if made { self.total(Phase::Making) } else { 0.0 };
        let phase = self.largest(true);
        self.compare_memory(file, "a run of this case", phase, made, available_memory())
    }

    /// `had` is what each rank has taken of the memory already, `available` what there is beside it.
    fn compare_memory(
        &self,
        file: &CaseFile,
        whose: &str,
        phase: Phase,
        had: f64,
        available: Option<f64>,
    ) -> Result<(), CaseError> {
        let (needed, on_node) = (self.of_rank(phase), self.on_node(phase));
        let available = available.map(|available| available + self.ranks_on_node * had);
        let bound = match available {
            Some(available) if on_node > available => {
                format!("{} are available", byte_size(available))
            }
            _ if !can_be_had(needed - had) => "the system gives less at once (see `ulimit -v`)".to_owned(),
            _ => return Ok(()),
        };
        let (key, most, remedy) = self.most(phase);
        // The case of a run that resumes can be changed no more.
        let (whose, remedy) = match self.is_resumed {
            true => (
                "going on with this run",
                "give it more, in a queue for example with `--mem`",
            ),
            false => (whose, remedy),
        };
        let (each, or) = match self.is_shared {
            true => (" per rank", ", or share it among more machines"),
            false => ("", ""),
        };
        let together = match self.ranks_on_node {
            1.0 => String::new(),
            ranks => format!(", {} for the {ranks} ranks of this machine,", byte_size(on_node)),
        };
        let needed = byte_size(needed);
        let sentence = format!(
            "{whose} takes about {needed} of memory{each} ({most}){together} where {bound}: {remedy}{or}"
        );
        Err(file.source.error(key, sentence))
    }

    /// Refuses a run whose files, and checkpoints if it saves any, have no room in `folder`, which need not be there yet.
    /// `replaced` is what goes from there before.
    pub fn check_disk(
        &self,
        file: &CaseFile,
        folder: &Path,
        replaced: u64,
        checkpoints: bool,
    ) -> Result<(), CaseError> {
        let Some(free) = free_disk(folder).map(|free| free + replaced as f64) else {
            return Ok(());
        };
        let beside = if checkpoints {
            self.disk_of_checkpoints()
        } else {
            0.0
        };
        if self.disk() + beside <= free {
            return Ok(());
        }
        let (beside, without) = match checkpoints {
            true => (
                format!(" and its checkpoints {}", byte_size(beside)),
                ", run without checkpoints (--checkpoint off)",
            ),
            false => (String::new(), ""),
        };
        let (key, most, remedy) = self.most(Phase::Files);
        let sentence = format!(
            "the files of this run take about {} ({most}){beside} where {} are free in {}: free some, {remedy}{without}, \
             or choose another folder",
            byte_size(self.disk()),
            byte_size(free),
            folder.display()
        );
        Err(file.source.error(key, sentence))
    }

    /// The key that most bytes of a phase are due to, how many these are and for what, and the remedy.
    fn most(&self, phase: Phase) -> (&'static str, String, &'static str) {
        let bytes_of = |part: &Part| part.bytes[phase as usize];
        let [mut most, others @ ..] = self.parts();
        for part in others {
            if bytes_of(&part) >= bytes_of(&most) {
                most = part;
            }
        }
        let what = format!("{} of it for {}", byte_size(bytes_of(&most)), (most.what)(self));
        (most.key, what, most.remedy)
    }
}

/// Memory in which the pictures of a finished run are drawn from its files, in bytes, with so many rows of the series and a kymograph of
/// so many bytes.
pub fn memory_to_draw(rows: f64, kymograph: f64) -> f64 {
    let maps = CELLS * (AVERAGED + MAX_MAPS as f64 * (VALUE + MAP_FILES));
    HEAP * (maps + grown(rows) * DRAWN_ROW + kymograph / VALUE * DRAWN_SHARE + PICTURES_WITH_MAPS)
}

/// Memory in which a movie is made from the files of a run, in bytes, with so many snapshots and rows of the series.
pub fn memory_of_movie(snapshots: f64, rows: f64) -> f64 {
    let maps = CELLS * (AVERAGED + snapshots * VALUE);
    HEAP * (maps + snapshots * MOVIE_PICTURE + grown(rows) * DRAWN_ROW + MOVIE_PIXELS)
}

/// Elements for which a vector has room that grew to `length` by doubling.
fn grown(length: f64) -> f64 {
    length.max(4.0).log2().ceil().exp2()
}

#[cfg(test)]
mod tests {
    use slipfront::communicator::Threads;

    use super::*;
    use crate::case::Case;

    fn case(sets: &[&str]) -> Case {
        let overrides: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        Case::parse("", "case", &overrides).unwrap()
    }

    /// Why a run with this budget is refused, if it is.
    fn refusal(case: &Case, budget: &Budget, had: f64, available: Option<f64>) -> Option<String> {
        let phase = budget.largest(true);
        let compared = budget.compare_memory(&case.file, "a run of this case", phase, had, available);
        compared.err().map(|error| error.to_string())
    }

    #[test]
    fn what_takes_the_most_is_named_with_its_remedy() {
        for (sets, key, words) in [
            (
                vec!["slider.blocks=[2000,2000]", "output.snapshots=[]"],
                "slider.blocks",
                ["276.9 MiB of it for 4000000 blocks", "lower `slider.blocks`"],
            ),
            (
                vec!["slider.blocks=[100,100]", "output.snapshots={every=0.1}"],
                "output.snapshots",
                ["for 2674 snapshots of 5 fields", "raise `output.stride`"],
            ),
            (
                vec!["output.series=0.1", "time.duration_star=1e6"],
                "output.series",
                ["for 10000002 rows of the series", "raise `output.series`"],
            ),
        ] {
            let case = case(&sets);
            let refused = refusal(&case, &case.budget, 0.0, Some(2e8)).unwrap();
            // The place is the override of the key.
            assert!(refused.starts_with(&format!("--set {key}=")), "{key}: {refused}");
            for word in ["where 190.7 MiB are available"].iter().chain(&words) {
                assert!(refused.contains(word), "{word}: {refused}");
            }
            assert!(!refused.contains("rank"), "{refused}");
        }
    }

    /// Four ranks, two of them on this machine.
    #[test]
    fn ranks_share_what_a_run_takes() {
        let overrides = ["slider.blocks=[2000,2000]", "output.snapshots={every=20}"].map(str::to_owned);
        let made = |communicator: &Threads, on_node| {
            let ranks = Ranks {
                communicator,
                on_node,
            };
            let file = CaseFile::parse("", "case", &overrides).unwrap();
            Case::to_run_on_ranks(file, "case", Path::new(""), &mut |_| true, ranks).unwrap()
        };
        let alone = case(&["slider.blocks=[2000,2000]", "output.snapshots={every=20}"]).budget;
        let cases = Threads::run(4, |communicator| made(communicator, 2));
        // What is there once for every process: the numbers that do not belong to blocks.
        let beside = |phase: Phase| {
            let mut none = alone;
            (none.blocks, none.cells, none.all_cells) = (0.0, 0.0, 0.0);
            none.total(phase)
        };
        for phase in [Phase::Making, Phase::Running] {
            let shared: f64 = cases
                .iter()
                .map(|case| case.budget.total(phase) - beside(phase))
                .sum();
            assert_eq!(shared, alone.total(phase) - beside(phase), "{phase:?}");
        }
        let budget = cases[0].budget;
        for phase in [Phase::Files, Phase::Checkpoint] {
            assert_eq!(budget.total(phase), alone.total(phase), "{phase:?}");
        }
        // While it draws, the other one has what it ran with.
        let drawing = budget.of_rank(Phase::Drawing) + budget.of_rank(Phase::Running);
        assert_eq!(budget.on_node(Phase::Drawing), drawing);
        let needed = budget.on_node(budget.largest(true));
        assert_eq!(refusal(&cases[0], &budget, 0.0, Some(needed)), None);
        assert_eq!(refusal(&cases[0], &budget, 1e6, Some(needed - 2e6)), None);
        let refused = refusal(&cases[0], &budget, 1e6, Some(needed - 3e6)).unwrap();
        for word in [
            " of memory per rank (",
            &format!(", {} for the 2 ranks of this machine, where ", byte_size(needed)),
            ", or share it among more machines",
        ] {
            assert!(refused.contains(word), "{word}: {refused}");
        }
        let spread = Threads::run(4, |communicator| made(communicator, 1));
        let refused = refusal(&spread[3], &spread[3].budget, 0.0, Some(1e6)).unwrap();
        assert!(
            refused.contains(" of memory per rank (") && !refused.contains("ranks"),
            "{refused}"
        );
    }

    /// The case itself is in memory when its run is judged.
    #[test]
    fn what_has_been_taken_already_counts_as_available() {
        let case = case(&["slider.blocks=[2000,1000]", "output.snapshots=[]"]);
        let made = case.budget.total(Phase::Making);
        let enough = case.budget.memory() - made;
        assert_eq!(refusal(&case, &case.budget, made, Some(enough)), None);
        assert!(refusal(&case, &case.budget, made, Some(0.99 * enough)).is_some());
        // A system that does not say what it has is asked for all of it.
        assert_eq!(refusal(&case, &case.budget, made, None), None);
        let mut huge = case.budget;
        huge.blocks = 1e16;
        let refused = refusal(&case, &huge, 0.0, None).unwrap();
        assert!(refused.contains("ulimit -v"), "{refused}");
        // Of a run that has begun no key can be changed.
        let refused = refusal(&case, &case.budget.resumed(), made, Some(0.0)).unwrap();
        assert!(
            refused.contains("give it more") && !refused.contains("lower"),
            "{refused}"
        );
    }

    #[test]
    fn the_machine_says_what_it_has() {
        let folder = tempfile::tempdir().unwrap();
        let there = free_disk(folder.path()).unwrap();
        assert!(there > 0.0);
        // Where a folder will be made counts the nearest that is there.
        assert!(free_disk(&folder.path().join("not/yet/there")).is_some());
        // This test runs in some memory.
        assert!(available_memory().is_none_or(|bytes| bytes > PROGRAM));
    }
}
