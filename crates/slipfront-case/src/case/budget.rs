//! Memory and disk space that a run needs, estimated before it begins and compared with what the machine has.
//!
//! Memory is that of the largest of three phases: a case is made, it is run and its results are written, its pictures are
//! drawn. Per block of the lattice, in bytes:
//!
//! | | made | run | drawn |
//! |---|---|---|---|
//! | surface: textured, mu_s, mu_k | 17 | 17 | 17 |
//! | fused kernel: displacement, velocity, thresholds, first slip, masks and tiles | | 58 | |
//! | instead, reference kernel: state, forces, springs, thresholds, first slip | | 185 | |
//! | first slip | | | 8 |
//!
//! and per block that is kept of a field (one in `stride` along each axis) 4 for every snapshot and field, of which
//! drawing keeps the contact stress of six snapshots only. A row of the series takes 104 and its text, in arrays that
//! double as they grow, and three times 104 when it is drawn; pictures take their primitives and pixels.

use std::path::Path;

use slipfront::observe::{CurveRow, Frame};
use slipfront::{FrictionLaw, Kernel, Lattice};

use super::output::{MAX_MAPS, Output, Snapshots};
use super::time_plan::TimePlan;
use crate::case_file::{CaseError, CaseFile};
use crate::machine::{available_memory, can_be_had, free_disk};
use crate::number_format::byte_size;
use slipfront::observe::Field;

/// A number of a block.
const NUMBER: f64 = size_of::<f64>() as f64;
/// Whether a block is textured; whether it slides.
const FLAG: f64 = size_of::<bool>() as f64;

/// [`slipfront::Surface`].
const SURFACE: f64 = FLAG + 2.0 * NUMBER;
/// The fused kernel: two vectors, two thresholds, a time; masks and tiles take 1.8 together.
const FUSED: f64 = 7.0 * NUMBER + 2.0;
/// The reference kernel: two vectors of state, eight of forces, two thresholds, a time.
const REFERENCE: f64 = 23.0 * NUMBER + FLAG;
/// A block in a checkpoint: two vectors, a time.
const SAVED: f64 = 5.0 * NUMBER;
/// Room for what is read of it, which grows by an eighth at a time.
const ROOM_TO_READ: f64 = 1.125;
/// The first slips of a [`slipfront::Snapshot`].
const FIRST_SLIP: f64 = NUMBER;

/// A value of a field.
const VALUE: f64 = size_of::<f32>() as f64;
/// The texture read back, and a field while it is decoded by way of doubles.
const DECODED: f64 = FLAG + VALUE + NUMBER;
/// What never changes in the file, where textured takes 16 bits.
const STATICS_ON_DISK: f64 = 2.0 + 3.0 * NUMBER;

/// A row of `series.csv`: 13 columns of at most 24 characters and what separates them.
const ROW_TEXT: f64 = 13.0 * 25.0;
/// A row of `series.csv` in memory: 13 numbers.
const SERIES_ROW: usize = 13 * size_of::<f64>();
/// Stretches of the history of mu* and their copies while an uncertainty is sought.
const HISTORY: f64 = 1024.0 * 1024.0;

/// Primitives and pixels of the picture of the friction, and of the one of the stress. They do not depend on the
/// lattice: more than 256 cells along a side are averaged (measured: 6.8 and 6.6 MB).
const PICTURE: f64 = 7.0 * 1024.0 * 1024.0;
/// Both pictures as SVG and PNG, the summary and the manifest (measured: at most 0.7 MB).
const PICTURE_FILES: f64 = 2e6;

/// What the allocator holds of memory that has been given back, or cannot use between pieces that have not: resident
/// memory was up to 4 % above what was allocated.
const HEAP: f64 = 1.05;

/// The program itself.
pub const PROGRAM: f64 = 8.0 * 1024.0 * 1024.0;

/// Cases whose making takes less are not compared with the machine.
const SMALL: f64 = 64.0 * 1024.0 * 1024.0;

/// Memory and disk space that a run needs; the head of its file says what is counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    blocks: f64,
    /// Bytes of the kernel per block.
    kernel: f64,
    /// Blocks that are kept of a field.
    cells: f64,
    frames: f64,
    fields: f64,
    rows: f64,
    /// Whether maps are drawn.
    maps: bool,
    /// Bytes of the files that the case reads, kept for their copies.
    inputs: f64,
    /// Bytes of masks, one a pixel or block, until they are laid over the lattice.
    masks: f64,
}

