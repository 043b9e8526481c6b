//! The study of one slider on blocks of twice its size, of its own, of half of it, and so on.

use std::path::{Path, absolute};

use slipfront_case::case::Case;
use slipfront_case::case_file::{CaseError, CaseFile, Override};
use toml::{Table, Value};

use super::on_meshes::{MIN_LEVELS, meshes};
use crate::error::StudyError;
use crate::plan::Plan;
use crate::project_file::portable_text;
use crate::study_file::StudyFile;

/// Largest number of meshes: the finest has 64 times as many blocks along a side as the coarsest.
pub const MAX_LEVELS: u8 = 7;

/// Number of surfaces of a mesh if coefficients scatter.
const REPLICATES: i64 = 5;

/// The study of a case on several meshes. The runs of a mesh differ by their seeds alone; if the case has
/// textures, every run is paired with one without them.
#[derive(Clone, Debug)]
pub struct MeshStudy {
    /// The study, whose only axis is the size of the blocks.
    pub file: StudyFile,
    /// Runs of the study.
    pub plan: Plan,
}

impl MeshStudy {
    /// The case on `levels` meshes, the second of which is its own, with `replicates` surfaces on each, by
    /// default 5 if coefficients scatter, else 1.
    ///
    /// # Errors
    /// When there are too few or too many meshes, when the case cannot be put on these blocks, or when no
    /// block of one mesh is textured.
    pub fn new(case: &Case, levels: i64, replicates: Option<i64>) -> Result<Self, StudyError> {
        if !(i64::from(MIN_LEVELS)..=i64::from(MAX_LEVELS)).contains(&levels) {
            return Err(StudyError::Levels {
                levels,
                fewest: MIN_LEVELS,
                most: MAX_LEVELS,
            });
        }
        let replicates = replicates.unwrap_or_else(|| default_replicates(case));
        let table = study_table(case, &overrides(case, levels)?, replicates)?;
        let name = format!("{}-meshes", case.name);
        // Every file is named by its whole path.
        let file = StudyFile::parse(&portable_text(table)?, &name, &name, Path::new(""))?;
        let plan = Plan::new(&file, None)?;
        refuse_bare(&plan)?;
        Ok(Self { file, plan })
    }
}

/// The keys that put a case on each of its meshes.
fn overrides(case: &Case, levels: i64) -> Result<Vec<Vec<Override>>, CaseError> {
    (0..levels)
        .map(|level| case.on_other_blocks(0.5 * f64::from(1_u32 << level)))
        .collect()
}

/// Contents of the study file.
fn study_table(case: &Case, on_meshes: &[Vec<Override>], replicates: i64) -> Result<Table, StudyError> {
    // Each key with its values on all meshes, those alone that differ between meshes or from the case.
    let mut zip = Table::new();
    for set in on_meshes.iter().flatten() {
        let list = zip.entry(set.key()).or_insert_with(|| Value::Array(Vec::new()));
        if let Value::Array(values) = list {
            values.push(set.value());
        }
    }
    let mut base = Value::try_from(reading_originals(case)).map_err(CaseError::from)?;
    if let Some(base) = base.as_table_mut() {
        base.remove("output");
    }
    let mut study = Table::from_iter([("replicates".to_owned(), Value::from(replicates))]);
    if !case.file.texture.is_empty() {
        let none = Table::from_iter([("texture".to_owned(), Value::Array(Vec::new()))]);
        study.insert("reference".to_owned(), none.into());
    }
    let axis = Table::from_iter([("zip".to_owned(), Value::Table(zip))]);
    Ok(Table::from_iter([
        ("base".to_owned(), base),
        ("study".to_owned(), study.into()),
        ("axes".to_owned(), Value::Array(vec![axis.into()])),
    ]))
}

/// The case file, which names the copies in a run folder, with the files that were copied in their place.
fn reading_originals(case: &Case) -> CaseFile {
    let mut file = case.file.clone();
    for named in file.files_mut().0 {
        if let Some(input) = case.inputs.iter().find(|input| input.name == *named.name) {
            let original = absolute(&input.original).unwrap_or_else(|_| input.original.clone());
            *named.name = original.display().to_string();
        }
    }
    file
}

/// Default number of replicates: five if surfaces differ by their seeds, else one.
fn default_replicates(case: &Case) -> i64 {
    let groups = &case.groups;
    if groups.sigma_static_star > 0.0 || groups.sigma_kinetic_star > 0.0 {
        REPLICATES
    } else {
        1
    }
}

/// Refuses textures that the blocks of a mesh are too large for.
fn refuse_bare(plan: &Plan) -> Result<(), StudyError> {
    let is_bare = |position: &usize| plan.has_reference() && plan.texture_percent(*position) == 0.0;
    let Some(position) = (0..plan.points.len()).find(is_bare) else {
        return Ok(());
    };
    let block_size = meshes(plan).swap_remove(position).block_size;
    Err(StudyError::Bare { block_size })
}
