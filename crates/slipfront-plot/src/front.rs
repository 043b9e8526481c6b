//! The spread of slip: the time at which every block has first slipped, and the share of sliding blocks along
//! the drive against time, which runs to the right.

use crate::axis::{DrawnAxis, range};
use crate::canvas::Canvas;
use crate::cell_means::CellMeans;
use crate::color_bar::{ABOVE, ColourBar};
use crate::color_image::{Image, level};
use crate::contour::{contours, smoothed};
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_side};
use crate::geometry::Area;
use crate::lattice_map::{DrawnLattice, MARK, MIN_RATIO, check_length, circle, place, unit_of};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::quantity_labels::{FIRST_SLIP, SLIDING_SHARE};
use crate::size::PictureSize;
use crate::style::{MARGIN, RADIUS_MARKER, TEXT_WIDTH, WHITE, WIDTH_FRAME};
use crate::text::Text;
use crate::ticks::{Direction, Tick, round_values};

/// Distance between a panel and its colour bar.
const GAP: f64 = 30.0;
/// Largest width of a map next to the other panel, 44 mm, and largest height, unless the slider is long along
/// y.
const MAX_SIDE: f64 = 520.0;
const MAX_SIDE_LONG: f64 = 1000.0;
/// Ratio of length to height above which a slider has its map above the other panel, as wide as the page.
const MAX_RATIO: f64 = 3.0;
/// Least width of a picture with both panels side by side, 140 mm.
const MIN_BESIDE: f64 = 1650.0;
/// Least height of a map above the other panel, over its length.
const MIN_RATIO_ABOVE: f64 = 1.0 / 12.0;
/// Height of the other panel below a map.
const HEIGHT_BELOW: f64 = 400.0;
/// Height of the other panel when it is drawn alone.
const HEIGHT_ALONE: f64 = 900.0;
/// Largest number of steps between contours.
const CONTOUR_STEPS: usize = 8;
/// Ratio of the longer side of the map to the reach of the moving average that smooths it for the contours.
const SMOOTHED_SHARE: usize = 64;
/// Least distance between contour levels, over the scatter of cells around these averages: closer contours
/// would show only scatter.
const SCATTERS_APART: f64 = 3.0;
/// Least number of cells along a side for contours: with fewer cells, they would be mere ticks.
const MIN_CELLS_OF_CONTOURS: usize = 8;
/// Room for the half of a number that extends beyond a panel's upper end.
const TOP: f64 = MARGIN + 8.0;

/// The times at which the blocks of a lattice have first slipped.
#[derive(Clone, Debug, PartialEq)]
pub struct FrontMap {
    /// The lattice.
    pub lattice: DrawnLattice,
    /// Mean t* of the first slip of every [cell](CellMeans), row by row from y = 0; NaN is left blank.
    pub first_slips: Vec<f32>,
    /// Places at which slip has nucleated, in metres, the earliest first.
    pub nucleations: Vec<[f64; 2]>,
}

/// Share of the sliding blocks against position and time.
#[derive(Clone, Debug, PartialEq)]
pub struct SpaceTime {
    /// Quantity of the places; its unit is added.
    pub place: String,
    /// The first and the last place, in metres.
    pub places: [f64; 2],
    /// The first and the last t*.
    pub times: [f64; 2],
    /// Number of places in a row.
    pub columns: usize,
    /// The share of the blocks that slide, row by row from the earliest; NaN is left blank.
    pub shares: Vec<f32>,
}

