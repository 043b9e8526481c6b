//! The calibration file: a base case, the unknown keys, and the conditions of the records.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use slipfront_base::disk::{TEXT_MAX_BYTES, read_limited};
use slipfront_base::number_format::{are, with_si_prefix};
use slipfront_case::case::{Case, FilesInMemory, PROGRAM};
use slipfront_case::case_file::{CaseError, KeyKind, Override, key, names_of, unknown_key, whole};
use slipfront_case::key_rows;
use slipfront_case::table::{DecimalSign, FieldSeparator, TableOptions};
use slipfront_run::folder_error::FolderError;
use slipfront_run::instrument::{HELD_DRIVE, Instrument, InstrumentKeys};
use slipfront_run::measured::{Correction, Measure, MeasuredRecord};
use slipfront_run::names::RUN_JOURNAL;
use slipfront_run::run_curve::steps_to;
use toml::Table;

use crate::doubts::doubts;
use crate::features::{MIN_VALUES, n_features};
use crate::sample_points::SamplePoints;
use crate::set_up::{Conditions, MOST_HALVINGS, SetUp};
use slipfront_study::StudyError;
use slipfront_study::Unknown;
use slipfront_study::axis::overrides;
use slipfront_study::measured_columns::MeasuredColumns;
use slipfront_study::project_file::ProjectFile;
use slipfront_study::project_folder::ProjectKind;
use slipfront_study::work_memory::WorkMemory;

/// Folders of calibrations. Their calibration file has the base case as a table in it.
pub(crate) static CALIBRATION: ProjectKind = ProjectKind {
    name: "calibration",
    table: "calibrate",
    file: "calibration.toml",
    journal: RUN_JOURNAL,
    given: &[(RECORD, "A measured record")],
    found: &[
        ("band-", "A record, with the band of the calibrated model"),
        (
            "calibration.",
            "The unknown keys with their intervals and their reliability",
        ),
        ("case.toml", "The case with the median of every unknown key"),
        (
            "posterior.csv",
            "Samples of the joint estimate of the unknown keys",
        ),
    ],
};

/// Beginning of the names of copies of records.
pub(crate) const RECORD: &str = "record-";

/// Table of the file that describes the measuring chain.
const INSTRUMENT: &str = "instrument";

/// Smallest and largest number of runs of a training: intervals of 90 % from 100 runs contain only three of
/// four true values, and the system of equations of more than 5000 runs needs too much memory.
const RUNS: [u32; 2] = [200, 5000];

/// Largest number of steps of a run for a record: a thousand such runs take days.
const MAX_STEPS: u64 = 10_000_000;

/// A calibration file.
#[derive(Clone, Debug)]
pub struct CalibrationFile {
    /// Keys of the file.
    pub keys: CalibrationKeys,
    /// The base case, and the text of the file.
    pub project: ProjectFile,
}

