//! Maps of any field over the blocks, each of a lattice of its own, on one colour scale.

use serde::{Deserialize, Serialize};

use crate::axis::Axis;
use crate::canvas::{Align, Area, Canvas, Image, level};
use crate::frame::{BAR_WIDTH, colour_bar, placed, widest};
use crate::mask_outline::outline;
use crate::picture::{Picture, PictureError};
use crate::stress::draw_outline;
use crate::style::{
    BLACK, MARGIN, RADIUS_MARKER, Rgb, SIZE_LABEL, SIZE_TICK, TEXT_WIDTH, TICK_LENGTH, WHITE, WIDTH_MARK,
};
use crate::text::Text;

const GAP: f64 = 26.0;
/// A map is no wider than this: 44 mm.
const WIDEST: f64 = 520.0;
/// The colour bar is no shorter than this.
const BAR_SHORTEST: f64 = 180.0;
/// The edge of a mark is drawn with so many corners.
const MARK_CORNERS: usize = 24;
const MARK: Rgb = [0xd5, 0x2b, 0x1e];

/// Maps on one colour scale.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FieldMaps {
    /// What the values are, over the colour bar; the letter after an underscore is a subscript.
    pub value_title: String,
    /// The values at the ends of the colour bar; what lies beyond is drawn as they are.
    pub range: [f64; 2],
    /// Maps in a row.
    pub columns: usize,
    /// The maps, row by row from the upper left.
    pub maps: Vec<FieldMap>,
}

/// One map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FieldMap {
    /// Its name, in the first line over it.
    pub label: String,
    /// More about it, in the second line; may be empty.
    pub note: String,
    /// Blocks along x.
    pub nx: usize,
    /// Blocks along y.
    pub ny: usize,
    /// The value of every block, shape (ny, nx), row 0 at y = 0; NaN is left blank.
    pub values: Vec<f32>,
    /// True for every textured block, which is outlined.
    pub textured: Vec<bool>,
    /// Blocks (i, j) with a circle around them.
    pub marks: Vec<[usize; 2]>,
}

/// Draws the maps in rows, as wide as a journal's text (175 mm) or less, all on one colour scale, textured areas
/// outlined and marked blocks circled. Every map is as wide as the others, whatever its number of blocks.
///
/// # Errors
///
/// No map, a lattice without blocks, an array of the wrong length.
pub fn field_maps(maps: &FieldMaps) -> Result<Picture, PictureError> {
    maps.maps.iter().try_for_each(check)?;
    let Some(first) = maps.maps.first() else {
        return Err(PictureError::Nothing("map"));
    };
    let [lo, hi] = maps.range;
    let scale = |start: f64, end: f64| Axis { lo, hi, start, end };
    let bar_room = BAR_WIDTH + TICK_LENGTH + 7.0 + widest(&placed(&scale(0.0, 1.0), 5)) + MARGIN;
    let columns = maps.columns.clamp(1, maps.maps.len());
    let rows = maps.maps.len().div_ceil(columns);
    let room = (TEXT_WIDTH - MARGIN - bar_room) / columns as f64;
    let width = (room - GAP).min(WIDEST).round();
    let height = (width * (first.ny as f64 / first.nx as f64).clamp(0.2, 5.0)).round();
    let noted = maps.maps.iter().any(|map| !map.note.is_empty());
    let titles = f64::from(SIZE_LABEL) + if noted { f64::from(SIZE_TICK) + 6.0 } else { 0.0 } + 16.0;
    // The title of the bar stands over it, on the line of the maps' names.
    let area = |index: usize| Area {
        x: MARGIN + (index % columns) as f64 * (width + GAP),
        y: MARGIN + titles + (index / columns) as f64 * (height + titles + GAP),
        width,
        height,
    };
    let lowest = area((rows - 1) * columns).bottom();
    let bar = Area {
        x: area(columns - 1).right() + GAP,
        y: MARGIN + titles,
        width: BAR_WIDTH,
        height: (lowest - MARGIN - titles).max(BAR_SHORTEST),
    };
    let title = Text::math(&maps.value_title, SIZE_LABEL);
    let right = (bar.x + bar_room - MARGIN).max(bar.x + title.width());
    let mut canvas = Canvas::new(right + MARGIN, lowest.max(bar.bottom()) + MARGIN);
    for (index, map) in maps.maps.iter().enumerate() {
        draw_map(&mut canvas, map, area(index), maps.range);
    }
    colour_bar(&mut canvas, bar, &placed(&scale(bar.bottom(), bar.y), 5));
    canvas.text(&title, (bar.x, bar.y - 18.0), Align::Start, BLACK);
    canvas.finish()
}

