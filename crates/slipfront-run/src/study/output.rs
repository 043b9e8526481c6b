//! Writes the tables and pictures of a study to its folder.

#[cfg(feature = "plot")]
use std::collections::HashSet;

use super::error::StudyError;
use super::folder::StudyFolder;
#[cfg(feature = "plot")]
use super::pictures;
use super::plan::Plan;
use super::study_results::StudyResults;
use super::{picture_plan, tables};
use crate::names::TABLES;

/// Writes the tables and pictures of a study to its folder, and removes its pictures of earlier results.
///
/// # Errors
/// When a file cannot be written.
pub fn write(plan: &Plan, results: &StudyResults, folder: &StudyFolder) -> Result<(), StudyError> {
    let [runs, points] = TABLES;
    folder.write(runs, &tables::runs(plan, results)?)?;
    folder.write(points, &tables::points(plan, results)?)?;
    let drawn = draw(plan, results, folder)?;
    folder.remove_pictures(picture_plan::names(&plan.axes).filter(|name| !drawn.contains(name)));
    Ok(())
}

/// Draws the pictures and returns their names.
#[cfg(feature = "plot")]
fn draw(plan: &Plan, results: &StudyResults, folder: &StudyFolder) -> Result<HashSet<String>, StudyError> {
    let mut drawn = HashSet::new();
    for (name, picture) in pictures::draw(plan, results)? {
        folder.write(&format!("{name}.svg"), picture.svg.as_bytes())?;
        folder.write(&format!("{name}.png"), &picture.png)?;
        drawn.insert(name);
    }
    Ok(drawn)
}

/// Without the feature `plot` nothing is drawn.
#[cfg(not(feature = "plot"))]
fn draw(_: &Plan, _: &StudyResults, _: &StudyFolder) -> Result<[String; 0], StudyError> {
    Ok([])
}
