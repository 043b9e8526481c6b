//! Rate and state with the ageing law, regularised at v = 0.

use slipfront::RateAndState;

use super::step::{Motion, Update};
use super::vector::{Vector, length, times, unit};

/// Function `asinh(e^y)`, also where the exponential would overflow.
fn asinh_of_exp(y: f64) -> f64 {
    if y > 100.0 {
        y + std::f64::consts::LN_2
    } else {
        y.exp().asinh()
    }
}

/// Coefficient `mu = a asinh(v/(2 V_0) exp((mu_0 + b ln(V_0 theta/D_c))/a))`.
pub(crate) fn coefficient(law: &RateAndState, speed: f64, theta: f64) -> f64 {
    let state = (law.mu_0 + law.b * (law.v_0 * theta / law.d_c).ln()) / law.a;
    law.a * asinh_of_exp((speed / (2.0 * law.v_0)).ln() + state)
}

/// The update, from the velocity without friction. Its speed solves `v + dt F_n mu(v, theta)/(m c_+) =
/// |v_free|`, by bisection, since the left side rises with v from 0.
pub(crate) fn update(
    law: &RateAndState,
    motion: &Motion,
    force: Vector,
    normal_force: f64,
    theta: f64,
) -> Update {
    let free = motion.accelerated(force);
    let friction = |speed: f64| normal_force * coefficient(law, speed, theta);
    let (mut low, mut high) = (0.0, length(free));
    if normal_force > 0.0 {
        loop {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if middle + motion.change_of_velocity(friction(middle)) < length(free) {
                low = middle;
            } else {
                high = middle;
            }
        }
    }
    let bears = if normal_force > 0.0 { friction(high) } else { 0.0 };
    Update {
        velocity: times(high, unit(free)),
        friction: times(-bears, unit(free)),
    }
}

/// State after a step at constant speed, the solution of `dtheta/dt = 1 - v theta/D_c`.
pub(crate) fn evolved(law: &RateAndState, theta: f64, speed: f64, dt: f64) -> f64 {
    let x = speed * dt / law.d_c;
    // (1 - e^-x)/x, which is 1 at rest.
    let mean_decay = if x > 0.0 { -(-x).exp_m1() / x } else { 1.0 };
    theta * (-x).exp() + dt * mean_decay
}