key_rows! {
    /// The table `[calibrate]`.
    #[derive(Clone, Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct CalibrationKeys {
        /// The unknown keys, each with its range: `[0.3, 0.9]`, `["1 um", "5 um"]`, or
        /// `{ from = 0.03, to = 0.5, scale = "log" }`. Before there is a record all values within it, or
        /// their logarithms, are equally likely.
        unknowns: Table = key("", KeyKind::Special("")).without("needed"),
        /// Standard deviation of the noise of a record, as a share of its mean friction.
        pub noise: f64 = key("", KeyKind::Special("more than 0, less than 1")).without("needed"),
        /// Column of times or displacements: its name, with or without the unit in the header, or its number
        /// from 1.
        x: String = key("", KeyKind::Special("")).without("needed"),
        /// Column of friction forces, or of coefficients if its unit is 1.
        y: String = key("", KeyKind::Special("")).without("needed"),
        /// Unit of `x`.
        x_unit: Option<String> = key("", KeyKind::Special("")).without("that in the header"),
        /// Unit of `y`.
        y_unit: Option<String> = key("", KeyKind::Special("")).without("that in the header"),
        /// Line with the names of the columns, from 1; 0 if none has.
        header_line: Option<u64> = key("", KeyKind::Special("")).without("found"),
        /// Decimal sign of the numbers.
        decimal: Option<DecimalSign> = key("", KeyKind::Words(names_of::<DecimalSign>)).without("found"),
        /// Separator of fields.
        separator: Option<FieldSeparator> = key("", KeyKind::Words(names_of::<FieldSeparator>)).without("found"),
        /// Part of the record, from 1, if it has several tables below each other, such as the steps of a
        /// test.
        segment: Option<u32> = key("", KeyKind::Special("")).without("the only one"),
        /// Quantity of the first column: time, or displacement of the drive. Both begin at 0 where the drive
        /// does.
        against: Against = key("\"time\"", KeyKind::Words(names_of::<Against>)),
        /// Factor of friction: -1 turns its sign.
        y_factor: Option<f64> = key("", KeyKind::Special("")).without("1"),
        /// Number that is added to friction after that, in N or 1: the zero of the load cell.
        y_offset: Option<f64> = key("", KeyKind::Special("")).without("0"),
        /// Time or displacement that is added to those of the record, such as `"-1.5 s"`, so that the drive
        /// begins at 0.
        shift: Option<String> = key("", KeyKind::Special("")).without("0"),
        /// Time or displacement after the shift with which the part begins that counts, such as `"2 s"`.
        from: Option<String> = key("", KeyKind::Special("")).without("value in the first line"),
        /// Time or displacement after the shift with which the part ends that counts.
        to: Option<String> = key("", KeyKind::Special("")).without("value in the last line"),
        /// A list of tables, one for each record: `set` has the keys whose values differ from those of the
        /// case, such as `{ set = { drive.speed = "2 um/s" } }`; `y_factor`, `y_offset`, `shift`, `from` and
        /// `to` are of this record alone.
        records: Vec<RecordKeys> = key("[]", KeyKind::Special("")),
        /// Runs of the training. Of six unknowns, intervals of 90 % hold 88 to 92 % of the values with 2500
        /// runs and 85 to 92 % with 200 or 400; with 100, which are refused, 75 to 91 %.
        pub runs: u32 = key("2500", whole(RUNS[0] as u64, RUNS[1] as u64)),
        /// Runs of the training on blocks of half the size; 0 for none. One takes some eight times as long as
        /// one on the blocks of the case.
        pub finer_runs: u32 = key("300", KeyKind::Special("0, or 200 to `runs`")),
        /// A list of tables of keys, such as `{ drive.v_star = 0.01 }`: possible next experiments. The report
        /// predicts how much each would narrow the intervals. Each costs as many runs as the training.
        pub next: Vec<Table> = key("[]", KeyKind::Special("")),
    }
}

/// Quantity of the first column of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Against {
    Time,
    Displacement,
}

/// Conditions of one of several records.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct RecordKeys {
    #[serde(default)]
    set: Table,
    y_factor: Option<f64>,
    y_offset: Option<f64>,
    shift: Option<String>,
    from: Option<String>,
    to: Option<String>,
}

/// A record as measured, and the points at which it is compared.
#[derive(Clone, Debug)]
pub struct SampledRecord {
    pub(crate) measured: MeasuredRecord,
    pub(crate) grid: SamplePoints,
    /// Warnings that the model can hardly have made the record.
    doubts: Vec<String>,
    /// Ending of the name of its file.
    pub(crate) ending: String,
    /// Content of its file.
    pub(crate) bytes: Vec<u8>,
}

impl SampledRecord {
    /// Notes on how the record was read, on skipped lines, and on doubts about the record.
    pub fn notes(&self) -> impl Iterator<Item = String> {
        self.measured.notes().chain(self.doubts.iter().cloned())
    }
}

impl CalibrationKeys {
    /// The columns of records, as the file names them.
    pub fn columns(&self) -> [&str; 2] {
        [&self.x, &self.y]
    }

    /// Quantity of the first column of records.
    pub(crate) fn along(&self) -> Measure {
        match self.against {
            Against::Time => Measure::Time,
            Against::Displacement => Measure::Displacement,
        }
    }

    /// Number of records that the file describes.
    pub(crate) fn n_records(&self) -> usize {
        self.records.len().max(1)
    }

    /// Format of the tables of records, as far as the file gives it.
    fn table(&self) -> TableOptions {
        TableOptions {
            segment: self.segment,
            ..TableOptions::stated(self.header_line, self.decimal, self.separator)
        }
    }
}

