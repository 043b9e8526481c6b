//! The pictures of a run, drawn from its files, so that a run, `slipfront plot` and a page without a disk
//! draw the same pictures.
//!
//! No other module of this crate draws pictures or imports this one: a program that writes a run calls
//! [`write_run`] here, or [`complete`] after the results of several ranks.

pub mod error;
mod events;
mod files;
pub mod friction;
mod front;
mod maps;
pub mod movie;
mod precursors;
mod record_fit;

use std::path::PathBuf;

use slipfront::parallel::*;
use slipfront_case::case::{Case, PICTURES};
use slipfront_plot::{MovieSize, Picture, PictureLook, PictureSize};

use self::error::RunPictureError;
use self::files::found;
pub use self::files::is_drawn_from;
pub use self::front::{draw_kymograph, title_of_place};
pub use self::maps::{draw_field, title_of_field};
use self::movie::MoviePace;
use crate::manifest::{Manifest, Processors};
use crate::names::{KYMOGRAPH, MOVIE, RunPicture, SERIES};
use crate::observers::events::FILE as EVENTS;
use crate::results;
use crate::run_files::RunFiles;
use crate::run_folder::RunFolder;
use crate::running::RunData;

/// Largest number of bytes of the pixels of a picture with a size chosen by the user.
const PIXELS: f64 = 96.0 * 1024.0 * 1024.0;

/// Memory for drawing the friction curves of these run folders, or all pictures of a single one, in bytes.
/// The data of a series, a kymograph or a catalogue of events take less than four times the size of the file.
pub fn memory(folders: &[PathBuf]) -> Result<f64, RunPictureError> {
    let mut read = 0;
    for folder in folders {
        for name in [SERIES, KYMOGRAPH, EVENTS] {
            read += found(&folder.join(name))?.map_or(0, |file| file.len());
        }
    }
    Ok(PICTURES + PIXELS + 4.0 * read as f64)
}

/// Writes the results of a run on one rank to its folder, which already contains the case, then the pictures
/// and the manifest, which completes it. The fields are moved out of the data, which frees their memory
/// before the pictures are drawn. After an error the folder is left without a manifest.
pub fn write_run(
    case: &Case,
    data: &mut RunData,
    mut folder: RunFolder,
    started: jiff::Timestamp,
    processors: Processors,
) -> Result<Manifest, RunPictureError> {
    results::write(case, data, &mut folder)?;
    complete(case, folder, started, processors)
}

/// Draws the pictures of a run from its [results](crate::results::write), and writes the manifest, which
/// completes its folder. After an error the folder is left without a manifest.
pub fn complete(
    case: &Case,
    mut folder: RunFolder,
    started: jiff::Timestamp,
    processors: Processors,
) -> Result<Manifest, RunPictureError> {
    let place = folder.path().to_owned();
    each_file(RunFiles::Folder(&place), case.output.movie, |name, contents| {
        Ok(folder.write(name, contents)?)
    })?;
    Ok(folder.complete(case, started, processors)?)
}

/// Draws the pictures of a run with its files in memory, and the movie if requested. Returns the files of the
/// pictures, with the same bytes as in the folder of a run.
///
/// # Errors
/// If a file of the run is missing or damaged, or cannot be drawn.
pub fn in_memory(
    files: &[(String, Vec<u8>)],
    with_movie: bool,
) -> Result<Vec<(String, Vec<u8>)>, RunPictureError> {
    let mut drawn = Vec::new();
    each_file(RunFiles::InMemory(files), with_movie, |name, contents| {
        drawn.push((name.to_owned(), contents.to_vec()));
        Ok(())
    })?;
    Ok(drawn)
}

