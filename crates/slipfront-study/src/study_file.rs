//! The study file: a base case, the axes that vary it, and the number of replicates.

use std::collections::{BTreeSet, HashSet};
use std::path::Path;

use serde::Deserialize;
use toml::de::DeValue;

use crate::axis::{self, Axis, AxisKeys};
use crate::error::StudyError;
use crate::project_file::{Base, given, parse_noting_places, read_base, without_places};
use crate::project_folder::{Given, ProjectKind};
use crate::summary_values::{REDUCTION, is_column, known};
use slipfront_case::case_file::{
    CASE_TABLES, CaseError, KeyKind, Override, STUDY_TABLES, Source, Tables, header_below, key, names_of,
    unknown_case_table, unknown_key, whole,
};
use slipfront_case::key_rows;
use slipfront_run::names::{RUN_JOURNAL, TABLES};

/// Folders of studies. Their study file contains the base case as a table: `slipfront study DIR/study.toml`
/// repeats the study.
pub(crate) static STUDIES: ProjectKind = ProjectKind {
    name: "study",
    table: "study",
    file: "study.toml",
    journal: RUN_JOURNAL,
    given: &[],
    found: &[
        (TABLES[0], "One row per run with levels, seed, status and results"),
        (TABLES[1], "The statistics of every quantity at every point"),
        (TABLES[2], "Friction over the directions of the drive"),
        ("convergence.", "Every result with its mesh error"),
        (
            "friction_polar.",
            "Picture: friction over the directions of the drive",
        ),
        ("static_friction_star", "Picture: static friction over the axes"),
        ("kinetic_friction_star", "Picture: kinetic friction over the axes"),
        (REDUCTION, "Picture: reduction of static friction over the axes"),
    ],
};

/// A study file.
#[derive(Clone, Debug)]
pub struct StudyFile {
    /// Name of the study and of its results.
    pub name: String,
    /// The case that the axes vary.
    pub base: Base,
    /// Settings under `[study]`.
    pub settings: Settings,
    /// Axes under `[[axes]]`, in the order of the file.
    pub axes: Vec<Axis>,
    /// The file as a table, for the copy in the results folder.
    pub(crate) table: toml::Table,
}

key_rows! {
    /// The table `[study]`: repetition, reference and kept folders.
    #[derive(Clone, Debug, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Settings {
        /// Runs per point. Replicate r = 0, 1, ... uses the seed `friction.seed` + r, at most 2^63 - 1.
        pub replicates: u32 = key("1", whole(1, MAX_REPLICATES as u64)),
        /// Keys of the case that make of every point what its reduction is measured against (Eq. 16), at the
        /// same seed. They come after those of the axes.
        pub reference: Option<toml::Table> =
            key("", KeyKind::Special("a valid case at every point")).without("none: no reductions"),
        /// Run folders that are kept in `runs/`: all, none, or of failed runs the case file.
        pub keep: RetainRuns = key("\"none\"", KeyKind::Words(names_of::<RetainRuns>)),
        /// Adaptive replication, in place of `replicates`.
        pub until: Option<StoppingRule> = key("", KeyKind::Table("", StoppingRule::KEYS)).without("none"),
    }
}

/// Run folders that are kept in addition to the tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RetainRuns {
    /// Folders of every run, with fields and pictures.
    All,
    /// No folders.
    None,
    /// Case files of runs that failed.
    Failed,
}

key_rows! {
    /// Replication until a confidence interval is narrow enough.
    #[derive(Clone, Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct StoppingRule {
        /// Name of a number of `summary.json`, or `static_reduction_percent`.
        pub key: String = key("", KeyKind::Special("the reduction needs a `reference`")).without("needed"),
        /// Half width that the interval must not exceed.
        pub half_width: f64 = key("", KeyKind::Special("more than 0")).without("needed"),
        /// Confidence of the interval; also of all intervals in tables and pictures (0.95 without `until`).
        pub confidence: f64 = key("0.95", KeyKind::Special("between 0 and 1")),
        /// Fewest replicates.
        pub min: u32 = key("3", KeyKind::Special("2 to `max`")),
        /// Most replicates.
        pub max: u32 = key("", KeyKind::Special("up to 100 000")).without("needed"),
    }
}

/// Confidence of intervals unless the study sets another one.
pub const CONFIDENCE: f64 = 0.95;

/// Largest number of points of a study.
const MAX_POINTS: usize = 1_000_000;

/// Largest number of replicates of a point.
const MAX_REPLICATES: u32 = 100_000;

impl Settings {
    /// Whether the folder of every run is kept, with fields and pictures.
    pub fn keeps_all_runs(&self) -> bool {
        self.keep == RetainRuns::All
    }

