//! A measuring chain: the record that it makes of friction.

use super::filter::{FirstOrder, SecondOrder, average, passed};
use crate::interpolation::interpolate;

/// The measuring chain, in SI units. The signal passes through the elements in the order of the fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Instrument {
    /// The load cell, a mass on its spring: its undamped frequency, Hz, and its damping ratio.
    pub(super) cell: Option<[f64; 2]>,
    pub(super) filter: Option<Filter>,
    /// Rate at which values are taken and held, Hz.
    pub(super) sampling: Option<f64>,
    pub(super) gain: f64,
    pub(super) offset: f64,
    /// Least and largest value of the record.
    pub(super) range: Option<[f64; 2]>,
}

/// A filter of the signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Filter {
    /// Time constant, s.
    FirstOrder(f64),
    /// Order, and the frequency at which 1/sqrt(2) of an amplitude is left, Hz.
    Butterworth(u32, f64),
    /// Width of the window that ends at the present time, s.
    MovingMean(f64),
}

impl Instrument {
    /// The values that the instrument writes at the times of a signal, which increase. Before the first time,
    /// the signal is constant.
    ///
    /// Load cell and filters are exact for a piecewise linear signal:
    ///
    /// ```text
    /// load cell     x''/omega^2 + 2 zeta x'/omega + x = y,   omega^2 = stiffness/mass
    /// first order   time x' + x = y
    /// Butterworth   |X/Y|^2 = 1/(1 + (f/cutoff)^(2 order))
    /// moving mean   x(t) = integral of y from t - time to t, over time
    /// ```
    ///
    /// Then `gain x + offset` is clipped to the range.
    pub fn record(&self, time: &[f64], signal: &[f64]) -> Vec<f64> {
        let mut signal = signal.to_vec();
        if let Some([frequency, damping]) = self.cell {
            passed(&mut SecondOrder::new(frequency, damping), time, &mut signal);
        }
        match self.filter {
            Some(Filter::FirstOrder(constant)) => passed(&mut FirstOrder::new(constant), time, &mut signal),
            Some(Filter::Butterworth(order, cutoff)) => butterworth(order, cutoff, time, &mut signal),
            Some(Filter::MovingMean(width)) => signal = average(time, &signal, width),
            None => {}
        }
        if let Some(rate) = self.sampling {
            signal = held(time, &signal, rate);
        }
        let [low, high] = self.range.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
        let written = signal
            .iter()
            .map(|y| (self.gain * y + self.offset).clamp(low, high));
        written.collect()
    }

    /// Least and largest value that the instrument writes.
    pub fn range(&self) -> Option<[f64; 2]> {
        self.range
    }

    /// Whether a value depends on the signal at earlier times.
    pub fn has_memory(&self) -> bool {
        self.cell.is_some() || self.filter.is_some() || self.sampling.is_some()
    }

    /// Bandwidth, Hz: the smallest of the cutoff of the filter, the frequency of the load cell and half of
    /// the sampling rate; none without any of them.
    pub fn bandwidth(&self) -> Option<f64> {
        // A mean over a width passes sin(pi f width)/(pi f width).
        let of_filter = self.filter.map(|filter| match filter {
            Filter::FirstOrder(constant) => 1.0 / (std::f64::consts::TAU * constant),
            Filter::Butterworth(_, cutoff) => cutoff,
            Filter::MovingMean(width) => MOVING_MEAN_CUTOFF / width,
        });
        let of_cell = self.cell.map(|[frequency, _]| frequency);
        let of_sampling = self.sampling.map(|rate| 0.5 * rate);
        [of_filter, of_cell, of_sampling]
            .into_iter()
            .flatten()
            .min_by(f64::total_cmp)
    }
}

/// Frequency times width at which a moving mean reduces an amplitude to 1/sqrt(2): the first root of sin(pi
/// f)/(pi f) = 1/sqrt(2).
pub(super) const MOVING_MEAN_CUTOFF: f64 = 0.442_946_470_689_452_34;

/// Passes a signal through a Butterworth filter. Its poles lie on a circle: a pair of them is a section of
/// second order with the damping ratio sin(pi (2 k + 1)/(2 order)), the one on the axis a section of first
/// order.
fn butterworth(order: u32, cutoff: f64, time: &[f64], signal: &mut [f64]) {
    for pair in 0..order / 2 {
        let angle = std::f64::consts::PI * f64::from(2 * pair + 1) / f64::from(2 * order);
        passed(&mut SecondOrder::new(cutoff, libm::sin(angle)), time, signal);
    }
    if order % 2 == 1 {
        passed(
            &mut FirstOrder::new(1.0 / (std::f64::consts::TAU * cutoff)),
            time,
            signal,
        );
    }
}

/// Values that are sampled at multiples of 1/rate and held until the next one.
fn held(time: &[f64], signal: &[f64], rate: f64) -> Vec<f64> {
    // A time that rounding has put just below a multiple belongs to it.
    let tick = |time: f64| (time * rate + 1e-9).floor() / rate;
    time.iter()
        .map(|&at| interpolate(time, signal, tick(at)))
        .collect()
}
