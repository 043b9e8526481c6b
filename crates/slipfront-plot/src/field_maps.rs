//! Maps of any field over the blocks, each with its own lattice, all on one colour scale.

use serde::{Deserialize, Serialize};

use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::color_bar::{ABOVE, ColourBar};
use crate::geometry::Area;
use crate::lattice_map::{
    Cells, LINE, MARK, MIN_MAP, TITLE_ROOM, block_count, check_length, circle, draw_titles, place,
};
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::size::PictureSize;
use crate::style::{MARGIN, SIZE_TEXT, TEXT_WIDTH};
use crate::text::Text;

const GAP: f64 = 26.0;
/// Largest width of a map: 44 mm.
const MAX_WIDTH: f64 = 520.0;

/// Maps on one colour scale.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FieldMaps {
    /// Quantity of the values, next to the colour bar or above it; the letter after an underscore is a
    /// subscript.
    pub value_title: String,
    /// Values at the ends of the colour bar; values beyond are drawn as the ends.
    pub range: [f64; 2],
    /// Number of maps in a row.
    pub columns: usize,
    /// The maps, row by row from the upper left.
    pub maps: Vec<FieldMap>,
}

/// One map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FieldMap {
    /// Name of the map, in the first line over it.
    pub label: String,
    /// Further information about the map, in the second line; may be empty.
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

/// Draws the maps in rows on one colour scale, with textured areas outlined and marked blocks circled. The
/// picture is at most as wide as a journal's text (175 mm), or as wide as requested, with fewer maps in a row
/// if they would be too small. All maps have the same width, whatever their number of blocks.
///
/// # Errors
///
/// No map, a lattice without blocks, an array of the wrong length; a height, or a width without room for a
/// map.
pub fn field_maps(maps: &FieldMaps, size: PictureSize) -> Result<Picture, PictureError> {
    maps.maps.iter().try_for_each(check)?;
    let Some(first) = maps.maps.first() else {
        return Err(PictureError::Nothing("map"));
    };
    let bar_of = |height| ColourBar::labelled(&maps.value_title, maps.range, height);
    let bar_width = bar_of(MAX_WIDTH).room();
    size.expect_no_height()?;
    let whole = size.roomy_width(TEXT_WIDTH)?;
    let is_asked = size.width_mm.is_some();
    let room_of = |columns: usize| (whole - 2.0 * MARGIN - bar_width) / columns as f64;
    let is_small = |columns: &usize| is_asked && room_of(*columns) - GAP < MIN_MAP;
    let most = maps.columns.clamp(1, maps.maps.len());
    let columns = (1..=most).rev().find(|columns| !is_small(columns)).unwrap_or(1);
    let rows = maps.maps.len().div_ceil(columns);
    let max_width = if is_asked { f64::INFINITY } else { MAX_WIDTH };
    let width = (room_of(columns) - GAP).min(max_width).round();
    let height = (width * (first.ny as f64 / first.nx as f64).clamp(0.2, 5.0)).round();
    let titles: Vec<Titles> = maps.maps.iter().map(|map| Titles::new(map, width)).collect();
    let lines = titles.iter().map(|titles| titles.label.len()).max().unwrap_or(1);
    let title_room = TITLE_ROOM + LINE * lines.saturating_sub(1) as f64;
    let pitch = height + title_room + GAP;
    let bar = bar_of((rows - 1) as f64 * pitch + height);
    let top = MARGIN + title_room + bar.upper_room();
    let area = |index: usize| {
        let (column, row) = ((index % columns) as f64, (index / columns) as f64);
        Area::new(MARGIN + column * (width + GAP), top + row * pitch, width, height)
    };
    let lowest = area((rows - 1) * columns).bottom();
    let bar_x = area(columns - 1).right() + GAP;
    let mut canvas = Canvas::sized(bar_x + bar.room() + MARGIN, lowest + MARGIN, size);
    for (index, (map, titles)) in maps.maps.iter().zip(&titles).enumerate() {
        draw_map(&mut canvas, map, area(index), maps.range);
        draw_titles(&mut canvas, area(index), &titles.label, &titles.note);
    }
    bar.draw(&mut canvas, (bar_x, top), top - title_room - ABOVE);
    canvas.widened(size).finish()
}

fn check(map: &FieldMap) -> Result<(), PictureError> {
    let expected = block_count(map.nx, map.ny)?;
    let lengths = [("values", map.values.len()), ("texture", map.textured.len())];
    lengths
        .into_iter()
        .try_for_each(|(what, found)| check_length(&format!("map `{}`, {what},", map.label), found, expected))
}

fn draw_map(canvas: &mut Canvas, map: &FieldMap, area: Area, range: [f64; 2]) {
    let (nx, ny) = (map.nx, map.ny);
    // A group of blocks counts as textured if most of them are.
    let flags = map
        .textured
        .iter()
        .map(|&textured| if textured { 1.0 } else { 0.0 });
    let shares = CellMeans::compute(nx, ny, flags);
    let textured: Vec<bool> = shares.into_iter().map(|share| share > 0.5).collect();
    let means = CellMeans::compute(nx, ny, map.values.iter().copied());
    Cells::new(nx, ny, &textured).draw(canvas, area, &means, range);
    for &[i, j] in &map.marks {
        let centre = ((i as f64 + 0.5) / map.nx as f64, (j as f64 + 0.5) / map.ny as f64);
        circle(canvas, place(area, centre), MARK);
    }
    canvas.frame(area);
}

/// Lines over a map.
struct Titles {
    label: Vec<Text>,
    note: Text,
}

impl Titles {
    /// The lines over a map of this width; the label takes at most two.
    fn new(map: &FieldMap, width: f64) -> Self {
        let room = width + 0.6 * GAP;
        let shortened = |text: &str| Text::shortened(text, SIZE_TEXT, room);
        let label = Text::wrapped(&map.label, SIZE_TEXT, room, 2);
        Self {
            label: label.unwrap_or_else(|| vec![shortened(&map.label)]),
            note: shortened(&map.note),
        }
    }
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
        let svg = field_maps(
            &maps(&[(5, 5), (25, 25), (75, 75), (5, 5)]),
            PictureSize::default(),
        )
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
        let (plain, more) = (
            field_maps(&plain, PictureSize::default()).unwrap().svg,
            field_maps(&more, PictureSize::default()).unwrap().svg,
        );
        assert!(more.matches("<path").count() > plain.matches("<path").count());
        assert!(more.contains(">note</text>"));
    }

    #[test]
    fn what_does_not_fit_the_lattice_is_refused() {
        let error = |change: &dyn Fn(&mut FieldMaps)| {
            let mut maps = maps(&[(2, 3)]);
            change(&mut maps);
            field_maps(&maps, PictureSize::default()).unwrap_err().to_string()
        };
        assert_eq!(error(&|m| m.maps.clear()), "there is no map to draw");
        assert_eq!(
            error(&|m| m.maps[0].nx = 0),
            "a lattice of 0 x 3 blocks cannot be drawn"
        );
        assert_eq!(
            error(&|m| m.maps[0].values.push(0.0)),
            "map `2 x 3`, values, has 7 values instead of 6"
        );
    }
}