    /// Confidence of all intervals.
    pub fn confidence(&self) -> f64 {
        self.until.as_ref().map_or(CONFIDENCE, |until| until.confidence)
    }

    /// Smallest number of replicates of every point.
    pub fn min_replicates(&self) -> usize {
        self.until.as_ref().map_or(self.replicates, |until| until.min) as usize
    }

    /// Largest number of replicates of a point.
    pub fn max_replicates(&self) -> usize {
        self.until.as_ref().map_or(self.replicates, |until| until.max) as usize
    }

    fn check(&self, source: &Source) -> Result<(), CaseError> {
        let refuse = |key: &str, sentence: String| Err(source.error(&format!("study.{key}"), sentence));
        let replicates = self.replicates;
        if !(1..=MAX_REPLICATES).contains(&replicates) {
            let sentence = format!("`replicates` = {replicates} must lie between 1 and {MAX_REPLICATES}");
            return refuse("replicates", sentence);
        }
        let mut reference = self.reference.iter().flat_map(axis::overrides);
        if reference.any(|set| set.key() == "friction.seed") {
            let sentence =
                "a reduction refers to the same surface: leave `friction.seed` out of the reference";
            return refuse("reference", sentence.to_owned());
        }
        let Some(until) = &self.until else {
            return Ok(());
        };
        if source.has("study.replicates") {
            let sentence = "`replicates` and `until` exclude each other: keep one";
            return refuse("replicates", sentence.to_owned());
        }
        let StoppingRule {
            key,
            half_width,
            confidence,
            min,
            max,
        } = until;
        if !(*half_width > 0.0 && half_width.is_finite()) {
            let sentence = format!("`half_width` = {half_width} must be more than 0");
            return refuse("until.half_width", sentence);
        }
        if !(*confidence > 0.0 && *confidence < 1.0) {
            let sentence = format!("`confidence` = {confidence} must lie between 0 and 1, such as 0.95");
            return refuse("until.confidence", sentence);
        }
        if !(2..=*max).contains(min) || *max > MAX_REPLICATES {
            let sentence = format!(
                "`min` = {min} and `max` = {max} must increase from 2 to at most {MAX_REPLICATES}: a single run has no interval"
            );
            return refuse("until.min", sentence);
        }
        if key == REDUCTION && self.reference.is_none() {
            let sentence = format!("`{key}` needs a `reference`");
            return refuse("until.key", sentence);
        }
        if !known().contains(key) {
            let sentence = format!(
                "`{key}` is not a quantity of the summary: use one such as static_friction_star, kinetic_friction_star or {REDUCTION}"
            );
            return refuse("until.key", sentence);
        }
        Ok(())
    }
}

impl StudyFile {
    /// The study file with the base case inside, and the files that it reads, for the results folder.
    pub(crate) fn given(&self) -> Result<Given, StudyError> {
        given(&self.base, &self.table)
    }

    /// Sets keys of the base case, each by a string such as `drive.v_star=0.05`.
    ///
    /// # Errors
    /// When a string is not an override, or sets a key that an axis sets.
    pub fn set(&mut self, overrides: &[String]) -> Result<(), CaseError> {
        for text in overrides {
            let change = Override::parse(text)?;
            let set = BTreeSet::from([change.key()]);
            let keys = self.axes.iter().flat_map(Axis::keys);
            if let Some(key) = keys
                .into_iter()
                .find(|key| axis::replaced_key(key, &set).is_some())
            {
                let mut source = Source::default();
                let sentence =
                    format!("an axis of the study sets `{key}`: change its levels, or remove the axis");
                let start = source.add_override(text);
                return Err(source.error_at(start..start + text.len(), sentence));
            }
        }
        self.base.set(overrides)
    }

    /// Whether the file has a key of a study. An empty file is also a study, which varies nothing.
    pub fn is_study(&self) -> bool {
        !self.table.is_empty()
    }

    /// Whether the base is a separate file, and not a table in the study file.
    pub fn has_base_file(&self) -> bool {
        self.table.get("base").is_some_and(toml::Value::is_str)
    }

    /// Points of the whole study, if they are not too many.
    pub fn count_points(&self) -> Result<usize, StudyError> {
        count_points(&self.axes)
    }

    /// Largest number of runs of the whole study; references that points share are counted for each.
    pub fn count_runs(&self) -> Result<u64, StudyError> {
        let roles = 1 + u64::from(self.settings.reference.is_some());
        Ok(self.count_points()? as u64 * self.settings.max_replicates() as u64 * roles)
    }

