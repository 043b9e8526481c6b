//! The two panels of a friction picture: mu* above, N* below, on one time axis.

use crate::axis::{Axis, range, widened};
use crate::canvas::{Area, Canvas};
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_title, placed, right_end};
use crate::friction::FrictionCurve;
use crate::style::{BLACK, COLUMN_WIDTH, MARGIN, SIZE_LABEL, TICK_LENGTH, WIDTH_LEADER};
use crate::text::Text;

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
        let mu = Axis {
            lo: if lo == 0.0 { lo } else { lo - room },
            hi: hi + room,
            start: mu_bottom,
            end: mu_top,
        };
        let sliding = Axis {
            lo: 0.0,
            hi: 100.0,
            start: sliding_top + HEIGHT_SLIDING,
            end: sliding_top,
        };
        let left = left_room(&[placed(&mu, 6), placed(&sliding, 2)].concat());
        // The last number on the time axis may stand half beyond its end.
        let mut time = Axis {
            lo: from,
            hi: to,
            start: left,
            end: COLUMN_WIDTH.round() - 28.0,
        };
        time.end = right_end(&placed(&time, 6), left, time.end, COLUMN_WIDTH);
        Self { time, mu, sliding }
    }

    /// The same panels, further down.
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
        let titles = [
            (
                &self.mu,
                6,
                "friction \u{3bc}* = \u{3bc}/\u{27e8}\u{3bc}_s\u{27e9}",
            ),
            (&self.sliding, 2, "sliding N* (%)"),
        ];
        for (axis, most, title) in titles {
            let title = Text::math(title, SIZE_LABEL);
            left_side(canvas, self.of_axis(axis), 0.0, &placed(axis, most), &title);
        }
        for (x, text) in placed(&self.time, 6) {
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
            for (x, text) in placed(&panels.time, 6) {
                assert!(x + 0.5 * text.width() <= COLUMN_WIDTH, "t* = {end}");
            }
            assert!(panels.time.end > 0.8 * COLUMN_WIDTH, "t* = {end}");
        }
    }
}
