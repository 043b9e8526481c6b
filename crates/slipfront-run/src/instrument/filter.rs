//! Linear elements of a measuring chain, exact for piecewise linear signals.

/// An element with memory that is advanced from value to value.
pub(super) trait Element {
    /// Sets the steady state of the element under a constant signal.
    fn settle(&mut self, signal: f64);

    /// Advances over `span` s, in which the signal changes linearly from one value to another, and returns
    /// the output at the end.
    fn advance(&mut self, span: f64, from: f64, to: f64) -> f64;
}

/// Passes a signal through an element that has settled at its first value.
pub(super) fn passed(element: &mut impl Element, time: &[f64], signal: &mut [f64]) {
    let Some(&first) = signal.first() else { return };
    element.settle(first);
    let mut from = first;
    for (k, span) in time.windows(2).map(|pair| pair[1] - pair[0]).enumerate() {
        let to = signal[k + 1];
        if span > 0.0 {
            signal[k + 1] = element.advance(span, from, to);
        }
        from = to;
    }
}

/// `constant x' + x = y`.
pub(super) struct FirstOrder {
    constant: f64,
    x: f64,
}

impl FirstOrder {
    pub(super) fn new(constant: f64) -> Self {
        Self { constant, x: 0.0 }
    }
}

impl Element for FirstOrder {
    fn settle(&mut self, signal: f64) {
        self.x = signal;
    }

    /// For the signal `y + r t`, the particular solution is `x = y + r (t - constant)`; the deviation from it
    /// decays exponentially.
    fn advance(&mut self, span: f64, from: f64, to: f64) -> f64 {
        let lag = self.constant * (to - from) / span;
        let decay = libm::exp(-span / self.constant);
        self.x = to - lag + decay * (self.x - from + lag);
        self.x
    }
}

/// `x''/omega^2 + 2 damping x'/omega + x = y`, with a damping ratio below 1.
pub(super) struct SecondOrder {
    omega: f64,
    damping: f64,
    x: f64,
    v: f64,
    /// A span, and the decay and rotation of the free oscillation over it.
    turn: (f64, [f64; 3]),
}

impl SecondOrder {
    /// An element of this undamped frequency in Hz.
    pub(super) fn new(frequency: f64, damping: f64) -> Self {
        Self {
            omega: std::f64::consts::TAU * frequency,
            damping,
            x: 0.0,
            v: 0.0,
            turn: (0.0, [1.0, 1.0, 0.0]),
        }
    }

    /// Frequency of the free, damped oscillation, rad/s.
    fn damped(&self) -> f64 {
        self.omega * ((1.0 - self.damping) * (1.0 + self.damping)).sqrt()
    }
}

impl Element for SecondOrder {
    fn settle(&mut self, signal: f64) {
        (self.x, self.v) = (signal, 0.0);
    }

    /// For the signal `y + r t`, the particular solution is `x = y + r (t - 2 damping/omega)`; the deviation
    /// from it is a free oscillation.
    fn advance(&mut self, span: f64, from: f64, to: f64) -> f64 {
        let rate = (to - from) / span;
        let lag = 2.0 * self.damping / self.omega * rate;
        let (fading, damped) = (self.damping * self.omega, self.damped());
        // Computed again only for another span: steps of a run are equal, and exponentials are expensive.
        if self.turn.0 != span {
            let angle = damped * span;
            self.turn = (
                span,
                [libm::exp(-fading * span), libm::cos(angle), libm::sin(angle)],
            );
        }
        let [decay, cos, sin] = self.turn.1;
        let (x, v) = (self.x - from + lag, self.v - rate);
        let free_x = decay * (x * cos + (v + fading * x) / damped * sin);
        let free_v = decay * (v * cos - (fading * v + self.omega * self.omega * x) / damped * sin);
        (self.x, self.v) = (to - lag + free_x, rate + free_v);
        self.x
    }
}

/// Means over the last `width` s of a piecewise linear signal, which is constant before its first value.
pub(super) fn average(time: &[f64], signal: &[f64], width: f64) -> Vec<f64> {
    let (Some(&start), Some(&first)) = (time.first(), signal.first()) else {
        return Vec::new();
    };
    let mut sums = vec![0.0];
    for k in 1..time.len() {
        let span = time[k] - time[k - 1];
        sums.push(sums[k - 1] + 0.5 * span * (signal[k] + signal[k - 1]));
    }
    let mut after = 0;
    let mut integral_to = |place: f64| {
        if place <= start {
            return first * (place - start);
        }
        while after + 1 < time.len() && time[after] < place {
            after += 1;
        }
        let (from, span) = (time[after - 1], time[after] - time[after - 1]);
        let share = (place - from) / span;
        let there = signal[after - 1] + share * (signal[after] - signal[after - 1]);
        sums[after - 1] + 0.5 * (place - from) * (signal[after - 1] + there)
    };
    let begins: Vec<f64> = time.iter().map(|&time| integral_to(time - width)).collect();
    sums.iter()
        .zip(begins)
        .map(|(end, begin)| (end - begin) / width)
        .collect()
}
