//! Memory and disk space of a run, estimated from its blocks, snapshots and rows, and compared with the
//! machine before any of it is allocated.
//!
//! The estimate is an upper bound with one margin: every figure in this file is the largest that was measured
//! over all options, rounded up. `tests/budget` of slipfront-cli compares it with the memory that runs take.

use std::ops::Range;
use std::path::Path;

use slipfront::observe::{Events, Kymograph, frames};
use slipfront::{Friction, Kernel, Lattice, Model};
use slipfront_base::machine::{available_memory, can_be_had, free_disk};
use slipfront_base::number_format::{byte_size, count};

use super::inputs::Input;
use super::output::Output;
use super::ranks::Ranks;
use crate::case_file::{Attached, AttachedEdge, Body, CaseError, CaseFile, Loading, Motion, Outline, Shape};

/// Bytes of a number.
const NUMBER: f64 = size_of::<f64>() as f64;

const MIB: f64 = 1024.0 * 1024.0;

/// Memory of the program itself.
pub const PROGRAM: f64 = 12.0 * MIB;

/// Memory for drawing pictures of the usual size, two at once, whatever they show.
pub const PICTURES: f64 = 28.0 * MIB;

/// Memory for drawing the pictures of a movie, several at once.
const MOVIE: f64 = 48.0 * MIB;

/// Bytes of a movie file per picture.
const MOVIE_FILE: f64 = 3e4;

/// Bytes of the files of a run that do not grow with it: pictures, summary and manifest.
const FILES: f64 = 2e6;

/// Largest number of blocks in a drawn map: larger lattices are averaged.
const MAP_BLOCKS: f64 = 65_536.0;

/// Bytes of a run in memory and in a checkpoint that do not grow with it.
const RESULTS: f64 = 1.5 * MIB;

/// Numbers per block that the first of several ranks needs to find the slip front, and the largest number of
/// blocks for which it does so.
const GATHERED: [f64; 2] = [5.0, (1 << 22) as f64];

/// Words for a run that begins, in a refusal because of its memory.
const RUN: &str = "a run of this case";

/// Remedy for a run that is resumed, the case of which can no longer be changed.
const RESUMED_REMEDY: &str = "give it more, in a queue for example with `--mem`";

/// Least number of steps from one slip event to the next, for a slider that is driven at an edge. The least
/// measured number is 175.
const STEPS_OF_EVENT: u64 = 50;

/// Numbers of blocks, snapshots, rows etc. that determine the memory and disk space of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Blocks of the rows that this process holds.
    blocks: f64,
    /// Numbers per block in the model, and with the kernel that steps it on one thread.
    numbers: [f64; 2],
    /// Ratio of the memory of the kernel to its memory on one thread.
    bands: f64,
    /// Bytes of masks and heights while they are laid over the lattice.
    laid: f64,
    /// Whether the lattice is shared by several ranks.
    is_shared: bool,
    /// Ranks on this machine.
    ranks_on_node: f64,
    /// Blocks of the whole lattice, and numbers per block in a checkpoint.
    all_blocks: f64,
    columns: f64,
    /// Number of blocks with recorded fields: of this process, and of the whole lattice.
    cells: [f64; 2],
    frames: f64,
    fields: f64,
    rows: f64,
    /// Slip events of a slider that is driven at an edge.
    events_at_edge: f64,
    /// Slip events in the catalogue.
    events: f64,
    /// Places times instants of the kymograph.
    kymograph: f64,
    /// Pictures of the movie.
    movie: f64,
    /// Bytes per block in the file of the last state.
    state: f64,
    /// Bytes of the files that the case reads.
    inputs: f64,
}

/// A part of the memory and disk space of a run.
struct Part {
    /// The key of the case that causes the use.
    key: &'static str,
    /// Number and kind of the items that take the bytes.
    what: fn(&Budget) -> String,
    /// Change by which the run takes less.
    remedy: &'static str,
    /// Bytes in memory, in files, and in a checkpoint.
    bytes: fn(&Budget) -> [f64; 3],
}