/// Bytes by their purpose.
#[derive(Clone, Copy, Debug, Default)]
struct Bytes {
    blocks: f64,
    snapshots: f64,
    series: f64,
    inputs: f64,
    /// Bytes that no key of a case changes.
    fixed: f64,
}

impl Bytes {
    fn total(&self) -> f64 {
        self.blocks + self.snapshots + self.series + self.inputs + self.fixed
    }
}

/// The task that memory is needed for.
#[derive(Clone, Copy, Debug)]
enum Needs {
    /// To make the case.
    Case,
    /// To run it.
    Run,
    /// To go on from a checkpoint of it.
    Resumed,
}

/// More memory or disk space needed than there is.
#[derive(Clone, Debug, PartialEq)]
pub struct BudgetExceeded {
    /// The key of the case that most of it is due to.
    pub key: &'static str,
    /// A sentence with both figures, the cause and the remedy.
    pub sentence: String,
}

impl Budget {
    /// The budget of a run, from the parameters of its case alone.
    pub fn new(lattice: &Lattice, law: FrictionLaw, time_plan: &TimePlan, output: &Output) -> Self {
        let kept = |blocks: usize| blocks.div_ceil(output.stride) as f64;
        let last_step = time_plan.last_step;
        Self {
            blocks: lattice.nx as f64 * lattice.ny as f64,
            kernel: match Kernel::Fused.for_law(law) {
                Kernel::Fused => FUSED,
                Kernel::Reference => REFERENCE,
            },
            cells: kept(lattice.nx) * kept(lattice.ny),
            frames: match &output.snapshots {
                Snapshots::Instants => 6.0,
                Snapshots::At(steps) => steps.len() as f64,
                Snapshots::Every(every) => (last_step / every + 1) as f64,
            },
            fields: output.fields.len() as f64,
            rows: (last_step / output.series_stride) as f64 + 2.0,
            maps: output.fields.contains(&Field::ContactStress),
            inputs: 0.0,
            masks: 0.0,
        }
    }

    /// Adds a file that the case reads.
    pub fn add_input(&mut self, bytes: usize) {
        self.inputs += bytes as f64;
    }

    /// Adds a mask.
    pub fn add_mask(&mut self, pixels: usize) {
        self.masks += pixels as f64;
    }

    /// While the case is made.
    fn making(&self) -> Bytes {
        Bytes {
            blocks: self.blocks * SURFACE,
            inputs: self.inputs + self.masks,
            ..Bytes::default()
        }
    }

    /// While it runs and its files are written: what writing takes for the blocks is less than the kernel's share.
    fn running(&self) -> Bytes {
        Bytes {
            blocks: self.blocks * (SURFACE + self.kernel),
            snapshots: self.snapshots(),
            series: grown(self.rows) * size_of::<CurveRow>() as f64 + grown(self.rows * ROW_TEXT),
            inputs: self.inputs,
            fixed: HISTORY,
        }
    }

    /// While its pictures are drawn, both at once.
    fn drawing(&self) -> Bytes {
        let maps = if self.maps {
            self.frames.min(MAX_MAPS as f64)
        } else {
            0.0
        };
        let row = size_of::<CurveRow>() + 2 * SERIES_ROW + 3 * size_of::<f64>();
        Bytes {
            blocks: self.blocks * (SURFACE + FIRST_SLIP) + self.cells * DECODED,
            snapshots: maps * self.cells * VALUE,
            series: grown(self.rows) * row as f64,
            inputs: self.inputs,
            fixed: if maps > 0.0 { 2.0 * PICTURE } else { PICTURE },
        }
    }

    /// All snapshots in memory.
    fn snapshots(&self) -> f64 {
        let frame = size_of::<Frame>() as f64 + self.fields * size_of::<Vec<f32>>() as f64;
        self.frames * self.fields * self.cells * VALUE + grown(self.frames) * frame
    }

    /// The phase that takes the most.
    fn largest(&self) -> Bytes {
        [self.making(), self.running(), self.drawing()]
            .into_iter()
            .max_by(|a, b| a.total().total_cmp(&b.total()))
            .unwrap_or_default()
    }

    /// Memory of a run with its files and pictures, in bytes.
    pub fn memory(&self) -> f64 {
        PROGRAM + HEAP * self.largest().total()
    }