/// Draws the map next to the space-time panel, or above it for a long slider or in a narrow picture. The
/// picture is at most as wide as a journal's text (175 mm), or as wide as requested. Nucleations are circled,
/// the first one filled; the texture is outlined.
///
/// # Errors
///
/// A lattice without blocks, an array of the wrong length, a block size that is not a positive length, no
/// instant; a height, or a width without room for a map.
pub fn front(map: &FrontMap, space_time: &SpaceTime, size: PictureSize) -> Result<Picture, PictureError> {
    check(map, space_time)?;
    size.expect_no_height()?;
    let layout = FrontLayout::new(map, space_time, size.roomy_width(TEXT_WIDTH)?);
    let lines = contour_lines(map, layout.map.bar.range);
    let note = Note::new(&meaning_of_marks(map, &lines), 0.5 * layout.width, layout.width);
    let mut canvas = Canvas::sized(layout.width, layout.height + note.height, size);
    draw_map(&mut canvas, map, &layout.map, lines);
    draw_space_time(&mut canvas, space_time, &layout.space_time);
    note.draw(&mut canvas);
    canvas.widened(size).finish()
}

/// Draws the share of the sliding blocks against position and time alone, usually as wide as a journal's text
/// (175 mm).
///
/// # Errors
///
/// No instant, an array of the wrong length, or a size without room for the panel.
pub fn kymograph(space_time: &SpaceTime, size: PictureSize) -> Result<Picture, PictureError> {
    check_space_time(space_time)?;
    let (axes, titles) = space_time_axes(space_time);
    let upper = share_bar(space_time, HEIGHT_ALONE).upper_room();
    let height = size.panel(HEIGHT_ALONE, TOP + upper + LOWER_ROOM, 1)?;
    let left = left_room(&axes[1].placed(height, 0.0).ticks(Direction::Y, 5));
    let bar = share_bar(space_time, height);
    let top = TOP + bar.upper_room();
    let width = size.roomy_width(TEXT_WIDTH)? - left - GAP - bar.room() - MARGIN;
    let area = Area::new(left, top, width.round(), height);
    let panel = FrontPanel {
        area,
        edge: 0.0,
        axes,
        titles,
        bar,
    };
    let mut canvas = Canvas::sized(panel.right() + MARGIN, area.bottom() + LOWER_ROOM, size);
    draw_space_time(&mut canvas, space_time, &panel);
    canvas.widened(size).finish()
}

/// The axes of times and places, and their titles.
fn space_time_axes(space_time: &SpaceTime) -> ([DrawnAxis; 2], [String; 2]) {
    let [from, to] = space_time.places;
    let (unit, factor) = unit_of(from.abs().max(to.abs()));
    let around = |[from, to]: [f64; 2]| {
        let (lo, hi) = range([from, to].into_iter());
        DrawnAxis::linear(lo, hi)
    };
    let axes = [around(space_time.times), around([from * factor, to * factor])];
    let place = format!("{} ({unit})", space_time.place);
    (axes, ["time t*".to_owned(), place])
}

/// The colour bar of the shares, which ends at the largest of them.
fn share_bar(space_time: &SpaceTime, height: f64) -> ColourBar {
    let shares = space_time
        .shares
        .iter()
        .copied()
        .filter(|share| share.is_finite());
    let largest = f64::from(shares.fold(0.0, f32::max));
    let largest = if largest > 0.0 { largest } else { 1.0 };
    ColourBar::labelled(SLIDING_SHARE, [0.0, largest], height)
}

/// A text that explains those marks that the map has.
fn meaning_of_marks(map: &FrontMap, lines: &[Vec<(f64, f64)>]) -> String {
    let marks = [
        (
            !map.nucleations.is_empty(),
            "filled circle: first nucleation site",
        ),
        (map.nucleations.len() > 1, "circles: the others"),
        (!lines.is_empty(), "white lines: equal times"),
    ];
    let drawn = marks.into_iter().filter(|(is_drawn, _)| *is_drawn);
    drawn.map(|(_, words)| words).collect::<Vec<_>>().join("; ")
}

fn check_space_time(space_time: &SpaceTime) -> Result<(), PictureError> {
    let (found, columns) = (space_time.shares.len(), space_time.columns);
    match found.checked_div(columns) {
        None | Some(0) => Err(PictureError::Nothing("instant")),
        Some(rows) => check_length("what slides", found, rows * columns),
    }
}

