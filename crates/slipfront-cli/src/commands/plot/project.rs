//! Pictures of folders of studies, convergences, designs and calibrations.

use std::path::PathBuf;

use slipfront_calibrate::CALIBRATIONS;
use slipfront_design::DESIGNS;
use slipfront_study::project_folder::Project;
use slipfront_study::{PicturesOf, is_of_figures, pictures_of};

use crate::failure::Failure;

/// Kinds of projects besides studies.
static OTHERS: [Project; 2] = [DESIGNS, CALIBRATIONS];

/// The project in the named folder; none if all folders are folders of runs.
pub(super) fn find(folders: &[PathBuf]) -> Result<Option<PicturesOf<'_>>, Failure> {
    for folder in folders {
        if is_of_figures(folder) {
            return Err(Failure::input(format!(
                "{} contains the figures of the paper, which have the printed size: `slipfront paper` draws them",
                folder.display()
            )));
        }
        let Some(found) = pictures_of(folder, &OTHERS).map_err(Failure::input)? else {
            continue;
        };
        if folders.len() > 1 {
            return Err(Failure::input(format!(
                "{} is not a folder of a run, and only curves of runs can be combined: give it alone",
                folder.display()
            )));
        }
        return Ok(Some(found));
    }
    Ok(None)
}