    /// Memory of one of several runs at once, in bytes; of one that writes no files if not `writes`.
    pub fn memory_beside_others(&self, writes: bool) -> f64 {
        let phases = if writes {
            self.largest().total()
        } else {
            self.making().total().max(self.running().total())
        };
        HEAP * phases
    }

    /// Memory of a case that is made and not run, in bytes.
    pub fn memory_of_case(&self) -> f64 {
        self.making().total()
    }

    /// The budget of the run when it resumes from a checkpoint, which is in memory until the kernel has taken it over.
    pub fn resumed(self) -> Self {
        Self {
            kernel: self.kernel + ROOM_TO_READ * SAVED,
            ..self
        }
    }

    /// Room for the files of a run, in bytes.
    pub fn disk(&self) -> f64 {
        self.files().total()
    }

    /// Disk space for the snapshots alone, in bytes.
    pub fn disk_of_snapshots(&self) -> f64 {
        self.files().snapshots
    }

    /// Room for checkpoints while the run goes on, in bytes: blocks, snapshots and rows as they stand in memory, in the
    /// latest one, the one before it, and one that is being written.
    pub fn disk_of_checkpoints(&self) -> f64 {
        let rows = self.rows * size_of::<CurveRow>() as f64;
        3.0 * (self.blocks * SAVED + self.snapshots() + rows + HISTORY)
    }

    fn files(&self) -> Bytes {
        Bytes {
            blocks: self.cells * STATICS_ON_DISK,
            snapshots: self.frames * (self.fields * self.cells * VALUE + 4.0 * NUMBER),
            series: self.rows * ROW_TEXT,
            inputs: self.inputs,
            fixed: PICTURE_FILES,
        }
    }

    /// Refuses a case that cannot even be made.
    pub fn check_making(&self) -> Result<(), BudgetExceeded> {
        if self.making().total() < SMALL {
            return Ok(());
        }
        self.compare_memory(Needs::Case, &self.making(), 0.0, available_memory())
    }

    /// Refuses a run that needs more memory than there is; what a case takes is there already if it is `made`.
    pub fn check_memory(&self, made: bool) -> Result<(), BudgetExceeded> {
        let made = if made { self.making().total() } else { 0.0 };
        self.compare_memory(Needs::Run, &self.largest(), made, available_memory())
    }

    /// Refuses to go on from a checkpoint with a case that is made, where there is less memory than that needs.
    pub fn check_memory_resumed(&self) -> Result<(), BudgetExceeded> {
        let (resumed, made) = (self.resumed(), self.making().total());
        resumed.compare_memory(Needs::Resumed, &resumed.largest(), made, available_memory())
    }

    /// `had` is what has been taken of `bytes` already, `available` what there is beside it.
    fn compare_memory(
        &self,
        needs: Needs,
        bytes: &Bytes,
        had: f64,
        available: Option<f64>,
    ) -> Result<(), BudgetExceeded> {
        let needed = PROGRAM + HEAP * bytes.total();
        let bound = match available {
            Some(available) if needed > available + had => {
                format!("{} are available", byte_size(available + had))
            }
            _ if !can_be_had(needed - had) => "the system gives less at once (see `ulimit -v`)".to_owned(),
            _ => return Ok(()),
        };
        let (key, most, remedy) = self.most(bytes);
        let (whose, remedy) = match needs {
            Needs::Case => ("this case", remedy),
            Needs::Run => ("a run of this case", remedy),
            // Its case can be changed no more.
            Needs::Resumed => (
                "going on with this run",
                "give it more, in a queue for example with `--mem`",
            ),
        };
        let sentence = format!(
            "{whose} takes about {} of memory ({most}) where {bound}: {remedy}",
            byte_size(needed)
        );
        Err(BudgetExceeded { key, sentence })
    }

    /// Refuses a run whose files, and checkpoints if it saves any, have no room in `folder`, which need not be there yet.
    /// `replaced` is what goes from there before.
    pub fn check_disk(&self, folder: &Path, replaced: u64, checkpoints: bool) -> Result<(), BudgetExceeded> {
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
        let (key, most, remedy) = self.most(&self.files());
        let (beside, without) = if checkpoints {
            let beside = format!(" and its checkpoints {}", byte_size(beside));
            (beside, ", run without checkpoints (--checkpoint off)")
        } else {
            (String::new(), "")
        };
        let sentence = format!(
            "the files of this run take about {} ({most}){beside} where {} are free in {}: free some, {remedy}{without}, \
             or choose another folder",
            byte_size(self.disk()),
            byte_size(free),
            folder.display()
        );
        Err(BudgetExceeded { key, sentence })
    }

