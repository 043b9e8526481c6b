//! The rate at which a disturbance grows.

use slipfront::{Simulation, Snapshot};

/// Growth rate of an oscillation `x(t) = A exp(s t) cos(w t + p)`, from four of its values from the time `from` on, `apart` from each
/// other, about a quarter of a period: of three of them in a row `x_2 = p x_1 - q x_0`, with `q = exp(2 s apart)`.
pub(crate) fn growth_rate(
    simulation: &mut Simulation,
    dt: f64,
    [from, apart]: [f64; 2],
    value: impl Fn(&Snapshot) -> f64,
) -> f64 {
    let [from, apart] = [from, apart].map(|time| (time / dt).round() as u64);
    let mut values = Vec::new();
    for step in 0..=from + 3 * apart {
        if step >= from && (step - from).is_multiple_of(apart) {
            values.push(value(&simulation.snapshot()));
        }
        simulation.step();
    }
    let [x0, x1, x2, x3] = [values[0], values[1], values[2], values[3]];
    let q = (x2 * x2 - x1 * x3) / (x1 * x1 - x0 * x2);
    q.ln() / (2.0 * apart as f64 * dt)
}
