//! Maps of values over the blocks of a lattice.

use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::color_image::{Image, level};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::mask_outline::outline;
use crate::picture_error::PictureError;
use crate::style::{BLACK, RADIUS_MARKER, Rgb, SIZE_TEXT, WHITE, WIDTH_MARK};
use crate::text::{Text, number};

/// Least width of maps side by side in a picture of requested width, 21 mm.
pub(crate) const MIN_MAP: f64 = 250.0;
/// Least thickness of a strip over its length.
pub(crate) const MIN_RATIO: f64 = 1.0 / 6.0;
/// Ratio of the width of a stripe of texture to the largest width of its outline.
const STRIPE_WIDTHS: f64 = 12.0;
/// Heights above a map of the second and the first line of text.
const NOTE_ABOVE: f64 = 22.0;
const LABEL_ABOVE: f64 = 62.0;
/// Distance of a line of a label from the next one.
pub(crate) const LINE: f64 = 40.0;
/// Room for both lines over a map, and for the second one.
pub(crate) const TITLE_ROOM: f64 = LABEL_ABOVE + SIZE_TEXT as f64;
pub(crate) const NOTE_ROOM: f64 = NOTE_ABOVE + SIZE_TEXT as f64;

/// The number of blocks, if a lattice has any and they can be counted.
pub(crate) fn block_count(nx: usize, ny: usize) -> Result<usize, PictureError> {
    let count = nx.checked_mul(ny).filter(|&count| count > 0);
    count.ok_or(PictureError::Lattice { nx, ny })
}

/// Refuses an array that does not have one value for every block.
pub(crate) fn check_length(what: &str, found: usize, expected: usize) -> Result<(), PictureError> {
    if found == expected {
        return Ok(());
    }
    Err(PictureError::Blocks {
        what: what.to_string(),
        found,
        expected,
    })
}

/// The unit in which a length reads well, and the number of units in a metre.
pub(crate) fn unit_of(length: f64) -> (&'static str, f64) {
    match length {
        ..1e-6 => ("nm", 1e9),
        ..1e-3 => ("\u{b5}m", 1e6),
        ..1.0 => ("mm", 1e3),
        _ => ("m", 1.0),
    }
}

/// A lattice of blocks as it is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DrawnLattice {
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y.
    pub ny: usize,
    /// Edge of a block, in metres.
    pub block_size: f64,
    /// True for every mostly textured [cell](CellMeans), row by row from y = 0.
    pub textured: Vec<bool>,
}

impl DrawnLattice {
    /// Refuses a lattice that cannot be drawn, and these arrays if they do not have one value for every cell.
    pub(crate) fn check(&self, arrays: &[(String, &[f32])]) -> Result<(), PictureError> {
        block_count(self.nx, self.ny)?;
        if !(self.block_size > 0.0 && self.block_size < 1e9) {
            return Err(PictureError::BlockSize(self.block_size.to_string()));
        }
        let [columns, rows] = CellMeans::cells(self.nx, self.ny);
        check_length("the texture", self.textured.len(), columns * rows)?;
        arrays
            .iter()
            .try_for_each(|(what, values)| check_length(what, values.len(), columns * rows))
    }

    /// Lengths of the sides, in metres.
    pub(crate) fn sides(&self) -> [f64; 2] {
        [self.nx, self.ny].map(|count| count as f64 * self.block_size)
    }

    pub(crate) fn cells(&self) -> Cells {
        Cells::new(self.nx, self.ny, &self.textured)
    }
}

/// Maps of a field at snapshots of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SnapshotMaps {
    /// The lattice of all maps.
    pub lattice: DrawnLattice,
    /// The maps, in the order of time.
    pub maps: Vec<SnapshotMap>,
    /// Quantity of the values, at the colour bar; the character after an underscore is a subscript.
    pub value_title: String,
    /// Values at the ends of the colour bar; values beyond are drawn as the ends.
    pub range: [f64; 2],
}

/// A map of a field at a snapshot of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SnapshotMap {
    /// Letters of the instants A-F that the map shows, such as "A, B", or its name; may be empty.
    pub label: String,
    /// Time t* of the map.
    pub time_star: f64,
    /// Friction coefficient mu* at that time; not written if NaN.
    pub mu_star: f64,
    /// Mean of every [cell](CellMeans), row by row from y = 0; NaN is left blank.
    pub values: Vec<f32>,
}

impl SnapshotMaps {
    /// Refuses maps that cannot be drawn.
    pub(crate) fn check(&self) -> Result<(), PictureError> {
        if self.maps.is_empty() {
            return Err(PictureError::Nothing("map"));
        }
        let named = |map: &SnapshotMap| format!("the map at t* = {}", map.time_star);
        let arrays = self.maps.iter().map(|map| (named(map), &map.values[..]));
        self.lattice.check(&arrays.collect::<Vec<_>>())
    }
}