    /// The key that most bytes are due to, how many these are and for what, and the remedy.
    fn most(&self, bytes: &Bytes) -> (&'static str, String, &'static str) {
        let Self {
            blocks,
            frames,
            fields,
            ..
        } = self;
        let parts = [
            (
                "slider.blocks",
                bytes.blocks,
                format!("{blocks} blocks"),
                "lower `slider.blocks`",
            ),
            (
                "output.snapshots",
                bytes.snapshots,
                format!("{frames} snapshots of {fields} fields"),
                "take fewer `output.snapshots`, name fewer `output.fields`, or raise `output.stride`",
            ),
            (
                "output.series",
                bytes.series,
                format!("{} rows of the series", self.rows),
                "raise `output.series`",
            ),
            (
                "texture",
                bytes.inputs,
                "the files that it reads".to_owned(),
                "scale them down",
            ),
        ];
        let most = parts.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let (key, part, what, remedy) = most.unwrap_or_default();
        (key, format!("{} of it for {what}", byte_size(part)), remedy)
    }
}

/// An exceeded budget as an error at the key that causes it.
pub(super) fn within_budget(file: &CaseFile, checked: Result<(), BudgetExceeded>) -> Result<(), CaseError> {
    checked.map_err(|excess| file.source.error(excess.key, excess.sentence))
}

/// Elements for which a vector has room that grew to `length` by doubling.
fn grown(length: f64) -> f64 {
    length.max(4.0).log2().ceil().exp2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;

    fn budget(sets: &[&str]) -> Budget {
        let overrides: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
        Case::parse("", "case", &overrides).unwrap().budget
    }

    #[test]
    fn what_takes_the_most_is_named_with_its_remedy() {
        for (sets, key, words) in [
            (
                vec!["slider.blocks=[2000,2000]", "output.snapshots=[]"],
                "slider.blocks",
                ["286.1 MiB of it for 4000000 blocks", "lower `slider.blocks`"],
            ),
            (
                vec!["slider.blocks=[100,100]", "output.snapshots={every=0.1}"],
                "output.snapshots",
                ["for 2668 snapshots of 5 fields", "raise `output.stride`"],
            ),
            (
                vec!["output.series=0.1", "time.duration_star=1e6"],
                "output.series",
                ["for 10000002 rows of the series", "raise `output.series`"],
            ),
        ] {
            let budget = budget(&sets);
            let refused = budget
                .compare_memory(Needs::Run, &budget.largest(), 0.0, Some(2e8))
                .unwrap_err();
            assert_eq!(refused.key, key);
            for word in ["where 190.7 MiB are available"].iter().chain(&words) {
                assert!(refused.sentence.contains(word), "{word}: {}", refused.sentence);
            }
        }
    }

    /// The case itself is in memory when its run is judged.
    #[test]
    fn what_has_been_taken_already_counts_as_available() {
        let budget = budget(&["slider.blocks=[2000,1000]", "output.snapshots=[]"]);
        let (run, made) = (budget.largest(), budget.making().total());
        let enough = budget.memory() - made;
        assert!(
            budget
                .compare_memory(Needs::Run, &run, made, Some(enough))
                .is_ok()
        );
        assert!(
            budget
                .compare_memory(Needs::Run, &run, made, Some(0.99 * enough))
                .is_err()
        );
        // A system that does not say what it has is asked for all of it.
        assert!(budget.compare_memory(Needs::Run, &run, made, None).is_ok());
        let all = Bytes {
            blocks: 1e18,
            ..Bytes::default()
        };
        let refused = budget.compare_memory(Needs::Run, &all, 0.0, None).unwrap_err();
        assert!(refused.sentence.contains("ulimit -v"), "{}", refused.sentence);
        // Of a run that has begun no key can be changed.
        let refused = budget
            .compare_memory(Needs::Resumed, &run, made, Some(0.0))
            .unwrap_err();
        assert!(
            refused.sentence.contains("give it more") && !refused.sentence.contains("lower"),
            "{}",
            refused.sentence
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
