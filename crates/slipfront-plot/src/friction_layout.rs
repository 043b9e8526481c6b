//! The two panels of a friction picture: mu* above, N* below, on one time axis.

use crate::axis::Axis;
use crate::canvas::Canvas;
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_title, right_end};
use crate::friction_curve::FrictionCurve;
use crate::geometry::Area;
use crate::range::{range, widened};
use crate::style::{BLACK, COLUMN_WIDTH, MARGIN, SIZE_LABEL, TICK_LENGTH, WIDTH_LEADER};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS, Tick};

const HEIGHT_FRICTION: f64 = 500.0;
const HEIGHT_SLIDING: f64 = 230.0;
const GAP: f64 = 34.0;

/// The two panels.
pub(crate) struct Panels {
    pub(crate) time: Axis,
    pub(crate) mu: Axis,
    pub(crate) sliding: Axis,
}

impl Panels {
    /// Panels that hold all curves and their marks, at the top of the picture.
    pub(crate) fn of(curves: &[FrictionCurve]) -> Self {
        let (from, to) = widened(range(
            curves.iter().flat_map(|curve| curve.time_star.iter().copied()),
        ));
        let marks = |curve: &FrictionCurve| {
            let mean = curve.kinetic.map(|window| window.mean);
            mean.into_iter()
                .chain(curve.peak.map(|(_, value)| value))
                .collect::<Vec<_>>()
        };
        let values = curves
            .iter()
            .flat_map(|curve| curve.mu_star.iter().copied().chain(marks(curve)));
        let (mut lo, hi) = widened(range(values));
        // Friction is read against zero, unless that would flatten it.
        if lo > 0.0 && lo < 0.9 * hi {
            lo = 0.0;
        }
        let room = 0.1 * (hi - lo);
        let mu_top = MARGIN;
        let mu_bottom = mu_top + HEIGHT_FRICTION;
        let sliding_top = mu_bottom + GAP;
        let mu = Axis::linear(if lo == 0.0 { lo } else { lo - room }, hi + room).placed(mu_bottom, mu_top);
        let sliding = Axis::linear(0.0, 100.0).placed(sliding_top + HEIGHT_SLIDING, sliding_top);
        let left = left_room(&[mu_ticks(&mu), sliding_ticks(&sliding)].concat());
        // The last number on the time axis may stand half beyond its end.
        let right = COLUMN_WIDTH.round() - 28.0;
        let time = Axis::linear(from, to).placed(left, right);
        let time = time.placed(left, right_end(&time_ticks(&time), left, right, COLUMN_WIDTH));
        Self { time, mu, sliding }
    }

    /// These panels, further down.
    pub(crate) fn lowered(mut self, by: f64) -> Self {
        for axis in [&mut self.mu, &mut self.sliding] {
            axis.start += by;
            axis.end += by;
        }
        self
    }

    /// The panel of friction.
    pub(crate) fn friction(&self) -> Area {
        self.of_axis(&self.mu)
    }

    fn of_axis(&self, axis: &Axis) -> Area {
        between(self.time.start, self.time.end, axis.start, axis.end)
    }

    /// Where the picture ends.
    pub(crate) fn bottom(&self) -> f64 {
        self.sliding.start + LOWER_ROOM
    }

    /// Ticks, numbers and titles.
    pub(crate) fn draw_axes(&self, canvas: &mut Canvas) {
        let sides = [
            (
                &self.mu,
                mu_ticks(&self.mu),
                "friction \u{3bc}* = \u{3bc}/\u{27e8}\u{3bc}_s\u{27e9}",
            ),
            (&self.sliding, sliding_ticks(&self.sliding), "sliding N* (%)"),
        ];
        for (axis, ticks, title) in sides {
            let title = Text::math(title, SIZE_LABEL);
            left_side(canvas, self.of_axis(axis), 0.0, &ticks, &title);
        }
        for (x, text) in time_ticks(&self.time) {
            canvas.tick_below((x, self.sliding.start), &text);
            let foot = self.mu.start;
            canvas.line((x, foot), (x, foot + TICK_LENGTH), WIDTH_LEADER, BLACK);
        }
        let title = Text::plain("dimensionless time t*", SIZE_LABEL);
        lower_title(canvas, self.of_axis(&self.sliding), &title);
    }

    /// The panels' edges, over everything that ends on them.
    pub(crate) fn draw_frames(&self, canvas: &mut Canvas) {
        for axis in [&self.mu, &self.sliding] {
            canvas.frame(self.of_axis(axis));
        }
    }
}

fn time_ticks(time: &Axis) -> Vec<Tick> {
    time.ticks(Direction::X, MAX_STEPS)
}

fn mu_ticks(mu: &Axis) -> Vec<Tick> {
    mu.ticks(Direction::Y, MAX_STEPS)
}

fn sliding_ticks(sliding: &Axis) -> Vec<Tick> {
    sliding.ticks(Direction::Y, 2)
}

/// The area between two values of x and two of y.
pub(crate) fn between(from: f64, to: f64, start: f64, end: f64) -> Area {
    Area {
        x: from,
        y: start.min(end),
        width: to - from,
        height: (end - start).abs(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_number_on_the_time_axis_is_cut_off() {
        for end in [0.3, 100.0, 267.0, 2000.0, 4000.0, 30_000.0, 999_999.0, 1e9, 3e-7] {
            let curve = FrictionCurve {
                time_star: vec![0.0, end],
                mu_star: vec![0.0, 1.0],
                sliding_percent: vec![0.0, 100.0],
                ..FrictionCurve::default()
            };
            let panels = Panels::of(&[curve]);
            for (x, text) in time_ticks(&panels.time) {
                assert!(x + 0.5 * text.width() <= COLUMN_WIDTH, "t* = {end}");
            }
            assert!(panels.time.end > 0.8 * COLUMN_WIDTH, "t* = {end}");
        }
    }
}
