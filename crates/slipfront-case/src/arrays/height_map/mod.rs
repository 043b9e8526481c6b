//! Measured topography: height maps of many formats, with the mean height of every block and their roughness.
//!
//! A file is read several times, for its mean and for the deviations from it. Only a line, a strip or tile,
//! or a MiB of numbers is in memory at a time.

mod averages;
mod axis;
mod grid;
mod gsf;
mod image;
mod preparation;
mod quantum;
mod roughness;
mod text;
mod tiff;
mod x3p;

use std::io::{BufRead, Seek};
use std::path::Path;

pub use preparation::Preparation;
pub use roughness::Roughness;

use self::averages::Averages;
use self::axis::FirstLines;
use self::grid::{HeightGrid, Line, Take, points};
use self::quantum::Quantum;
use self::roughness::{HeightRange, Mean, Moments, Plane, PlaneSums};
use super::array_file::ArrayFile;
use super::error::{ArrayError, contents_error, extension, unknown_extension};
use super::npy;
use crate::extremes::Extremes;
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// Units of a height map that the case states, m; one that differs from that of the file is refused.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeightMapUnits {
    /// Height in m of the value 1 in the file.
    pub height: Option<f64>,
    /// Point spacing along x and along y.
    pub pixel: Option<[f64; 2]>,
}

/// Blocks that a height map covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Blocks along x and along y.
    pub blocks: [usize; 2],
    /// Whether the blocks are one place of a pattern, rather than the slider.
    pub is_place: bool,
}

/// A height map laid over blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct HeightMap {
    /// Points of the file along x and along y.
    pub points: [usize; 2],
    /// True size of the map along x and along y, m.
    pub size: [f64; 2],
    /// Roughness of all measured points, after levelling if the map is levelled.
    pub roughness: Roughness,
    /// Sentences on doubtful features of the map.
    pub notes: Vec<String>,
    /// Mean height of every block, m, row by row in rising y.
    pub blocks: Vec<f64>,
}

/// Reads the height map called `path`, and averages it over the given blocks.
///
/// The first row of an array, `.npy` or a text table, has the smallest y. The first row of every other file,
/// of the text export of Gwyddion, of ESRI grids and of tables of Keyence, is the top row, at the largest y.
///
/// # Errors
/// [`ArrayError`] if the file has another format, more than 2^28 points or more than 2^20 along a side; if a
/// point has no height and is not marked as missing; if a block has no measured point; if a unit is given
/// neither in the file nor in `units`, or differs in both; or if the map does not have the aspect ratio of
/// the blocks.
pub fn height_map(
    path: &Path,
    source: &mut (impl BufRead + Seek),
    units: &HeightMapUnits,
    preparation: &Preparation,
    room: &Room,
) -> Result<HeightMap, ArrayError> {
    let mut file = ArrayFile { path, source };
    let too_far_apart = || {
        let problem = "has heights too far apart to be averaged: check its numbers".to_owned();
        contents_error(path, problem)
    };
    let range_of = |mean: &Mean| {
        let of_all = mean.of_all();
        let is_finite = |range: HeightRange| (range.highest - range.lowest).is_finite();
        let found = of_all.filter(|(mean, range)| is_finite(*range) && mean.is_finite());
        found.ok_or_else(too_far_apart)
    };
    let (mut mean, mut edges, mut extremes) = (Mean::default(), FirstLines::default(), Extremes::default());
    let grid = read(&mut file, preparation, &mut |line| {
        mean.add(line.heights);
        extremes.add(line.heights);
        edges.add(line);
        Ok(())
    })?;
    let (pixel, unit) = (pixel(path, &grid, units)?, height_unit(path, &grid, units)?);
    let points = grid.points;
    let size = [0, 1].map(|axis| points[axis] as f64 * pixel[axis]);
    keep_aspect(path, size, room, edges.axis_warning())?;
    let n_missing = points[0] * points[1] - mean.count();
    let (mut middle, mut range) = range_of(&mean)?;

    let mut plane = Plane::default();
    if preparation.is_levelled {
        let mut sums = PlaneSums::new(points);
        read(&mut file, preparation, &mut |line| {
            sums.add(line, middle);
            Ok(())
        })?;
        plane = sums.plane();
        let (mut levelled, mut heights) = (Mean::default(), Vec::new());
        read(&mut file, preparation, &mut |line| {
            plane.subtract(line, &mut heights);
            levelled.add(&heights);
            Ok(())
        })?;
        (middle, range) = range_of(&levelled)?;
    }
    let (mut moments, mut sums) = (Moments::default(), PlaneSums::new(points));
    let mut averages = Averages::new(points, room.blocks, Quantum::for_range(range));
    let mut heights = Vec::new();
    read(&mut file, preparation, &mut |line| {
        if line.row >= points[1] || line.column + line.heights.len() > points[0] {
            return Err(contents_error(
                path,
                "changed while it was read: try again".to_owned(),
            ));
        }
        plane.subtract(line, &mut heights);
        let levelled = Line {
            heights: &heights,
            ..*line
        };
        moments.add(&heights, middle);
        sums.add(&levelled, middle);
        averages.add(&Line {
            row: if grid.top_first {
                points[1] - 1 - line.row
            } else {
                line.row
            },
            ..levelled
        });
        Ok(())
    })?;
    let roughness = moments.roughness(unit);
    let is_finite = |number: Option<f64>| number.is_none_or(f64::is_finite);
    if ![Some(roughness.sq), roughness.ssk, roughness.sku]
        .into_iter()
        .all(is_finite)
    {
        return Err(too_far_apart());
    }
    let blocks: Vec<f64> = averages.means().map(|mean| mean * unit).collect();
    if let Some(gap) = blocks.iter().position(|mean| mean.is_nan()) {
        let [nx, _] = room.blocks;
        let problem = format!(
            "has no measured point in the block in column {} and row {} (both counted from 0, row 0 at y = 0): fill its gaps by \
             interpolation, or use larger blocks",
            gap % nx,
            gap / nx
        );
        return Err(contents_error(path, problem));
    }
    let mut notes = grid.notes;
    notes.extend(edges.axis_warning());
    if n_missing > 0 {
        notes.push(format!(
            "{} of its {} points were not measured: blocks have the mean of the others",
            n_missing,
            points[0] * points[1]
        ));
    }
    notes.extend(doubts(
        &roughness,
        sums.plane().share,
        range,
        size,
        unit,
        &extremes,
    ));
    Ok(HeightMap {
        points,
        size,
        roughness,
        notes,
        blocks,
    })
}

