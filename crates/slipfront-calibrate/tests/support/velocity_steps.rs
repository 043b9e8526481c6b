//! Rate-and-state friction of a block that is driven with velocity steps: the equations without inertia, in
//! units of the normal force, integrated independently of the library; and the case of the library.

use std::path::Path;

use slipfront_study::{Base, StudyError, StudyFile};

/// Coefficient of steady sliding at [`V_0`]; slipfront scales forces by this coefficient.
pub(crate) const MU_0: f64 = 0.6;
pub(crate) const V_0: f64 = 0.005;
/// Stiffness of the drive spring: stiff enough for stable sliding anywhere in the ranges, (b - a)/(mu_0 D_c)
/// < 0.14.
pub(crate) const STIFFNESS: f64 = 1.0;
/// Speeds of the drive, each until a time t* at which the record has a value and a step of the run ends. They
/// are so low that the effect of inertia, of the order of V sqrt(k), is negligible compared with the noise.
pub(crate) const SPEEDS: [(f64, f64); 5] = [
    (0.005, 600.0),
    (0.0015, 1400.0),
    (0.005, 1800.0),
    (0.0015, 2600.0),
    (0.005, 2800.0),
];
/// Time t* from one value of a record to the next.
pub(crate) const SPACING: f64 = 8.0;
/// Keys of a, b and D_c, and their ranges.
pub(crate) const KEYS: [&str; 3] = ["friction.a", "friction.b", "friction.d_c_star"];
pub(crate) const RANGES: [[f64; 2]; 3] = [[0.005, 0.03], [0.005, 0.03], [0.3, 3.0]];

/// Friction of a block at these shares of the ranges, by the ageing law or the slip law, integrated by the
/// Runge-Kutta method in `steps` steps from one value of a record to the next:
///
/// ```text
/// dF/dt = k (V(t) - v),   v = V_0 exp((F - mu_0 - b ln(V_0 theta/D_c))/a)
/// ageing dtheta/dt = 1 - v theta/D_c,   slip dtheta/dt = -v theta/D_c ln(v theta/D_c)
/// ```
///
/// The fastest rate is k V/(a/mu_0) = 0.6 per t*: with a step of 1, the error is 0.6^5/120 = 6e-4 of the
/// change.
pub(crate) fn friction(shares: &[f64], steps: usize, is_slip_law: bool) -> Vec<f64> {
    let value = |j: usize| RANGES[j][0] + shares[j] * (RANGES[j][1] - RANGES[j][0]);
    let (a, b, d_c) = (value(0) / MU_0, value(1) / MU_0, value(2));
    let dt = SPACING / steps as f64;
    let rates = |[force, state]: [f64; 2], drive: f64| {
        let v = V_0 * ((force - 1.0 - b * (V_0 * state / d_c).ln()) / a).exp();
        let ratio = v * state / d_c;
        let evolution = if is_slip_law {
            -ratio * ratio.ln()
        } else {
            1.0 - ratio
        };
        [STIFFNESS * (drive - v), evolution]
    };
    let moved = |from: [f64; 2], rate: [f64; 2], dt: f64| [from[0] + dt * rate[0], from[1] + dt * rate[1]];
    let mut now = [0.0, d_c / V_0];
    let mut values = vec![0.0];
    for (drive, until) in SPEEDS {
        while values.len() as f64 * dt < until + 0.5 * dt {
            let k1 = rates(now, drive);
            let k2 = rates(moved(now, k1, 0.5 * dt), drive);
            let k3 = rates(moved(now, k2, 0.5 * dt), drive);
            let k4 = rates(moved(now, k3, dt), drive);
            let mean = |i: usize| (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]) / 6.0;
            now = moved(now, [mean(0), mean(1)], dt);
            values.push(MU_0 * now[0]);
        }
    }
    values
}

/// The case of the block, with its velocity steps.
pub(crate) fn base() -> Result<Base, StudyError> {
    let mut program: Vec<String> = SPEEDS
        .iter()
        .map(|(v, until)| format!("{{ v_star = {v}, until_star = {until} }}"))
        .collect();
    program.push(format!("{{ v_star = {} }}", SPEEDS[4].0));
    let text = format!(
        "[base]\nslider = {{ blocks = [1, 1], omega_star = 0 }}\n\
         drive = {{ program = [{}], total_stiffness_star = {STIFFNESS} }}\n\
         friction = {{ law = 'rate_and_state', mu_static = {MU_0}, a = 0.01, b = 0.01, d_c_star = 1, v_0_star = {V_0} }}\n\
         time = {{ step = 0.4, duration_star = 2900 }}",
        program.join(", ")
    );
    Ok(StudyFile::parse(&text, "base", "base", Path::new(""))?.base)
}