fn check(map: &FrontMap, space_time: &SpaceTime) -> Result<(), PictureError> {
    map.lattice
        .check(&[("the map of first slips".to_owned(), &map.first_slips)])?;
    check_space_time(space_time)
}

/// A panel with its axes and its colour bar.
struct FrontPanel {
    area: Area,
    /// Left end of the room of the panel.
    edge: f64,
    axes: [DrawnAxis; 2],
    titles: [String; 2],
    bar: ColourBar,
}

impl FrontPanel {
    fn draw_axes(&self, canvas: &mut Canvas) {
        let (area, [x_title, y_title]) = (self.area, &self.titles);
        canvas.frame(area);
        let y_ticks = ticks(self.axes[1], area, Direction::Y);
        let title = Text::fitted(y_title, area.height);
        left_side(canvas, area, self.edge, &y_ticks, &title);
        let x_ticks = ticks(self.axes[0], area, Direction::X);
        let title = Text::fitted(x_title, area.width + 2.0 * GAP);
        lower_side(canvas, area, &x_ticks, &title);
        self.bar
            .draw(canvas, (area.right() + GAP, area.y), area.y - ABOVE);
    }

    /// Right end of the colour bar.
    fn right(&self) -> f64 {
        self.area.right() + GAP + self.bar.room()
    }
}

/// Ticks along a side, fewer along a short one.
fn ticks(axis: DrawnAxis, area: Area, direction: Direction) -> Vec<Tick> {
    let (axis, side) = match direction {
        Direction::X => (axis.placed(area.x, area.right()), area.width),
        Direction::Y => (axis.placed(area.bottom(), area.y), area.height),
    };
    axis.ticks(direction, if side < 130.0 { 2 } else { 5 })
}

/// Layout of the picture.
struct FrontLayout {
    width: f64,
    height: f64,
    map: FrontPanel,
    space_time: FrontPanel,
}

impl FrontLayout {
    /// Panels in a picture that is at most this wide.
    fn new(map: &FrontMap, space_time: &SpaceTime, whole: f64) -> Self {
        let lengths = map.lattice.sides();
        let units = lengths.map(unit_of);
        let sides = [0, 1].map(|axis| DrawnAxis::linear(0.0, lengths[axis] * units[axis].1));
        let space_time_axes = space_time_axes(space_time);
        let first_slips: [f64; 2] = range(quantiles(&map.first_slips).into_iter()).into();
        let map_bar = |height| ColourBar::labelled(FIRST_SLIP, first_slips, height);
        let bar = |height| share_bar(space_time, height);
        let left = |axis: DrawnAxis| left_room(&axis.placed(MAX_SIDE, 0.0).ticks(Direction::Y, 5));
        let [map_left, left] = [left(sides[1]), left(space_time_axes.0[1])];
        let titles = [format!("x ({})", units[0].0), format!("y ({})", units[1].0)];
        let map_axes = (sides, titles);
        let panel = |area: Area, room: f64, (axes, titles): ([DrawnAxis; 2], [String; 2]), bar| FrontPanel {
            edge: area.x - room,
            area,
            axes,
            titles,
            bar,
        };
        let ratio = lengths[1] / lengths[0];
        let (map, space_time) = if ratio * MAX_RATIO < 1.0 || whole < MIN_BESIDE {
            let left = map_left.max(left);
            let widest = map_bar(HEIGHT_BELOW).room().max(bar(HEIGHT_BELOW).room());
            let width = (whole - left - GAP - widest - MARGIN).round();
            let ratio = ratio.clamp(MIN_RATIO_ABOVE, 1.0 / MIN_RATIO);
            let height = (width * ratio).min(MAX_SIDE_LONG).round();
            let map_bar = map_bar(height);
            let map_width = (height / ratio).round();
            let upper = Area::new(left, TOP + map_bar.upper_room(), map_width, height);
            let below = upper.bottom() + LOWER_ROOM + TOP;
            let lower = Area::new(left, below, width, HEIGHT_BELOW);
            (
                panel(upper, left, map_axes, map_bar),
                panel(lower, left, space_time_axes, bar(HEIGHT_BELOW)),
            )
        } else {
            let ratio = ratio.clamp(MIN_RATIO, 1.0 / MIN_RATIO);
            let height = if ratio > MAX_RATIO {
                MAX_SIDE_LONG
            } else {
                (MAX_SIDE * ratio.min(1.0)).round()
            };
            let first = Area::new(map_left, TOP, (height / ratio).round(), height);
            let first = panel(first, map_left, map_axes, map_bar(height));
            let x = (first.right() + GAP + left).round();
            let bar = bar(MAX_SIDE);
            let width = whole - x - GAP - bar.room() - MARGIN;
            let second = Area::new(x, TOP, width.min(1.5 * MAX_SIDE).round(), MAX_SIDE);
            (first, panel(second, left, space_time_axes, bar))
        };
        let lowest = map.area.bottom().max(space_time.area.bottom());
        Self {
            width: map.right().max(space_time.right()) + MARGIN,
            height: lowest + LOWER_ROOM,
            map,
            space_time,
        }
    }
}