/// Sentences on doubtful features of a map: a tilt, impossible heights, and values that are not heights.
fn doubts(
    roughness: &Roughness,
    share_of_plane: f64,
    range: HeightRange,
    size: [f64; 2],
    unit: f64,
    extremes: &Extremes,
) -> Vec<String> {
    let mut doubts = Vec::new();
    if share_of_plane > LARGE_TILT {
        doubts.push(format!(
            "a plane contains {} % of the variance of its heights, so only one side is in contact: level the map with `level = \"plane\"`",
            four_digits(100.0 * share_of_plane)
        ));
    }
    let marks = extremes.marks();
    for (mark, points) in &marks {
        doubts.push(format!(
            "{} the height {mark} in the unit of the file, far from all others, which may mark points that were not measured: omit \
             them with `missing = {mark}`",
            if *points == 1 { "1 of its points has".to_owned() } else { format!("{points} of its points have") }
        ));
    }
    let height = (range.highest - range.lowest) * unit;
    if marks.is_empty() && height > size[0].max(size[1]) {
        doubts.push(format!(
            "its heights range over {}, more than its width: check `height_unit` and `pixel_size`",
            with_si_prefix(height, "m")
        ));
    }
    if marks.is_empty() && height > FAR_OFF * roughness.sq {
        doubts.push(format!(
            "a few of its heights are far from all others, within {} to {} in the unit of the file: check whether they are heights",
            range.lowest, range.highest
        ));
    }
    doubts
}

/// Share of the variance above which a map counts as tilted: for a single step in the middle, a plane takes
/// three quarters of the variance.
const LARGE_TILT: f64 = 0.9;
/// Ratio of the range of heights to their root mean square above which the extremes may be no heights: for a
/// normal distribution and a thousand million points it is 12.
const FAR_OFF: f64 = 50.0;

/// Reads all points of a file. Missing points become NaN; all others are finite.
fn read(file: &mut ArrayFile, preparation: &Preparation, take: &mut Take) -> Result<HeightGrid, ArrayError> {
    let (path, mut marked) = (file.path, Vec::new());
    read_file(file, preparation, &mut |line| {
        marked.clear();
        for (column, &height) in (line.column..).zip(line.heights) {
            let is_missing = preparation.is_missing(height);
            if !is_missing && !height.is_finite() {
                return Err(not_measured(path, height, [line.row, column]));
            }
            marked.push(if is_missing { f64::NAN } else { height });
        }
        take(&Line {
            heights: &marked,
            ..*line
        })
    })
}

