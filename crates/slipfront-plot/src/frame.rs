//! The numbered sides of panels and colour bars: ticks, their numbers, titles.

use crate::axis::DrawnAxis;
use crate::canvas::Canvas;
use crate::color_image::Image;
use crate::geometry::{Align, Area};
use crate::style::{BLACK, MARGIN, SIZE_TEXT, TICK_LENGTH, WIDTH_FRAME};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS, Tick};

/// The room below a panel for numbers and a title.
pub(crate) const LOWER_ROOM: f64 = TICK_LENGTH + 7.0 + SIZE_TEXT as f64 + SIZE_TEXT as f64 + MARGIN;
/// Width of a colour bar.
pub(crate) const BAR_WIDTH: f64 = 30.0;
/// Largest number of steps of the numbers of a colour bar.
const BAR_STEPS: usize = 5;

fn widest(ticks: &[Tick]) -> f64 {
    ticks.iter().map(|(_, text)| text.width()).fold(0.0, f64::max)
}

/// The room left of a panel for a title and these numbers.
pub(crate) fn left_room(ticks: &[Tick]) -> f64 {
    (MARGIN + f64::from(SIZE_TEXT) + 14.0 + widest(ticks) + TICK_LENGTH + 7.0).round()
}

/// Right end of a panel from `left` to `right` in a picture of this width, moved left if needed so that no
/// number below the panel is cut off.
pub(crate) fn right_end(ticks: &[Tick], left: f64, right: f64, width: f64) -> f64 {
    const EDGE: f64 = 4.0;
    let end = |(x, text): &Tick| {
        let share = (x - left) / (right - left);
        let room = width - EDGE - 0.5 * text.width() - left;
        let is_cut = share * (right - left) > room;
        if is_cut { left + room / share } else { right }
    };
    ticks.iter().map(end).fold(right, f64::min).floor()
}

/// Largest length of a title that is centred on the left side of `area` and stays within a picture of this
/// height.
pub(crate) fn upright_room(area: Area, height: f64) -> f64 {
    let middle = area.centre().1;
    (2.0 * middle.min(height - middle) - MARGIN).max(area.height)
}

/// Draws the left side of `area`, with the title along `edge`, where the room left of the panel begins.
pub(crate) fn left_side(canvas: &mut Canvas, area: Area, edge: f64, ticks: &[Tick], title: &Text) {
    for (y, text) in ticks {
        canvas.tick_left((area.x, *y), text);
    }
    let baseline = edge + MARGIN + 0.8 * f64::from(SIZE_TEXT);
    canvas.text_upwards(title, (baseline, area.centre().1), Align::Middle, BLACK);
}

/// Draws the lower side of `area`.
pub(crate) fn lower_side(canvas: &mut Canvas, area: Area, ticks: &[Tick], title: &Text) {
    for (x, text) in ticks {
        canvas.tick_below((*x, area.bottom()), text);
    }
    lower_title(canvas, area, title);
}

/// Writes a title under the numbers below `area`.
pub(crate) fn lower_title(canvas: &mut Canvas, area: Area, title: &Text) {
    let baseline = area.bottom() + LOWER_ROOM - MARGIN - 4.0;
    canvas.text(title, (area.centre().0, baseline), Align::Middle, BLACK);
}

/// Draws ticks without numbers on the lower or the left side of `area`, half as long as the others.
pub(crate) fn short_ticks(canvas: &mut Canvas, area: Area, direction: Direction, ticks: &[f64]) {
    let length = 0.5 * TICK_LENGTH;
    for &at in ticks {
        let (from, to) = match direction {
            Direction::X => ((at, area.bottom()), (at, area.bottom() + length)),
            Direction::Y => ((area.x, at), (area.x - length, at)),
        };
        canvas.line(from, to, WIDTH_FRAME, BLACK);
    }
}

/// Draws the left and the lower side of `area` along the axes of x and y, with short ticks between the
/// numbers of a logarithmic axis.
pub(crate) fn numbered_sides(
    canvas: &mut Canvas,
    area: Area,
    [x, y]: [&DrawnAxis; 2],
    [x_title, y_title]: [&str; 2],
) {
    let title = Text::fitted(y_title, upright_room(area, canvas.height));
    left_side(canvas, area, 0.0, &y.ticks(Direction::Y, MAX_STEPS), &title);
    short_ticks(canvas, area, Direction::Y, &y.short_ticks());
    short_ticks(canvas, area, Direction::X, &x.short_ticks());
    let title = Text::fitted(x_title, area.width);
    lower_side(canvas, area, &x.ticks(Direction::X, MAX_STEPS), &title);
}

/// Ticks at round numbers next to a colour bar over this range.
fn bar_ticks([lo, hi]: [f64; 2], bottom: f64, top: f64) -> Vec<Tick> {
    DrawnAxis::linear(lo, hi)
        .placed(bottom, top)
        .ticks(Direction::Y, BAR_STEPS)
}

/// Width of a colour bar of this height with the numbers next to it.
pub(crate) fn bar_room(range: [f64; 2], height: f64) -> f64 {
    BAR_WIDTH + TICK_LENGTH + 7.0 + widest(&bar_ticks(range, height, 0.0))
}

/// Draws a bar of all colours, dark at the bottom.
pub(crate) fn colour_bar(canvas: &mut Canvas, area: Area, range: [f64; 2]) {
    let levels = (0..=254).rev().collect();
    canvas.images.push(Image {
        area,
        columns: 1,
        levels,
    });
    canvas.frame(area);
    for (y, text) in bar_ticks(range, area.bottom(), area.y) {
        canvas.tick_right((area.right(), y), &text);
    }
}
