//! The study of one slider on blocks of twice, once and half the given size, and so on.

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

/// The study of a case on several meshes. The runs on a mesh differ only by their seeds. If the case has
/// textures, every run is paired with one without textures.
#[derive(Clone, Debug)]
pub struct MeshStudy {
    /// The study; its only axis is the size of the blocks.
    pub file: StudyFile,
    /// Runs of the study.
    pub plan: Plan,
}

impl MeshStudy {
    /// The case on `levels` meshes with `replicates` surfaces on each. The second mesh is that of the case.
    /// The default of `replicates` is 5 if coefficients scatter, and 1 otherwise.
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
        // The table names every file by its full path.
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
    // Each key with its values on all meshes, but only keys that differ between meshes or from the case.
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

/// The case file with the original files in place of the copies that it names in a run folder.
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

/// Default number of replicates: five if surfaces with different seeds differ, and one otherwise.
fn default_replicates(case: &Case) -> i64 {
    let groups = &case.groups;
    if groups.sigma_static_star > 0.0 || groups.sigma_kinetic_star > 0.0 {
        REPLICATES
    } else {
        1
    }
}

/// Refuses a mesh with blocks that are too large for the textures.
fn refuse_bare(plan: &Plan) -> Result<(), StudyError> {
    let is_bare = |position: &usize| plan.has_reference() && plan.texture_percent(*position) == 0.0;
    let Some(position) = (0..plan.points.len()).find(is_bare) else {
        return Ok(());
    };
    let block_size = meshes(plan).swap_remove(position).block_size;
    Err(StudyError::Bare { block_size })
}
