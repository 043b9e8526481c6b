//! Maps of the contact stress.

use crate::axis::Axis;
use crate::canvas::{Align, Area, Canvas, Image, level};
use crate::frame::{BAR_WIDTH, LOWER_ROOM, colour_bar, left_side, lower_side, placed, widest};
use crate::mask_outline::outline;
use crate::picture::{Picture, PictureError};
use crate::style::{BLACK, MARGIN, SIZE_LABEL, SIZE_TICK, TEXT_WIDTH, TICK_LENGTH, WHITE, WIDTH_MARK};
use crate::text::{Text, number};

/// More blocks than this along a side are averaged in groups.
const CELLS: usize = 256;
/// Maps in a row.
const COLUMNS: usize = 6;

const GAP: f64 = 30.0;
/// A single map is no wider than this: 44 mm.
const WIDEST: f64 = 520.0;
const TALLEST: f64 = 620.0;
/// The colour bar is no shorter than this.
const BAR_SHORTEST: f64 = 180.0;
/// A strip is drawn no thinner than this share of its length.
const THINNEST: f64 = 1.0 / 6.0;

/// One map of the contact stress.
#[derive(Clone, Debug, PartialEq)]
pub struct StressMap {
    /// Its letter or name.
    pub label: String,
    /// Its time.
    pub time_star: f64,
    /// mu* at that time; not written if NaN.
    pub mu_star: f64,
    /// `tau_c*` of every block, shape (ny, nx), row 0 at y = 0; NaN is left blank.
    pub values: Vec<f32>,
}

/// Maps of one lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct StressMaps {
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y.
    pub ny: usize,
    /// Edge of a block, in metres.
    pub block_size: f64,
    /// True for every textured block, shape (ny, nx).
    pub textured: Vec<bool>,
    /// The maps, in the order in which they are drawn.
    pub maps: Vec<StressMap>,
}

/// Draws the maps in one row (in more, if there are more than six), at most as wide as a journal's text (175
/// mm), all on one colour scale from 0 to 1, the textured area outlined.
///
/// A lattice of more than 256 blocks along a side is averaged in groups of blocks, blank ones left out; a
/// group counts as textured if most of its blocks are. A lattice more than six times as long as wide is drawn
/// as if it were six times.
///
/// # Errors
///
/// No map, a lattice without blocks, an array of the wrong length, a block size that is not a positive
/// length.
pub fn stress(maps: &StressMaps) -> Result<Picture, PictureError> {
    check(maps)?;
    let layout = Layout::of(maps);
    let mut canvas = Canvas::new(layout.width, layout.height);
    let cells = Cells {
        nx: maps.nx,
        ny: maps.ny,
        columns: maps.nx.min(CELLS),
        rows: maps.ny.min(CELLS),
    };
    let share = cells.mean(|block| if maps.textured[block] { 1.0 } else { 0.0 });
    let textured: Vec<bool> = share.into_iter().map(|share| share > 0.5).collect();
    let lines = outline(&textured, cells.columns, cells.rows);
    for (index, map) in maps.maps.iter().enumerate() {
        let area = layout.map(index);
        let values = cells.mean(|block| map.values[block]);
        // The image's first row is the uppermost.
        let levels = values
            .chunks_exact(cells.columns)
            .rev()
            .flatten()
            .map(|&value| level(value))
            .collect();
        canvas.image(Image {
            area,
            columns: cells.columns,
            levels,
        });
        for line in &lines {
            let corner = |&(x, y): &(usize, usize)| {
                let (x, y) = (x as f64 / cells.columns as f64, y as f64 / cells.rows as f64);
                (area.x + x * area.width, area.bottom() - y * area.height)
            };
            draw_outline(&mut canvas, &line.iter().map(corner).collect::<Vec<_>>());
        }
        canvas.frame(area);
        layout.draw_titles(&mut canvas, index, map);
    }
    layout.draw_axes(&mut canvas, maps.maps.len());
    layout.draw_bar(&mut canvas);
    canvas.finish()
}

