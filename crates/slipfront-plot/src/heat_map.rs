//! A quantity over two axes of a parametric study.

use crate::axis::{DrawnAxis, drawable, range, widened};
use crate::canvas::Canvas;
use crate::color_bar::ColourBar;
use crate::color_image::{Image, level, level_colour};
use crate::estimate::Estimate;
use crate::frame::{BAR_WIDTH, LOWER_ROOM, left_room, left_side, lower_side, short_ticks};
use crate::geometry::{Align, Area};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::series::cross;
use crate::size::PictureSize;
use crate::style::{BLACK, BLANK, COLUMN_WIDTH, MARGIN, Rgb, SIZE_NARROW, SIZE_TEXT, WHITE};
use crate::text::{MINUS, Text, number};
use crate::ticks::{Direction, MAX_STEPS, Tick, apart};

const HEIGHT: f64 = 560.0;
/// Room for the half of a number that extends beyond the bar's upper end.
const TOP: f64 = MARGIN + 8.0;
/// Distance between the map and its colour bar.
const GAP: f64 = 30.0;
/// Distance from the number of a cell to its half width below it.
const LINE: f64 = 36.0;
/// Largest number of columns and rows of a map with numbers in its cells.
const MAX_NUMBERED: usize = 8;
/// Largest number of cells for which an axis has a number at every cell; longer axes have numbers at round
/// values.
const MAX_NAMED: usize = 12;

/// A map of cells over two axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatMap {
    /// The axis of the columns.
    pub x: HeatAxis,
    /// The axis of the rows.
    pub y: HeatAxis,
    /// Quantity of the values.
    pub value_title: String,
    /// One value for every cell: all of the first y, then all of the second. A cell without a mean is left
    /// grey.
    pub values: Vec<Estimate>,
    /// Meaning of the intervals, below the map; may be empty.
    pub note: String,
}

/// An axis of a map.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HeatAxis {
    /// Quantity of the axis; see [`title`](crate::QuantityLabel::title).
    pub title: String,
    /// Values of the cells, in any order, all different.
    pub values: Vec<f64>,
    /// Whether the axis is logarithmic; without effect if a value is not positive.
    pub log: bool,
}