/// The parts that depend on a key of the case.
const PARTS: [Part; 6] = [
    Part {
        key: "slider.blocks",
        what: |budget| count(budget.blocks as usize, "block"),
        remedy: "lower `slider.blocks`",
        bytes: |budget| {
            [
                // Includes the displacements of the driven ends, from which the last displacements count.
                budget.blocks * (NUMBER * budget.numbers[1] * budget.bands + 1.5 * budget.state),
                26.0 * budget.cells[1] + budget.state * budget.all_blocks,
                budget.all_blocks * NUMBER * budget.columns,
            ]
        },
    },
    Part {
        key: "output.snapshots",
        what: |budget| {
            format!(
                "{} of {}",
                count(budget.frames as usize, "snapshot"),
                count(budget.fields as usize, "field")
            )
        },
        remedy: "use fewer `output.snapshots` or `output.fields`, or increase `output.stride`",
        bytes: |budget| {
            let [own, all] = budget.snapshots();
            [own, all, all]
        },
    },
    Part {
        key: "output.series",
        what: |budget| format!("{} of the series", count(budget.rows as usize, "row")),
        remedy: "raise `output.series`",
        bytes: |budget| [750.0, 400.0, 200.0].map(|bytes| bytes * budget.rows),
    },
    Part {
        key: "drive.attach",
        what: |budget| count(budget.events_at_edge as usize, "slip event"),
        remedy: "shorten the run",
        bytes: |budget| [500.0, 250.0, 250.0].map(|bytes| bytes * budget.events_at_edge),
    },
    Part {
        key: "output.events",
        what: |budget| count(budget.events as usize, "slip event"),
        remedy: "shorten the run, or leave `output.events` out",
        bytes: |budget| {
            // The path from which the slip of each block is counted.
            let paths = when(budget.events > 0.0, NUMBER * budget.blocks);
            let events = budget.events;
            [800.0 * events + paths, 300.0 * events, 80.0 * events]
        },
    },
    Part {
        key: "texture",
        what: |_| "the files that it reads".to_owned(),
        remedy: "scale them down, or use fewer",
        bytes: |budget| [budget.laid, budget.inputs, 0.0],
    },
];

/// Places in which a run takes bytes, in the order of [`Part::bytes`].
#[derive(Clone, Copy)]
enum Place {
    Memory,
    Files,
    Checkpoint,
}

impl Budget {
    /// Memory of a small case, below which neither making the case nor running it from Python is compared
    /// with the machine: querying the free memory takes longer than making a small case. Commands compare the
    /// whole memory of a run.
    pub const SMALL: f64 = 64.0 * MIB;

    /// The budget of a model, without results, for a process that holds these rows.
    pub(super) fn of_model(
        lattice: &Lattice,
        rows: &Range<usize>,
        ranks: &Ranks,
        file: &CaseFile,
        friction: &Friction,
    ) -> Self {
        let blocks = (lattice.nx * rows.len()) as f64;
        let shapes = || file.texture.iter().map(|texture| &texture.shape);
        let masks = shapes().filter(|shape| !shape.has_outline()).count();
        let has_heights = shapes().any(|shape| matches!(shape, Shape::HeightMap(_)));
        // The mean heights are computed over the whole lattice.
        let heights = when(has_heights, 3.0 * NUMBER);
        let shares = when(file.shares_load_nearby(), SHARED * NUMBER);
        Self {
            blocks,
            numbers: numbers_of_block(file, friction),
            bands: match kernel(file, friction) {
                Kernel::Fused => 1.0,
                Kernel::General => BANDS,
            },
            laid: blocks * masks as f64 + lattice.n_blocks() as f64 * (heights + shares),
            is_shared: ranks.communicator.size() > 1,
            ranks_on_node: ranks.on_node as f64,
            ..Self::default()
        }
    }

    /// The budget with the results of a run of `last_step` steps, and with the files that the case reads.
    pub(super) fn with_results(
        self,
        file: &CaseFile,
        model: &Model,
        output: &Output,
        last_step: u64,
        inputs: &[Input],
    ) -> Self {
        let lattice = &model.lattice;
        // The number of steps in which a held drive stops is not known in advance. Two events are separated
        // by a step without slip, in which the drive moves.
        let (most_steps, most_events) = if model.drive.is_held() {
            (u64::MAX, last_step.saturating_add(1))
        } else {
            (last_step, last_step / 2 + 1)
        };
        let kept = |indices: Range<usize>| frames::kept(indices, output.stride).len() as f64;
        let columns = kept(0..lattice.nx);
        let frames = output.max_snapshots(last_step) as f64;
        Self {
            all_blocks: lattice.n_blocks() as f64,
            columns: (model.n_columns() + usize::from(file.output.events)) as f64,
            cells: [columns * kept(model.rows.clone()), columns * kept(0..lattice.ny)],
            frames,
            fields: output.fields.len() as f64,
            rows: (last_step / output.series_stride) as f64 + 2.0,
            events_at_edge: when(
                file.drive.edge().is_some(),
                last_step.div_ceil(STEPS_OF_EVENT) as f64,
            ),
            events: when(file.output.events, most_events.min(Events::MAX as u64) as f64),
            kymograph: Kymograph::max_counts(lattice, most_steps) as f64,
            movie: when(output.movie, frames),
            state: when(output.final_state, 4.0 * NUMBER),
            inputs: inputs.iter().map(|input| input.length as f64).sum(),
            ..self
        }
    }

