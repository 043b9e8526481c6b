//! The plan of a study: its points, and what each run of a point is.

use super::axis::{self, Axis};
use super::error::StudyError;
use super::file::{Base, Keep, Settings, StudyFile};
use super::shard::Shard;
use crate::case::Case;
use crate::case_file::{AutoOr, CaseError, CaseFile, Output, Snapshots};

/// Every run that a study may need.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Name of the study.
    pub name: String,
    /// Repetition, reference and what is kept.
    pub settings: Settings,
    /// What varies.
    pub axes: Vec<Axis>,
    /// Every combination of levels, the last axis fastest.
    pub points: Vec<Point>,
    base: Base,
    reference: Option<Vec<String>>,
}

/// A combination of levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Place in the whole study, from 0: the same in every shard.
    pub index: usize,
    /// Level of each axis.
    pub levels: Vec<usize>,
}

/// What a run of a point is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Role {
    /// The point itself.
    Point,
    /// What its reduction is measured against.
    Reference,
}

/// One run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RunKey {
    /// Index of the point.
    pub point: usize,
    /// Replicate, from 0.
    pub replicate: usize,
    /// What it is for.
    pub role: Role,
}

impl RunKey {
    /// Its name: what its folder is called.
    pub fn name(&self) -> String {
        let role = match self.role {
            Role::Point => "",
            Role::Reference => "-reference",
        };
        format!("{}-{}{role}", self.point, self.replicate)
    }
}

/// Most points that are listed.
const MAX_POINTS: usize = 10_000_000;

impl Plan {
    /// Multiplies the axes out and tries every point: the first that is no valid case is named.
    ///
    /// # Errors
    /// [`StudyError::Point`], [`StudyError::TooLarge`].
    pub fn new(file: &StudyFile, shard: Option<Shard>) -> Result<Self, StudyError> {
        let count = file
            .axes
            .iter()
            .try_fold(1usize, |product, axis| product.checked_mul(axis.levels.len()));
        let count = count
            .filter(|&count| count <= MAX_POINTS)
            .ok_or(StudyError::TooLarge { limit: MAX_POINTS })?;
        let points = (0..count)
            .filter(|&index| shard.is_none_or(|shard| shard.holds(index)))
            .map(|index| Point {
                index,
                levels: levels(&file.axes, index),
            })
            .collect();
        let plan = Self {
            name: file.name.clone(),
            settings: file.settings.clone(),
            axes: file.axes.clone(),
            points,
            base: file.base.clone(),
            reference: file.settings.reference.as_ref().map(axis::overrides),
        };
        for point in &plan.points {
            for role in plan.roles() {
                let run = RunKey {
                    point: point.index,
                    replicate: 0,
                    role,
                };
                plan.case(run).map_err(|source| StudyError::Point {
                    point: plan.describe(point),
                    source,
                })?;
            }
        }
        Ok(plan)
    }

    /// What runs a point has: itself, and its reference if the study has one.
    pub fn roles(&self) -> impl Iterator<Item = Role> + use<> {
        [Role::Point]
            .into_iter()
            .chain(self.reference.as_ref().map(|_| Role::Reference))
    }

    /// Whether reductions are measured.
    pub fn has_reference(&self) -> bool {
        self.reference.is_some()
    }

    /// The case file of a run. The seed alone tells replicates apart, so that all points meet the same surfaces.
    ///
    /// # Errors
    /// As for any case file.
    pub fn case_file(&self, run: RunKey) -> Result<CaseFile, CaseError> {
        let mut overrides: Vec<String> = Vec::new();
        for (axis, level) in self.axes.iter().zip(levels(&self.axes, run.point)) {
            overrides.extend_from_slice(&axis.levels[level].overrides);
        }
        if run.role == Role::Reference {
            overrides.extend(self.reference.iter().flatten().cloned());
        }
        let mut file = self.base.with(&overrides)?;
        file.friction.seed = file.friction.seed.wrapping_add(run.replicate as u64) & i64::MAX as u64;
        Ok(file)
    }

    /// The case of a run, ready to run.
    ///
    /// # Errors
    /// As for any case.
    pub fn case(&self, run: RunKey) -> Result<Case, CaseError> {
        let mut file = self.case_file(run)?;
        if self.settings.keep != Keep::All {
            // Nobody will look at fields or curves, and the numbers do not depend on them.
            file.output.snapshots = Snapshots::At(Vec::new());
            file.output.series = AutoOr::Auto;
        }
        let mut case = Case::new(file, &run.name(), &self.base.folder)?;
        if self.settings.keep != Keep::All {
            case.output.series_stride = case.schedule.last_step;
        }
        Ok(case)
    }

    /// What tells two runs apart: the physics of their cases, the contents of their files and the version; not
    /// names of files, nor what is written. Points share a run that is the same, such as their reference.
    ///
    /// # Errors
    /// As for any case file, and when a file cannot be read.
    pub fn identity(&self, run: RunKey) -> Result<String, CaseError> {
        let mut file = self.case_file(run)?;
        file.output = Output::default();
        let source = file.source.clone();
        for (key, name) in file.files_mut() {
            let path = self.base.folder.join(&*name);
            let hash = blake3::hash(&crate::case::read_input(&source, &key, &path)?).to_hex();
            let ending = path
                .extension()
                .map(|ending| ending.to_string_lossy().into_owned());
            *name = format!("{hash}.{}", ending.unwrap_or_default());
        }
        let mut hasher = blake3::Hasher::new();
        hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
        hasher.update(file.to_toml()?.as_bytes());
        Ok(hasher.finalize().to_hex()[..32].to_owned())
    }

    /// The levels of a point, as a reader would name it.
    pub fn describe(&self, point: &Point) -> String {
        let levels: Vec<String> = self
            .columns(point)
            .into_iter()
            .map(|(name, value)| format!("{name} = {value}"))
            .collect();
        if levels.is_empty() {
            "of the base case".to_owned()
        } else {
            levels.join(", ")
        }
    }

    /// Columns of the axes, and what stands in them at a point.
    pub fn columns(&self, point: &Point) -> Vec<(&str, &str)> {
        let mut columns = Vec::new();
        for (axis, &level) in self.axes.iter().zip(&point.levels) {
            let names = axis.columns.iter().map(String::as_str);
            columns.extend(names.zip(axis.levels[level].labels.iter().map(String::as_str)));
        }
        columns
    }

    /// Runs of `replicates` replicates of every point; references that points share are counted for each.
    pub fn runs(&self, replicates: usize) -> u64 {
        self.points.len() as u64 * replicates as u64 * self.roles().count() as u64
    }
}

/// Levels of point `index`, the last axis fastest.
fn levels(axes: &[Axis], mut index: usize) -> Vec<usize> {
    let mut levels: Vec<usize> = axes
        .iter()
        .rev()
        .map(|axis| {
            let level = index % axis.levels.len();
            index /= axis.levels.len();
            level
        })
        .collect();
    levels.reverse();
    levels
}
