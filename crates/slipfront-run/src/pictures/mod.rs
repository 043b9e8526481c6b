//! The pictures of a run, drawn from its files, so that those of a run and those of `slipfront plot` are equal.
//!
//! No other module of this crate draws pictures: a program that writes a run calls [`write_run`] here, or [`complete`] after
//! the results of several ranks.

mod budget;
pub mod error;
mod files;
pub mod friction;
mod front;
mod maps;
pub mod movie;
mod precursors;
mod record_fit;
pub mod texture_file;

use std::path::Path;

use rayon::prelude::*;
use slipfront_case::case::Case;
use slipfront_plot::{MovieSize, Picture};

pub use self::budget::{memory, run_budget};
use self::error::RunPictureError;
pub use self::files::DRAWN_FROM;
pub use self::front::draw_kymograph;
pub use self::maps::draw_field;
use self::movie::MoviePace;
use crate::manifest::Manifest;
use crate::names::{MOVIE, RunPicture};
use crate::results;
use crate::run_folder::RunFolder;
use crate::running::Record;

/// Writes the results of a run on one rank to its folder, where the case stands already, then the pictures and the manifest, which
/// completes it. The fields are moved out of the record, which frees their memory before the pictures are drawn. After an error the
/// folder is left without a manifest.
pub fn write_run(
    case: &Case,
    record: &mut Record,
    mut folder: RunFolder,
    started: jiff::Timestamp,
    threads: usize,
) -> Result<Manifest, RunPictureError> {
    results::write(case, record, &mut folder)?;
    complete(case, folder, started, threads)
}

/// Draws the pictures of a run from its [results](crate::results::write), and writes the manifest, which completes its folder. After an
/// error the folder is left without a manifest.
pub fn complete(
    case: &Case,
    mut folder: RunFolder,
    started: jiff::Timestamp,
    threads: usize,
) -> Result<Manifest, RunPictureError> {
    for (name, picture) in draw(folder.path())? {
        folder.write(&format!("{name}.svg"), picture.svg.as_bytes())?;
        folder.write(&format!("{name}.png"), &picture.png)?;
    }
    if case.output.movie
        && let Some(movie) = movie::of_run(folder.path(), None)?
    {
        let delays = movie::delays(&movie, MoviePace::Usual)?;
        folder.write(MOVIE, &movie::gif(&movie, MovieSize::Usual, &delays)?)?;
    }
    Ok(folder.complete(case, started, threads)?)
}

/// Draws the pictures of a run folder from its files, which must be there and undamaged.
pub fn draw(folder: &Path) -> Result<Vec<(&'static str, Picture)>, RunPictureError> {
    let mut pictures = Vec::new();
    // The budget of a run has room for two at once.
    for two in RunPicture::ALL.chunks(2) {
        let drawn: Vec<_> = two.par_iter().map(|picture| draw_one(*picture, folder)).collect();
        for (picture, drawn) in two.iter().zip(drawn) {
            pictures.extend(drawn?.map(|drawn| (picture.name(), drawn)));
        }
    }
    Ok(pictures)
}

/// Draws a picture from the files of a run folder; none if the run has kept no data for it.
fn draw_one(picture: RunPicture, folder: &Path) -> Result<Option<Picture>, RunPictureError> {
    match picture {
        RunPicture::Friction => friction::of_run(folder).map(Some),
        RunPicture::Stress => maps::of_run(folder),
        RunPicture::Front => front::of_run(folder),
        RunPicture::Precursors => precursors::of_run(folder),
    }
}