    /// Bytes of the snapshots, of this process and of the whole lattice.
    fn snapshots(&self) -> [f64; 2] {
        self.cells
            .map(|cells| self.frames * (256.0 + self.fields * (64.0 + 4.0 * cells)))
    }

    /// Bytes in a place, including those that do not depend on any key of the case.
    fn total(&self, place: Place) -> f64 {
        let beside = match place {
            Place::Memory => RESULTS + 24.0 * self.kymograph + self.gathered(),
            // Six maps, with six bytes per block.
            Place::Files => {
                let maps = 36.0 * self.cells[1].min(MAP_BLOCKS);
                FILES + maps + 4.0 * self.kymograph + MOVIE_FILE * self.movie
            }
            Place::Checkpoint => RESULTS + 8.0 * self.kymograph,
        };
        let parts = PARTS.iter().map(|part| (part.bytes)(self)[place as usize]);
        parts.sum::<f64>() + beside
    }

    /// Bytes for the blocks of other ranks that the first rank gathers.
    fn gathered(&self) -> f64 {
        let [numbers, most] = GATHERED;
        when(self.is_shared, NUMBER * numbers * self.all_blocks.min(most))
    }

    /// Bytes for drawing pictures and movie, in addition to those of the run, which has released its
    /// snapshots.
    fn drawing(&self) -> f64 {
        let ([_, cells], [snapshots, _]) = (self.cells, self.snapshots());
        let more = memory_of_movie(self.movie, cells) - snapshots;
        PICTURES + when(self.movie > 0.0, more.max(0.0))
    }

    /// Memory for making the case, in bytes.
    pub fn making(&self) -> f64 {
        self.blocks * NUMBER * self.numbers[0] + self.laid
    }

    /// Memory for stepping the model on one thread, without results, in bytes.
    pub fn stepping(&self) -> f64 {
        self.blocks * NUMBER * self.numbers[1] + self.laid
    }

    /// Memory of one of several simultaneous runs without that of the program, each on one thread, in bytes.
    /// `writes` is whether it writes files and draws pictures.
    pub fn beside_others(&self, writes: bool) -> f64 {
        let on_one_thread = Self { bands: 1.0, ..*self };
        on_one_thread.of_run(writes)
    }

    /// Memory of a run without that of the program, in bytes.
    fn of_run(&self, writes: bool) -> f64 {
        self.total(Place::Memory) + when(writes, self.drawing())
    }

    /// Memory of a run with its files and pictures, in bytes; per rank if there are several.
    pub fn memory(&self) -> f64 {
        PROGRAM + self.of_run(true)
    }

    /// Bytes of all ranks on this machine. The first one draws.
    fn on_node(&self) -> f64 {
        self.memory() + (self.ranks_on_node - 1.0) * (PROGRAM + self.of_run(false))
    }

    /// Disk space for the files of a run, in bytes.
    pub fn disk(&self) -> f64 {
        self.total(Place::Files)
    }

    /// Disk space for the snapshots alone, in bytes.
    pub fn disk_of_snapshots(&self) -> f64 {
        let [_, all] = self.snapshots();
        all
    }

    /// Disk space for checkpoints during the run, in bytes: the latest, the one before it, and the one that
    /// is being written.
    pub fn disk_of_checkpoints(&self) -> f64 {
        3.0 * self.total(Place::Checkpoint)
    }

    /// Refuses a case if there is too little memory to make it, or to run it if it is made for a run. No
    /// array has been allocated yet.
    pub(super) fn check_case(&self, file: &CaseFile, to_run: bool) -> Result<(), CaseError> {
        let (whose, budget) = if to_run {
            (RUN, *self)
        } else {
            let made = Self {
                numbers: [self.numbers[0]; 2],
                bands: 1.0,
                ..*self
            };
            ("this case", made)
        };
        if self.ranks_on_node * budget.of_run(false) < Self::SMALL {
            return Ok(());
        }
        budget.compare(file, whose, None, 0.0, available_memory())
    }