/// Draws a map, usually as wide as a journal's column (85 mm).
///
/// A cell reaches half-way to its neighbours, so uneven values give uneven cells. The colours span the values
/// plus half the median interval at both ends, so that smaller differences look small. A map of up to 8 x 8
/// cells has its numbers in the cells, if they are wide enough. The half width of an interval is below the
/// number; if there is no room for it, a second map below shows the half widths.
///
/// # Errors
///
/// An axis without values, with a value that is not a number, or with a value twice; a number of values other
/// than the number of cells; a size that leaves no room for the cells.
pub fn heat_map(map: &HeatMap, size: PictureSize) -> Result<Picture, PictureError> {
    let (mut x, mut y) = (HeatCells::new(&map.x)?, HeatCells::new(&map.y)?);
    let cells = in_order([&x, &y], &map.values)?;
    let values: Vec<f64> = cells.iter().map(Estimate::drawn_mean).collect();
    let half_width = |cell: &Estimate| Estimate::exact(0.5 * (cell.high - cell.low)).drawn_mean();
    let half_widths: Vec<f64> = cells.iter().map(half_width).collect();
    let half = median(&half_widths);
    let with_half = values.iter().flat_map(|value| [value - half, value + half]);
    let ranges = [range(with_half), range(half_widths.iter().copied())].map(<[f64; 2]>::from);

    let whole = size.roomy_width(COLUMN_WIDTH)?;
    let has_intervals = half_widths.iter().any(|half| !half.is_nan());
    let half_width_title = format!("half width, {}", map.value_title);
    let below = Note::new(&map.note, 0.0, whole).height;
    let height_of = |panels: usize| size.panel(HEIGHT, panels as f64 * (TOP + LOWER_ROOM) + below, panels);
    let none = vec![f64::NAN; values.len()];
    let mut panels = 1;
    let (area, bars, texts) = loop {
        let height = height_of(panels)?;
        y.axis = y.axis.placed(TOP + height, TOP);
        let left = left_room(&y.ticks(Direction::Y).0);
        let bar = |name: &str, range| ColourBar::new(Text::fitted(name, height), range, height);
        let bars = [
            bar(&map.value_title, ranges[0]),
            bar(&half_width_title, ranges[1]),
        ];
        let shown = if has_intervals { &bars[..] } else { &bars[..1] };
        let bar_room = shown.iter().map(ColourBar::room).fold(0.0, f64::max) + MARGIN;
        let width = (whole - left - GAP - bar_room).max(100.0).round();
        let area = Area::new(left, TOP, width, height);
        x.axis = x.axis.placed(area.x, area.right());
        let texts = cell_texts(&x, &y, &values, &half_widths, ranges[0]);
        if !has_intervals || texts.is_some() {
            break (area, bars, texts);
        }
        if panels == 2 {
            break (area, bars, cell_texts(&x, &y, &values, &none, ranges[0]));
        }
        // Half widths that do not fit in the cells get their own panel.
        panels = 2;
    };
    let panel = area.bottom() + LOWER_ROOM;
    let note = Note::new(&map.note, area.centre().0, whole);

    let mut canvas = Canvas::sized(whole, panels as f64 * panel + note.height, size);
    let titles = [map.x.title.as_str(), &map.y.title];
    draw_panel(&mut canvas, area, [&x, &y], (&values, &bars[0]), texts, titles);
    draw_crosses(&mut canvas, [&x, &y], &cells);
    if panels == 2 {
        let area = Area {
            y: panel + TOP,
            ..area
        };
        y.axis = y.axis.placed(area.bottom(), area.y);
        let texts = cell_texts(&x, &y, &half_widths, &none, ranges[1]);
        draw_panel(
            &mut canvas,
            area,
            [&x, &y],
            (&half_widths, &bars[1]),
            texts,
            titles,
        );
    }
    note.draw(&mut canvas);
    canvas.finish()
}

/// The areas of all cells in the order in which they are drawn.
fn cell_areas([x, y]: [&HeatCells; 2]) -> Vec<Area> {
    let (edges_x, edges_y) = (x.edges(), y.edges());
    let row = |y: &[f64]| -> Vec<Area> {
        let columns = edges_x.windows(2);
        columns.map(|x| Area::between(x[0], x[1], y[0], y[1])).collect()
    };
    edges_y.windows(2).flat_map(row).collect()
}

/// Values of cells in the order in which they are drawn.
fn in_order([x, y]: [&HeatCells; 2], values: &[Estimate]) -> Result<Vec<Estimate>, PictureError> {
    let (columns, rows) = (x.values.len(), y.values.len());
    if columns.checked_mul(rows) != Some(values.len()) {
        let values = values.len();
        return Err(PictureError::Cells {
            columns,
            rows,
            values,
        });
    }
    let value = |cell: usize| values[y.order[cell / columns] * columns + x.order[cell % columns]];
    Ok((0..values.len()).map(value).collect())
}

/// Draws a cross in the lower left corner of the marked cells.
fn draw_crosses(canvas: &mut Canvas, [x, y]: [&HeatCells; 2], cells: &[Estimate]) {
    /// Distance from the corner to the middle of the cross.
    const INSET: f64 = 14.0;
    let areas = cell_areas([x, y]).into_iter().zip(cells);
    for (area, _) in areas.filter(|(_, cell)| cell.crossed) {
        cross(canvas, (area.x + INSET, area.bottom() - INSET));
    }
}

