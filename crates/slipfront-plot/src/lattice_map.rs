//! A map of values over the blocks of a lattice, as stress maps and field maps draw it.

use crate::canvas::Canvas;
use crate::color_image::{Image, level};
use crate::geometry::{Align, Area, Point};
use crate::mask_outline::outline;
use crate::picture::PictureError;
use crate::style::{BLACK, SIZE_LABEL, WHITE, WIDTH_MARK};
use crate::text::Text;

/// More blocks than this along a side are averaged in groups.
const MAX_CELLS: usize = 256;
/// The second line over a map stands so far above it, the first one so far.
const NOTE_ABOVE: f64 = 16.0;
const LABEL_ABOVE: f64 = 56.0;
/// The room that both lines take.
pub(crate) const TITLE_ROOM: f64 = LABEL_ABOVE + SIZE_LABEL as f64;

/// The number of blocks, if a lattice has any and they can be counted.
pub(crate) fn block_count(nx: usize, ny: usize) -> Result<usize, PictureError> {
    let count = nx.checked_mul(ny).filter(|&count| count > 0);
    count.ok_or(PictureError::Lattice { nx, ny })
}

/// Refuses an array that has not one value for every block.
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

/// The cells in which a lattice is drawn: its blocks, or groups of them.
pub(crate) struct Cells {
    nx: usize,
    ny: usize,
    columns: usize,
    rows: usize,
    /// The corners of the lines around the textured cells.
    outlines: Vec<Vec<(usize, usize)>>,
}

impl Cells {
    /// The cells of a lattice. A group of blocks counts as textured if most of them are.
    pub(crate) fn of(nx: usize, ny: usize, textured: &[bool]) -> Self {
        let mut cells = Self {
            nx,
            ny,
            columns: nx.min(MAX_CELLS),
            rows: ny.min(MAX_CELLS),
            outlines: Vec::new(),
        };
        let share = cells.means(|block| if textured[block] { 1.0 } else { 0.0 });
        let textured: Vec<bool> = share.into_iter().map(|share| share > 0.5).collect();
        cells.outlines = outline(&textured, cells.columns, cells.rows);
        cells
    }

    /// The mean of every cell over its blocks that are not NaN.
    fn means(&self, value: impl Fn(usize) -> f32) -> Vec<f32> {
        let blocks = |cell: usize, cells, blocks| cell * blocks / cells..(cell + 1) * blocks / cells;
        let mean = |row: usize, column: usize| {
            let (mut sum, mut count) = (0.0f64, 0u32);
            for y in blocks(row, self.rows, self.ny) {
                for x in blocks(column, self.columns, self.nx) {
                    let value = value(y * self.nx + x);
                    if !value.is_nan() {
                        sum += f64::from(value);
                        count += 1;
                    }
                }
            }
            (sum / f64::from(count)) as f32
        };
        let cells = (0..self.rows).flat_map(|row| (0..self.columns).map(move |column| (row, column)));
        cells.map(|(row, column)| mean(row, column)).collect()
    }

    /// Draws the values of all blocks, the ends of the colours being those of `range`, and the outline of the texture.
    pub(crate) fn draw(&self, canvas: &mut Canvas, area: Area, values: &[f32], range: [f64; 2]) {
        let means = self.means(|block| values[block]);
        // The image's first row is the uppermost.
        let cells = means.chunks_exact(self.columns).rev().flatten();
        canvas.images.push(Image {
            area,
            columns: self.columns,
            levels: cells.map(|&mean| level(f64::from(mean), range)).collect(),
        });
        let (columns, rows) = (self.columns as f64, self.rows as f64);
        let corner = |&(x, y): &(usize, usize)| place(area, (x as f64 / columns, y as f64 / rows));
        for line in &self.outlines {
            rimmed_line(canvas, line.iter().map(corner).collect(), BLACK);
        }
    }
}

/// The point of a map at these fractions of the lattice's sides.
pub(crate) fn place(area: Area, (x, y): Point) -> Point {
    (area.x + x * area.width, area.bottom() - y * area.height)
}

/// A line with a pale rim, seen on every colour of the ramp.
pub(crate) fn rimmed_line(canvas: &mut Canvas, points: Vec<Point>, colour: [u8; 3]) {
    canvas.polyline(points.clone(), WIDTH_MARK + 3.0, WHITE);
    canvas.polyline(points, WIDTH_MARK, colour);
}

/// Writes two lines over a map.
pub(crate) fn draw_titles(canvas: &mut Canvas, area: Area, label: &Text, note: &Text) {
    let (middle, _) = area.centre();
    let has_note = note.width() > 0.0;
    let label_above = if has_note { LABEL_ABOVE } else { NOTE_ABOVE };
    canvas.text(label, (middle, area.y - label_above), Align::Middle, BLACK);
    canvas.text(note, (middle, area.y - NOTE_ABOVE), Align::Middle, BLACK);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_of_blocks_are_averaged_without_the_blank_ones() {
        let cells = Cells {
            nx: 4,
            ny: 2,
            columns: 2,
            rows: 1,
            outlines: Vec::new(),
        };
        let values = [1.0, 2.0, f32::NAN, f32::NAN, 3.0, f32::NAN, f32::NAN, f32::NAN];
        let means = cells.means(|block| values[block]);
        assert!(means[0] == 2.0 && means[1].is_nan());
    }
}
