//! A movie of a run, from its files: the snapshots of a field beside the friction curve.

use std::path::Path;

use rayon::prelude::*;
use slipfront::observe::Field;
use slipfront_case::case::mapped_field;
use slipfront_case::case_file::{CaseFile, Motion};
use slipfront_plot::{CellMeans, FrictionAxes, Movie, MovieFrame, MovieGif, MoviePictures, PictureError};

use crate::error::ResultsError;
use crate::fields;
use crate::friction_picture::marked_curve;
use crate::names::{CASE, FIELDS, SERIES};
use crate::pictures::{MuStar, bar_ends, extent, prefix_of};
use crate::series::{self, SeriesRow};
use crate::summary::read_summary;

/// Most pictures of a movie: a minute and more of it.
const MAX_PICTURES: usize = 1000;
/// Pictures that are drawn side by side.
const BATCH: usize = 16;
/// A movie takes so long, in hundredths of a second, as far as its pictures are not shown longer or shorter than this.
const DURATION: usize = 1600;
const SHORTEST: usize = 5;
const LONGEST: usize = 100;
/// An instant A-F is shown so many times as long as other pictures.
const INSTANT: usize = 5;

/// The movie of a run folder, of this field or of that whose maps are drawn; none if the run has kept no snapshot of it.
///
/// # Errors
/// When a file cannot be read, or there are more than 1000 snapshots.
pub fn of_run(folder: &Path, field: Option<Field>) -> Result<Option<Movie>, ResultsError> {
    let field = match field {
        Some(field) => field,
        None => mapped_field(&CaseFile::load(&folder.join(CASE), &[])?),
    };
    let fields = fields::read_maps::<CellMeans>(&folder.join(FIELDS), field, |labels| {
        (0..labels.len().min(MAX_PICTURES + 1)).collect()
    })?;
    if fields.names.is_empty() || fields.frames.is_empty() {
        return Ok(None);
    }
    if fields.frames.len() > MAX_PICTURES {
        return Err(ResultsError::TooManySnapshots(MAX_PICTURES));
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
    let (title, range, unit) = scale(field, fields.frames.iter().flat_map(|frame| &frame.values[0]));
    let (nx, ny) = (fields.columns(), fields.rows());
    let frames = fields.frames.into_iter().map(|frame| MovieFrame {
        mu_star: mu_star.at(&frame),
        label: frame.label,
        time_star: frame.time_star,
        values: {
            let values = frame.values.into_iter().next().unwrap_or_default();
            values.into_iter().map(|value| value / unit).collect()
        },
    });
    Ok(Some(Movie {
        nx,
        ny,
        textured: fields.textured,
        title,
        range,
        curve,
        axes,
        frames: frames.collect(),
    }))
}

/// The title of a field over its colour bar, the ends of the bar, and what its values are divided by.
fn scale<'a>(field: Field, values: impl Iterator<Item = &'a f32>) -> (String, [f64; 2], f32) {
    let (symbol, unit) = match field {
        Field::ContactStress => return ("\u{3c4}_c*".to_owned(), [0.0, 1.0], 1.0),
        Field::Sliding => return ("sliding".to_owned(), [0.0, 1.0], 1.0),
        Field::Traction => ("\u{3c4}", "Pa"),
        Field::DisplacementX => ("u_x", "m"),
        Field::DisplacementY => ("u_y", "m"),
        Field::VelocityX => ("v_x", "m/s"),
        Field::VelocityY => ("v_y", "m/s"),
    };
    let extent = extent(values.copied());
    let (factor, prefix) = prefix_of(extent);
    (
        format!("{symbol} ({prefix}{unit})"),
        bar_ends(extent, factor),
        factor as f32,
    )
}

/// How long each picture of a movie is shown, in hundredths of a second.
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

/// The pictures of a movie, to be drawn, and their colours.
///
/// # Errors
/// When they cannot be drawn.
pub fn pictures(movie: &Movie) -> Result<MoviePictures<'_>, ResultsError> {
    MoviePictures::of(movie).map_err(not_drawn)
}

/// Draws the pictures of a movie one after the other, and gives each to `take`.
///
/// # Errors
/// Those of `take`.
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
pub fn gif(movie: &Movie) -> Result<Vec<u8>, ResultsError> {
    let pictures = pictures(movie)?;
    let mut delays = delays(movie).into_iter();
    let mut file = MovieGif::of(pictures.palette()).map_err(not_drawn)?;
    let drawn = draw(movie, &pictures, |pixels| {
        file.add(pixels, delays.next().unwrap_or_default())
    });
    drawn.and_then(|()| file.finish()).map_err(not_drawn)
}

fn not_drawn(source: PictureError) -> ResultsError {
    ResultsError::Picture {
        name: "the movie",
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_have_the_prefix_that_suits() {
        let values = [-2e-9_f32, f32::NAN, 5e-9];
        let (title, range, unit) = scale(Field::DisplacementX, values.iter());
        assert_eq!((title.as_str(), unit), ("u_x (nm)", 1e-9));
        assert!((range[0] + 2.0).abs() < 1e-6 && (range[1] - 5.0).abs() < 1e-6);
        let still = [0.0_f32; 3];
        assert_eq!(scale(Field::VelocityY, still.iter()).1, [0.0, 1.0]);
        assert_eq!(scale(Field::Sliding, still.iter()).1, [0.0, 1.0]);
    }

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