/// The median of the values that are not NaN; zero if there is none.
fn median(values: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

/// Draws a map with its sides, numbers and colour bar; the titles are those of x and y.
fn draw_panel(
    canvas: &mut Canvas,
    area: Area,
    [x, y]: [&HeatCells; 2],
    (values, bar): (&[f64], &ColourBar),
    texts: Option<Vec<Vec<Text>>>,
    [x_title, y_title]: [&str; 2],
) {
    canvas.images.push(image(area, x, y, values, bar.range));
    if let Some(texts) = texts {
        draw_numbers(canvas, [x, y], &texts, (values, bar.range));
    }
    canvas.frame(area);
    let (ticks, short) = y.ticks(Direction::Y);
    short_ticks(canvas, area, Direction::Y, &short);
    left_side(canvas, area, 0.0, &ticks, &Text::fitted(y_title, area.height));
    let (ticks, short) = x.ticks(Direction::X);
    short_ticks(canvas, area, Direction::X, &short);
    lower_side(canvas, area, &ticks, &Text::fitted(x_title, area.width));
    let at = (area.right() + GAP, area.y);
    // A name that was cut to the height of the bar is next to it, never above.
    bar.draw(canvas, at, area.y);
    if values.iter().any(|value| value.is_nan()) {
        draw_blank(canvas, Area::new(at.0, area.y, BAR_WIDTH, area.height));
    }
}

/// The cells along an axis, in rising order.
struct HeatCells {
    axis: DrawnAxis,
    /// The index of every cell among the axis' values.
    order: Vec<usize>,
    values: Vec<f64>,
    /// Boundaries of the cells in coordinates of the axis, one more than there are cells.
    edges: Vec<f64>,
}

impl HeatCells {
    fn new(axis: &HeatAxis) -> Result<Self, PictureError> {
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
        let whole = DrawnAxis::around(&values, axis.log, 0.0);
        let measured: Vec<f64> = values.iter().map(|&value| whole.measure(value)).collect();
        if measured.windows(2).any(|pair| pair[0] >= pair[1]) {
            return Err(error("two values are the same"));
        }
        let (first, last) = (measured[0], measured[measured.len() - 1]);
        let middles = measured.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let mut edges: Vec<f64> = middles.collect();
        // The outermost cells are symmetric about their values.
        let (lo, hi) = match edges[..] {
            [] => widened((first, last)),
            [inner, ..] => (2.0 * first - inner, 2.0 * last - edges[edges.len() - 1]),
        };
        edges.insert(0, lo);
        edges.push(hi);
        Ok(Self {
            axis: DrawnAxis::between(lo, hi, whole.is_log),
            order,
            values,
            edges,
        })
    }

    /// The pixels of the cells' boundaries, in rising order of value.
    fn edges(&self) -> Vec<f64> {
        let pixel = |&edge: &f64| self.axis.at_measured(edge).round();
        self.edges.iter().map(pixel).collect()
    }

    /// Numbered and short ticks: the values themselves if they are few and have room, else round values.
    fn ticks(&self, direction: Direction) -> (Vec<Tick>, Vec<f64>) {
        let named = |digits: usize| {
            let written: Option<Vec<String>> = self.values.iter().map(|&v| short(v, digits)).collect();
            let written = written.filter(|texts| texts.windows(2).all(|pair| pair[0] != pair[1]))?;
            let numbers = written.iter().map(|text| Text::number(text, SIZE_TEXT));
            let pixels = self.values.iter().map(|&value| self.axis.at(value));
            let ticks: Vec<Tick> = pixels.zip(numbers).collect();
            apart(&ticks, direction).then_some(ticks)
        };
        let few = self.values.len() <= MAX_NAMED;
        match [4, 3, 2].into_iter().filter(|_| few).find_map(named) {
            Some(ticks) => (ticks, Vec::new()),
            None => (self.axis.ticks(direction, MAX_STEPS), self.axis.short_ticks()),
        }
    }
}

/// A value with `digits` significant digits and without trailing zeros; none if that changes it by more than
/// 2 %.
fn short(value: f64, digits: usize) -> Option<String> {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1));
    if (rounded.parse::<f64>().ok()? - value).abs() > 0.02 * value.abs() {
        return None;
    }
    let (mantissa, power) = rounded.split_once('e')?;
    let trimmed = |text: &str| {
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_string()
        } else {
            text.to_string()
        }
    };
    let exponent: i32 = power.parse().ok()?;
    if (-4..6).contains(&exponent) {
        let decimals = (digits as i32 - 1 - exponent).max(0) as usize;
        return Some(trimmed(&number(value, decimals)));
    }
    Some(format!("{}e{power}", trimmed(mantissa)).replace('-', MINUS))
}

