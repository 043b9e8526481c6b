//! A movie of a run, from its files: the snapshots of a field beside the friction curve.

use std::path::Path;

use rayon::prelude::*;
use slipfront::observe::Field;
use slipfront_case::case::{Budget, MAX_PICTURES};
use slipfront_case::case_file::Motion;
use slipfront_plot::{
    CellMeans, FrictionAxes, MOVIE_FILE_BYTES, MOVIE_PICTURE_BYTES, Movie, MovieFrame, MovieGif,
    MoviePictures, PictureError,
};

use super::error::RunPictureError;
use super::files::case_of;
use super::friction::{ROW_BYTES, marked_curve};
use super::maps::{CELL_BYTES, MapScale, MuStar, field_of_maps, separated};
use crate::fields;
use crate::names::{FIELDS, SERIES};
use crate::series::{self, SeriesRow};
use crate::summary::read_summary;

/// Duration of a movie in hundredths of a second, as far as the limits on the duration of its pictures allow.
const DURATION: usize = 1600;
const SHORTEST: usize = 5;
const LONGEST: usize = 100;
/// Factor by which an instant A-F is shown longer than other pictures.
const INSTANT: usize = 5;

/// Largest number of pictures that are drawn at once.
const BATCH: usize = 8;
/// Bytes while [`BATCH`] pictures are drawn.
pub(super) const BATCH_BYTES: f64 = (BATCH * MOVIE_PICTURE_BYTES) as f64;

/// Bytes of a snapshot of `cells` cells while a movie is made: its values, and its picture in the file.
pub(super) fn snapshot_bytes(cells: f64) -> f64 {
    cells * size_of::<f32>() as f64 + MOVIE_FILE_BYTES as f64
}

/// Memory for making the movie of a run folder, in bytes.
pub fn memory(folder: &Path) -> Result<f64, RunPictureError> {
    let snapshots = fields::count_snapshots(&folder.join(FIELDS))?;
    let rows = series::estimate_rows(&folder.join(SERIES))?;
    let snapshots = snapshots.min(MAX_PICTURES) as f64;
    let cells = CellMeans::MAX_CELLS as f64;
    Ok(Budget::resident(
        cells * CELL_BYTES
            + Budget::grown(rows) * ROW_BYTES
            + snapshots * snapshot_bytes(cells)
            + BATCH_BYTES,
    ))
}

/// The movie of a run folder, of the given field or of the field whose maps are drawn; none if the run has kept no snapshot
/// of it.
///
/// # Errors
/// When a file cannot be read, or there are more than 1000 snapshots.
pub fn of_run(folder: &Path, field: Option<Field>) -> Result<Option<Movie>, RunPictureError> {
    let case = case_of(folder)?;
    let field = field.unwrap_or_else(|| field_of_maps(case.as_ref()));
    let fields = fields::read_maps::<CellMeans>(&folder.join(FIELDS), field, |labels| {
        (0..labels.len().min(MAX_PICTURES + 1)).collect()
    })?;
    if fields.names.is_empty() || fields.frames.is_empty() {
        return Ok(None);
    }
    if fields.frames.len() > MAX_PICTURES {
        return Err(RunPictureError::TooManySnapshots(MAX_PICTURES));
    }
    let summary = read_summary(folder)?;
    let point = |row: SeriesRow| (row.step, row.time_star, row.mu_star);
    let rows = series::read_rows(&folder.join(SERIES), SERIES, point)?;
    let mut curve = marked_curve(String::new(), &summary);
    curve.x = rows.iter().map(|(_, time_star, _)| *time_star).collect();
    curve.friction = rows.iter().map(|(.., mu_star)| *mu_star).collect();
    let mut axes = FrictionAxes::default();
    if summary.motion == Some(Motion::Rotation) {
        axes.friction = "torque \u{3bc}*".to_owned();
    }
    let steps = rows.iter().map(|(step, _, mu_star)| (*step, *mu_star));
    let mu_star = MuStar::of(&summary.instants, steps);
    let values = fields.frames.iter().flat_map(|frame| &frame.values).flatten();
    let scale = MapScale::of(field, case.as_ref(), values.copied());
    let (nx, ny) = (fields.columns(), fields.rows());
    let frames = fields.frames.into_iter();
    let frames: Vec<_> = frames
        .map(|frame| MovieFrame {
            mu_star: mu_star.at(&frame),
            label: separated(&frame.label),
            time_star: frame.time_star,
            values: scale.values_of(frame),
        })
        .collect();
    Ok(Some(Movie {
        nx,
        ny,
        textured: fields.textured,
        title: scale.symbol,
        range: scale.range,
        curve,
        axes,
        frames,
    }))
}

/// Duration of each picture of a movie, in hundredths of a second.
pub fn delays(movie: &Movie) -> Vec<u16> {
    let delay = (DURATION / movie.frames.len().max(1)).clamp(SHORTEST, LONGEST);
    let frames = movie.frames.iter();
    frames
        .map(|frame| match frame.label.as_str() {
            "" => delay as u16,
            _ => (INSTANT * delay).clamp(LONGEST, 2 * LONGEST) as u16,
        })
        .collect()
}

/// The pictures of a movie before they are drawn, and their colours.
///
/// # Errors When the pictures cannot be drawn.
pub fn pictures(movie: &Movie) -> Result<MoviePictures<'_>, RunPictureError> {
    MoviePictures::of(movie).map_err(not_drawn)
}

/// Draws the pictures of a movie one after the other, and passes each to `take`.
///
/// # Errors Errors of `take`.
pub fn draw<E>(
    movie: &Movie,
    pictures: &MoviePictures,
    mut take: impl FnMut(Vec<u8>) -> Result<(), E>,
) -> Result<(), E> {
    for first in (0..movie.frames.len()).step_by(BATCH) {
        let batch = first..(first + BATCH).min(movie.frames.len());
        let drawn: Vec<_> = batch.into_par_iter().map(|index| pictures.draw(index)).collect();
        drawn.into_iter().try_for_each(&mut take)?;
    }
    Ok(())
}

/// A movie as an animated GIF file.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn gif(movie: &Movie) -> Result<Vec<u8>, RunPictureError> {
    let pictures = pictures(movie)?;
    let mut delays = delays(movie).into_iter();
    let mut file = MovieGif::of(pictures.palette()).map_err(not_drawn)?;
    let drawn = draw(movie, &pictures, |pixels| {
        file.add(pixels, delays.next().unwrap_or_default())
    });
    drawn.and_then(|()| file.finish()).map_err(not_drawn)
}

fn not_drawn(source: PictureError) -> RunPictureError {
    RunPictureError::Picture {
        name: "the movie",
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_are_shown_longer() {
        let frame = |label: &str| MovieFrame {
            label: label.to_owned(),
            ..MovieFrame::default()
        };
        let movie = |others: usize| Movie {
            frames: std::iter::once(frame("A"))
                .chain((0..others).map(|_| frame("")))
                .collect(),
            ..Movie::default()
        };
        assert_eq!(delays(&movie(199))[..2], [100, 8]);
        assert_eq!(delays(&movie(3))[..2], [200, 100]);
        assert_eq!(delays(&movie(999))[..2], [100, 5]);
    }
}