impl CalibrationFile {
    /// Loads a calibration file; a base case that it names is relative to it.
    ///
    /// # Errors
    /// As [`parse`](Self::parse), and when the file cannot be read.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        CALIBRATION.load(path, Self::parse)
    }

    /// Reads a calibration file called `file` in messages; a base case that it names is relative to
    /// `folder`.
    ///
    /// # Errors
    /// When it is not TOML, has unknown keys, or has values out of bounds.
    pub fn parse(text: &str, file: &str, name: &str, folder: &Path) -> Result<Self, StudyError> {
        let (project, keys) = ProjectFile::parse(
            &CALIBRATION,
            CalibrationKeys::KEYS,
            &[INSTRUMENT],
            text,
            file,
            name,
            folder,
        )?;
        let file = Self { keys, project };
        file.check()?;
        Ok(file)
    }

    /// The calibration with files in memory that the base case names.
    pub(crate) fn with_files(mut self, in_memory: FilesInMemory) -> Self {
        self.project.base.in_memory = in_memory;
        self
    }

    fn check(&self) -> Result<(), CaseError> {
        let keys = &self.keys;
        let refuse = |key: &str, sentence: String| Err(self.project.error(key, sentence));
        if !(keys.noise > 0.0 && keys.noise < 1.0) {
            let sentence = format!(
                "`noise` = {} must lie between 0 and 1: it is the standard deviation of the noise relative to the mean \
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
                "`unknowns` has no key: give one with its range, such as \"friction.r_star\" = [0.3, 0.9]";
            return refuse("unknowns", sentence.to_owned());
        }
        self.check_names_of_instrument()?;
        self.unknowns().map(drop)
    }

    /// Refuses an unknown name in the table `[instrument]`. The values of its keys may be unknowns of the
    /// calibration.
    fn check_names_of_instrument(&self) -> Result<(), CaseError> {
        let known: Vec<&str> = InstrumentKeys::KEYS.iter().map(|key| key.name).collect();
        let mut given = self.project.table(INSTRUMENT)?.into_iter().flatten();
        given
            .find(|(name, _)| !known.contains(&name.as_str()))
            .map_or(Ok(()), |(name, _)| {
                let sentence = unknown_key(name, "the table [instrument]", &known);
                Err(self.project.error_in_table(INSTRUMENT, sentence))
            })
    }

    /// The unknown keys.
    fn unknowns(&self) -> Result<Vec<Unknown>, CaseError> {
        self.keys
            .unknowns
            .iter()
            .map(|(key, range)| {
                Unknown::read(key, range).map_err(|sentence| self.project.error("unknowns", sentence))
            })
            .collect()
    }

    /// Reads records, one for each of `records` in the file, or any number if it has none.
    ///
    /// # Errors
    /// When their number differs, when one cannot be read, or when it has no record in these columns.
    pub fn read(&self, paths: &[PathBuf]) -> Result<Vec<SampledRecord>, StudyError> {
        let expected = self.keys.records.len();
        if paths.is_empty() || (expected > 0 && expected != paths.len()) {
            let sentence = format!(
                "the file describes how {} measured, but {} given: give one file for each, in the same order",
                are(expected.max(1), "record"),
                are(paths.len(), "record"),
            );
            return Err(self.project.error("records", sentence).into());
        }
        let numbered = paths.iter().enumerate();
        numbered
            .map(|(number, path)| self.read_record(number, path))
            .collect()
    }

    /// The correction of the record of this number, from its own keys or the common ones.
    fn correction(&self, number: usize, along: Measure) -> Result<Correction, CaseError> {
        let keys = &self.keys;
        let own = keys.records.get(number);
        let place = |key: &str, own: Option<&String>, of_all: &Option<String>| {
            let text = own.or(of_all.as_ref());
            let place = text.map(|text| along.parse(text)).transpose();
            place.map_err(|why| self.project.error(key, format!("`{key}`: {why}")))
        };
        let shift = place("shift", own.and_then(|own| own.shift.as_ref()), &keys.shift)?;
        let from = place("from", own.and_then(|own| own.from.as_ref()), &keys.from)?;
        let to = place("to", own.and_then(|own| own.to.as_ref()), &keys.to)?;
        let plain = Correction::default();
        Ok(Correction {
            y_factor: own
                .and_then(|own| own.y_factor)
                .or(keys.y_factor)
                .unwrap_or(plain.y_factor),
            y_offset: own
                .and_then(|own| own.y_offset)
                .or(keys.y_offset)
                .unwrap_or(plain.y_offset),
            shift: shift.unwrap_or(plain.shift),
            part: [from.unwrap_or(plain.part[0]), to.unwrap_or(plain.part[1])],
        })
    }

    fn read_record(&self, number: usize, path: &Path) -> Result<SampledRecord, StudyError> {
        let bytes = read_limited(path, TEXT_MAX_BYTES).map_err(FolderError::read(path))?;
        self.read_bytes(number, path, bytes)
    }

    /// Reads the record of this number from the bytes of its file.
    ///
    /// # Errors
    /// When it has no record in these columns.
    pub(crate) fn read_bytes(
        &self,
        number: usize,
        path: &Path,
        bytes: Vec<u8>,
    ) -> Result<SampledRecord, StudyError> {
        let keys = &self.keys;
        let columns = MeasuredColumns::new(keys.columns(), [&keys.x_unit, &keys.y_unit], keys.table());
        let along = keys.along();
        let measured = columns.parse(&bytes, path, along);
        let mut measured = measured.map_err(|sentence| self.project.error("x", sentence))?;
        measured.correct(&self.correction(number, along)?);
        let grid = SamplePoints::from_record(&measured).ok_or_else(|| {
            let sentence = format!(
                "{} has {} values: a record needs at least {MIN_VALUES}, not all at the same position",
                path.display(),
                measured.x.len()
            );
            self.project.error("x", sentence)
        })?;
        if measured.y.iter().all(|friction| *friction == 0.0) {
            let sentence = format!(
                "{} is 0 in each of its {} values of friction: give the column of friction with `y`, and check that the sensor was \
                 on",
                path.display(),
                measured.y.len()
            );
            return Err(self.project.error("y", sentence).into());
        }
        if grid.end() <= 0.0 {
            return Err(self.before_the_drive(path, &grid).into());
        }
        let ending = path.extension().and_then(|ending| ending.to_str());
        Ok(SampledRecord {
            doubts: doubts(&measured, &grid, keys.noise, path),
            measured,
            grid,
            ending: ending.unwrap_or("csv").to_owned(),
            bytes,
        })
    }

    /// The set-up of the runs for records, on the blocks of the case. Both ends of every range are checked
    /// with the case.
    pub(crate) fn set_up(&self, records: &[SampledRecord]) -> Result<SetUp, StudyError> {
        self.set_up_at(records.iter().map(|record| record.grid.clone()).collect())
    }

    /// The set-up for records at these sample points.
    pub(crate) fn set_up_at(&self, grids: Vec<SamplePoints>) -> Result<SetUp, StudyError> {
        let conditions = grids.into_iter().enumerate().map(|(number, grid)| Conditions {
            overrides: self.overrides_of(number),
            grid,
        });
        self.set_up_under(conditions.collect())
    }

    /// The set-up under these conditions.
    pub(crate) fn set_up_under(&self, conditions: Vec<Conditions>) -> Result<SetUp, StudyError> {
        let mut set_up = SetUp {
            base: self.project.base.clone(),
            unknowns: self.unknowns()?,
            conditions,
            instrument: self.project.table(INSTRUMENT)?.cloned(),
            is_finer: false,
            halvings: 0,
        };
        let middle = set_up.middle();
        let in_instrument = |why: String| self.project.error_in_table(INSTRUMENT, why);
        for number in 0..set_up.conditions.len() {
            let instrument = set_up.instrument(&middle, &set_up.conditions[number]);
            let instrument = instrument.map_err(|error| in_instrument(error.to_string()))?;
            let range = instrument.as_ref().and_then(Instrument::range);
            set_up.conditions[number].grid.range = range;
        }
        for conditions in &set_up.conditions {
            for unknown in 0..middle.len() {
                for end in [0.0, 1.0] {
                    let mut shares = middle.clone();
                    shares[unknown] = end;
                    let instrument = set_up.instrument(&shares, conditions);
                    let instrument = instrument.map_err(|error| in_instrument(error.to_string()))?;
                    let case = set_up.case(&shares, 0, conditions);
                    let case = case.map_err(|error| self.project.found_in("unknowns", error))?;
                    let has_memory = instrument.is_some_and(|instrument| instrument.has_memory());
                    if has_memory && case.model.drive.is_held() {
                        return Err(in_instrument(HELD_DRIVE.to_owned()).into());
                    }
                    let steps = steps_to(&case, conditions.grid.along, conditions.grid.end());
                    if steps > MAX_STEPS {
                        return Err(self.too_long(&case, steps, &conditions.grid).into());
                    }
                }
            }
        }
        Ok(set_up)
    }

    /// Refuses a calibration from these records if memory is too small for `threads` simultaneous runs and
    /// the regressions after them. The error gives the number of threads that memory is large enough for.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case, or memory is too small: with the needed and the
    /// available memory.
    pub fn check_memory(&self, records: &[SampledRecord], threads: usize) -> Result<(), StudyError> {
        expect_memory(&self.memory(records)?, threads)
    }

    /// Memory of the calibration from these records.
    ///
    /// # Errors
    /// When the ranges leave the bounds of the case.
    pub fn memory(&self, records: &[SampledRecord]) -> Result<WorkMemory, StudyError> {
        const NUMBER: f64 = size_of::<f64>() as f64;
        // Least size of a regression: it finds its weights from 900 runs, with four numbers for each pair of
        // runs.
        const LEAST: usize = 2 * 900;
        let set_up = self.set_up(records)?;
        let [runs, finer_runs] = [self.keys.runs, self.keys.finer_runs].map(|runs| runs as usize);
        let further = self.further(&set_up)?;
        // A calibration skips blocks of half the size if they are not possible.
        let finer = set_up.finer().ok().filter(|_| finer_runs > 0);
        let mut trainings = vec![(&set_up, runs)];
        trainings.extend(finer.iter().map(|finer| (finer, finer_runs)));
        trainings.extend(further.iter().map(|(_, further)| (further, runs)));
        let (mut values, mut run) = (0, 0.0_f64);
        for (set_up, runs) in trainings {
            values += runs
                * set_up
                    .conditions
                    .iter()
                    .map(|one| one.grid.n_values())
                    .sum::<usize>();
            run = run.max(set_up.bytes_of_run(0)?);
        }
        if !set_up.is_random()? {
            run = run.max(set_up.bytes_of_run(MOST_HALVINGS)?);
        }
        // Regressions: one for each unknown and one for the drift of a record. Records: those of the file,
        // and one of a further experiment.
        let regressions = 1 + set_up.unknowns.len();
        let records = set_up.conditions.len() + usize::from(!further.is_empty());
        let kept = 10 * (regressions + 1) * runs * records * n_features();
        // Curves are held by the journal, by a training and by copies of both.
        let numbers = (4 * values + kept) as f64;
        let regression = NUMBER * (runs.max(LEAST) as f64).powi(2);
        Ok(WorkMemory {
            beside: PROGRAM + NUMBER * numbers,
            pieces: vec![(run, usize::MAX), (regression, regressions)],
        })
    }

    /// The set-ups of the experiments that may be made next, over the path of the first record of `set_up`,
    /// and their names.
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
    fn before_the_drive(&self, path: &Path, grid: &SamplePoints) -> CaseError {
        let places = match self.keys.against {
            Against::Time => "times",
            Against::Displacement => "displacements",
        };
        let sentence = format!(
            "{} ends at {}, before the drive begins: {places} count from the beginning of the drive, at 0. Add a number to all {places} of the \
             record by `shift`, so that the drive begins at 0",
            path.display(),
            with_si_prefix(grid.end(), grid.along.unit())
        );
        self.project.error("x", sentence)
    }

    /// The error of a record that takes too many steps.
    fn too_long(&self, case: &Case, steps: u64, grid: &SamplePoints) -> CaseError {
        let begin = grid.begin();
        if begin > 0.5 * grid.end() {
            let sentence = format!(
                "a record begins at {begin} {0} and ends at {1} {0}, while the drive begins at 0: `shift = \"{2} {0}\"`, besides the shift \
                 that it may have, begins it at 0",
                grid.along.unit(),
                grid.end(),
                -begin
            );
            return self.project.error("x", sentence);
        }
        let sentence = format!(
            "a record takes {steps} steps of the case, more than {MAX_STEPS}: a step lasts {}. For slow rigs compare against \
             displacement, with a drive that stops while blocks slide: `against = \"displacement\"` and `drive.loading = \
             \"held\"`",
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

/// Refuses work of a calibration on this number of threads if memory is too small.
pub(crate) fn expect_memory(memory: &WorkMemory, threads: usize) -> Result<(), StudyError> {
    let no_memory = |needed, available| StudyError::CalibrationMemory { needed, available };
    memory.check(threads, no_memory)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The memory of a calibration of a small slider from a record of 50 values.
    fn memory(keys: &str) -> WorkMemory {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("record.csv");
        let rows: String = (0..50).map(|k| format!("{k}e-9,{k}\n")).collect();
        std::fs::write(&record, format!("t_s,f_n\n{rows}")).unwrap();
        let text = format!(
            "[base]\nslider.blocks = [8, 8]\n[calibrate]\nx = 't_s'\ny = 'f_n'\nnoise = 0.01\n{keys}\n\
             unknowns = {{ 'friction.r_star' = [0.3, 0.9], 'friction.mu_static' = [0.3, 0.9] }}"
        );
        let file = CalibrationFile::parse(&text, "fit.toml", "fit", Path::new("")).unwrap();
        file.memory(&file.read(&[record]).unwrap()).unwrap()
    }

    /// A record of 80 values, of which the last 60 are used: they equal the record that the model makes.
    #[test]
    fn records_are_corrected_by_keys_of_all_and_of_their_own() {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("record.csv");
        let rows: String = (0..80).map(|k| format!("{k},{}\n", 2 * (20 - k))).collect();
        std::fs::write(&record, format!("t (ms),F (N)\n{rows}")).unwrap();
        let read = |keys: &str, records: &[PathBuf]| {
            let text = format!(
                "[base]\nslider.blocks = [8, 8]\n[calibrate]\nx = 't'\ny = 'F'\nnoise = 0.01\n{keys}\n\
                 unknowns = {{ 'friction.r_star' = [0.3, 0.9] }}"
            );
            let file = CalibrationFile::parse(&text, "fit.toml", "fit", Path::new("")).unwrap();
            file.read(records).map_err(|error| error.to_string())
        };
        let of_all = "y_factor = -0.5\nshift = '-20 ms'\nfrom = '0 s'\nto = '0.0595 s'";
        let own =
            "y_factor = 3\nrecords = [{ y_factor = -0.5, y_offset = 1, shift = '-20 ms', from = '0 s' }]";
        for (keys, zero) in [(of_all, 0.0), (own, 1.0)] {
            let found = &read(keys, std::slice::from_ref(&record)).unwrap()[0].measured;
            assert_eq!(found.x.len(), 60, "{keys}");
            for (k, (x, y)) in found.x.iter().zip(&found.y).enumerate() {
                // The conversion from milliseconds and the shift each round once.
                assert!(
                    (x - 1e-3 * k as f64).abs() < 1e-16 && *y == zero + k as f64,
                    "{x} {y}"
                );
            }
        }
        let refused = read("shift = '2 N'", &[record]).unwrap_err();
        assert!(refused.contains("`shift`: "), "{refused}");
    }

    #[test]
    fn threads_are_held_against_the_memory() {
        let found = memory("runs = 2000\nfiner_runs = 0");
        // A kernel matrix of all runs, factorised in place; for a regression of each unknown and one more.
        assert_eq!(found.pieces[1], (8.0 * 2000.0 * 2000.0, 3));
        let no_memory = |needed, available| StudyError::CalibrationMemory { needed, available };
        assert!(found.compare(2, found.on_threads(2), no_memory).is_ok());
        assert!(matches!(
            found.compare(8, found.on_threads(2), no_memory),
            Err(StudyError::Memory {
                threads: 8,
                fit: 2,
                ..
            })
        ));
        let said = found
            .compare(2, found.on_threads(1) - 1.0, no_memory)
            .unwrap_err()
            .to_string();
        assert!(
            said.starts_with("the calibration needs") && said.contains("or `calibrate.runs`"),
            "{said}"
        );
    }

    /// Runs on blocks of half the size have four times the blocks, twice the steps, and their own curves.
    #[test]
    fn all_trainings_count() {
        let plain = memory("runs = 200\nfiner_runs = 0");
        let finer = memory("runs = 200\nfiner_runs = 200");
        let further = memory("runs = 200\nfiner_runs = 0\nnext = [{ drive.v_star = 0.01 }]");
        let curve = 8.0 * 50.0;
        assert!(finer.pieces[0].0 > 1.9 * plain.pieces[0].0);
        assert!(finer.beside - plain.beside >= 2.0 * 200.0 * curve);
        assert!(further.beside - plain.beside > 3.0 * 200.0 * curve);
    }
}