    /// Refuses a run, or the resumption of one if `is_resumed`, that needs more memory than there is. The
    /// models of all ranks are already in memory.
    ///
    /// # Errors
    /// A sentence with both figures, the cause of the largest part, and the key to change.
    pub fn check_memory(&self, file: &CaseFile, is_resumed: bool) -> Result<(), CaseError> {
        let made = self.blocks * NUMBER * self.numbers[0];
        let (whose, remedy) = if is_resumed {
            ("resuming this run", Some(RESUMED_REMEDY))
        } else {
            (RUN, None)
        };
        self.compare(file, whose, remedy, made, available_memory())
    }

    /// Refuses a demand for more memory than there is: each rank has already taken `had` bytes, and another
    /// `available` bytes are free. The message names `whose` memory it is, and the `remedy`, by default that
    /// of the largest part.
    fn compare(
        &self,
        file: &CaseFile,
        whose: &str,
        remedy: Option<&'static str>,
        had: f64,
        available: Option<f64>,
    ) -> Result<(), CaseError> {
        let (of_rank, on_node) = (self.memory(), self.on_node());
        let available = available.map(|available| available + self.ranks_on_node * had);
        let bound = match available {
            Some(available) if on_node > available => {
                format!("{} are available", byte_size(available))
            }
            _ if !can_be_had(of_rank - had) => "the system gives less at once (see `ulimit -v`)".to_owned(),
            _ => return Ok(()),
        };
        let (each, or) = if self.is_shared {
            (" per rank", ", or share it among more machines")
        } else {
            ("", "")
        };
        let together = match self.ranks_on_node {
            1.0 => String::new(),
            ranks => format!(", {} for the {ranks} ranks of this machine", byte_size(on_node)),
        };
        let (part, most) = self.most(Place::Memory);
        let (needed, remedy) = (byte_size(of_rank), remedy.unwrap_or(part.remedy));
        let sentence = format!(
            "{whose} needs about {needed} of memory{each} ({most}){together}, but {bound}: {remedy}{or}"
        );
        Err(file.source.error(part.key, sentence))
    }

    /// Refuses a run if its files, and its checkpoints if it saves any, do not fit into `folder`, which need
    /// not exist yet. `replaced` bytes in this folder will be freed first.
    ///
    /// # Errors
    /// A sentence with both figures, the largest cause, and the key to change.
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
        let of_checkpoints = when(checkpoints, self.disk_of_checkpoints());
        if self.disk() + of_checkpoints <= free {
            return Ok(());
        }
        let (beside, without) = if checkpoints {
            (
                format!(" and its checkpoints {}", byte_size(of_checkpoints)),
                ", run without checkpoints (--checkpoint off)",
            )
        } else {
            (String::new(), "")
        };
        let (part, most) = self.most(Place::Files);
        let sentence = format!(
            "the files of this run need about {} ({most}){beside}, but {} are free in {}: free some, {}{without}, or choose another \
             folder",
            byte_size(self.disk()),
            byte_size(free),
            folder.display(),
            part.remedy
        );
        Err(file.source.error(part.key, sentence))
    }

    /// The largest part of the bytes in a place, and its bytes in words.
    fn most(&self, place: Place) -> (&'static Part, String) {
        let bytes_of = |part: &Part| (part.bytes)(self)[place as usize];
        let [first, others @ ..] = &PARTS;
        let larger = |most, part| {
            if bytes_of(part) >= bytes_of(most) {
                part
            } else {
                most
            }
        };
        let most = others.iter().fold(first, larger);
        let words = format!("{} of it for {}", byte_size(bytes_of(most)), (most.what)(self));
        (most, words)
    }
}

/// A number if something is so, else 0.
fn when(is_so: bool, number: f64) -> f64 {
    if is_so { number } else { 0.0 }
}

/// Memory for making a movie of this many pictures of at most `cells` blocks, in bytes. Larger lattices are
/// averaged to maps.
pub fn memory_of_movie(pictures: f64, cells: f64) -> f64 {
    MOVIE + pictures * (1e5 + 4.0 * cells.min(MAP_BLOCKS))
}

