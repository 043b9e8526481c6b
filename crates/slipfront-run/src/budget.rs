//! Memory and disk space that a run needs with its files and pictures, known before it begins and compared with the memory
//! and disk of the machine.
//!
//! The parts of a [`RunBudget`] are a table of causes and their bytes: the owners of arrays, files and pictures state the
//! bytes of a block, a cell, a row or a picture. Memory is that of the largest of three phases: a case is made, it is run
//! and its results are written, its pictures are drawn. Each of several ranks takes memory for its own rows, and the ranks
//! of a machine share its memory.

use std::ops::Range;
use std::path::Path;

use slipfront::observe::{CurveRow, Frame, KineticHistory, Kymograph, Precursors, SlipEvent, frames};
use slipfront_base::machine::{available_memory, free_disk};
use slipfront_base::number_format::{byte_size, count};
use slipfront_case::case::{Budget, Case, Cause, Demand, PROGRAM};
use slipfront_case::case_file::{CaseError, CaseFile, names_of};

use crate::fields::{SHARE_BYTES, STATIC_BYTES, WORKING_SHARE_BYTES, record_bytes};
use crate::observers::precursors::PrecursorRow;
use crate::series::COLUMN_BYTES;
use crate::{front, series};

/// Bytes of a number of a block.
const NUMBER: f64 = size_of::<f64>() as f64;

/// Bytes of the files of all pictures without those of maps, of the summary and of the manifest (measured: at most 0.7 MB).
const FILE_BYTES: f64 = 2e6;

/// Bytes of the pictures of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct PictureBytes {
    /// Bytes of the cells of the lattice while maps are read.
    pub(crate) cells: f64,
    /// Bytes of the values of all maps, or of all pictures of the movie.
    pub(crate) snapshots: f64,
    /// Bytes for each row of the series.
    pub(crate) row: f64,
    /// Bytes of the two pictures that are drawn at once.
    pub(crate) two: f64,
    /// Bytes of the pictures of the movie that are drawn at once.
    pub(crate) batch: f64,
    /// Bytes of the files of maps and movie.
    pub(crate) files: f64,
}

/// Memory and disk space that a run needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunBudget {
    /// Memory for making and stepping the case.
    case: Budget,
    /// Bytes of a block in a checkpoint.
    saved: f64,
    /// Blocks of this process whose fields are kept.
    cells: f64,
    /// Blocks of the whole lattice.
    all_blocks: f64,
    /// Blocks of the whole lattice whose fields are kept.
    pub(crate) all_cells: f64,
    pub(crate) frames: f64,
    fields: f64,
    rows: f64,
    /// Bytes of a row in its file.
    row_text: f64,
    /// Number of events of slip of a slider that is driven at an edge.
    events: f64,
    /// Number of places times instants of the kymograph.
    kymograph: f64,
    pub(crate) pictures: PictureBytes,
    /// Whether the run resumes from a checkpoint.
    is_resumed: bool,
}

/// A part of the memory or disk space of a run.
struct Part {
    /// Function that makes the words of the cause, called for a refusal alone because many small cases are judged.
    cause: fn(&RunBudget) -> Cause,
    /// Bytes in each [`Phase`].
    bytes: [f64; 5],
}

/// The phases of a run that take memory, then the parts of its disk space.
#[derive(Clone, Copy, Debug)]
enum Phase {
    Making,
    /// Running; memory for writing files is less than the kernel's share for the blocks.
    Running,
    /// Drawing two pictures at once, by the first of several ranks.
    Drawing,
    Files,
    /// A checkpoint: blocks, snapshots and rows as they stand in memory, of all ranks.
    Checkpoint,
}

