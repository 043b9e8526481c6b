//! A movie of a run, from its files: the snapshots of a field next to the friction curve.

use std::path::Path;

use slipfront::observe::Field;
use slipfront::parallel::*;
use slipfront_case::case::{MAX_PICTURES, memory_of_movie};
use slipfront_case::case_file::Motion;
use slipfront_plot::{Movie, MovieGif, MoviePictures, MovieSize, PictureError, SnapshotMap};

use super::error::RunPictureError;
use super::files::{case_of, found};
use super::friction::{dimensionless_axes, marked_curve};
use super::maps::{Snapshots, field_of_maps};
use crate::fields;
use crate::names::{FIELDS, SERIES};
use crate::run_files::RunFiles;
use crate::series::{self, SeriesRow};

/// Duration of a movie in hundredths of a second, as far as the limits on the duration of its pictures allow.
const DURATION: usize = 1600;
const SHORTEST: usize = 5;
const LONGEST: usize = 100;
/// Factor by which an instant A-F is shown longer than other pictures.
const INSTANT: usize = 5;

/// Largest number of pictures that are drawn at once.
const BATCH: usize = 8;
/// Shortest duration of a picture that viewers respect, in hundredths of a second.
const SHORTEST_SHOWN: f64 = 2.0;

/// Pace of a movie.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum MoviePace {
    /// About 16 s, with instants A-F shown longer.
    #[default]
    Usual,
    /// Duration in seconds, with instants A-F shown longer.
    Seconds(f64),
    /// Number of pictures per second, each shown as long as the others.
    PerSecond(f64),
}

/// Memory for making the movie of a run folder, in bytes. The data of a series take less than four times the
/// size of the file.
pub fn memory(folder: &Path) -> Result<f64, RunPictureError> {
    let snapshots = fields::count_snapshots(&folder.join(FIELDS))?.min(MAX_PICTURES);
    let series = found(&folder.join(SERIES))?.map_or(0, |file| file.len());
    Ok(memory_of_movie(snapshots as f64, f64::INFINITY) + 4.0 * series as f64)
}

/// The movie of a run, of the given field or of the field that its maps show; none if the run has kept no
/// snapshot of it.
///
/// # Errors
/// When a file cannot be read, or there are more than 1000 snapshots.
pub fn of_run(run: RunFiles, field: Option<Field>) -> Result<Option<Movie>, RunPictureError> {
    let case = case_of(run)?;
    let field = field.unwrap_or_else(|| field_of_maps(case.as_ref()));
    let all = |labels: &[String]| (0..labels.len().min(MAX_PICTURES + 1)).collect();
    let Some(mut snapshots) = Snapshots::read(run, case.as_ref(), field, all)? else {
        return Ok(None);
    };
    if snapshots.maps.maps.len() > MAX_PICTURES {
        return Err(RunPictureError::TooManySnapshots(MAX_PICTURES));
    }
    // There is no room for the title.
    snapshots.maps.value_title = snapshots.symbol;
    let mut curve = marked_curve(String::new(), &snapshots.summary);
    curve.x = snapshots
        .rows
        .iter()
        .map(|(_, time_star, _)| *time_star)
        .collect();
    curve.friction = snapshots.rows.iter().map(|(.., mu_star)| *mu_star).collect();
    Ok(Some(Movie {
        snapshots: snapshots.maps,
        curve,
        axes: dimensionless_axes(snapshots.summary.motion == Some(Motion::Rotation)),
    }))
}

/// Spacing in t* at which a run has at least this many snapshots from its start to its end, but at most one
/// per step.
///
/// # Errors
/// When the series cannot be read, or has no rows.
pub fn spacing(run: RunFiles, snapshots: usize) -> Result<f64, RunPictureError> {
    let end = |row: SeriesRow| (row.step, row.drive_time_star.unwrap_or(row.time_star));
    let rows = series::read_rows(&run.file(SERIES)?, SERIES, end)?;
    let Some((steps, end)) = rows.last().copied().filter(|(steps, _)| *steps > 0) else {
        return Err(not_drawn(PictureError::Nothing("step")));
    };
    Ok((end / snapshots.max(1) as f64).max(end / steps as f64))
}

