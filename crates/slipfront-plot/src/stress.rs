//! Maps of the contact stress, with axes along the slider's sides.

use crate::axis::Axis;
use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::frame::{
    BAR_MIN_HEIGHT, BAR_STEPS, BAR_WIDTH, LOWER_ROOM, bar_room, colour_bar, left_room, left_side, lower_side,
};
use crate::geometry::{Align, Area};
use crate::lattice_map::{
    Cells, MIN_RATIO, TITLE_ROOM, block_count, check_block_size, check_length, draw_titles, unit_of,
};
use crate::picture::{Picture, PictureError};
use crate::style::{BLACK, MARGIN, SIZE_LABEL, SIZE_TICK, TEXT_WIDTH};
use crate::text::{Text, number};
use crate::ticks::Direction;

/// Maps in a row.
const MAX_COLUMNS: usize = 6;
const GAP: f64 = 30.0;
/// A single map is no wider than this: 44 mm.
const MAX_WIDTH: f64 = 520.0;
const MAX_HEIGHT: f64 = 620.0;
/// A side shorter than this has fewer numbers.
const SHORT_SIDE: f64 = 130.0;

/// One map of the contact stress.
#[derive(Clone, Debug, PartialEq)]
pub struct StressMap {
    /// Its letter or name.
    pub label: String,
    /// Its time.
    pub time_star: f64,
    /// mu* at that time; not written if NaN.
    pub mu_star: f64,
    /// Mean of every [cell](CellMeans), row by row from y = 0; NaN is left blank.
    pub values: Vec<f32>,
}

/// What the values of a map are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stress {
    /// Contact stress `tau_c*`, over the largest of the run.
    #[default]
    Contact,
    /// Traction `tau_f* = |F_f|/(P mu_s l^2)`, blank over a texture.
    Traction,
}

/// Maps of one lattice.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StressMaps {
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y.
    pub ny: usize,
    /// Edge of a block, in metres.
    pub block_size: f64,
    /// True for every [cell](CellMeans) of which most is textured, row by row from y = 0.
    pub textured: Vec<bool>,
    /// The maps, in the order in which they are drawn.
    pub maps: Vec<StressMap>,
    /// What their values are.
    pub stress: Stress,
    /// Whether mu* is a torque, of a drive that rotates.
    pub is_torque: bool,
}

/// Draws the maps in one row (in more, if there are more than six), at most as wide as a journal's text (175
/// mm), all on one colour scale from 0 to 1, or to the largest traction, the textured area outlined.
///
/// A lattice more than six times as long as wide is drawn as if it were six times.
///
/// # Errors
///
/// No map, a lattice without blocks, an array of the wrong length, a block size that is not a positive
/// length.
pub fn stress(maps: &StressMaps) -> Result<Picture, PictureError> {
    check(maps)?;
    let layout = Layout::of(maps);
    let mut canvas = Canvas::new(layout.width, layout.height);
    let cells = Cells::of(maps.nx, maps.ny, &maps.textured);
    for (map, &area) in maps.maps.iter().zip(&layout.areas) {
        cells.draw(&mut canvas, area, &map.values, layout.range);
        canvas.frame(area);
        let mut label = title(map);
        let room = layout.pitch_x - 0.5 * GAP;
        if label.width() > room {
            label = Text::shortened(&map.label, SIZE_LABEL, room);
        }
        draw_titles(&mut canvas, area, &label, &friction(map, maps.is_torque));
    }
    layout.draw_axes(&mut canvas);
    // As tall as all rows.
    colour_bar(&mut canvas, layout.bar, layout.range, BAR_STEPS);
    let title = match maps.stress {
        Stress::Contact => Text::math("\u{3c4}_c*", SIZE_LABEL),
        Stress::Traction => Text::math("\u{3c4}_f*", SIZE_LABEL),
    };
    canvas.text(&title, (layout.bar.centre().0, TOP - 22.0), Align::Middle, BLACK);
    canvas.finish()
}