/// Writes the meaning of grey below the colour bar.
fn draw_blank(canvas: &mut Canvas, bar: Area) {
    let text = Text::plain("none", SIZE_TEXT);
    // At the height of the axis title, because a tick number may reach as far as the bar.
    let baseline = bar.bottom() + LOWER_ROOM - MARGIN - 4.0;
    let patch = Area {
        y: baseline - text.height() - 3.0,
        height: text.height() + 6.0,
        ..bar
    };
    canvas.fill(patch, BLANK, 1.0);
    canvas.frame(patch);
    canvas.text(&text, (patch.right() + 10.0, baseline), Align::Start, BLACK);
}

/// The cells as an image with a pixel for every pixel of the picture, because all columns of an image have
/// the same width.
fn image(area: Area, x: &HeatCells, y: &HeatCells, values: &[f64], range: [f64; 2]) -> Image {
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
        cells_x.iter().map(move |&column| level(values[column], range))
    });
    Image {
        area,
        columns,
        levels: levels.collect(),
    }
}

/// The lines in every cell, its value and its half width if it has one; none if there is no room.
fn cell_texts(
    x: &HeatCells,
    y: &HeatCells,
    values: &[f64],
    half_widths: &[f64],
    [lo, hi]: [f64; 2],
) -> Option<Vec<Vec<Text>>> {
    let size = lo.abs().max(hi.abs());
    if x.values.len().max(y.values.len()) > MAX_NUMBERED || !(1e-4..1e6).contains(&size) {
        return None;
    }
    let areas = cell_areas([x, y]);
    let smallest = |side: fn(&Area) -> f64| areas.iter().map(side).fold(f64::INFINITY, f64::min);
    let (room_x, room_y) = (
        smallest(|area| area.width) - 12.0,
        smallest(|area| area.height) - 12.0,
    );
    // About two significant digits of the range, or one fewer.
    let decimals = libm::log10(50.0 / (hi - lo)).ceil().clamp(0.0, 9.0) as usize;
    let lines = |(&value, &half): (&f64, &f64), decimals, size| {
        let mut lines = Vec::new();
        if !value.is_nan() {
            lines.push(Text::plain(&number(value, decimals), size));
        }
        if !half.is_nan() {
            lines.push(Text::plain(&plus_minus(half, decimals), size));
        }
        lines
    };
    let has_room = |lines: &Vec<Text>| {
        let height = lines.first().map_or(0.0, Text::height);
        let tall = height + LINE * lines.len().saturating_sub(1) as f64;
        tall <= room_y && lines.iter().all(|line| line.width() <= room_x)
    };
    let fewer = decimals.saturating_sub(1);
    let choices = [decimals, fewer].map(|decimals| [SIZE_TEXT, SIZE_NARROW].map(|size| (decimals, size)));
    choices.into_iter().flatten().find_map(|(decimals, size)| {
        let cells = values.iter().zip(half_widths);
        let cells: Vec<_> = cells.map(|cell| lines(cell, decimals, size)).collect();
        cells.iter().all(has_room).then_some(cells)
    })
}

/// A half width with as many decimals as its value, or with as many as its first digit needs.
fn plus_minus(half: f64, decimals: usize) -> String {
    let first = -libm::log10(half).floor();
    let needed = if half > 0.0 {
        first.clamp(0.0, 9.0) as usize
    } else {
        0
    };
    format!("\u{b1}{}", number(half, decimals.max(needed)))
}