/// Numbers per block in the model of a case file, and with the kernel that steps it on one thread.
fn numbers_of_block(file: &CaseFile, friction: &Friction) -> [f64; 2] {
    let (slider, load, needs) = (&file.slider, &file.load, friction.needs());
    let has_outline = slider.outline != Outline::Rectangle;
    let has_pressures = load.profile.is_some() || load.pressure_field.is_some() || file.shares_load_nearby();
    let varies = [
        slider.stiffness_field.is_some() || slider.stiffness_grade.is_some(),
        slider.density_field.is_some() || slider.density_grade.is_some(),
        file.drive.attached != Attached::At(AttachedEdge::All),
        load.shear_field.is_some(),
    ];
    let many = |options: &[bool]| options.iter().filter(|is_used| **is_used).count() as f64;
    let own = 2.0 * many(&varies) + 2.0 * many(&[has_outline, has_pressures]);
    let stepped = match kernel(file, friction) {
        Kernel::Fused if varies.contains(&true) || needs.varies => 22.0 + 2.0 * many(&varies[3..]),
        Kernel::Fused => 10.0 + own,
        Kernel::General => 29.0 + when(own > 0.0, 9.0) + when(is_viscous(file), 12.0),
    };
    let is_bulk = slider.body == Body::Bulk;
    let stepped = stepped + when(is_bulk, NUMBERS_OF_BODY) + 2.0 * needs.columns as f64;
    // The search for the strength of a bulk body has a simulation of its own, and its last rest.
    let searched = when(is_bulk && file.drive.loading == Loading::Held, stepped + 7.0);
    // While a kernel is made, the state of the case exists twice.
    let state = when(!file.initial.is_at_rest(), 4.0);
    [3.0 + own + state, stepped + 2.0 * state + searched]
}

/// Numbers per block of the whole lattice while the load of textured blocks is shared among nearby blocks:
/// two marks, pressures as numbers and as bits, and sums of counts and of shares.
const SHARED: f64 = 6.0;

/// Numbers per block of a bulk body: displacements and forces of the whole lattice, its response, and two
/// complex arrays of a transform.
const NUMBERS_OF_BODY: f64 = 13.0;

/// Ratio of the memory of the general kernel on several threads to that on one: each thread also has the rows
/// next to its own.
const BANDS: f64 = 1.3;

fn is_viscous(file: &CaseFile) -> bool {
    file.slider.viscosity_time_star > 0.0
}

/// The kernel that computes the model of a case file.
fn kernel(file: &CaseFile, friction: &Friction) -> Kernel {
    if file.slider.body == Body::Bulk {
        return Kernel::General;
    }
    Kernel::default().for_law(friction, is_viscous(file), file.drive.motion == Motion::Rotation)
}

#[cfg(test)]
mod tests {
    use slipfront::testing::Threads;

    use super::*;
    use crate::case::Case;

    fn case(sets: &[&str]) -> Case {
        let overrides: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        Case::parse("", "case", "", &overrides).unwrap()
    }

    /// Message with which a new run with this budget is refused, if it is refused.
    fn refusal(case: &Case, budget: &Budget, had: f64, available: Option<f64>) -> Option<String> {
        let compared = budget.compare(&case.file, RUN, None, had, available);
        compared.err().map(|error| error.to_string())
    }

    #[test]
    fn what_takes_the_most_is_named_with_its_remedy() {
        for (sets, key, words) in [
            (
                vec!["slider.blocks=[2000,2000]", "output.snapshots=[]"],
                "slider.blocks",
                ["MiB of it for 4000000 blocks", "lower `slider.blocks`"],
            ),
            (
                vec!["slider.blocks=[100,100]", "output.snapshots={every=0.1}"],
                "output.snapshots",
                ["for 2674 snapshots of 5 fields", "increase `output.stride`"],
            ),
            (
                vec!["output.series=0.1", "time.duration_star=1e6"],
                "output.series",
                ["for 10000002 rows of the series", "raise `output.series`"],
            ),
        ] {
            let case = case(&sets);
            let refused = refusal(&case, &case.budget, 0.0, Some(2e8)).unwrap();
            // The place of the error is the override of the key.
            assert!(refused.starts_with(&format!("--set {key}=")), "{key}: {refused}");
            for word in ["but 190.7 MiB are available"].iter().chain(&words) {
                assert!(refused.contains(word), "{word}: {refused}");
            }
            assert!(!refused.contains("rank"), "{refused}");
        }
    }

