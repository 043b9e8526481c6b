//! The two panels of a friction picture: mu* above, N* below, on one time axis.

use super::axis::{Axis, range, widened};
use super::canvas::{Align, Area, Canvas};
use super::friction::FrictionCurve;
use super::style::{BLACK, COLUMN_WIDTH, MARGIN, SIZE_LABEL, SIZE_TICK, TICK_LENGTH, WIDTH_LEADER};
use super::text::Text;

const HEIGHT_FRICTION: f64 = 500.0;
const HEIGHT_SLIDING: f64 = 230.0;
const GAP: f64 = 34.0;

/// The two panels.
pub(super) struct Panels {
    pub(super) time: Axis,
    pub(super) mu: Axis,
    pub(super) sliding: Axis,
}

impl Panels {
    /// Panels that hold all curves and their marks, at the top of the picture.
    pub(super) fn of(curves: &[FrictionCurve]) -> Self {
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
        let numbers = [mu.ticks(6), sliding.ticks(2)].concat();
        let widest = numbers
            .iter()
            .map(|(_, text)| Text::plain(text, SIZE_TICK).width())
            .fold(0.0, f64::max);
        let left = (MARGIN + f64::from(SIZE_LABEL) + 14.0 + widest + TICK_LENGTH + 7.0).round();
        // The last number on the time axis may stand half beyond its end.
        let right = COLUMN_WIDTH.round() - 28.0;
        Self {
            time: Axis {
                lo: from,
                hi: to,
                start: left,
                end: right,
            },
            mu,
            sliding,
        }
    }

    /// The same panels, further down.
    pub(super) fn lowered(mut self, by: f64) -> Self {
        for axis in [&mut self.mu, &mut self.sliding] {
            axis.start += by;
            axis.end += by;
        }
        self
    }

    /// The panel of friction.
    pub(super) fn friction(&self) -> Area {
        between(self.time.start, self.time.end, self.mu.start, self.mu.end)
    }

    /// Where the picture ends.
    pub(super) fn bottom(&self) -> f64 {
        self.sliding.start + TICK_LENGTH + 7.0 + f64::from(SIZE_TICK + SIZE_LABEL) + MARGIN
    }

    /// Ticks, numbers and titles.
    pub(super) fn draw_axes(&self, canvas: &mut Canvas) {
        let baseline = MARGIN + 0.8 * f64::from(SIZE_LABEL);
        let titles = [
            (
                &self.mu,
                6,
                "friction \u{3bc}* = \u{3bc}/\u{27e8}\u{3bc}_s\u{27e9}",
            ),
            (&self.sliding, 2, "sliding N* (%)"),
        ];
        for (axis, most, title) in titles {
            for (value, text) in axis.ticks(most) {
                canvas.tick_left((self.time.start, axis.at(value)), &Text::plain(&text, SIZE_TICK));
            }
            let middle = 0.5 * (axis.start + axis.end);
            canvas.text_upwards(&Text::math(title, SIZE_LABEL), (baseline, middle), BLACK);
        }
        for (value, text) in self.time.ticks(6) {
            let x = self.time.at(value);
            canvas.tick_below((x, self.sliding.start), &Text::plain(&text, SIZE_TICK));
            canvas.line(
                (x, self.mu.start),
                (x, self.mu.start + TICK_LENGTH),
                WIDTH_LEADER,
                BLACK,
            );
        }
        let middle = 0.5 * (self.time.start + self.time.end);
        let title = Text::plain("dimensionless time t*", SIZE_LABEL);
        canvas.text(
            &title,
            (middle, self.bottom() - MARGIN - 4.0),
            Align::Middle,
            BLACK,
        );
    }

    /// The panels' edges, over everything that ends on them.
    pub(super) fn draw_frames(&self, canvas: &mut Canvas) {
        for axis in [&self.mu, &self.sliding] {
            canvas.frame(between(self.time.start, self.time.end, axis.start, axis.end));
        }
    }
}

/// The area between two values of x and two of y.
pub(super) fn between(from: f64, to: f64, start: f64, end: f64) -> Area {
    Area {
        x: from,
        y: start.min(end),
        width: to - from,
        height: (end - start).abs(),
    }
}
