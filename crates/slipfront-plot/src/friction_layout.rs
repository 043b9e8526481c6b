//! The two panels of a friction picture: friction above, N* below, on one axis of time or path.

use crate::axis::{DrawnAxis, range};
use crate::canvas::Canvas;
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_title, right_end};
use crate::friction_curve::{FrictionAxes, FrictionCurve};
use crate::geometry::{Area, CanvasPoint};
use crate::style::{BLACK, MARGIN, SIZE_NARROW, SIZE_TEXT, TICK_LENGTH, WIDTH_LEADER};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS, Tick};

const HEIGHT_FRICTION: f64 = 500.0;
const HEIGHT_SLIDING: f64 = 230.0;
const GAP: f64 = 34.0;

#[derive(Clone, Copy)]
pub(crate) struct Panels {
    pub(crate) x: DrawnAxis,
    pub(crate) mu: DrawnAxis,
    pub(crate) sliding: DrawnAxis,
}

impl Panels {
    /// Panels for all curves and their marks, at the top of a picture of this width. Their height, with the
    /// room below them, is the given height or the usual one.
    pub(crate) fn new(curves: &[FrictionCurve], width: f64, height: Option<f64>) -> Self {
        // The panels share the height in the usual proportion.
        let usual = HEIGHT_FRICTION + HEIGHT_SLIDING;
        let larger = height.map_or(1.0, |height| (height - MARGIN - GAP - LOWER_ROOM) / usual);
        let (from, to) = range(curves.iter().flat_map(|curve| curve.x.iter().copied()));
        let values = curves.iter().flat_map(|curve| {
            let marks = [
                curve.kinetic.map(|window| window.mean),
                curve.peak.map(|(_, mu)| mu),
            ];
            curve.friction.iter().copied().chain(marks.into_iter().flatten())
        });
        let (mut lo, hi) = range(values);
        // The axis starts at zero, unless that would flatten the curves.
        if lo > 0.0 && lo < 0.9 * hi {
            lo = 0.0;
        }
        let room = 0.1 * (hi - lo);
        let mu_bottom = MARGIN + larger * HEIGHT_FRICTION;
        let sliding_top = mu_bottom + GAP;
        let mu =
            DrawnAxis::linear(if lo == 0.0 { lo } else { lo - room }, hi + room).placed(mu_bottom, MARGIN);
        let sliding =
            DrawnAxis::linear(0.0, 100.0).placed(sliding_top + larger * HEIGHT_SLIDING, sliding_top);
        let left = left_room(&[mu_ticks(&mu), sliding_ticks(&sliding)].concat());
        // Half of the last number may extend beyond the end of the axis.
        let right = (width - 28.0).round();
        let x = DrawnAxis::linear(from, to).placed(left, right);
        let x = x.placed(left, right_end(&x_ticks(&x), left, right, width));
        Self { x, mu, sliding }
    }

    /// The panels moved down.
    pub(crate) fn lowered(self, by: f64) -> Self {
        let lowered = |axis: DrawnAxis| axis.placed(axis.start + by, axis.end + by);
        Self {
            mu: lowered(self.mu),
            sliding: lowered(self.sliding),
            ..self
        }
    }

    /// The panel of friction or of sliding.
    pub(crate) fn area(&self, axis: &DrawnAxis) -> Area {
        Area::between(self.x.start, self.x.end, axis.start, axis.end)
    }

    /// The pixel of a point that lies in the panel of friction.
    pub(crate) fn point(&self, (x, mu): CanvasPoint) -> Option<CanvasPoint> {
        let is_inside = self.x.contains(x) && self.mu.contains(mu);
        is_inside.then(|| (self.x.at(x), self.mu.at(mu)))
    }

    /// Lower end of the picture.
    pub(crate) fn bottom(&self) -> f64 {
        self.sliding.start + LOWER_ROOM
    }

    /// Draws ticks, numbers and titles.
    pub(crate) fn draw_axes(&self, canvas: &mut Canvas, axes: &FrictionAxes) {
        // The gap between the panels leaves room for the ends of both titles.
        let room = |axis: &DrawnAxis| self.area(axis).height + GAP;
        let words = axes.friction.split(" = ").next().unwrap_or_default();
        let title = fitted([&axes.friction, &axes.friction, words], room(&self.mu));
        left_side(canvas, self.area(&self.mu), 0.0, &mu_ticks(&self.mu), &title);
        let title = fitted(["sliding N* (%)", "N* (%)", "N* (%)"], room(&self.sliding));
        left_side(
            canvas,
            self.area(&self.sliding),
            0.0,
            &sliding_ticks(&self.sliding),
            &title,
        );
        let foot = self.mu.start;
        for (x, text) in x_ticks(&self.x) {
            canvas.tick_below((x, self.sliding.start), &text);
            canvas.line((x, foot), (x, foot + TICK_LENGTH), WIDTH_LEADER, BLACK);
        }
        let across = 2.0 * (canvas.width - self.area(&self.sliding).centre().0 - MARGIN);
        let title = fitted([&axes.x, &axes.x, &axes.x], across);
        lower_title(canvas, self.area(&self.sliding), &title);
    }

    /// Draws the panels' edges, over everything that ends on them.
    pub(crate) fn draw_frames(&self, canvas: &mut Canvas) {
        for axis in [&self.mu, &self.sliding] {
            canvas.frame(self.area(axis));
        }
    }
}

/// The first of these titles that is no longer than `room`: the first in the usual size, the second in the
/// smaller one, or else the third in the smaller one.
fn fitted(titles: [&str; 3], room: f64) -> Text {
    let [first, second, last] = titles;
    let sized = [(first, SIZE_TEXT), (second, SIZE_NARROW)];
    let mut texts = sized.iter().map(|(title, size)| Text::math(title, *size));
    texts
        .find(|text| text.width() <= room)
        .unwrap_or_else(|| Text::math(last, SIZE_NARROW))
}

fn x_ticks(x: &DrawnAxis) -> Vec<Tick> {
    x.ticks(Direction::X, MAX_STEPS)
}

fn mu_ticks(mu: &DrawnAxis) -> Vec<Tick> {
    mu.ticks(Direction::Y, MAX_STEPS)
}

fn sliding_ticks(sliding: &DrawnAxis) -> Vec<Tick> {
    sliding.ticks(Direction::Y, 2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::COLUMN_WIDTH;

    #[test]
    fn no_number_on_the_horizontal_axis_is_cut_off() {
        for end in [0.3, 100.0, 267.0, 2000.0, 4000.0, 30_000.0, 999_999.0, 1e9, 3e-7] {
            let curve = FrictionCurve {
                x: vec![0.0, end],
                friction: vec![0.0, 1.0],
                sliding_percent: vec![0.0, 100.0],
                ..FrictionCurve::default()
            };
            let panels = Panels::new(&[curve], COLUMN_WIDTH, None);
            for (x, text) in x_ticks(&panels.x) {
                assert!(x + 0.5 * text.width() <= COLUMN_WIDTH, "{end}");
            }
            assert!(panels.x.end > 0.8 * COLUMN_WIDTH, "{end}");
        }
    }
}
