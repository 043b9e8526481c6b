//! The calibration file: a base case, the unknown keys, and the conditions of the records.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use slipfront_base::disk::{TEXT_MAX_BYTES, read_limited};
use slipfront_base::number_format::{are, with_si_prefix};
use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, Override};
use slipfront_run::folder_error::FolderError;
use slipfront_run::measured::{Measure, MeasuredRecord};
use slipfront_run::run_curve::steps_to;
use toml::{Table, Value};

use crate::grid::Grid;
use crate::set_up::{Conditions, SetUp};
use crate::summaries::MIN_VALUES;
use crate::unknowns::Unknown;
use slipfront_study::StudyError;
use slipfront_study::axis::overrides;
use slipfront_study::measured_columns::MeasuredColumns;
use slipfront_study::project_file::ProjectFile;
use slipfront_study::project_folder::ProjectKind;

/// Folders of calibrations. Their calibration file has the base case as a table in it.
pub(crate) static CALIBRATION: ProjectKind = ProjectKind {
    name: "calibration",
    table: "calibrate",
    file: "calibration.toml",
    journal: "training.jsonl",
};

/// Smallest and largest number of runs of a training: intervals of 90 % from 100 runs hold three values of four, more are a system of
/// equations that memory is too small for.
const RUNS: [u32; 2] = [200, 5000];

/// Largest number of steps of a run for a record: a thousand such runs take days.
const MAX_STEPS: u64 = 10_000_000;

/// A calibration file.
#[derive(Clone, Debug)]
pub struct CalibrationFile {
    /// Keys of the file.
    pub keys: CalibrationKeys,
    pub(crate) project: ProjectFile,
}

/// The table `[calibrate]`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CalibrationKeys {
    unknowns: Table,
    /// Standard deviation of the noise of a record, as a share of its mean friction.
    pub noise: f64,
    x: String,
    y: String,
    x_unit: Option<String>,
    y_unit: Option<String>,
    #[serde(default)]
    against: Against,
    #[serde(default)]
    records: Vec<RecordKeys>,
    /// Runs of the training.
    #[serde(default = "default_runs")]
    pub runs: u32,
    /// Runs of the training on blocks of half the size; 0 for none.
    #[serde(default = "default_finer_runs")]
    pub finer_runs: u32,
    /// Experiments that may be made next, each as the keys in which it differs from the case.
    #[serde(default)]
    pub next: Vec<Table>,
}

/// Quantity of the first column of a record.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Against {
    #[default]
    Time,
    Displacement,
}

/// Conditions of one of several records.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordKeys {
    set: Table,
}

