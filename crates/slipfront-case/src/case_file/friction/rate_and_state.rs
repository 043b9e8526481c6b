//! `law` = "rate_and_state": friction that depends on speed and on the state of the contact.

use slipfront::{Model, RateAndState};

use crate::case_file::synonyms::{Synonyms, synonyms};
use slipfront_base::number_format::four_digits;

/// Number of required keys of the law, which have no default and are first.
pub(super) const NEEDED: usize = 4;

pub(super) const SYNONYMS: Synonyms = synonyms! {
    "rate_and_state" "rsf" "dieterich" "ruina" "rate_state" "state" =>
        "rate and state is `friction.law` = \"rate_and_state\"";
    "d_c" "dc" => "the slip of rate and state is `friction.d_c_star`";
    "v_0" "v0" => "the reference speed of rate and state is `friction.v_0_star`";
    "mu0" => "the coefficient of rate and state at its reference speed is `friction.mu_0`";
};

/// Reason why other keys do not apply to this law.
pub(super) const ALONE: &str = "`law` = \"rate_and_state\" has no static and kinetic coefficients, and already depends on speed \
                                and age; leave it out, or use `law` = \"projection\"";

/// Reason why the keys of this law do not apply to another law.
pub(super) const ELSEWHERE: &str = "it belongs to `law` = \"rate_and_state\"; set that, or leave it out";

/// Error of a missing key that the law at this path needs.
pub(super) fn without_key(path: &str, key: &str) -> String {
    format!("`{path}` = \"rate_and_state\" needs `{key}`: it needs `a`, `b`, `d_c_star` and `v_0_star`")
}

/// The law of the model, with coefficients relative to `mu_static`, from the values of its keys and the speed
/// of the drive. The reader of a file ensures that the required keys are given.
pub(super) fn law(values: [Option<f64>; 7], mu_static: f64, v_star: f64) -> RateAndState {
    let [a, b, d_c, v_0, mu_0, theta_0, slip_speed] = values;
    let given = |key: Option<f64>| key.unwrap_or(f64::NAN);
    let (d_c, v_0) = (given(d_c), given(v_0));
    RateAndState {
        a: given(a) / mu_static,
        b: given(b) / mu_static,
        d_c,
        v_0,
        mu_0: mu_0.map_or(1.0, |mu_0| mu_0 / mu_static),
        theta_0: theta_0.unwrap_or(d_c / v_0),
        slip_speed: slip_speed.unwrap_or(0.1 * v_star),
    }
}

/// The law in words.
pub(super) fn in_words(law: &RateAndState, mu_static: f64) -> String {
    let of_mean = |coefficient: f64| four_digits(coefficient * mu_static);
    format!(
        "rate and state: a = {}, b = {}, D_c* = {}, V_0* = {}, mu_0 = {}, state {} at the start",
        of_mean(law.a),
        of_mean(law.b),
        four_digits(law.d_c),
        four_digits(law.v_0),
        of_mean(law.mu_0),
        four_digits(law.theta_0)
    )
}

/// A warning if steady sliding of the whole slider, which has the least stiffness, is unstable.
pub(super) fn warning(law: &RateAndState, model: &Model) -> Option<String> {
    let (k_drive, v_star) = (model.drive.k_drive, model.drive.v_star);
    let critical = law.critical_stiffness(model.surface.mean_normal_force(), model.damping, v_star);
    (k_drive < critical).then(|| {
        format!(
            "the drive stiffness is {} E h per block, below the critical stiffness {} for steady sliding at V* = {}: expect \
             stick-slip",
            four_digits(k_drive),
            four_digits(critical),
            four_digits(v_star)
        )
    })
}