impl RunBudget {
    /// The budget of a run of a case without its pictures, for the rows that this process holds. The budget with pictures is
    /// `pictures::run_budget`.
    pub fn without_pictures(case: &Case) -> Self {
        let (model, output, last_step) = (&case.model, &case.output, case.time_plan.last_step);
        let lattice = &model.lattice;
        // How often a held drive stands is not known before.
        let most_steps = if model.drive.is_held() {
            u64::MAX
        } else {
            last_step
        };
        let kept = |indices: Range<usize>| frames::kept(indices, output.stride).len() as f64;
        let n_frames = output.max_snapshots(last_step) as f64;
        Self {
            case: case.budget,
            saved: model.n_columns() as f64 * NUMBER,
            cells: kept(0..lattice.nx) * kept(model.rows.clone()),
            all_blocks: lattice.n_blocks() as f64,
            all_cells: kept(0..lattice.nx) * kept(0..lattice.ny),
            frames: n_frames,
            fields: output.fields.len() as f64,
            rows: (last_step / output.series_stride) as f64 + 2.0,
            row_text: (COLUMN_BYTES * series::n_columns(&case.scales, model)) as f64,
            events: match case.file.drive.edge() {
                Some(_) => Precursors::expected_events(last_step) as f64,
                None => 0.0,
            },
            kymograph: Kymograph::max_counts(lattice, most_steps) as f64,
            pictures: PictureBytes::default(),
            is_resumed: false,
        }
    }

    /// Parts of the memory and disk space, with the bytes of each in each phase.
    fn parts(&self) -> [Part; 5] {
        let (blocks, all_cells, pictures) = (self.case.blocks, self.all_cells, &self.pictures);
        let (frames, fields, rows) = (self.frames, self.fields, self.rows);
        let frame = Frame::bytes(fields as usize) as f64;
        let snapshots =
            |cells: f64| frames * fields * cells * Frame::VALUE_BYTES as f64 + Budget::grown(frames) * frame;
        let row = size_of::<CurveRow>() as f64;
        let (event, event_columns) = (
            size_of::<SlipEvent>() as f64,
            names_of::<PrecursorRow>().len() as f64,
        );
        let event_text = COLUMN_BYTES as f64 * event_columns;
        [
            Part {
                cause: |budget| budget.case.cause_of_blocks(),
                bytes: [
                    blocks * self.case.surface,
                    self.case.stepping(),
                    // With the time of its first slip.
                    blocks * (self.case.surface + NUMBER) + pictures.cells,
                    all_cells * STATIC_BYTES as f64,
                    self.all_blocks * self.saved,
                ],
            },
            Part {
                cause: |budget| Cause {
                    key: "output.snapshots",
                    what: format!(
                        "{} of {}",
                        count(budget.frames as usize, "snapshot"),
                        count(budget.fields as usize, "field")
                    ),
                    remedy: "take fewer `output.snapshots`, name fewer `output.fields`, or raise `output.stride`",
                },
                bytes: [
                    0.0,
                    snapshots(self.cells),
                    pictures.snapshots,
                    frames * record_bytes(fields, all_cells) + pictures.files,
                    snapshots(all_cells),
                ],
            },
            Part {
                cause: |budget| Cause {
                    key: "output.series",
                    what: format!("{} of the series", count(budget.rows as usize, "row")),
                    remedy: "raise `output.series`",
                },
                bytes: [
                    0.0,
                    Budget::grown(rows) * row + rows * self.row_text,
                    Budget::grown(rows) * (row + pictures.row),
                    rows * self.row_text,
                    rows * row,
                ],
            },
            Part {
                cause: |budget| Cause {
                    key: "drive.attach",
                    what: count(budget.events as usize, "slip event"),
                    remedy: "shorten the run",
                },
                bytes: [
                    0.0,
                    Budget::grown(self.events) * event + Budget::grown(self.events * event_text),
                    // As numbers, then as points.
                    Budget::grown(self.events) * (event_columns + 4.0) * NUMBER,
                    self.events * event_text,
                    self.events * event_text,
                ],
            },
            Part {
                cause: |_| Budget::cause_of_inputs(),
                bytes: [self.case.laid, 0.0, 0.0, self.case.inputs, 0.0],
            },
        ]
    }