/// The range of an unknown.
#[derive(Deserialize)]
#[serde(untagged)]
enum RangeKeys {
    Ends([Number; 2]),
    Scaled(ScaledKeys),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ScaledKeys {
    from: Number,
    to: Number,
    scale: Scale,
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Scale {
    Linear,
    Log,
}

/// A number, or one with a unit.
#[derive(Deserialize)]
#[serde(untagged)]
enum Number {
    Plain(f64),
    WithUnit(String),
}

fn default_runs() -> u32 {
    2500
}

fn default_finer_runs() -> u32 {
    300
}

/// A record as measured, and the steps in which it is compared.
#[derive(Clone, Debug)]
pub struct GivenRecord {
    pub(crate) measured: MeasuredRecord,
    pub(crate) grid: Grid,
    /// Ending of the name of its file.
    pub(crate) ending: String,
    /// Content of its file.
    pub(crate) bytes: Vec<u8>,
}

impl GivenRecord {
    /// A sentence about lines of the record that were passed over, if there are some.
    pub fn note(&self) -> Option<String> {
        let footer = self.measured.footer.as_ref()?;
        Some(format!("{footer}: passed over"))
    }
}

impl CalibrationKeys {
    /// The columns of records, as the file names them.
    pub fn columns(&self) -> [&str; 2] {
        [&self.x, &self.y]
    }
}

impl CalibrationFile {
    /// Loads a calibration file; a base case that it names stands relative to it.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), and when the file cannot be read.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        CALIBRATION.load(path, Self::parse)
    }

    /// Reads a calibration file called `file` in messages; a base case that it names stands relative to `folder`.
    ///
    /// # Errors
    /// When it is no TOML, has unknown keys, or values out of their bounds.
    pub fn parse(text: &str, file: &str, name: &str, folder: &Path) -> Result<Self, StudyError> {
        let (project, keys) = ProjectFile::parse(&CALIBRATION, text, file, name, folder)?;
        let file = Self { keys, project };
        file.check()?;
        Ok(file)
    }

    /// Name of the calibration and of its results.
    pub fn name(&self) -> &str {
        &self.project.name
    }

    fn check(&self) -> Result<(), CaseError> {
        let keys = &self.keys;
        let refuse = |key: &str, sentence: String| Err(self.project.error(key, sentence));
        if !(keys.noise > 0.0 && keys.noise < 1.0) {
            let sentence = format!(
                "`noise` = {} must lie between 0 and 1: it is the standard deviation of the noise as a share of the mean \
                 friction, such as 0.01",
                keys.noise
            );
            return refuse("noise", sentence);
        }
        let [fewest, most] = RUNS;
        if !(fewest..=most).contains(&keys.runs) {
            let sentence = format!("`runs` = {} must lie between {fewest} and {most}", keys.runs);
            return refuse("runs", sentence);
        }
        if keys.finer_runs != 0 && !(fewest..=keys.runs).contains(&keys.finer_runs) {
            let sentence = format!(
                "`finer_runs` = {} must be 0, or lie between {fewest} and `runs` = {}",
                keys.finer_runs, keys.runs
            );
            return refuse("finer_runs", sentence);
        }
        if keys.unknowns.is_empty() {
            let sentence =
                "`unknowns` names no key: give one with its range, such as \"friction.r_star\" = [0.3, 0.9]";
            return refuse("unknowns", sentence.to_owned());
        }
        self.unknowns().map(drop)
    }

    /// The unknown keys.
    fn unknowns(&self) -> Result<Vec<Unknown>, CaseError> {
        self.keys
            .unknowns
            .iter()
            .map(|(key, range)| self.unknown(key, range))
            .collect()
    }

    fn unknown(&self, key: &str, range: &Value) -> Result<Unknown, CaseError> {
        let refuse = |sentence: String| self.project.error("unknowns", sentence);
        let Ok(keys) = range.clone().try_into::<RangeKeys>() else {
            return Err(refuse(format!(
                "the range of `{key}` is written [0.3, 0.9], [\"1 um\", \"5 um\"] or {{ from = 0.03, to = 0.5, scale = \"log\" }}"
            )));
        };
        let (ends, is_logarithmic) = match keys {
            RangeKeys::Ends(ends) => (ends, false),
            RangeKeys::Scaled(ScaledKeys { from, to, scale }) => ([from, to], matches!(scale, Scale::Log)),
        };
        let [(from, unit), (to, other)] = ends.map(Number::parted);
        let (Some(from), Some(to)) = (from, to) else {
            return Err(refuse(format!(
                "the range of `{key}` has ends that are no numbers"
            )));
        };
        if unit != other {
            return Err(refuse(format!(
                "the ends of the range of `{key}` differ in their units"
            )));
        }
        let unknown = Unknown::new(key, from, to, is_logarithmic);
        let unknown = unknown.map_err(|error| refuse(error.to_string()))?;
        Ok(match unit {
            Some(unit) => unknown.in_unit(&unit),
            None => unknown,
        })
    }

    /// Reads records, one for each of `records` in the file, or any number if it has none.
    ///
    /// # Errors
    /// When their number is another one, when one cannot be read, or when it is no record of these columns.
    pub fn read(&self, paths: &[PathBuf]) -> Result<Vec<GivenRecord>, StudyError> {
        let expected = self.keys.records.len();
        if paths.is_empty() || (expected > 0 && expected != paths.len()) {
            let sentence = format!(
                "the file tells how {} measured, and {} given: name one file for each, in their order",
                are(expected.max(1), "record"),
                are(paths.len(), "record"),
            );
            return Err(self.project.error("records", sentence).into());
        }
        paths.iter().map(|path| self.read_record(path)).collect()
    }

    fn read_record(&self, path: &Path) -> Result<GivenRecord, StudyError> {
        let keys = &self.keys;
        let columns = MeasuredColumns::new(keys.columns(), [&keys.x_unit, &keys.y_unit]);
        let along = match keys.against {
            Against::Time => Measure::Time,
            Against::Displacement => Measure::Displacement,
        };
        let bytes = read_limited(path, TEXT_MAX_BYTES).map_err(FolderError::read(path))?;
        let measured = columns.parse(&bytes, path, along);
        let measured = measured.map_err(|sentence| self.project.error("x", sentence))?;
        let grid = Grid::of(&measured).ok_or_else(|| {
            let sentence = format!(
                "{} has {} values: a record needs {MIN_VALUES} at the least, which do not all stand at one place",
                path.display(),
                measured.x.len()
            );
            self.project.error("x", sentence)
        })?;
        if grid.end() <= 0.0 {
            return Err(self.before_the_drive(path, &grid).into());
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        Ok(GivenRecord {
            measured,
            grid,
            ending: ending.unwrap_or("csv").to_owned(),
            bytes,
        })
    }

    /// The set-up of the runs for records, on the blocks of the case. Both ends of every range are checked with the case.
    pub(crate) fn set_up(&self, records: &[GivenRecord]) -> Result<SetUp, StudyError> {
        let conditions = records.iter().enumerate().map(|(number, record)| Conditions {
            overrides: self.overrides_of(number),
            grid: record.grid.clone(),
        });
        let set_up = SetUp {
            base: self.project.base.clone(),
            unknowns: self.unknowns()?,
            conditions: conditions.collect(),
            is_finer: false,
        };
        let middle = set_up.middle();
        for conditions in &set_up.conditions {
            for unknown in 0..middle.len() {
                for end in [0.0, 1.0] {
                    let mut shares = middle.clone();
                    shares[unknown] = end;
                    let case = set_up.case(&shares, 0, conditions);
                    let case = case.map_err(|error| self.project.found_in("unknowns", error))?;
                    let steps = steps_to(&case, conditions.grid.along(), conditions.grid.end());
                    if steps > MAX_STEPS {
                        return Err(self.too_long(&case, steps).into());
                    }
                }
            }
        }
        Ok(set_up)
    }

    /// The set-ups of the experiments that may be made next, over the path of the first record of `set_up`, and their names.
    pub(crate) fn further(&self, set_up: &SetUp) -> Result<Vec<(String, SetUp)>, StudyError> {
        let middle = set_up.middle();
        let first = &set_up.conditions[0];
        let speed = |conditions: &Conditions| {
            let case = set_up.case(&middle, 0, conditions);
            let case = case.map_err(|error| self.project.found_in("next", error))?;
            Ok::<f64, StudyError>(case.model.drive.v_star * case.scales.displacement() / case.scales.time())
        };
        let further = |set: &Table| {
            let mut conditions = Conditions {
                overrides: overrides(set),
                grid: first.grid.clone(),
            };
            conditions.grid = first.grid.slower(speed(first)? / speed(&conditions)?);
            let names: Vec<String> = conditions.overrides.iter().map(ToString::to_string).collect();
            let further = SetUp {
                conditions: vec![conditions],
                ..set_up.clone()
            };
            Ok((names.join(", "), further))
        };
        self.keys.next.iter().map(further).collect()
    }

    /// The error of a record that ends before the drive moves.
    fn before_the_drive(&self, path: &Path, grid: &Grid) -> CaseError {
        let places = match self.keys.against {
            Against::Time => "times",
            Against::Displacement => "displacements",
        };
        let sentence = format!(
            "{} ends at {}, before the drive begins: {places} count from the beginning of the drive, at 0. Add a number to all {places} of the \
             record, so that the drive begins at 0",
            path.display(),
            with_si_prefix(grid.end(), grid.along().unit())
        );
        self.project.error("x", sentence)
    }

    /// The error of a record that takes too many steps.
    fn too_long(&self, case: &Case, steps: u64) -> CaseError {
        let sentence = format!(
            "a record takes {steps} steps of the case, more than {MAX_STEPS}: a step lasts {}. Records of rigs that move so slowly are compared \
             against displacement, with a drive that is held while blocks slide: `against = \"displacement\"` and `drive.loading = \"held\"`",
            with_si_prefix(case.time_plan.dt_star * case.scales.time(), "s")
        );
        self.project.error("x", sentence)
    }

    /// Keys in which a record differs from the case.
    pub(crate) fn overrides_of(&self, record: usize) -> Vec<Override> {
        self.keys
            .records
            .get(record)
            .map_or_else(Vec::new, |record| overrides(&record.set))
    }
}

impl Number {
    /// The number, and the unit.
    fn parted(self) -> (Option<f64>, Option<String>) {
        match self {
            Self::Plain(number) => (Some(number), None),
            Self::WithUnit(text) => match text.trim().split_once(' ') {
                Some((number, unit)) => (number.parse().ok(), Some(unit.trim().to_owned())),
                None => (text.trim().parse().ok(), None),
            },
        }
    }
}