fn check(maps: &StressMaps) -> Result<(), PictureError> {
    let StressMaps {
        nx, ny, block_size, ..
    } = *maps;
    let expected = nx
        .checked_mul(ny)
        .filter(|&count| count > 0)
        .ok_or(PictureError::Lattice { nx, ny })?;
    if !(block_size > 0.0 && block_size < 1e9) {
        return Err(PictureError::BlockSize(block_size.to_string()));
    }
    if maps.maps.is_empty() {
        return Err(PictureError::Nothing("map"));
    }
    let mut lengths = vec![("the texture".to_string(), maps.textured.len())];
    lengths.extend(
        maps.maps
            .iter()
            .map(|map| (format!("map `{}`", map.label), map.values.len())),
    );
    match lengths.into_iter().find(|(_, found)| *found != expected) {
        Some((what, found)) => Err(PictureError::Blocks {
            what,
            found,
            expected,
        }),
        None => Ok(()),
    }
}

/// A dark line with a pale rim, seen on every colour of the ramp.
pub(crate) fn draw_outline(canvas: &mut Canvas, corners: &[(f64, f64)]) {
    let mut points = corners.to_vec();
    // A closed line is drawn past its start: only so is that corner rounded like the others.
    if points.len() > 2 && points.first() == points.last() {
        points.push(points[1]);
    }
    canvas.polyline(points.clone(), WIDTH_MARK + 3.0, WHITE);
    canvas.polyline(points, WIDTH_MARK, BLACK);
}

/// Blocks gathered into the cells that are drawn.
struct Cells {
    nx: usize,
    ny: usize,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// The mean of every cell over its blocks that are not NaN.
    fn mean(&self, value: impl Fn(usize) -> f32) -> Vec<f32> {
        let from = |cell: usize, cells: usize, blocks: usize| cell * blocks / cells;
        let mut means = Vec::with_capacity(self.columns * self.rows);
        for row in 0..self.rows {
            let ys = from(row, self.rows, self.ny)..from(row + 1, self.rows, self.ny);
            for column in 0..self.columns {
                let xs = from(column, self.columns, self.nx)..from(column + 1, self.columns, self.nx);
                let (mut sum, mut count) = (0.0f64, 0u32);
                for y in ys.clone() {
                    for x in xs.clone() {
                        let value = value(y * self.nx + x);
                        if !value.is_nan() {
                            sum += f64::from(value);
                            count += 1;
                        }
                    }
                }
                means.push((sum / f64::from(count)) as f32);
            }
        }
        means
    }
}

/// Where everything is.
struct Layout {
    width: f64,
    height: f64,
    /// Maps in a row.
    columns: usize,
    rows: usize,
    map_width: f64,
    map_height: f64,
    left: f64,
    top: f64,
    pitch_x: f64,
    pitch_y: f64,
    /// The slider's extent along x and y, in `unit`.
    extent: (f64, f64),
    unit: &'static str,
}

impl Layout {
    fn of(maps: &StressMaps) -> Self {
        let (length_x, length_y) = (maps.nx as f64 * maps.block_size, maps.ny as f64 * maps.block_size);
        let (unit, factor) = unit_of(length_x.max(length_y));
        let extent = (length_x * factor, length_y * factor);
        let columns = maps.maps.len().min(COLUMNS);
        let rows = maps.maps.len().div_ceil(COLUMNS);
        let ratio = (length_y / length_x).clamp(THINNEST, 1.0 / THINNEST);

        let numbers_y = widest(&placed(&axis_of(extent.1), 4));
        let left = (MARGIN + f64::from(SIZE_LABEL) + 12.0 + numbers_y + TICK_LENGTH + 7.0).round();
        let right = bar_room();
        let room = (TEXT_WIDTH - left - right + GAP) / columns as f64;
        let map_width = (room - GAP).min(WIDEST).min(TALLEST / ratio).round();
        let map_height = (map_width * ratio).round();
        // A narrow map may have a wider title.
        let titles = maps
            .maps
            .iter()
            .map(|map| title(map).width())
            .fold(map_width, f64::max);
        let pitch_x = (titles + GAP).min(room).max(map_width + GAP).round();

        let top = (MARGIN + 2.0 * f64::from(SIZE_LABEL) + 18.0).round();
        let pitch_y = map_height + LOWER_ROOM + top - MARGIN;
        let lowest = (rows - 1) as f64 * pitch_y + map_height + LOWER_ROOM;
        Self {
            width: left + columns as f64 * pitch_x - GAP + right,
            height: top + lowest.max(BAR_SHORTEST + 2.0 * MARGIN),
            columns,
            rows,
            map_width,
            map_height,
            left,
            top,
            pitch_x,
            pitch_y,
            extent,
            unit,
        }
    }

