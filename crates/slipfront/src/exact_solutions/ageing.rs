//! Static friction that grows while blocks rest.

use crate::friction::Ageing;

/// When a block breaks that has been stuck since t = 0 and is pulled by a spring of stiffness `k` whose end rests until `hold` and then
/// moves at `v`; its static friction of age 0 is 1, so that
///
/// ```text
/// k v (t - hold) = 1 + beta ln(1 + t/tau)
/// ```
///
/// ```
/// # use slipfront::{Ageing, exact_solutions::ageing_slip_time};
/// // Without ageing as always.
/// let none = Ageing { beta: 0.0, time: 1.0 };
/// assert_eq!(ageing_slip_time(&none, 0.0, 40.0, 0.5, 0.1), 60.0);
/// // The pull of the spring may begin at another value than 0, and the age at another time.
/// assert_eq!(ageing_slip_time(&none, 0.5, 40.0, 0.5, 0.1), 50.0);
/// ```
///
/// `pull`: that of the spring while its end rests.
pub fn ageing_slip_time(law: &Ageing, pull: f64, hold: f64, k: f64, v: f64) -> f64 {
    slip_time(law, 0.0, pull, hold, k, v)
}

fn slip_time(law: &Ageing, stopped_at: f64, pull: f64, hold: f64, k: f64, v: f64) -> f64 {
    let aged = |t: f64| 1.0 + law.beta * ((t - stopped_at) / law.time).ln_1p();
    let excess = |t: f64| pull + k * v * (t - hold) - aged(t);
    // The pull rises linearly, what it must reach more slowly from some time on: a bracket, then bisection to the last bit.
    let (mut low, mut high) = (hold, hold + 1.0);
    while excess(high) < 0.0 {
        (low, high) = (high, hold + 2.0 * (high - hold));
    }
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if excess(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// A block that slides steadily at `v` while its drive stops: with `w^2 = k - Omega^2/4` it comes to rest after
///
/// ```text
/// t_stop = (pi - atan(2 w/Omega))/w,   where its spring pulls with   F_stop = mu_k F_n - sqrt(k) v exp(-Omega t_stop/2)
/// ```
///
/// as the solution of `v'' + Omega v' + k v = 0`, `v(0) = v`, `v'(0) = 0`. It holds for `Omega^2 < 4 k`; a block with more damping
/// creeps and never stops.
///
/// ```
/// # use slipfront::exact_solutions::StopOfSteadySliding;
/// // Without damping a quarter of a period.
/// let stop = StopOfSteadySliding::new(0.5, 0.1, 0.25, 0.0);
/// assert_eq!((stop.time, stop.pull), (std::f64::consts::PI, 0.45));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopOfSteadySliding {
    /// `t_stop`, counted from when the drive stops.
    pub time: f64,
    /// `F_stop`.
    pub pull: f64,
}

impl StopOfSteadySliding {
    /// `kinetic`: `mu_k F_n`; `k`: stiffness of the drive spring; the mass is 1.
    pub fn new(kinetic: f64, v: f64, k: f64, damping: f64) -> Self {
        let w = (k - 0.25 * damping * damping).sqrt();
        let time = (std::f64::consts::PI - (2.0 * w).atan2(damping)) / w;
        Self {
            time,
            pull: kinetic - k.sqrt() * v * (-0.5 * damping * time).exp(),
        }
    }

    /// When the block breaks again if the drive, stopped at `stopped`, moves on at `v` from `restarted` on: its age counts from the
    /// stop of the block.
    pub fn next_slip_time(&self, law: &Ageing, stopped: f64, restarted: f64, k: f64, v: f64) -> f64 {
        slip_time(law, stopped + self.time, self.pull, restarted, k, v)
    }
}