    /// Ranks share the memory of a run: four ranks, two of them on this machine.
    #[test]
    fn ranks_share_what_a_run_takes() {
        let overrides = ["slider.blocks=[2000,2000]", "output.snapshots={every=20}"].map(str::to_owned);
        let made = |communicator: &Threads, on_node| {
            let ranks = Ranks {
                communicator,
                on_node,
            };
            let file = CaseFile::parse("", "case", &overrides).unwrap();
            Case::to_run(file, "case", Path::new(""), &mut |_| true, ranks).unwrap()
        };
        let alone = case(&["slider.blocks=[2000,2000]", "output.snapshots={every=20}"]).budget;
        let cases = Threads::run(4, |communicator| made(communicator, 2));
        // Memory per process that does not depend on the number of blocks.
        let mut none = alone;
        (none.blocks, none.cells) = (0.0, [0.0; 2]);
        let beside = none.of_run(false);
        let shared = cases
            .iter()
            .map(|case| case.budget.of_run(false) - case.budget.gathered() - beside);
        assert_eq!(shared.sum::<f64>(), alone.of_run(false) - beside);
        for case in &cases {
            assert_eq!(case.budget.disk(), alone.disk());
            assert_eq!(case.budget.disk_of_checkpoints(), alone.disk_of_checkpoints());
        }
        // While one rank draws, the other still has the memory of its run.
        let budget = cases[0].budget;
        let needed = budget.on_node();
        assert_eq!(needed, 2.0 * budget.memory() - budget.drawing());
        assert_eq!(refusal(&cases[0], &budget, 0.0, Some(needed)), None);
        assert_eq!(refusal(&cases[0], &budget, 1e6, Some(needed - 2e6)), None);
        let refused = refusal(&cases[0], &budget, 1e6, Some(needed - 3e6)).unwrap();
        for word in [
            " of memory per rank (",
            &format!(", {} for the 2 ranks of this machine, but ", byte_size(needed)),
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

    /// Memory that this process has already taken counts as available: the case itself is in memory when its
    /// run is checked.
    #[test]
    fn what_has_been_taken_already_counts_as_available() {
        let case = case(&["slider.blocks=[2000,1000]", "output.snapshots=[]"]);
        let budget = case.budget;
        let made = budget.making();
        let enough = budget.memory() - made;
        assert_eq!(refusal(&case, &budget, made, Some(enough)), None);
        assert!(refusal(&case, &budget, made, Some(0.99 * enough)).is_some());
        // If the system does not report its free memory, the whole amount is allocated as a test.
        assert_eq!(refusal(&case, &budget, made, None), None);
        let mut huge = budget;
        huge.blocks = 1e16;
        let refused = refusal(&case, &huge, 0.0, None).unwrap();
        assert!(refused.contains("ulimit -v"), "{refused}");
        // No key of a run that has begun can be changed.
        let refused = budget.compare(&case.file, RUN, Some(RESUMED_REMEDY), made, Some(0.0));
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.contains("give it more") && !refused.contains("lower"),
            "{refused}"
        );
    }

    /// The kernel that the budget assumes before there is a model is the one that computes the model.
    #[test]
    fn the_kernel_is_that_of_the_model() {
        for set in [
            "friction.mu_static=0.5",
            "friction.law='reversal'",
            "friction={velocity={law='weakening',v_c_star=0.1,ratio=0.5}}",
            "friction={ageing={law='logarithmic',beta=0.1,time_star=1}}",
            "friction={contact='springs',contact_stiffness_star=0.1}",
            "friction={law='rate_and_state',a=0.01,b=0.02,d_c_star=0.5,v_0_star=0.03}",
            "slider.viscosity_time_star=0.1",
            "slider.outline='disc'",
            "slider.stiffness_grade={along='x',from=1,to=2}",
            "slider.density_grade={along='y',from=1,to=2}",
            "drive.attach='left'",
            "drive.motion='rotation'",
            "load.profile={along='x',relative_slope=0.5}",
            "load.shear_star=0.5",
        ] {
            let case = case(&[set]);
            let friction = case.file.friction.in_model(case.groups.v_star, &case.scales, 0.0);
            assert_eq!(friction, case.model.friction, "{set}");
            let kernel = kernel(&case.file, &friction);
            assert_eq!(Kernel::default().for_model(&case.model), kernel, "{set}");
        }
    }

    #[test]
    fn the_machine_says_what_it_has() {
        let folder = tempfile::tempdir().unwrap();
        let there = free_disk(folder.path()).unwrap();
        assert!(there > 0.0);
        // For a folder that does not exist yet, the nearest existing parent counts.
        assert!(free_disk(&folder.path().join("not/yet/there")).is_some());
        // This test itself needs some memory.
        assert!(available_memory().is_none_or(|bytes| bytes > PROGRAM));
    }
}