/// Writes the lines of every cell into it.
fn draw_numbers(
    canvas: &mut Canvas,
    cells: [&HeatCells; 2],
    texts: &[Vec<Text>],
    (values, range): (&[f64], [f64; 2]),
) {
    for ((lines, &value), area) in texts.iter().zip(values).zip(cell_areas(cells)) {
        let (middle, centre) = area.centre();
        let colour = readable_on(level_colour(level(value, range)));
        let above = 0.5 * LINE * lines.len().saturating_sub(1) as f64;
        for (line, text) in lines.iter().enumerate() {
            let baseline = centre - above + LINE * line as f64 + 0.5 * text.height();
            canvas.text(text, (middle, baseline), Align::Middle, colour);
        }
    }
}

/// Black or white, whichever contrasts more.
fn readable_on(ground: Rgb) -> Rgb {
    let [red, green, blue] = ground.map(|channel| libm::pow(f64::from(channel) / 255.0, 2.2));
    let luminance = 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    // Contrast with white against contrast with black (WCAG 2).
    let is_dark = 1.05 / (luminance + 0.05) > (luminance + 0.05) / 0.05;
    if is_dark { WHITE } else { BLACK }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(values: &[f64], log: bool) -> HeatAxis {
        HeatAxis {
            title: "axis".to_string(),
            values: values.to_vec(),
            log,
        }
    }

    fn map(columns: usize, rows: usize) -> HeatMap {
        let values = |count: usize| (1..=count).map(|i| i as f64).collect::<Vec<_>>();
        HeatMap {
            x: axis(&values(columns), false),
            y: axis(&values(rows), true),
            value_title: "value".to_string(),
            values: (0..columns * rows)
                .map(|cell| Estimate::exact(0.5 * cell as f64))
                .collect(),
            ..HeatMap::default()
        }
    }

    fn with_half_widths(mut map: HeatMap, half: f64) -> HeatMap {
        for value in &mut map.values {
            (value.low, value.high) = (value.mean - half, value.mean + half);
        }
        map
    }

    #[test]
    fn cells_reach_half_way_to_their_neighbours() {
        let cells = HeatCells::new(&axis(&[4.0, 1.0, 2.0], false)).unwrap();
        assert_eq!(cells.order, [1, 2, 0]);
        assert_eq!(cells.edges, [0.5, 1.5, 3.0, 5.0]);
        let cells = HeatCells::new(&axis(&[1.0, 100.0], true)).unwrap();
        assert_eq!(cells.edges, [-1.0, 1.0, 3.0]);
    }

    #[test]
    fn the_order_of_the_values_does_not_matter() {
        let mut map = map(3, 2);
        (map.values[0].crossed, map.values[4].crossed) = (true, true);
        let mut turned = map.clone();
        turned.x.values.reverse();
        turned.y.values.reverse();
        turned.values.reverse();
        assert_eq!(
            heat_map(&map, PictureSize::default()).unwrap(),
            heat_map(&turned, PictureSize::default()).unwrap()
        );
    }

    #[test]
    fn few_cells_have_numbers_and_many_have_none() {
        assert!(
            heat_map(&map(6, 6), PictureSize::default())
                .unwrap()
                .svg
                .contains(">17.5</text>")
        );
        assert!(
            !heat_map(&map(6, 9), PictureSize::default())
                .unwrap()
                .svg
                .contains(">17.5</text>")
        );
    }

    /// Half widths are below the numbers if there is room, else on their own map, and nowhere if there are
    /// none.
    #[test]
    fn half_widths_are_shown_wherever_there_are_some() {
        let svg = |columns: usize, half: f64| {
            let map = with_half_widths(map(columns, 3), half);
            heat_map(&map, PictureSize::default()).unwrap().svg
        };
        let title = ">half width, value</text>";
        let few = svg(3, 0.25);
        assert!(
            few.matches(">\u{b1}0.25</text>").count() == 9 && !few.contains(title),
            "{few}"
        );
        // A half width that the decimals of the values would round to zero shows its first digit.
        assert!(svg(3, 0.0004).contains(">\u{b1}0.0004</text>"));
        assert_eq!(svg(9, 0.25).matches(title).count(), 1);
        let none = svg(3, f64::NAN);
        assert!(!none.contains('\u{b1}') && !none.contains(title) && !none.contains("NaN"));
    }

    /// Values that differ by less than the intervals do not span all colours.
    #[test]
    fn the_colours_span_the_intervals() {
        let reaches_below = |half: f64| {
            let map = with_half_widths(map(9, 2), half);
            heat_map(&map, PictureSize::default())
                .unwrap()
                .svg
                .contains(">\u{2212}20</text>")
        };
        assert!(!reaches_below(f64::NAN) && !reaches_below(0.1) && reaches_below(20.0));
        assert_eq!(median(&[3.0, f64::NAN, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[f64::NAN]), 0.0);
    }

    #[test]
    fn grey_is_explained_where_there_is_any() {
        let mut map = map(6, 6);
        assert!(
            !heat_map(&map, PictureSize::default())
                .unwrap()
                .svg
                .contains(">none</text>")
        );
        map.values[7] = Estimate::NONE;
        assert!(
            heat_map(&map, PictureSize::default())
                .unwrap()
                .svg
                .contains(">none</text>")
        );
        map.values.fill(Estimate::exact(f64::INFINITY));
        assert!(
            !heat_map(&map, PictureSize::default())
                .unwrap()
                .svg
                .contains("NaN")
        );
    }

    #[test]
    fn odd_maps_are_drawn_all_the_same() {
        for (columns, rows) in [(1, 1), (1, 40), (40, 1), (300, 700)] {
            heat_map(&map(columns, rows), PictureSize::default()).unwrap();
        }
        let mut odd = map(2, 2);
        odd.x.values = vec![1e-9, 12345.0];
        odd.y.values = vec![5e-324, 9e99];
        odd.values = [-9e99, 9e99, 5e-324, 0.0].map(Estimate::exact).to_vec();
        assert!(
            !heat_map(&odd, PictureSize::default())
                .unwrap()
                .svg
                .contains("NaN")
        );
    }

    #[test]
    fn an_axis_value_keeps_the_digits_that_matter() {
        let written = |value, digits| short(value, digits).unwrap_or_default();
        assert_eq!(written(0.05, 4), "0.05");
        assert_eq!(written(0.018_205_6, 3), "0.0182");
        assert_eq!(written(12345.0, 4), "12345");
        assert_eq!(written(-1.5e-9, 3), "\u{2212}1.5e\u{2212}9");
        assert_eq!(written(0.0, 2), "0");
        // 12 would be 4 % off.
        assert_eq!(short(12.5, 2), None);
    }

    #[test]
    fn what_cannot_be_divided_into_cells_is_refused() {
        let error = |change: &dyn Fn(&mut HeatMap)| {
            let mut map = map(2, 3);
            change(&mut map);
            heat_map(&map, PictureSize::default()).unwrap_err().to_string()
        };
        let reasons = [
            error(&|m| m.x.values.clear()),
            error(&|m| m.x.values[1] = f64::NAN),
            error(&|m| m.y.values[1] = m.y.values[0]),
        ];
        for (error, reason) in reasons.iter().zip([
            "it has no value",
            "a value is not a number",
            "two values are the same",
        ]) {
            assert_eq!(
                *error,
                format!("the axis `axis` cannot be divided into cells: {reason}")
            );
        }
        assert_eq!(
            error(&|m| m.values.push(Estimate::NONE)),
            "a map of 2 x 3 cells has 7 values"
        );
    }

    #[test]
    fn numbers_stand_out_from_their_cells() {
        assert_eq!(readable_on(level_colour(0)), WHITE);
        assert_eq!(readable_on(level_colour(254)), BLACK);
    }
}