fn check(maps: &StressMaps) -> Result<(), PictureError> {
    block_count(maps.nx, maps.ny)?;
    let [columns, rows] = CellMeans::cells(maps.nx, maps.ny);
    let expected = columns * rows;
    check_block_size(maps.block_size)?;
    if maps.maps.is_empty() {
        return Err(PictureError::Nothing("map"));
    }
    check_length("the texture", maps.textured.len(), expected)?;
    maps.maps
        .iter()
        .try_for_each(|map| check_length(&format!("map `{}`", map.label), map.values.len(), expected))
}

/// Where everything is.
struct Layout {
    width: f64,
    height: f64,
    /// Maps in a row.
    columns: usize,
    left: f64,
    pitch_x: f64,
    areas: Vec<Area>,
    bar: Area,
    /// The ends of the colour scale.
    range: [f64; 2],
    /// The slider's sides along x and y, in `unit`.
    sides: [Axis; 2],
    unit: &'static str,
}

/// Where the uppermost maps start.
const TOP: f64 = MARGIN + TITLE_ROOM;

impl Layout {
    fn of(maps: &StressMaps) -> Self {
        let (length_x, length_y) = (maps.nx as f64 * maps.block_size, maps.ny as f64 * maps.block_size);
        let (unit, factor) = unit_of(length_x.max(length_y));
        let sides = [length_x, length_y].map(|length| Axis::linear(0.0, length * factor));
        let columns = maps.maps.len().min(MAX_COLUMNS);
        let rows = maps.maps.len().div_ceil(MAX_COLUMNS);
        let ratio = (length_y / length_x).clamp(MIN_RATIO, 1.0 / MIN_RATIO);

        let range = [0.0, largest(maps)];
        let left = left_room(&sides[1].placed(MAX_HEIGHT, 0.0).ticks(Direction::Y, 4));
        let right = GAP + bar_room(range, BAR_STEPS, MAX_HEIGHT) + MARGIN;
        let room = (TEXT_WIDTH - left - right + GAP) / columns as f64;
        let map_width = (room - GAP).min(MAX_WIDTH).min(MAX_HEIGHT / ratio).round();
        let map_height = (map_width * ratio).round();
        // A narrow map may have a wider title.
        let titles = maps.maps.iter().map(|map| title(map).width());
        let widest = titles.fold(map_width, f64::max);
        let pitch_x = (widest + GAP).min(room).max(map_width + GAP).round();
        let pitch_y = map_height + LOWER_ROOM + TITLE_ROOM;
        let lowest = (rows - 1) as f64 * pitch_y + map_height;
        let slack = pitch_x - GAP - map_width;
        let area = |index: usize| {
            let x = (left + (index % columns) as f64 * pitch_x + 0.5 * slack).round();
            Area::new(x, TOP + (index / columns) as f64 * pitch_y, map_width, map_height)
        };
        let bar_x = left + columns as f64 * pitch_x;
        Self {
            width: bar_x - GAP + right,
            height: TOP + (lowest + LOWER_ROOM).max(BAR_MIN_HEIGHT + 2.0 * MARGIN),
            columns,
            left,
            pitch_x,
            areas: (0..maps.maps.len()).map(area).collect(),
            bar: Area::new(bar_x, TOP, BAR_WIDTH, lowest.max(BAR_MIN_HEIGHT)),
            range,
            sides,
            unit,
        }
    }

    /// Numbers below the lowest map of every column and left of every row.
    fn draw_axes(&self, canvas: &mut Canvas) {
        let most = |side: f64| if side < SHORT_SIDE { 2 } else { 4 };
        for (index, &area) in self.areas.iter().enumerate() {
            if index % self.columns == 0 {
                let axis = self.sides[1].placed(area.bottom(), area.y);
                let ticks = axis.ticks(Direction::Y, most(area.height));
                let title = Text::plain(&format!("y ({})", self.unit), SIZE_LABEL);
                left_side(canvas, area, area.x - self.left, &ticks, &title);
            }
            if index + self.columns >= self.areas.len() {
                let axis = self.sides[0].placed(area.x, area.right());
                let mut ticks = axis.ticks(Direction::X, most(area.width));
                // No number may touch the first one of the next map.
                let end = area.x + 0.5 * (area.width + self.pitch_x) - 4.0;
                for (at, text) in &mut ticks {
                    if *at + 0.5 * text.width() > end {
                        *text = Text::default();
                    }
                }
                let title = Text::plain(&format!("x ({})", self.unit), SIZE_LABEL);
                lower_side(canvas, area, &ticks, &title);
            }
        }
    }
}

