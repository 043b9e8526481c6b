//! A quantity over two axes of a parametric study.

use super::axis::{drawable, range, widened};
use super::canvas::{Align, Area, Canvas, Image, level, level_colour};
use super::scale::{Scale, Way, apart};
use super::sides::{
    BAR_WIDTH, LOWER_ROOM, Tick, colour_bar, left_room, left_side, lower_side, short_ticks, widest,
};
use super::style::{BLACK, COLUMN_WIDTH, MARGIN, Rgb, SIZE_LABEL, SIZE_TICK, TICK_LENGTH, WHITE};
use super::text::{MINUS, Text, number};
use super::{Picture, PictureError};

const HEIGHT: f64 = 560.0;
/// Between the map and its colour bar.
const GAP: f64 = 30.0;
/// Numbers are written in the cells of a map of at most so many columns and rows.
const MOST_NUMBERED: usize = 8;
/// An axis of more cells is numbered at round values.
const MOST_NAMED: usize = 12;

/// A map of cells over two axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatMap {
    /// The axis of the columns.
    pub x: HeatAxis,
    /// The axis of the rows.
    pub y: HeatAxis,
    /// What the values are.
    pub value_title: String,
    /// One value for every cell: all of the first y, then all of the second; NaN is left grey.
    pub values: Vec<f64>,
}

/// An axis of a map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatAxis {
    /// What the axis is; see [`title`](super::title).
    pub title: String,
    /// Where its cells are, in any order, all different.
    pub values: Vec<f64>,
    /// Whether it is logarithmic; without effect if a value is not positive.
    pub log: bool,
}

/// Draws a map, as wide as a journal's column (85 mm).
///
/// A cell reaches half-way to its neighbours, so uneven values give uneven cells. The colours span the values'
/// own range. A map of up to 8 x 8 cells has its numbers in the cells, if they are wide enough.
///
/// # Errors
///
/// An axis without values, with one that is not a number, or with the same one twice; as many values as there
/// are cells are needed.
pub fn heat_map(map: &HeatMap) -> Result<Picture, PictureError> {
    let (mut x, mut y) = (Cells::of(&map.x)?, Cells::of(&map.y)?);
    let (columns, rows) = (x.values.len(), y.values.len());
    if columns.checked_mul(rows) != Some(map.values.len()) {
        let values = map.values.len();
        return Err(PictureError::Cells {
            columns,
            rows,
            values,
        });
    }
    let at = |row: usize, column: usize| map.values[y.order[row] * columns + x.order[column]];
    let values = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let values: Vec<f64> = values
        .map(|(row, column)| at(row, column))
        .map(|value| if drawable(value) { value } else { f64::NAN })
        .collect();
    let colours = Colours::of(&values);

    let (top, bottom) = (MARGIN, MARGIN + HEIGHT);
    y.place(bottom, top);
    let y_ticks = y.ticks(Way::Y);
    let bar_ticks = colours.scale.from_to(bottom, top).ticks(Way::Y);
    let left = left_room(&y_ticks);
    let bar_room = BAR_WIDTH + TICK_LENGTH + 7.0 + widest(&bar_ticks) + 14.0 + f64::from(SIZE_LABEL) + MARGIN;
    let area = Area {
        x: left,
        y: top,
        width: (COLUMN_WIDTH - left - GAP - bar_room).max(100.0).round(),
        height: HEIGHT,
    };
    x.place(area.x, area.right());

    let mut canvas = Canvas::new(COLUMN_WIDTH, bottom + LOWER_ROOM);
    canvas.image(image(area, &x, &y, &values, &colours));
    draw_numbers(&mut canvas, &x, &y, &values, &colours);
    canvas.frame(area);
    short_ticks(&mut canvas, area, Way::Y, &y.scale.short_ticks());
    let title = Text::fitted(&map.y.title, area.height);
    left_side(&mut canvas, area, 0.0, &y_ticks, &title);
    short_ticks(&mut canvas, area, Way::X, &x.scale.short_ticks());
    let title = Text::fitted(&map.x.title, area.width);
    lower_side(&mut canvas, area, &x.ticks(Way::X), &title);
    let bar = Area {
        x: area.right() + GAP,
        width: BAR_WIDTH,
        ..area
    };
    colour_bar(&mut canvas, bar, &bar_ticks);
    let baseline = COLUMN_WIDTH - MARGIN - 0.24 * f64::from(SIZE_LABEL);
    let title = Text::fitted(&map.value_title, area.height);
    let middle = area.y + 0.5 * area.height;
    canvas.text_upwards(&title, (baseline, middle), Align::Middle, BLACK);
    canvas.finish()
}