    /// The area of a map.
    fn map(&self, index: usize) -> Area {
        let (column, row) = (index % self.columns, index / self.columns);
        let slack = self.pitch_x - GAP - self.map_width;
        Area {
            x: (self.left + column as f64 * self.pitch_x + 0.5 * slack).round(),
            y: self.top + row as f64 * self.pitch_y,
            width: self.map_width,
            height: self.map_height,
        }
    }

    fn draw_titles(&self, canvas: &mut Canvas, index: usize, map: &StressMap) {
        let area = self.map(index);
        let middle = area.x + 0.5 * area.width;
        let mut upper = title(map);
        if upper.width() > self.pitch_x - 0.5 * GAP {
            upper = Text::shortened(&map.label, SIZE_LABEL, self.pitch_x - 0.5 * GAP);
        }
        canvas.text(&upper, (middle, area.y - 58.0), Align::Middle, BLACK);
        if map.mu_star.is_finite() {
            let lower = Text::plain(&format!("\u{3bc}* = {}", number(map.mu_star, 3)), SIZE_TICK);
            canvas.text(&lower, (middle, area.y - 16.0), Align::Middle, BLACK);
        }
    }

    /// Numbers below the lowest map of every column and left of every row.
    fn draw_axes(&self, canvas: &mut Canvas, count: usize) {
        for index in 0..count {
            let area = self.map(index);
            if index % self.columns == 0 {
                let axis = Axis {
                    start: area.bottom(),
                    end: area.y,
                    ..axis_of(self.extent.1)
                };
                let most = if area.height < 130.0 { 2 } else { 4 };
                let mut lowest = f64::INFINITY;
                let mut ticks = placed(&axis, most);
                for (at, text) in &mut ticks {
                    // A number that would touch the one before is left out.
                    if *at + text.height() + 8.0 > lowest {
                        *text = Text::plain("", SIZE_TICK);
                    } else {
                        lowest = *at;
                    }
                }
                let title = Text::plain(&format!("y ({})", self.unit), SIZE_LABEL);
                left_side(canvas, area, area.x - self.left, &ticks, &title);
            }
            if index + self.columns >= count {
                let axis = Axis {
                    start: area.x,
                    end: area.right(),
                    ..axis_of(self.extent.0)
                };
                let most = if area.width < 130.0 { 2 } else { 4 };
                let mut free = f64::NEG_INFINITY;
                let limit = area.x + 0.5 * (area.width + self.pitch_x) - 4.0;
                let mut ticks = placed(&axis, most);
                for (at, text) in &mut ticks {
                    let half = 0.5 * text.width();
                    // Nor may it touch the next map's first.
                    if *at - half < free || *at + half > limit {
                        *text = Text::plain("", SIZE_TICK);
                    } else {
                        free = *at + half + 12.0;
                    }
                }
                let title = Text::plain(&format!("x ({})", self.unit), SIZE_LABEL);
                lower_side(canvas, area, &ticks, &title);
            }
        }
    }

    /// The colour bar, as tall as all rows.
    fn draw_bar(&self, canvas: &mut Canvas) {
        let height = ((self.rows - 1) as f64 * self.pitch_y + self.map_height).max(BAR_SHORTEST);
        let x = self.left + self.columns as f64 * self.pitch_x;
        let area = Area {
            x,
            y: self.top,
            width: BAR_WIDTH,
            height,
        };
        let axis = Axis {
            lo: 0.0,
            hi: 1.0,
            start: area.bottom(),
            end: area.y,
        };
        colour_bar(canvas, area, &placed(&axis, 5));
        let title = Text::math("\u{3c4}_c*", SIZE_LABEL);
        canvas.text(
            &title,
            (area.x + 0.5 * area.width, area.y - 22.0),
            Align::Middle,
            BLACK,
        );
    }
}

/// The first line over a map.
fn title(map: &StressMap) -> Text {
    let time = format!("t* = {}", number(map.time_star, 1));
    // A map may be named after its time.
    if map.label.is_empty() || map.label.starts_with("t*") {
        return Text::plain(if map.label.is_empty() { &time } else { &map.label }, SIZE_LABEL);
    }
    Text::plain(&format!("{}: {time}", map.label), SIZE_LABEL)
}

/// The unit in which a length reads well, and how many of it make a metre.
fn unit_of(length: f64) -> (&'static str, f64) {
    match length {
        ..1e-6 => ("nm", 1e9),
        ..1e-3 => ("\u{b5}m", 1e6),
        ..1.0 => ("mm", 1e3),
        _ => ("m", 1.0),
    }
}