impl SnapshotMap {
    /// Letters or name, and time.
    pub(crate) fn time_title(&self) -> String {
        let time = format!("t* = {}", number(self.time_star, 1));
        match self.label.as_str() {
            "" => time,
            // A map may be named after its time.
            label if label.starts_with("t*") => label.to_owned(),
            label => format!("{label}: {time}"),
        }
    }

    /// Friction; empty if it is not known.
    pub(crate) fn friction_title(&self) -> String {
        if !self.mu_star.is_finite() {
            return String::new();
        }
        format!("\u{3bc}* = {}", number(self.mu_star, 3))
    }
}

/// The cells in which a lattice is drawn: its blocks, or groups of them.
pub(crate) struct Cells {
    columns: usize,
    rows: usize,
    /// The share of textured cells.
    textured_share: f64,
    /// The corners of the lines around the textured cells.
    outlines: Vec<Vec<(usize, usize)>>,
}

impl Cells {
    /// The cells of a lattice of `nx` x `ny` blocks, with marks of those that are textured.
    pub(crate) fn new(nx: usize, ny: usize, textured: &[bool]) -> Self {
        let [columns, rows] = CellMeans::cells(nx, ny);
        Self {
            columns,
            rows,
            textured_share: textured.iter().filter(|&&textured| textured).count() as f64
                / textured.len() as f64,
            outlines: outline(textured, columns, rows),
        }
    }

    /// Draws the means of all cells, with the colour scale over `range`, and the outline of the texture.
    pub(crate) fn draw(&self, canvas: &mut Canvas, area: Area, means: &[f32], range: [f64; 2]) {
        // The image's first row is the uppermost.
        let cells = means.chunks_exact(self.columns).rev().flatten();
        canvas.images.push(Image {
            area,
            columns: self.columns,
            levels: cells.map(|&mean| level(f64::from(mean), range)).collect(),
        });
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let corner = |&(x, y): &(usize, usize)| place(area, (x as f64 / columns, y as f64 / rows));
        let lines = self.outlines.iter();
        let lines: Vec<Vec<CanvasPoint>> = lines.map(|line| line.iter().map(corner).collect()).collect();
        // Width of a stripe with the area and edge length of the texture, or of the untextured part if that
        // is smaller.
        let edge: f64 = lines.iter().map(|line| length(line)).sum();
        let share = self.textured_share.min(1.0 - self.textured_share);
        let stripe = 2.0 * share * area.width * area.height / edge;
        let width = WIDTH_MARK.min(stripe / STRIPE_WIDTHS);
        for line in lines {
            rimmed_line(canvas, line, width, BLACK);
        }
    }
}

/// The point of a map at these fractions of the lattice's sides.
pub(crate) fn place(area: Area, (x, y): CanvasPoint) -> CanvasPoint {
    (area.x + x * area.width, area.bottom() - y * area.height)
}

/// The colour of marks, visible on every colour of the ramp.
pub(crate) const MARK: Rgb = [0xd5, 0x2b, 0x1e];
/// Number of corners with which the edge of a mark is drawn.
const MARK_CORNERS: usize = 24;

/// A circle with a pale rim, visible on every colour of the ramp.
pub(crate) fn circle(canvas: &mut Canvas, (x, y): CanvasPoint, colour: Rgb) {
    let corner = |k: usize| {
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * k as f64 / MARK_CORNERS as f64);
        (x + 1.5 * RADIUS_MARKER * cos, y + 1.5 * RADIUS_MARKER * sin)
    };
    let mut circle: Vec<CanvasPoint> = (0..MARK_CORNERS).map(corner).collect();
    circle.push(circle[0]);
    rimmed_line(canvas, circle, WIDTH_MARK, colour);
}

/// A line with a pale rim, visible on every colour of the ramp.
fn rimmed_line(canvas: &mut Canvas, points: Vec<CanvasPoint>, width: f64, colour: Rgb) {
    canvas.polyline(points.clone(), 2.2 * width, WHITE);
    canvas.polyline(points, width, colour);
}

/// The length of a line through points that are joined along x or y.
fn length(points: &[CanvasPoint]) -> f64 {
    let step = |pair: &[CanvasPoint]| (pair[0].0 - pair[1].0).abs() + (pair[0].1 - pair[1].1).abs();
    points.windows(2).map(step).sum()
}

/// Writes the lines of a label and a note over a map.
pub(crate) fn draw_titles(canvas: &mut Canvas, area: Area, label: &[Text], note: &Text) {
    let (middle, _) = area.centre();
    let has_note = note.width() > 0.0;
    let label_above = if has_note { LABEL_ABOVE } else { NOTE_ABOVE };
    for (above, line) in label.iter().rev().enumerate() {
        let baseline = area.y - label_above - LINE * above as f64;
        canvas.text(line, (middle, baseline), Align::Middle, BLACK);
    }
    canvas.text(note, (middle, area.y - NOTE_ABOVE), Align::Middle, BLACK);
}
