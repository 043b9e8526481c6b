//! Error of stick-slip periods under rate and state due to the time step, estimated before the run.

use std::f64::consts::PI;

use slipfront::{Friction, RateAndState};

use super::runnable::Case;
use slipfront_base::number_format::four_digits;

/// Relative error of a period for which the note suggests a time step.
const GOOD: f64 = 1e-3;
/// Largest ratio of the measured to the expected error (`docs/model.md`), rounded up.
const SAFETY: f64 = 3.0;
/// Iterations after which the expected cycle has converged to far more digits than its accuracy.
const ROUNDS: usize = 100;

/// Expected stick-slip cycle of a block on a spring.
#[derive(Clone, Copy, Debug, PartialEq)]
struct StickSlip {
    /// Period, t*.
    period: f64,
    /// Smallest force of the spring, in units of `P mu_s l^2`.
    least: f64,
}

impl Case {
    /// A sentence on a time step that is too long for stick-slip under rate and state. It gives the error of
    /// periods, which is about
    ///
    /// ```text
    /// dt (1.5 + a F_n sqrt(k)/(k V))/period
    /// ```
    ///
    /// and the step that reduces the error to 0.1 %. There is none where the drive is stiffer than
    /// [critical](RateAndState::critical_stiffness), where blocks do not move as one, or where
    /// slips are so large that the spring pushes back, because such slips differ from each other at any step.
    pub fn coarse_for_stick_slip(&self) -> Option<String> {
        let model = &self.model;
        let Friction::RateAndState(law) = &model.friction else {
            return None;
        };
        let (k, v) = (model.drive.k_drive, model.drive.v_star);
        let load = model.surface.mean_normal_force();
        let moves_as_one = (model.driven_share() - 1.0).abs() < 1e-9 && model.body().is_none();
        if !moves_as_one || k >= law.critical_stiffness(load, model.damping, v) {
            return None;
        }
        let cycle = StickSlip::expected(law, load, [k, v, model.damping]);
        let dt_star = self.time_plan.dt_star;
        let error = dt_star * (1.5 + law.a * load / (k.sqrt() * v)) / cycle.period;
        // No note for NaN.
        if !(error.is_finite() && SAFETY * error > GOOD && cycle.least > 0.0) {
            return None;
        }
        Some(format!(
            "periods of stick-slip are too long by about {} % for dt* = {}, because the scheme for rate and state is \
             first-order accurate; `time.step = {}` reduces the error to {} %",
            two_digits(100.0 * error),
            four_digits(dt_star),
            two_digits(dt_star * GOOD / (SAFETY * error)),
            100.0 * GOOD
        ))
    }
}

impl StickSlip {
    /// The cycle of a block of unit mass under the normal force `load`, on a spring of stiffness `k` that is
    /// pulled at `v`. Its state grows during the period. The block slips at the speed `v_m`, at which the
    /// spring, the law and inertia are in balance, and overshoots this balance by an amount that depends on
    /// the damping:
    ///
    /// ```text
    /// peak = mu_ss(v) + b ln(1 + v period/D_c)                      in units of the load
    /// drop = peak - mu_ss(v_m) = v_m (sqrt(k) + Omega)/load
    /// period = drop (1 + overshoot)/(k v) + pi/sqrt(k)
    /// ```
    fn expected(law: &RateAndState, load: f64, [k, v, damping]: [f64; 3]) -> Self {
        let frequency = k.sqrt();
        let damping_ratio = damping / (2.0 * frequency);
        let overshoot = if damping_ratio < 1.0 {
            libm::exp(-PI * damping_ratio / (1.0 - damping_ratio * damping_ratio).sqrt())
        } else {
            0.0
        };
        let (mut fall, mut slip_speed) = (load * law.b, v.max(1.0));
        let (mut rise, mut period) = (0.0, 0.0);
        for _ in 0..ROUNDS {
            period = fall / (k * v) + PI / frequency;
            rise = load * law.b * libm::log(1.0 + v * period / law.d_c);
            let drop = rise + load * (law.b - law.a) * libm::log(slip_speed / v);
            slip_speed = (drop / (frequency + damping)).max(v);
            fall = 0.5 * (fall + drop * (1.0 + overshoot));
        }
        let peak = load * law.steady_coefficient(v) + rise;
        Self {
            period,
            least: peak - fall,
        }
    }
}

/// A number rounded down to two digits.
fn two_digits(number: f64) -> String {
    let unit = libm::pow(10.0, libm::floor(libm::log10(number)) - 1.0);
    four_digits(libm::floor(number / unit) * unit)
}