/// The range of most times: a few slips long after the front has passed would otherwise take up most of the
/// colour scale.
fn quantiles(times: &[f32]) -> [f64; 2] {
    let mut sorted: Vec<f32> = times.iter().copied().filter(|time| !time.is_nan()).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let at = |share: f64| {
        let place = (share * sorted.len().saturating_sub(1) as f64).round() as usize;
        sorted.get(place).map_or(f64::NAN, |time| f64::from(*time))
    };
    [at(0.0), at(0.98)]
}

/// Contours of the time of first slip in a map with this range of colours, as fractions of its sides.
fn contour_lines(map: &FrontMap, range: [f64; 2]) -> Vec<Vec<(f64, f64)>> {
    let [columns, rows] = CellMeans::cells(map.lattice.nx, map.lattice.ny);
    let reach = 1 + columns.max(rows) / SMOOTHED_SHARE;
    let means = smoothed(&map.first_slips, columns, reach);
    let at = |(x, y): (f64, f64)| ((x + 0.5) / columns as f64, (y + 0.5) / rows as f64);
    levels(range, &map.first_slips, &means, columns.min(rows))
        .into_iter()
        .flat_map(|level| contours(&means, columns, level))
        .map(|line| line.into_iter().map(at).collect())
        .collect()
}

fn draw_map(canvas: &mut Canvas, map: &FrontMap, panel: &FrontPanel, lines: Vec<Vec<(f64, f64)>>) {
    let area = panel.area;
    let cells = map.lattice.cells();
    cells.draw(canvas, area, &map.first_slips, panel.bar.range);
    for line in lines {
        let points = line.into_iter().map(|point| place(area, point));
        canvas.polyline(points.collect(), WIDTH_FRAME, WHITE);
    }
    let sides = map.lattice.sides();
    // The first one is drawn last, on top of all others.
    for (index, [x, y]) in map.nucleations.iter().enumerate().rev() {
        let (x, y) = (x / sides[0], y / sides[1]);
        if !((0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y)) {
            continue;
        }
        let at = place(area, (x, y));
        circle(canvas, at, MARK);
        if index == 0 {
            canvas.dot(at, RADIUS_MARKER, MARK);
        }
    }
    panel.draw_axes(canvas);
}

