//! Maps of the contact stress, or of another field, with axes along the slider's sides.

use crate::axis::DrawnAxis;
use crate::canvas::Canvas;
use crate::color_bar::{ABOVE, ColourBar};
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_side};
use crate::geometry::Area;
use crate::lattice_map::{
    MIN_MAP, MIN_RATIO, NOTE_ROOM, SnapshotMap, SnapshotMaps, TITLE_ROOM, draw_titles, unit_of,
};
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::size::PictureSize;
use crate::style::{MARGIN, SIZE_TEXT, TEXT_WIDTH};
use crate::text::Text;
use crate::ticks::{Direction, Tick};

const GAP: f64 = 30.0;
/// Largest width of maps side by side, 44 mm, and largest height.
const MAX_WIDTH: f64 = 520.0;
const MAX_HEIGHT: f64 = 620.0;
/// Ratios of length to width above which a slider is long and very long. A slider that is long along x has
/// two maps in a row, a very long one has one; a slider that is long along y has all maps in one row.
const LONG: f64 = 3.0;
const VERY_LONG: f64 = 10.0;
/// Least thickness of the map of a slider that is long along x, over its length.
const MIN_RATIO_WIDE: f64 = 1.0 / 12.0;
/// Length of a side below which it has fewer numbers.
const SHORT_SIDE: f64 = 130.0;

/// Draws the maps on one colour scale, with the textured area outlined. The picture is at most as wide as a
/// journal's text (175 mm), or as wide as requested. There are three maps in a row, or fewer if they would be
/// too small. A slider that is long along x has two maps in a row, or one; a slider that is long along y has
/// all in one row. `is_torque` says that mu* is the torque of a rotating drive.
///
/// A slider more than twelve times as long as wide (six times if it is long along y) is drawn with that
/// ratio.
///
/// # Errors
///
/// No map, a lattice without blocks, an array of the wrong length, a block size that is not a positive
/// length; a height, or a width without room for a map.
pub fn stress(maps: &SnapshotMaps, is_torque: bool, size: PictureSize) -> Result<Picture, PictureError> {
    maps.check()?;
    size.expect_no_height()?;
    let width = size.roomy_width(TEXT_WIDTH)?;
    let layout = StressLayout::new(maps, is_torque, width, size.width_mm.is_some());
    let mut canvas = Canvas::sized(layout.width, layout.height, size);
    let cells = maps.lattice.cells();
    for (map, &area) in maps.maps.iter().zip(&layout.areas) {
        cells.draw(&mut canvas, area, &map.values, maps.range);
        canvas.frame(area);
        let room = layout.pitch_x - 0.5 * GAP;
        let [mut label, note] = titles(map, is_torque, layout.is_wide);
        if label.width() > room {
            label = Text::shortened(&map.label, SIZE_TEXT, room);
        }
        draw_titles(&mut canvas, area, &[label], &note);
    }
    layout.draw_axes(&mut canvas);
    let top = layout.areas[0].y;
    layout.bar.draw(&mut canvas, (layout.bar_x, top), top - ABOVE);
    canvas.widened(size).finish()
}

/// Layout of the picture.
struct StressLayout {
    width: f64,
    height: f64,
    /// Number of maps in a row.
    columns: usize,
    is_wide: bool,
    /// The room left of a map for its axis.
    left: f64,
    pitch_x: f64,
    areas: Vec<Area>,
    bar: ColourBar,
    bar_x: f64,
    sides: [Side; 2],
}

/// A side of the slider, with its unit.
struct Side {
    axis: DrawnAxis,
    title: Text,
}

impl Side {
    fn new(name: &str, length: f64) -> Self {
        let (unit, factor) = unit_of(length);
        Self {
            axis: DrawnAxis::linear(0.0, length * factor),
            title: Text::plain(&format!("{name} ({unit})"), SIZE_TEXT),
        }
    }

    fn ticks(&self, from: f64, to: f64, direction: Direction) -> Vec<Tick> {
        let most = if (to - from).abs() < SHORT_SIDE { 2 } else { 4 };
        self.axis.placed(from, to).ticks(direction, most)
    }
}