/// Duration of each picture of a movie, in hundredths of a second.
///
/// # Errors
/// When pictures would be shown for too short a time.
pub fn delays(movie: &Movie, pace: MoviePace) -> Result<Vec<u16>, RunPictureError> {
    let weight = |frame: &SnapshotMap| {
        if frame.label.is_empty() {
            1.0
        } else {
            INSTANT as f64
        }
    };
    let (unit, weights): (f64, Vec<f64>) = match pace {
        MoviePace::Usual => return Ok(usual_delays(movie)),
        MoviePace::Seconds(seconds) => {
            let weights: Vec<f64> = movie.snapshots.maps.iter().map(weight).collect();
            (100.0 * seconds / weights.iter().sum::<f64>(), weights)
        }
        MoviePace::PerSecond(rate) => (100.0 / rate, vec![1.0; movie.snapshots.maps.len()]),
    };
    if unit < SHORTEST_SHOWN {
        return Err(RunPictureError::TooFast {
            pictures: movie.snapshots.maps.len(),
            seconds: SHORTEST_SHOWN * weights.iter().sum::<f64>() / 100.0,
        });
    }
    // The ends of the pictures are rounded, so that the total duration is right.
    let mut end = 0.0;
    let ends = weights.iter().map(|weight| {
        let start: f64 = end;
        end += unit * weight;
        (end.round() - start.round()).min(f64::from(u16::MAX)) as u16
    });
    Ok(ends.collect())
}

fn usual_delays(movie: &Movie) -> Vec<u16> {
    let delay = (DURATION / movie.snapshots.maps.len().max(1)).clamp(SHORTEST, LONGEST);
    let frames = movie.snapshots.maps.iter();
    frames
        .map(|frame| match frame.label.as_str() {
            "" => delay as u16,
            _ => (INSTANT * delay).clamp(LONGEST, 2 * LONGEST) as u16,
        })
        .collect()
}

/// The pictures of a movie before they are drawn, and their colours.
///
/// # Errors
/// When the pictures cannot be drawn.
pub fn pictures(movie: &Movie, size: MovieSize) -> Result<MoviePictures<'_>, RunPictureError> {
    MoviePictures::new(movie, size).map_err(not_drawn)
}

/// Draws the pictures of a movie one after the other, and passes each to `take`.
///
/// # Errors
/// Errors of `take`.
pub fn draw<E>(
    movie: &Movie,
    pictures: &MoviePictures,
    mut take: impl FnMut(Vec<u8>) -> Result<(), E>,
) -> Result<(), E> {
    for first in (0..movie.snapshots.maps.len()).step_by(BATCH) {
        let batch = first..(first + BATCH).min(movie.snapshots.maps.len());
        let drawn: Vec<_> = batch.into_par_iter().map(|index| pictures.draw(index)).collect();
        drawn.into_iter().try_for_each(&mut take)?;
    }
    Ok(())
}

/// A movie as an animated GIF file, with the duration of each picture in hundredths of a second.
///
/// # Errors
/// When a picture cannot be drawn.
pub fn gif(movie: &Movie, size: MovieSize, delays: &[u16]) -> Result<Vec<u8>, RunPictureError> {
    let pictures = pictures(movie, size)?;
    let mut delays = delays.iter().copied();
    let mut file = MovieGif::new(pictures.palette(), size).map_err(not_drawn)?;
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
    use slipfront_plot::SnapshotMaps;

    use super::*;

    #[test]
    fn instants_are_shown_longer() {
        let frame = |label: &str| SnapshotMap {
            label: label.to_owned(),
            ..SnapshotMap::default()
        };
        let movie = |others: usize| Movie {
            snapshots: SnapshotMaps {
                maps: std::iter::once(frame("A"))
                    .chain((0..others).map(|_| frame("")))
                    .collect(),
                ..SnapshotMaps::default()
            },
            ..Movie::default()
        };
        let usual = |others: usize| delays(&movie(others), MoviePace::Usual).unwrap();
        assert_eq!(usual(199)[..2], [100, 8]);
        assert_eq!(usual(3)[..2], [200, 100]);
        assert_eq!(usual(999)[..2], [100, 5]);
        // An instant with 5 parts and 95 pictures with one part each share 10 s.
        let timed = delays(&movie(95), MoviePace::Seconds(10.0)).unwrap();
        assert_eq!(timed[..3], [50, 10, 10]);
        let timed = delays(&movie(196), MoviePace::Seconds(7.0)).unwrap();
        assert_eq!(timed.iter().map(|delay| usize::from(*delay)).sum::<usize>(), 700);
        // 100/30 hundredths, as 3, 4 and 3 in turn.
        let paced = delays(&movie(5), MoviePace::PerSecond(30.0)).unwrap();
        assert_eq!(paced, [3, 4, 3, 3, 4, 3]);
        let said = delays(&movie(995), MoviePace::Seconds(5.0))
            .unwrap_err()
            .to_string();
        assert!(said.contains("996 pictures take at least 20 s"), "{said}");
    }
}