    /// Bytes of a phase, including those that no key of a case changes.
    fn total(&self, phase: Phase) -> f64 {
        let counts = Budget::grown(self.kymograph) * Kymograph::COUNT_BYTES as f64;
        let working_shares = self.kymograph * WORKING_SHARE_BYTES as f64;
        let history = KineticHistory::MAX_BYTES as f64;
        let fixed = [
            0.0,
            history + counts + working_shares,
            (self.pictures.two + working_shares).max(self.pictures.batch),
            FILE_BYTES + self.kymograph * SHARE_BYTES as f64,
            history + counts,
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

    /// Bytes of a rank in a phase; the first of several also holds numbers of the others' blocks.
    fn of_rank(&self, phase: Phase) -> f64 {
        let gathered = match (phase, self.case.is_shared) {
            (Phase::Running, true) => front::bytes_of_shared(self.all_blocks),
            _ => 0.0,
        };
        PROGRAM + Budget::resident(self.total(phase) + gathered)
    }

    /// Bytes of all ranks of this machine in a phase. While one draws, the others have at most the bytes of running.
    fn on_node(&self, phase: Phase) -> f64 {
        let others = match phase {
            Phase::Drawing => Phase::Running,
            phase => phase,
        };
        self.of_rank(phase) + (self.case.ranks_on_node - 1.0) * self.of_rank(others)
    }

    /// Memory of a run with its files and pictures, in bytes; memory of each rank if there are several.
    pub fn memory(&self) -> f64 {
        self.of_rank(self.largest(true))
    }

    /// Memory of one of several runs at once, each on one thread, in bytes; `writes` tells whether it writes files.
    pub fn memory_beside_others(&self, writes: bool) -> f64 {
        let mut on_one_thread = *self;
        on_one_thread.case.bands = 0.0;
        on_one_thread.of_rank(on_one_thread.largest(writes)) - PROGRAM
    }

    /// The budget of the run when it resumes from a checkpoint, which the kernel takes over without a copy.
    pub fn resumed(mut self) -> Self {
        self.is_resumed = true;
        self
    }

    /// Disk space for the files of a run, in bytes.
    pub fn disk(&self) -> f64 {
        self.total(Phase::Files)
    }

    /// Disk space for the snapshots alone, in bytes.
    pub fn disk_of_snapshots(&self) -> f64 {
        let [_, snapshots, ..] = self.parts();
        snapshots.bytes[Phase::Files as usize]
    }

    /// Disk space for checkpoints while the run goes on, in bytes: the latest one, the one before it, and one that is being
    /// written.
    pub fn disk_of_checkpoints(&self) -> f64 {
        3.0 * self.total(Phase::Checkpoint)
    }

    /// Refuses a run, new or resumed, that needs more memory than there is; surface and slider of all ranks are in memory
    /// already.
    ///
    /// # Errors
    /// A sentence with both figures, the cause of the largest part, and the key to change.
    pub fn check_memory(&self, file: &CaseFile) -> Result<(), CaseError> {
        let made = self.case.blocks * self.case.surface;
        self.compare_memory(file, made, available_memory())
    }

    /// Compares the memory of the run: `had` bytes were taken by each rank already, `available` bytes are free beside them.
    fn compare_memory(&self, file: &CaseFile, had: f64, available: Option<f64>) -> Result<(), CaseError> {
        let phase = self.largest(true);
        let (mut cause, bytes) = self.most(phase);
        let whose = if self.is_resumed {
            // The case of a run that resumes can be changed no more.
            cause.remedy = "give it more, in a queue for example with `--mem`";
            "going on with this run"
        } else {
            "a run of this case"
        };
        let demand = Demand {
            file,
            whose,
            most: (cause, bytes),
            of_rank: self.of_rank(phase),
            on_node: self.on_node(phase),
            had,
        };
        self.case.compare(demand, available)
    }

    /// Refuses a run whose files, and checkpoints if it saves any, have no room in `folder`, which need not exist yet.
    /// `replaced` is what goes from there before.
    ///
    /// # Errors
    /// A sentence with both figures, what most of it is for, and the key to change.
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
        let (beside, without) = if checkpoints {
            (
                format!(" and its checkpoints {}", byte_size(beside)),
                ", run without checkpoints (--checkpoint off)",
            )
        } else {
            (String::new(), "")
        };
        let (cause, bytes) = self.most(Phase::Files);
        let sentence = format!(
            "the files of this run take about {} ({}){beside} where {} are free in {}: free some, {}{without}, \
             or choose another folder",
            byte_size(self.disk()),
            cause.in_words(bytes),
            byte_size(free),
            folder.display(),
            cause.remedy
        );
        Err(file.source.error(cause.key, sentence))
    }

    /// Cause of the largest part of the bytes of a phase, and its bytes.
    fn most(&self, phase: Phase) -> (Cause, f64) {
        let bytes_of = |part: &Part| part.bytes[phase as usize];
        let [mut most, others @ ..] = self.parts();
        for part in others {
            if bytes_of(&part) >= bytes_of(&most) {
                most = part;
            }
        }
        let bytes = bytes_of(&most);
        ((most.cause)(self), bytes)
    }
}

#[cfg(test)]
mod tests {
    use slipfront::testing::Threads;
    use slipfront_case::case::Ranks;