/// Reads all points of a file without any treatment.
fn read_file(
    file: &mut ArrayFile,
    preparation: &Preparation,
    take: &mut Take,
) -> Result<HeightGrid, ArrayError> {
    let path = file.path;
    file.source.rewind().map_err(ArrayError::read(path))?;
    let take_line = |[row, column]: [usize; 2], heights: &[f64]| take(&Line { row, column, heights });
    let [nx, ny] = match extension(path).as_str() {
        "npy" => npy::rows(file, take_line)?,
        "csv" | "txt" | "dat" | "asc" | "xyz" => return text::read(file, preparation, take),
        "gsf" => return gsf::read(file, take),
        "x3p" => return x3p::read(file, preparation.is_missing(f64::NAN), take),
        "png" => return image::read(file, take),
        "tif" | "tiff" => return tiff::read(file, take),
        other => {
            let known = ".npy, .csv (.txt, .dat, .asc, .xyz), .gsf, .x3p, .png or .tif; Gwyddion and the Python package SurfaceTopography \
                         write them from files of instruments";
            return Err(unknown_extension(path, other, known));
        }
    };
    Ok(HeightGrid::without_units(points(path, "array", nx, ny)?, false))
}

fn not_measured(path: &Path, height: f64, [row, column]: [usize; 2]) -> ArrayError {
    let remedy = match height.is_nan() {
        true => ", or leave them out with `missing = \"nan\"`",
        false => "",
    };
    let problem = format!(
        "has {height} in row {row}, column {column} (both counted from 0), but must have a height: fill missing points by \
         interpolation{remedy}"
    );
    contents_error(path, problem)
}

/// Point spacing, m, from the file or from the case.
fn pixel(path: &Path, grid: &HeightGrid, units: &HeightMapUnits) -> Result<[f64; 2], ArrayError> {
    match (grid.pixel, units.pixel) {
        (Some(pixel), None) | (None, Some(pixel)) => Ok(pixel),
        (Some(stated), Some(given)) if [0, 1].iter().all(|&axis| is_same(stated[axis], given[axis])) => {
            Ok(stated)
        }
        (Some([x, y]), Some(_)) => {
            let (x, y) = (with_si_prefix(x, "m"), with_si_prefix(y, "m"));
            let problem = format!("gives a pixel size of {x} x {y}: leave out `pixel_size`");
            Err(contents_error(path, problem))
        }
        (None, None) => {
            let problem = "gives no pixel size: add `pixel_size`, such as pixel_size = \"0.5 um\"";
            Err(contents_error(path, problem.to_owned()))
        }
    }
}

/// Whether a length in a file, which has some digits, is the one in the case.
fn is_same(stated: f64, given: f64) -> bool {
    (stated - given).abs() <= 1e-6 * stated.abs()
}

/// Height in m of the value 1 in the file, from the file or from the case.
fn height_unit(path: &Path, grid: &HeightGrid, units: &HeightMapUnits) -> Result<f64, ArrayError> {
    match (grid.height_unit, units.height) {
        (Some(unit), None) | (None, Some(unit)) => Ok(unit),
        (Some(stated), Some(given)) if is_same(stated, given) => Ok(stated),
        (Some(unit), Some(_)) => {
            let unit = with_si_prefix(unit, "m");
            let problem = format!("gives its heights in units of {unit}: leave out `height_unit`");
            Err(contents_error(path, problem))
        }
        (None, None) => {
            let problem = "gives no unit of height: add `height_unit`, such as height_unit = \"1 nm\"";
            Err(contents_error(path, problem.to_owned()))
        }
    }
}

/// Refuses a map, with a warning about its first lines, if its aspect ratio differs from that of the blocks
/// by more than half a block of the longer side.
fn keep_aspect(path: &Path, size: [f64; 2], room: &Room, warning: Option<String>) -> Result<(), ArrayError> {
    let blocks = room.blocks;
    let aspect = size[0] / size[1];
    let (longer, shorter, ratio) = if aspect >= 1.0 {
        (0, 1, aspect)
    } else {
        (1, 0, 1.0 / aspect)
    };
    let wanted = blocks[shorter] as f64 * ratio;
    if (wanted - blocks[longer] as f64).abs() <= 0.5 {
        return Ok(());
    }
    let mut right = blocks;
    right[longer] = wanted.round() as usize;
    let problem = format!(
        "is {} x {}, {} times as wide as high, and the {} x {} blocks {} are {} times as wide as high: cut the map, or take {} x {} blocks \
         there{}",
        with_si_prefix(size[0], "m"),
        with_si_prefix(size[1], "m"),
        four_digits(aspect),
        blocks[0],
        blocks[1],
        if room.is_place {
            "in every place of the pattern"
        } else {
            "of the slider"
        },
        four_digits(blocks[0] as f64 / blocks[1] as f64),
        right[0],
        right[1],
        warning.map_or(String::new(), |warning| format!("; {warning}"))
    );
    Err(contents_error(path, problem))
}