/// From values to colours.
struct Colours {
    scale: Scale,
    lo: f64,
    hi: f64,
}

impl Colours {
    fn of(values: &[f64]) -> Self {
        let (lo, hi) = widened(range(values.iter().copied()));
        let scale = Scale::between(lo, hi, false);
        Self { scale, lo, hi }
    }

    fn level(&self, value: f64) -> u8 {
        level(((value - self.lo) / (self.hi - self.lo)) as f32)
    }
}

/// The cells along an axis, in rising order.
struct Cells {
    scale: Scale,
    /// The index of every cell among the axis' values.
    order: Vec<usize>,
    values: Vec<f64>,
    /// Where the cells meet, as the scale measures it: one more than there are cells.
    edges: Vec<f64>,
}

impl Cells {
    fn of(axis: &HeatAxis) -> Result<Self, PictureError> {
        let error = |reason| PictureError::CellAxis {
            title: axis.title.clone(),
            reason,
        };
        if axis.values.is_empty() {
            return Err(error("it has no value"));
        }
        if !axis.values.iter().all(|&value| drawable(value)) {
            return Err(error("a value is not a number"));
        }
        let mut order: Vec<usize> = (0..axis.values.len()).collect();
        order.sort_by(|&a, &b| axis.values[a].total_cmp(&axis.values[b]));
        let values: Vec<f64> = order.iter().map(|&index| axis.values[index]).collect();
        let log = Scale::around(&values, axis.log, 0.0).is_log();
        let measured: Vec<f64> = values
            .iter()
            .map(|&value| Scale::between(0.0, 1.0, log).measure(value))
            .collect();
        if measured.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(error("two values are the same"));
        }
        let middles = measured.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let (first, last) = (measured[0], measured[measured.len() - 1]);
        let mut edges: Vec<f64> = middles.collect();
        // The outermost cells reach as far out as in.
        let (lo, hi) = match edges[..] {
            [] => widened((first, last)),
            [inner, ..] => (2.0 * first - inner, 2.0 * last - edges[edges.len() - 1]),
        };
        edges.insert(0, lo);
        edges.push(hi);
        let scale = Scale::between(lo, hi, log);
        Ok(Self {
            scale,
            order,
            values,
            edges,
        })
    }

    /// Places the axis between two pixels.
    fn place(&mut self, start: f64, end: f64) {
        self.scale = self.scale.from_to(start, end);
    }

    /// The pixels where the cells meet, in rising order of value.
    fn edges(&self) -> Vec<f64> {
        self.edges
            .iter()
            .map(|&edge| self.scale.axis().at(edge).round())
            .collect()
    }

    /// The values themselves if they are few and have room, else round ones.
    fn ticks(&self, way: Way) -> Vec<Tick> {
        if self.values.len() > MOST_NAMED {
            return self.scale.ticks(way);
        }
        let written: Vec<String> = self.values.iter().map(|&value| short(value)).collect();
        let ticks: Vec<Tick> = self
            .values
            .iter()
            .zip(&written)
            .map(|(&value, text)| (self.scale.at(value), Text::number(text, SIZE_TICK)))
            .collect();
        let alike = written.windows(2).any(|pair| pair[0] == pair[1]);
        if alike || !apart(&ticks, way) {
            return self.scale.ticks(way);
        }
        ticks
    }
}

