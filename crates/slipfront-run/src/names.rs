//! Names of the files in a run folder and in the folder of a study.

/// The resolved case.
pub const CASE: &str = "case.toml";
/// The manifest: the files that were written, and the program, time and machine; the last file to be written.
pub const MANIFEST: &str = "manifest.json";
/// The numbers of a run.
pub const SUMMARY: &str = "summary.json";
/// The curve of a run, row by row.
pub const SERIES: &str = "series.csv";
/// The share of sliding blocks against position and time.
pub const KYMOGRAPH: &str = "kymograph.nc";
/// The fields of a run, block by block.
pub const FIELDS: &str = "fields.nc";
/// The last state of a run, if the case asks for it.
pub const STATE: &str = "state.npy";
/// The movie of a run, if the case asks for it.
pub const MOVIE: &str = "movie.gif";
/// The description of runs for data repositories, which `slipfront export` writes.
pub const RO_CRATE: &str = "ro-crate-metadata.json";
/// The hidden subfolder for everything that belongs to an incomplete run.
pub const UNFINISHED: &str = ".slipfront";
/// In the hidden subfolder: the list of files that the run has finished. It also marks the subfolder as
/// slipfront's.
pub const JOURNAL: &str = "journal.jsonl";
/// In the hidden subfolder: a folder of the temporary files that are being written.
pub const TEMPORARY: &str = "tmp";
/// In the hidden subfolder: the latest checkpoint.
pub const CHECKPOINT: &str = "checkpoint.bin";
/// In the hidden subfolder: the checkpoint before the latest.
pub const PREVIOUS: &str = "checkpoint-previous.bin";
/// Results from which the figures of the paper are made, kept between calls of `slipfront paper`.
pub const FIGURE_CACHE: &str = "found";
/// The journal of a study: a line for every run that has ended.
pub const RUN_JOURNAL: &str = "runs.jsonl";
/// Tables of a study: a row for every run, a row for every quantity at every point, and, where the direction
/// of the drive is varied, a row for friction over all directions.
pub const TABLES: [&str; 3] = ["runs.csv", "points.csv", "anisotropy.csv"];
/// Results of a study over meshes: as numbers, and as a text.
pub const CONVERGENCE: [&str; 2] = ["convergence.json", "convergence.txt"];
/// Subfolder of the run folders that a study keeps.
pub const RUNS: &str = "runs";

/// A picture of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunPicture {
    /// Friction and sliding blocks against time.
    Friction,
    /// Maps of the contact stress.
    Stress,
    /// First slips, and sliding against place and time.
    Front,
    /// The reach of events of slip against the load.
    Precursors,
    /// The distributions of the moments of events and of the times between them.
    Events,
}

impl RunPicture {
    /// Every picture of a run.
    pub const ALL: [Self; 5] = [
        Self::Friction,
        Self::Stress,
        Self::Front,
        Self::Precursors,
        Self::Events,
    ];

    /// Name of the picture's files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Stress => "stress",
            Self::Front => "front",
            Self::Precursors => "precursors",
            Self::Events => "events",
        }
    }

    /// Content of the picture in words.
    pub fn shows(self) -> &'static str {
        match self {
            Self::Friction => "friction and sliding blocks against time",
            Self::Stress => "maps of the contact stress",
            Self::Front => "first slip times, and sliding against position and time",
            Self::Precursors => "length of slip events against load",
            Self::Events => "sizes of slip events, and times between them",
        }
    }

    /// Names of the picture's files, with their endings.
    pub fn files(self) -> [String; 2] {
        ["svg", "png"].map(|ending| format!("{}.{ending}", self.name()))
    }
}