fn axis_of(extent: f64) -> Axis {
    Axis {
        lo: 0.0,
        hi: extent,
        start: 0.0,
        end: 1.0,
    }
}

/// The room for the colour bar and its numbers, right of the last map.
fn bar_room() -> f64 {
    GAP + BAR_WIDTH + TICK_LENGTH + 7.0 + Text::plain("0.0", SIZE_TICK).width() + MARGIN
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps(nx: usize, ny: usize, count: usize) -> StressMaps {
        let map = |index: usize| StressMap {
            label: ["A", "B", "C", "D", "E", "F", "G"][index].to_string(),
            time_star: 12.34 * index as f64,
            mu_star: 0.5,
            values: (0..nx * ny)
                .map(|block| block as f32 / (nx * ny) as f32)
                .collect(),
        };
        let textured = (0..nx * ny).map(|block| block % nx == nx / 2 && nx > 2).collect();
        StressMaps {
            nx,
            ny,
            block_size: 1e-6,
            textured,
            maps: (0..count).map(map).collect(),
        }
    }

    #[test]
    fn the_same_maps_give_the_same_bytes() {
        assert_eq!(
            stress(&maps(10, 10, 2)).unwrap(),
            stress(&maps(10, 10, 2)).unwrap()
        );
    }

    #[test]
    fn every_shape_is_drawn_within_the_width_of_a_page() {
        for (nx, ny, count) in [
            (50, 50, 6),
            (50, 50, 7),
            (200, 1, 6),
            (1, 200, 6),
            (1, 1, 1),
            (300, 20, 2),
        ] {
            let maps = maps(nx, ny, count);
            let layout = Layout::of(&maps);
            assert!(layout.width <= TEXT_WIDTH + 6.0, "{nx} x {ny}: {}", layout.width);
            let last = layout.map(count - 1);
            assert!(last.bottom() < layout.height && last.width >= 40.0 && last.height >= 40.0);
            stress(&maps).unwrap();
        }
    }

    #[test]
    fn blank_maps_and_unknown_friction_are_drawn() {
        let mut blank = maps(4, 4, 1);
        blank.maps[0].values.fill(f32::NAN);
        blank.maps[0].mu_star = f64::NAN;
        let svg = stress(&blank).unwrap().svg;
        assert!(svg.contains(">A: t* = 0.0</text>") && !svg.contains("NaN"));
    }

    #[test]
    fn groups_of_blocks_are_averaged_without_the_blank_ones() {
        let cells = Cells {
            nx: 4,
            ny: 2,
            columns: 2,
            rows: 1,
        };
        let values = [1.0, 2.0, f32::NAN, f32::NAN, 3.0, f32::NAN, f32::NAN, f32::NAN];
        let means = cells.mean(|block| values[block]);
        assert!(means[0] == 2.0 && means[1].is_nan());
    }

    #[test]
    fn a_large_lattice_stays_a_small_file() {
        let picture = stress(&maps(1000, 600, 1)).unwrap();
        assert!(picture.svg.len() < 300_000, "{}", picture.svg.len());
    }

    #[test]
    fn what_does_not_fit_the_lattice_is_refused() {
        let error = |change: &dyn Fn(&mut StressMaps)| {
            let mut maps = maps(2, 3, 1);
            change(&mut maps);
            stress(&maps).unwrap_err().to_string()
        };
        assert_eq!(error(&|m| m.nx = 0), "a lattice of 0 x 3 blocks cannot be drawn");
        assert_eq!(
            error(&|m| m.nx = usize::MAX),
            format!("a lattice of {} x 3 blocks cannot be drawn", usize::MAX)
        );
        assert_eq!(
            error(&|m| m.block_size = f64::NAN),
            "a block size of NaN m cannot be drawn"
        );
        assert_eq!(error(&|m| m.maps.clear()), "there is no map to draw");
        assert_eq!(
            error(&|m| m.textured.clear()),
            "the texture has 0 values, but the lattice has 6 blocks"
        );
        assert_eq!(
            error(&|m| m.maps[0].values.push(0.0)),
            "map `A` has 7 values, but the lattice has 6 blocks"
        );
    }

    #[test]
    fn the_unit_follows_the_length() {
        let units = [5e-7, 5e-5, 5e-2, 5.0].map(|length| unit_of(length).0);
        assert_eq!(units, ["nm", "\u{b5}m", "mm", "m"]);
    }
}