/// A value with three digits that count, none of them a needless zero.
fn short(value: f64) -> String {
    let rounded = format!("{value:.2e}");
    let Some((digits, power)) = rounded.split_once('e') else {
        return rounded;
    };
    let power: i32 = power.parse().unwrap_or(0);
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    if value == 0.0 {
        return "0".to_string();
    }
    if (-4..6).contains(&power) {
        return trimmed(&number(value, (2 - power).max(0) as usize));
    }
    format!("{}e{power}", trimmed(digits)).replace('-', MINUS)
}

/// The cells as an image with a pixel for every pixel of the picture: an image's own columns are all alike.
fn image(area: Area, x: &Cells, y: &Cells, values: &[f64], colours: &Colours) -> Image {
    let (columns, rows) = (area.width as usize, area.height as usize);
    let (edges_x, edges_y) = (x.edges(), y.edges());
    // The cell is the last one that starts before the pixel's middle.
    let cell_x = |column: usize| {
        let middle = area.x + column as f64 + 0.5;
        edges_x[1..edges_x.len() - 1].partition_point(|&edge| edge < middle)
    };
    let cell_y = |row: usize| {
        let middle = area.y + row as f64 + 0.5;
        edges_y[1..edges_y.len() - 1].partition_point(|&edge| edge > middle)
    };
    let cells_x: Vec<usize> = (0..columns).map(cell_x).collect();
    let levels = (0..rows).map(cell_y).flat_map(|row| {
        let values = &values[row * x.values.len()..];
        cells_x.iter().map(move |&column| colours.level(values[column]))
    });
    Image {
        area,
        columns,
        levels: levels.collect(),
    }
}

/// Writes every value into its cell, if all have room.
fn draw_numbers(canvas: &mut Canvas, x: &Cells, y: &Cells, values: &[f64], colours: &Colours) {
    if x.values.len().max(y.values.len()) > MOST_NUMBERED {
        return;
    }
    let size = colours.lo.abs().max(colours.hi.abs());
    if !(1e-4..1e6).contains(&size) {
        return;
    }
    // Two digits or so of the range.
    let decimals = (50.0 / (colours.hi - colours.lo)).log10().ceil().clamp(0.0, 9.0) as usize;
    let texts: Vec<Text> = values
        .iter()
        .map(|&value| {
            if value.is_nan() {
                String::new()
            } else {
                number(value, decimals)
            }
        })
        .map(|text| Text::plain(&text, SIZE_TICK))
        .collect();
    let smallest = |edges: &[f64]| {
        let sizes = edges.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        sizes.fold(f64::INFINITY, f64::min)
    };
    let (edges_x, edges_y) = (x.edges(), y.edges());
    let widest = texts.iter().map(Text::width).fold(0.0, f64::max);
    let height = Text::plain("0", SIZE_TICK).height();
    if widest + 12.0 > smallest(&edges_x) || height + 12.0 > smallest(&edges_y) {
        return;
    }
    for (index, (text, &value)) in texts.iter().zip(values).enumerate() {
        let (row, column) = (index / x.values.len(), index % x.values.len());
        let middle = (
            0.5 * (edges_x[column] + edges_x[column + 1]),
            0.5 * (edges_y[row] + edges_y[row + 1] + height),
        );
        let colour = readable_on(level_colour(colours.level(value)));
        canvas.text(text, middle, Align::Middle, colour);
    }
}

/// Black or white, whichever stands out more.
fn readable_on(ground: Rgb) -> Rgb {
    let [red, green, blue] = ground.map(|channel| (f64::from(channel) / 255.0).powf(2.2));
    let luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    // Contrast with white against contrast with black (WCAG 2).
    if 1.05 / (luminance + 0.05) > (luminance + 0.05) / 0.05 {
        WHITE
    } else {
        BLACK
    }
}