impl StressLayout {
    /// Layout of maps in a picture of this width; the maps are not wider than usual unless the width is
    /// requested.
    fn new(maps: &SnapshotMaps, is_torque: bool, width: f64, is_asked: bool) -> Self {
        let [length_x, length_y] = maps.lattice.sides();
        let sides = [Side::new("x", length_x), Side::new("y", length_y)];
        let ratio = length_y / length_x;
        let is_wide = ratio * LONG < 1.0;
        let most = match ratio {
            _ if ratio * VERY_LONG < 1.0 => 1,
            _ if is_wide => 2,
            _ if ratio > LONG => maps.maps.len(),
            _ => 3,
        };
        let (thinnest, max_width) = if is_wide {
            (MIN_RATIO_WIDE, f64::INFINITY)
        } else {
            (MIN_RATIO, if is_asked { f64::INFINITY } else { MAX_WIDTH })
        };
        let ratio = ratio.clamp(thinnest, 1.0 / MIN_RATIO);

        let bar_of = |height| ColourBar::labelled(&maps.value_title, maps.range, height);
        let left = left_room(&sides[1].ticks(MAX_HEIGHT, 0.0, Direction::Y));
        let right = bar_of(MAX_HEIGHT).room() + MARGIN;
        // Keeps the last number below a map apart from the first number below the next map.
        let numbers = sides[0].ticks(0.0, MAX_WIDTH, Direction::X);
        let gap = numbers.iter().map(|(_, text)| text.width()).fold(GAP, f64::max) + GAP;
        let room_of = |columns: usize| (width - left - right - GAP + gap) / columns as f64;
        let width_of = |columns: usize| (room_of(columns) - gap).min(max_width).min(MAX_HEIGHT / ratio);
        let lines = maps.maps.iter().flat_map(|map| titles(map, is_torque, is_wide));
        let title = lines.map(|line| line.width()).fold(0.0, f64::max);
        let is_small = |columns: &usize| {
            let least = MIN_MAP.min(MAX_HEIGHT / ratio);
            is_asked && (width_of(*columns) < least || room_of(*columns) < title + GAP)
        };
        let most = (1..=most).rev().find(|columns| !is_small(columns)).unwrap_or(1);
        // Spreads the maps evenly over the rows.
        let rows = maps.maps.len().div_ceil(most);
        let columns = maps.maps.len().div_ceil(rows);
        let room = room_of(columns);
        let map_width = width_of(columns).round();
        let map_height = (map_width * ratio).round();
        // A narrow map may have a wider title.
        let widest = title.max(map_width);
        let pitch_x = (widest + GAP).min(room).max(map_width + gap).round();
        let overhang = 0.5 * (widest.min(pitch_x - GAP) - map_width);
        let first_x = left.max(MARGIN + overhang).round();

        let title_room = if is_wide { NOTE_ROOM } else { TITLE_ROOM };
        let pitch_y = map_height + title_room + GAP;
        let below = (rows - 1) as f64 * pitch_y + map_height;
        let bar = bar_of(below);
        let top = MARGIN + title_room.max(bar.upper_room());
        let area = |index: usize| {
            let (column, row) = ((index % columns) as f64, (index / columns) as f64);
            Area::new(
                first_x + column * pitch_x,
                top + row * pitch_y,
                map_width,
                map_height,
            )
        };
        let bar_x = area(columns - 1).right() + overhang + GAP;
        Self {
            width: bar_x + bar.room() + MARGIN,
            height: top + below + LOWER_ROOM,
            columns,
            is_wide,
            left,
            pitch_x,
            areas: (0..maps.maps.len()).map(area).collect(),
            bar,
            bar_x,
            sides,
        }
    }

    /// Draws numbers below the lowest map of every column and left of every row.
    fn draw_axes(&self, canvas: &mut Canvas) {
        let [x, y] = &self.sides;
        for (index, &area) in self.areas.iter().enumerate() {
            if index % self.columns == 0 {
                let ticks = y.ticks(area.bottom(), area.y, Direction::Y);
                left_side(canvas, area, area.x - self.left, &ticks, &y.title);
            }
            if index + self.columns >= self.areas.len() {
                let ticks = x.ticks(area.x, area.right(), Direction::X);
                lower_side(canvas, area, &ticks, &x.title);
            }
        }
    }
}