fn check(map: &FieldMap) -> Result<(), PictureError> {
    let (nx, ny) = (map.nx, map.ny);
    let expected = nx
        .checked_mul(ny)
        .filter(|&count| count > 0)
        .ok_or(PictureError::Lattice { nx, ny })?;
    let lengths = [("values", map.values.len()), ("texture", map.textured.len())];
    match lengths.into_iter().find(|(_, found)| *found != expected) {
        Some((what, found)) => Err(PictureError::Blocks {
            what: format!("map `{}`, {what},", map.label),
            found,
            expected,
        }),
        None => Ok(()),
    }
}

fn draw_map(canvas: &mut Canvas, map: &FieldMap, area: Area, [lo, hi]: [f64; 2]) {
    let share = |&value: &f32| level(((f64::from(value) - lo) / (hi - lo)) as f32);
    // The image's first row is the uppermost.
    let levels = map
        .values
        .chunks_exact(map.nx)
        .rev()
        .flatten()
        .map(share)
        .collect();
    canvas.image(Image {
        area,
        columns: map.nx,
        levels,
    });
    let place = |x: f64, y: f64| {
        (
            area.x + x / map.nx as f64 * area.width,
            area.bottom() - y / map.ny as f64 * area.height,
        )
    };
    for line in outline(&map.textured, map.nx, map.ny) {
        let corners: Vec<(f64, f64)> = line.iter().map(|&(x, y)| place(x as f64, y as f64)).collect();
        draw_outline(canvas, &corners);
    }
    for &[i, j] in &map.marks {
        draw_mark(canvas, place(i as f64 + 0.5, j as f64 + 0.5));
    }
    canvas.frame(area);
    let middle = area.x + 0.5 * area.width;
    let fitted = |text: &str, size| Text::shortened(text, size, area.width + 0.6 * GAP);
    let mut baseline = area.y - 14.0;
    if !map.note.is_empty() {
        canvas.text(
            &fitted(&map.note, SIZE_TICK),
            (middle, baseline),
            Align::Middle,
            BLACK,
        );
        baseline -= f64::from(SIZE_TICK) + 8.0;
    }
    canvas.text(
        &fitted(&map.label, SIZE_LABEL),
        (middle, baseline),
        Align::Middle,
        BLACK,
    );
}

/// A circle with a pale rim, seen on every colour of the ramp.
fn draw_mark(canvas: &mut Canvas, (x, y): (f64, f64)) {
    let corner = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / MARK_CORNERS as f64).sin_cos();
        (x + 1.5 * RADIUS_MARKER * cos, y + 1.5 * RADIUS_MARKER * sin)
    };
    let circle: Vec<(f64, f64)> = (0..=MARK_CORNERS).map(corner).collect();
    canvas.polyline(circle.clone(), WIDTH_MARK + 3.0, WHITE);
    canvas.polyline(circle, WIDTH_MARK, MARK);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(nx: usize, ny: usize) -> FieldMap {
        FieldMap {
            label: format!("{nx} x {ny}"),
            note: String::new(),
            nx,
            ny,
            values: (0..nx * ny).map(|block| block as f32).collect(),
            textured: (0..nx * ny).map(|block| block % nx == 1).collect(),
            marks: vec![[0, 0]],
        }
    }

    fn maps(sizes: &[(usize, usize)]) -> FieldMaps {
        FieldMaps {
            value_title: "value".to_owned(),
            range: [0.0, 30.0],
            columns: 3,
            maps: sizes.iter().map(|&(nx, ny)| map(nx, ny)).collect(),
        }
    }

    #[test]
    fn lattices_of_different_sizes_stand_side_by_side() {
        let svg = field_maps(&maps(&[(5, 5), (25, 25), (75, 75), (5, 5)]))
            .unwrap()
            .svg;
        // Four maps and the bar.
        assert_eq!(svg.matches("<image").count(), 5);
        for text in ["5 x 5", "25 x 25", "75 x 75", "value"] {
            assert!(svg.contains(&format!(">{text}</text>")), "{text}");
        }
    }

    #[test]
    fn a_mark_and_a_note_add_to_the_picture() {
        let plain = maps(&[(5, 5)]);
        let mut more = plain.clone();
        more.maps[0].marks.push([4, 4]);
        more.maps[0].note = "note".to_owned();
        let (plain, more) = (field_maps(&plain).unwrap().svg, field_maps(&more).unwrap().svg);
        assert!(more.matches("<path").count() > plain.matches("<path").count());
        assert!(more.contains(">note</text>"));
    }

    #[test]
    fn what_does_not_fit_the_lattice_is_refused() {
        let error = |change: &dyn Fn(&mut FieldMaps)| {
            let mut maps = maps(&[(2, 3)]);
            change(&mut maps);
            field_maps(&maps).unwrap_err().to_string()
        };
        assert_eq!(error(&|m| m.maps.clear()), "there is no map to draw");
        assert_eq!(
            error(&|m| m.maps[0].nx = 0),
            "a lattice of 0 x 3 blocks cannot be drawn"
        );
        assert_eq!(
            error(&|m| m.maps[0].values.push(0.0)),
            "map `2 x 3`, values, has 7 values, but the lattice has 6 blocks"
        );
    }
}