    use super::*;

    fn case(sets: &[&str]) -> Case {
        let overrides: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        Case::parse("", "case", "", &overrides).unwrap()
    }

    /// The budget of a run whose pictures take some bytes.
    fn budget_of(case: &Case) -> RunBudget {
        let pictures = PictureBytes {
            cells: 1e6,
            snapshots: 1e6,
            row: 64.0,
            two: 2e7,
            batch: 1e7,
            files: 1e6,
        };
        RunBudget {
            pictures,
            ..RunBudget::without_pictures(case)
        }
    }

    /// Reason for which a run with this budget is refused, if it is.
    fn refusal(case: &Case, budget: &RunBudget, had: f64, available: Option<f64>) -> Option<String> {
        let compared = budget.compare_memory(&case.file, had, available);
        compared.err().map(|error| error.to_string())
    }

    #[test]
    fn what_takes_the_most_is_named_with_its_remedy() {
        for (sets, key, words) in [
            (
                vec!["slider.blocks=[2000,2000]", "output.snapshots=[]"],
                "slider.blocks",
                ["277.3 MiB of it for 4000000 blocks", "lower `slider.blocks`"],
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
            let refused = refusal(&case, &budget_of(&case), 0.0, Some(2e8)).unwrap();
            // The place is the override of the key.
            assert!(refused.starts_with(&format!("--set {key}=")), "{key}: {refused}");
            for word in ["where 190.7 MiB are available"].iter().chain(&words) {
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
        let alone = budget_of(&case(&[
            "slider.blocks=[2000,2000]",
            "output.snapshots={every=20}",
        ]));
        let cases = Threads::run(4, |communicator| made(communicator, 2));
        let budgets: Vec<RunBudget> = cases.iter().map(budget_of).collect();
        // What is there once for every process: the numbers that do not belong to blocks.
        let beside = |phase: Phase| {
            let mut none = alone;
            (none.case.blocks, none.cells, none.all_cells) = (0.0, 0.0, 0.0);
            none.total(phase)
        };
        for phase in [Phase::Making, Phase::Running] {
            let shared: f64 = budgets
                .iter()
                .map(|budget| budget.total(phase) - beside(phase))
                .sum();
            assert_eq!(shared, alone.total(phase) - beside(phase), "{phase:?}");
        }
        for budget in &budgets {
            for phase in [Phase::Files, Phase::Checkpoint] {
                assert_eq!(budget.total(phase), alone.total(phase), "{phase:?}");
            }
            assert_eq!(budget.disk(), alone.disk());
            assert_eq!(budget.disk_of_checkpoints(), alone.disk_of_checkpoints());
        }
        let budget = budgets[0];
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
        let refused = refusal(&spread[3], &budget_of(&spread[3]), 0.0, Some(1e6)).unwrap();
        assert!(
            refused.contains(" of memory per rank (") && !refused.contains("ranks"),
            "{refused}"
        );
    }

    /// Memory that has been taken already counts as available: the case itself is in memory when its run is judged.
    #[test]
    fn what_has_been_taken_already_counts_as_available() {
        let case = case(&["slider.blocks=[2000,1000]", "output.snapshots=[]"]);
        let budget = budget_of(&case);
        let made = budget.total(Phase::Making);
        let enough = budget.memory() - made;
        assert_eq!(refusal(&case, &budget, made, Some(enough)), None);
        assert!(refusal(&case, &budget, made, Some(0.99 * enough)).is_some());
        // A system that does not say what it has is asked for all of it.
        assert_eq!(refusal(&case, &budget, made, None), None);
        let mut huge = budget;
        huge.case.blocks = 1e16;
        let refused = refusal(&case, &huge, 0.0, None).unwrap();
        assert!(refused.contains("ulimit -v"), "{refused}");
        // Of a run that has begun no key can be changed.
        let refused = refusal(&case, &budget.resumed(), made, Some(0.0)).unwrap();
        assert!(
            refused.contains("give it more") && !refused.contains("lower"),
            "{refused}"
        );
    }
}