/// The two lines over a map: time, and friction if it is known; with `in_one`, both are in the second line.
fn titles(map: &SnapshotMap, is_torque: bool, in_one: bool) -> [Text; 2] {
    let (time, mut friction) = (map.time_title(), map.friction_title());
    if is_torque && !friction.is_empty() {
        friction.insert_str(0, "torque ");
    }
    let lines = match in_one {
        true if friction.is_empty() => [String::new(), time],
        true => [String::new(), format!("{time}, {friction}")],
        false => [time, friction],
    };
    lines.map(|line| Text::plain(&line, SIZE_TEXT))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell_means::CellMeans;
    use crate::lattice_map::DrawnLattice;

    fn maps(nx: usize, ny: usize, count: usize) -> SnapshotMaps {
        let map = |index: usize| SnapshotMap {
            label: ["A", "B", "C", "D", "E", "F", "G"][index].to_string(),
            time_star: 12.34 * index as f64,
            mu_star: 0.5,
            values: CellMeans::compute(nx, ny, (0..nx * ny).map(|block| block as f32 / (nx * ny) as f32)),
        };
        let [columns, rows] = CellMeans::cells(nx, ny);
        let is_textured = |cell: usize| cell % columns == columns / 2 && columns > 2;
        let textured = (0..columns * rows).map(is_textured).collect();
        SnapshotMaps {
            lattice: DrawnLattice {
                nx,
                ny,
                block_size: 1e-6,
                textured,
            },
            maps: (0..count).map(map).collect(),
            value_title: "contact stress \u{3c4}_c*".to_owned(),
            range: [0.0, 1.0],
        }
    }

    #[test]
    fn maps_of_other_values_have_their_own_scale_and_titles() {
        let mut maps = maps(4, 4, 2);
        (maps.value_title, maps.range) = ("\u{3c4}_f*".to_owned(), [0.0, 1.25]);
        maps.maps[0].values[2] = f32::NAN;
        let svg = stress(&maps, true, PictureSize::default()).unwrap().svg;
        assert!(svg.contains(">torque \u{3bc}* = 0.500</text>") && !svg.contains("NaN"));
        assert!(svg.contains(">1.0</text>") && svg.contains(">f</text>"));
    }

    #[test]
    fn maps_stand_three_in_a_row_and_those_of_long_sliders_above_each_other_or_in_one_row() {
        for (nx, ny, count, columns) in [
            (50, 50, 6, 3),
            (50, 50, 4, 2),
            (50, 50, 5, 3),
            (50, 50, 1, 1),
            (200, 50, 6, 2),
            (400, 4, 6, 1),
            (4, 400, 6, 6),
        ] {
            let layout = StressLayout::new(&maps(nx, ny, count), false, TEXT_WIDTH, false);
            assert_eq!(layout.columns, columns, "{nx} x {ny}, {count}");
            let bottom = layout.areas[count - 1].bottom();
            assert_eq!(layout.height, bottom + LOWER_ROOM);
        }
    }

    #[test]
    fn the_same_maps_give_the_same_bytes() {
        assert_eq!(
            stress(&maps(10, 10, 2), false, PictureSize::default()).unwrap(),
            stress(&maps(10, 10, 2), false, PictureSize::default()).unwrap()
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
            let layout = StressLayout::new(&maps, false, TEXT_WIDTH, false);
            assert!(layout.width <= TEXT_WIDTH + 6.0, "{nx} x {ny}: {}", layout.width);
            let last = layout.areas[count - 1];
            assert!(last.bottom() < layout.height && last.width >= 40.0 && last.height >= 40.0);
            stress(&maps, false, PictureSize::default()).unwrap();
        }
    }

    #[test]
    fn blank_maps_and_unknown_friction_are_drawn() {
        let mut blank = maps(4, 4, 1);
        blank.maps[0].values.fill(f32::NAN);
        blank.maps[0].mu_star = f64::NAN;
        let svg = stress(&blank, false, PictureSize::default()).unwrap().svg;
        assert!(svg.contains(">A: t* = 0.0</text>") && !svg.contains("NaN"));
    }

    #[test]
    fn a_large_lattice_stays_a_small_file() {
        let picture = stress(&maps(1000, 600, 1), false, PictureSize::default()).unwrap();
        assert!(picture.svg.len() < 300_000, "{}", picture.svg.len());
    }

    #[test]
    fn what_does_not_fit_the_lattice_is_refused() {
        let error = |change: &dyn Fn(&mut SnapshotMaps)| {
            let mut maps = maps(2, 3, 1);
            change(&mut maps);
            stress(&maps, false, PictureSize::default())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            error(&|m| m.lattice.nx = 0),
            "a lattice of 0 x 3 blocks cannot be drawn"
        );
        assert_eq!(
            error(&|m| m.lattice.nx = usize::MAX),
            format!("a lattice of {} x 3 blocks cannot be drawn", usize::MAX)
        );
        assert_eq!(
            error(&|m| m.lattice.block_size = f64::NAN),
            "a block size of NaN m cannot be drawn"
        );
        assert_eq!(error(&|m| m.maps.clear()), "there is no map to draw");
        assert_eq!(
            error(&|m| m.lattice.textured.clear()),
            "the texture has 0 values instead of 6"
        );
        assert_eq!(
            error(&|m| m.maps[0].values.push(0.0)),
            "the map at t* = 0 has 7 values instead of 6"
        );
    }

    #[test]
    fn the_unit_follows_the_length() {
        let units = [5e-7, 5e-5, 5e-2, 5.0].map(|length| unit_of(length).0);
        assert_eq!(units, ["nm", "\u{b5}m", "mm", "m"]);
    }
}