/// The levels of the contours of these means of first slips, on a map with `side` cells along its shorter
/// side.
fn levels([lo, hi]: [f64; 2], first_slips: &[f32], means: &[f32], side: usize) -> Vec<f64> {
    let pairs = first_slips.iter().zip(means);
    let deviations = pairs.map(|(time, mean)| f64::from(time - mean));
    let deviations: Vec<f64> = deviations.filter(|deviation| deviation.is_finite()).collect();
    let squares: f64 = deviations.iter().map(|deviation| deviation * deviation).sum();
    let scatter = f64::sqrt(squares / deviations.len() as f64);
    // Without scatter, the largest number of steps.
    let steps = ((hi - lo) / (SCATTERS_APART * scatter)).min(CONTOUR_STEPS as f64) as usize;
    if steps >= 2 && side >= MIN_CELLS_OF_CONTOURS {
        round_values(lo, hi, steps).1
    } else {
        Vec::new()
    }
}

fn draw_space_time(canvas: &mut Canvas, space_time: &SpaceTime, panel: &FrontPanel) {
    let rows = space_time.shares.len() / space_time.columns;
    let means = CellMeans::compute(space_time.columns, rows, space_time.shares.iter().copied());
    let [columns, _] = CellMeans::cells(space_time.columns, rows);
    let instants = means.len() / columns;
    // The image's first row is the uppermost, the farthest place.
    let places = (0..columns).rev();
    let cells = places.flat_map(|place| (0..instants).map(move |instant| instant * columns + place));
    canvas.images.push(Image {
        area: panel.area,
        columns: instants,
        levels: cells
            .map(|cell| level(f64::from(means[cell]), panel.bar.range))
            .collect(),
    });
    panel.draw_axes(canvas);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(nx: usize, ny: usize) -> FrontMap {
        let [columns, rows] = CellMeans::cells(nx, ny);
        let times = (0..columns * rows).map(|cell| (cell % columns + cell / columns) as f32);
        FrontMap {
            lattice: DrawnLattice {
                nx,
                ny,
                block_size: 1e-6,
                textured: (0..columns * rows)
                    .map(|cell| columns > 4 && cell % columns == 2)
                    .collect(),
            },
            first_slips: times.collect(),
            nucleations: vec![[0.5e-6, 0.5e-6], [nx as f64 * 0.9e-6, ny as f64 * 0.9e-6]],
        }
    }

    fn space_time(columns: usize, rows: usize) -> SpaceTime {
        SpaceTime {
            place: "position along drive".to_owned(),
            places: [0.0, columns as f64 * 1e-6],
            times: [12.5, 260.0],
            columns,
            shares: (0..columns * rows).map(|k| (k % 11) as f32 / 10.0).collect(),
        }
    }

    #[test]
    fn every_shape_is_drawn_within_the_width_of_a_page() {
        for (nx, ny) in [
            (50, 50),
            (4, 400),
            (400, 4),
            (100, 1),
            (1, 100),
            (1, 1),
            (30, 20),
            (1000, 300),
        ] {
            let (map, space_time) = (map(nx, ny), space_time(nx.min(1024), 90));
            let layout = FrontLayout::new(&map, &space_time, TEXT_WIDTH);
            assert!(layout.width <= TEXT_WIDTH + 12.0, "{nx} x {ny}: {}", layout.width);
            for panel in [&layout.map, &layout.space_time] {
                assert!(
                    panel.area.width >= 80.0 && panel.area.height >= 80.0,
                    "{nx} x {ny}"
                );
                assert!(panel.area.bottom() + LOWER_ROOM <= layout.height);
            }
            let svg = front(&map, &space_time, PictureSize::default()).unwrap().svg;
            assert!(!svg.contains("NaN"));
            // Both panels and their bars.
            assert_eq!(svg.matches("<image").count(), 4);
        }
    }

    #[test]
    fn contours_and_nucleations_are_drawn() {
        let marked = map(40, 40);
        let mut plain = marked.clone();
        plain.nucleations.clear();
        let lines = |map: &FrontMap| {
            front(map, &space_time(40, 60), PictureSize::default())
                .unwrap()
                .svg
                .matches("<path")
                .count()
        };
        assert!(lines(&marked) > lines(&plain));
        let mut level = plain.clone();
        level.first_slips.fill(3.0);
        assert!(lines(&plain) > lines(&level));
    }

    /// The scale of the shares ends at the largest of them, and the marks that are drawn are named.
    #[test]
    fn the_scale_ends_with_the_data_and_marks_are_named() {
        let (map, mut shares) = (map(40, 40), space_time(40, 60));
        for share in &mut shares.shares {
            *share *= 0.25;
        }
        assert_eq!(share_bar(&shares, 100.0).range, [0.0, 0.25]);
        let written = |map: &FrontMap, words: &str| {
            front(map, &shares, PictureSize::default())
                .unwrap()
                .svg
                .contains(words)
        };
        for words in [
            "filled circle: first nucleation site",
            "circles: the others",
            "white lines: equal times",
        ] {
            assert!(written(&map, words), "{words}");
        }
        let mut plain = map;
        plain.nucleations.truncate(1);
        assert!(!written(&plain, "circles"));
        plain.nucleations.clear();
        plain.first_slips.fill(3.0);
        assert!(!written(&plain, "filled circle") && !written(&plain, "lines"));
        shares.shares.fill(0.0);
        assert_eq!(share_bar(&shares, 100.0).range, [0.0, 1.0]);
        let svg = kymograph(&shares, PictureSize::default()).unwrap().svg;
        assert!(svg.contains("position along drive") && svg.matches("<image").count() == 2);
        shares.shares.clear();
        assert_eq!(
            kymograph(&shares, PictureSize::default())
                .unwrap_err()
                .to_string(),
            "there is no instant to draw"
        );
    }

    /// Blocks that slip at random have no contours, and neither have narrow strips.
    #[test]
    fn scatter_has_no_contours() {
        let mut random = map(40, 40);
        for (index, time) in random.first_slips.iter_mut().enumerate() {
            *time = (index * index * 7919 % 1009) as f32;
        }
        let of = |map: &FrontMap| {
            let [columns, rows] = CellMeans::cells(map.lattice.nx, map.lattice.ny);
            let range = range(quantiles(&map.first_slips).into_iter()).into();
            let means = smoothed(&map.first_slips, columns, 1);
            levels(range, &map.first_slips, &means, columns.min(rows)).len()
        };
        assert_eq!((of(&random), of(&map(4, 400))), (0, 0));
        assert!(of(&map(40, 40)) > 4);
    }

    #[test]
    fn blank_maps_are_drawn() {
        let (mut map, mut space_time) = (map(5, 5), space_time(5, 1));
        map.first_slips.fill(f32::NAN);
        space_time.shares.fill(f32::NAN);
        space_time.times = [3.0; 2];
        assert!(
            !front(&map, &space_time, PictureSize::default())
                .unwrap()
                .svg
                .contains("NaN")
        );
    }

    /// One block that slips long after all others does not compress the colours of the others.
    #[test]
    fn late_slips_take_no_colours() {
        let mut times = vec![1.0; 99];
        times.push(1000.0);
        assert_eq!(quantiles(&times), [1.0, 1.0]);
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let error = |change: &dyn Fn(&mut FrontMap, &mut SpaceTime)| {
            let (mut map, mut space_time) = (map(2, 3), space_time(2, 4));
            change(&mut map, &mut space_time);
            front(&map, &space_time, PictureSize::default())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            error(&|map, _| map.lattice.nx = 0),
            "a lattice of 0 x 3 blocks cannot be drawn"
        );
        assert_eq!(
            error(&|map, _| map.lattice.textured.clear()),
            "the texture has 0 values instead of 6"
        );
        assert_eq!(
            error(&|map, _| map.first_slips.push(0.0)),
            "the map of first slips has 7 values instead of 6"
        );
        assert_eq!(error(&|_, it| it.shares.clear()), "there is no instant to draw");
        assert_eq!(error(&|_, it| it.columns = 0), "there is no instant to draw");
        assert_eq!(
            error(&|_, it| it.shares.push(0.0)),
            "what slides has 9 values instead of 8"
        );
    }
}