/// The first line over a map.
fn title(map: &StressMap) -> Text {
    let time = format!("t* = {}", number(map.time_star, 1));
    let title = match map.label.as_str() {
        "" => time,
        // A map may be named after its time.
        label if label.starts_with("t*") => label.to_string(),
        label => format!("{label}: {time}"),
    };
    Text::plain(&title, SIZE_LABEL)
}

/// The second line over a map; empty if the friction is not known.
fn friction(map: &StressMap, is_torque: bool) -> Text {
    let what = if is_torque { "torque " } else { "" };
    match map.mu_star.is_finite() {
        true => Text::plain(&format!("{what}\u{3bc}* = {}", number(map.mu_star, 3)), SIZE_TICK),
        false => Text::default(),
    }
}

/// The upper end of the colour scale: 1 of the contact stress, and of the traction the largest there is.
fn largest(maps: &StressMaps) -> f64 {
    let values = maps.maps.iter().flat_map(|map| &map.values);
    let largest = match maps.stress {
        Stress::Contact => 0.0,
        Stress::Traction => values
            .copied()
            .filter(|value| value.is_finite())
            .fold(0.0, f32::max),
    };
    if largest > 0.0 { f64::from(largest) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn maps(nx: usize, ny: usize, count: usize) -> StressMaps {
        let map = |index: usize| StressMap {
            label: ["A", "B", "C", "D", "E", "F", "G"][index].to_string(),
            time_star: 12.34 * index as f64,
            mu_star: 0.5,
            values: CellMeans::of(nx, ny, (0..nx * ny).map(|block| block as f32 / (nx * ny) as f32)),
        };
        let [columns, rows] = CellMeans::cells(nx, ny);
        let is_textured = |cell: usize| cell % columns == columns / 2 && columns > 2;
        let textured = (0..columns * rows).map(is_textured).collect();
        StressMaps {
            nx,
            ny,
            block_size: 1e-6,
            textured,
            maps: (0..count).map(map).collect(),
            ..StressMaps::default()
        }
    }

    /// Of a drive that rotates, and of one that pulls at some blocks only.
    #[test]
    fn other_drives_have_other_titles_and_another_scale() {
        let mut maps = maps(4, 4, 2);
        (maps.is_torque, maps.stress) = (true, Stress::Traction);
        maps.maps[1].values[3] = 1.25;
        maps.maps[0].values[2] = f32::NAN;
        assert_eq!(Layout::of(&maps).range, [0.0, 1.25]);
        let svg = stress(&maps).unwrap().svg;
        assert!(svg.contains(">torque \u{3bc}* = 0.500</text>") && !svg.contains("NaN"));
        // A slider that nothing has pulled yet.
        maps.maps.iter_mut().for_each(|map| map.values.fill(0.0));
        assert_eq!(Layout::of(&maps).range, [0.0, 1.0]);
        stress(&maps).unwrap();
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
            let last = layout.areas[count - 1];
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
            "the texture has 0 values where 6 are wanted"
        );
        assert_eq!(
            error(&|m| m.maps[0].values.push(0.0)),
            "map `A` has 7 values where 6 are wanted"
        );
    }

    #[test]
    fn the_unit_follows_the_length() {
        let units = [5e-7, 5e-5, 5e-2, 5.0].map(|length| unit_of(length).0);
        assert_eq!(units, ["nm", "\u{b5}m", "mm", "m"]);
    }
}