    /// Loads a study file; a base case that it names is relative to it.
    pub fn load(path: &Path) -> Result<Self, StudyError> {
        STUDIES.load(path, Self::parse)
    }

    /// Reads a study file called `file` in messages; a base case that it names is relative to `folder`.
    pub fn parse(text: &str, file: &str, name: &str, folder: &Path) -> Result<Self, StudyError> {
        let mut source = Source::new(file, text);
        let root = parse_noting_places(&mut source, text)?;
        let mut tables = Tables {
            root: root.get_ref().clone(),
            source: &source,
        };
        let base = read_base(&mut tables, file, folder)?;
        let settings: Settings = tables.read_with("study", Settings::KEYS)?;
        settings.check(&source)?;
        let axes = read_axes(&mut tables)?;
        refuse_rest(&tables)?;
        refuse_conflicts(&axes, &source)?;
        Ok(Self {
            name: name.to_owned(),
            base,
            settings,
            axes,
            table: without_places(root, &source)?,
        })
    }
}

/// Refuses the first table or key of the file that a study does not use.
fn refuse_rest(tables: &Tables) -> Result<(), CaseError> {
    let Some(key) = tables.root.keys().min_by_key(|key| key.span().start) else {
        return Ok(());
    };
    let name = key.get_ref().as_ref();
    let sentence = if names_of::<Settings>().contains(&name) {
        format!("`{name}` is outside its table: it belongs in [study]")
    } else if CASE_TABLES.contains(&name) {
        let [key, below] = ["", "base."].map(|above| header_below(above, name));
        format!(
            "{key} belongs in a case file, which `slipfront run` runs: in a study file, write {below}, or name the case \
             file with `base`"
        )
    } else {
        unknown_key(name, "a study file", &STUDY_TABLES)
    };
    Err(tables.source.error_at(key.span(), sentence))
}

/// Largest number of axes: 20 axes with two levels already reach the largest number of points.
const MAX_AXES: usize = 64;

fn read_axes(tables: &mut Tables) -> Result<Vec<Axis>, StudyError> {
    let Some(value) = tables.root.remove("axes") else {
        return Ok(Vec::new());
    };
    let span = value.span();
    let DeValue::Array(values) = value.into_inner() else {
        let sentence = "`axes` must be a list of tables: write [[axes]] above the keys of each";
        return Err(tables.source.error_at(span, sentence))?;
    };
    if values.len() > MAX_AXES {
        let sentence = format!(
            "the study has {} axes, more than {MAX_AXES}: move axes with one level to the base",
            values.len()
        );
        Err(tables.source.error_at(span, sentence))?;
    }
    let mut axes: Vec<Axis> = Vec::new();
    for value in values {
        let span = value.span();
        let keys: AxisKeys = tables.read_table(value, "[[axes]]")?;
        let axis = Axis::new(keys).map_err(|sentence| tables.source.error_at(span, sentence))?;
        axes.push(axis);
        // A line of the file can define up to 100 000 levels, so check the number of points after each axis.
        count_points(&axes)?;
    }
    Ok(axes)
}

/// Number of points: the product of the numbers of levels.
fn count_points(axes: &[Axis]) -> Result<usize, StudyError> {
    let mut counts = axes.iter().map(|axis| axis.levels.len());
    let product = counts.try_fold(1usize, usize::checked_mul);
    let product = product.filter(|&count| count <= MAX_POINTS);
    product.ok_or(StudyError::TooLarge { limit: MAX_POINTS })
}

/// Refuses axes that overwrite each other, and columns with the name of another column of the tables.
fn refuse_conflicts(axes: &[Axis], source: &Source) -> Result<(), CaseError> {
    let (mut columns, mut keys) = (HashSet::new(), BTreeSet::new());
    for (k, axis) in axes.iter().enumerate() {
        let refuse = |sentence: String| Err(source.error(&format!("axes.{k}"), sentence));
        let has_table = |key: &&str| key.contains('.') || CASE_TABLES.contains(key);
        if let Some(key) = axis.keys().into_iter().find(|key| !has_table(key)) {
            return refuse(unknown_case_table(key));
        }
        for column in &axis.columns {
            if is_column(column) {
                return refuse(format!(
                    "the tables have a column `{column}` already: give the axis another name"
                ));
            }
            if !columns.insert(column) {
                return refuse(format!("`{column}` is on two axes: keep one of them"));
            }
        }
        for key in axis.keys() {
            if let Some(earlier) = axis::replaced_key(key, &keys) {
                return refuse(format!(
                    "this axis sets `{key}`, which overwrites `{earlier}` of an earlier axis: put it before that axis, or keep \
                     one of them"
                ));
            }
        }
        keys.extend(axis.keys());
    }
    Ok(())
}
