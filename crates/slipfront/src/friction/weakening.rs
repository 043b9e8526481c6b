//! Kinetic friction that falls with speed.

/// Velocity weakening: `mu_k(v) = mu_k [ratio + (1 - ratio)/(1 + |v|/v_c)]`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weakening {
    /// Speed `v_c` at which half of the fall is reached, in units of `P mu_s/sqrt(E rho)`.
    pub critical_speed: f64,
    /// Kinetic friction at high speed over that at rest.
    pub ratio: f64,
}