/// Draws the pictures of a run, and the movie if requested, and passes each file with its name to `take`.
fn each_file(
    run: RunFiles,
    with_movie: bool,
    mut take: impl FnMut(&str, &[u8]) -> Result<(), RunPictureError>,
) -> Result<(), RunPictureError> {
    for (name, picture) in draw(run, &PictureLook::default())? {
        // The two formats are accessed directly, so that the module of a page does not contain the PDF
        // writer.
        take(&format!("{name}.svg"), picture.svg.as_bytes())?;
        take(&format!("{name}.png"), &picture.png)?;
    }
    if with_movie && let Some(movie) = movie::of_run(run, None)? {
        let delays = movie::delays(&movie, MoviePace::Usual)?;
        take(MOVIE, &movie::gif(&movie, MovieSize::Usual, &delays)?)?;
    }
    Ok(())
}

/// Draws the pictures of a run from its files, which must exist and be undamaged. Returns each picture with
/// its name.
///
/// # Errors
/// When a file of the run cannot be read or drawn, and when the size leaves no room for a picture.
pub fn draw(run: RunFiles, look: &PictureLook) -> Result<Vec<(&'static str, Picture)>, RunPictureError> {
    let mut pictures = Vec::new();
    let asked = RunPicture::ALL
        .into_iter()
        .filter(|picture| look.draws(picture.name()));
    let asked: Vec<RunPicture> = asked.collect();
    // The memory budget of a run allows two at a time.
    for two in asked.chunks(2) {
        let drawn: Vec<_> = two
            .par_iter()
            .map(|picture| draw_one(*picture, run, look.size))
            .collect();
        for (picture, drawn) in two.iter().zip(drawn) {
            pictures.extend(drawn?.map(|drawn| (picture.name(), drawn)));
        }
    }
    Ok(pictures)
}

/// Draws a picture from the files of a run; none if the run has kept no data for it.
fn draw_one(
    picture: RunPicture,
    run: RunFiles,
    size: PictureSize,
) -> Result<Option<Picture>, RunPictureError> {
    match picture {
        RunPicture::Friction => friction::of_run(run, size).map(Some),
        RunPicture::Stress => maps::of_run(run, size),
        RunPicture::Front => front::of_run(run, size),
        RunPicture::Precursors => precursors::of_run(run, size),
        RunPicture::Events => events::of_run(run, size),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::sync::Arc;

    use super::*;
    use crate::names::MANIFEST;
    use crate::running;

    /// A run with its files in memory has the same pictures as the run in a folder, byte for byte.
    #[test]
    fn pictures_of_files_in_memory_are_those_of_a_folder() {
        let out = tempfile::tempdir().unwrap();
        let out = out.path().join("out");
        // The slider is driven at an edge, so it has events of slip, and it slides as a whole: every picture
        // is drawn.
        let text = "slider.blocks = [6, 4]\ndrive = { attach = 'left', v_star = 3, loading = 'held' }\ntime.duration_star = 60\noutput = { movie = true, events = true }\n";
        let case = Arc::new(Case::parse(text, "case", "", &[]).unwrap());
        let run = || running::run(&case, 1).unwrap();
        let mut folder = RunFolder::prepare(&out, false, &case.inputs).unwrap();
        results::write_case(&case, &mut folder).unwrap();
        write_run(
            &case,
            &mut run(),
            folder,
            jiff::Timestamp::now(),
            Processors::threads(1),
        )
        .unwrap();
        let mut files = results::in_memory(&case, &mut run()).unwrap();
        files.extend(in_memory(&files, true).unwrap());
        let written: BTreeMap<String, Vec<u8>> = std::fs::read_dir(&out)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name != MANIFEST && !name.starts_with('.'))
            .map(|name| (name.clone(), std::fs::read(out.join(name)).unwrap()))
            .collect();
        let n_pictures = 2 * RunPicture::ALL.len() + 1;
        assert_eq!(
            files
                .iter()
                .filter(|(name, _)| [".svg", ".png", ".gif"].iter().any(|end| name.ends_with(end)))
                .count(),
            n_pictures
        );
        assert!(BTreeMap::from_iter(files) == written);
        // A missing file is reported by its name.
        let missing = in_memory(&[], false).unwrap_err().to_string();
        assert!(missing.contains("summary.json"), "{missing}");
    }
}
