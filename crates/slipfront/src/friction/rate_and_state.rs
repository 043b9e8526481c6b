//! Friction that follows speed and the state of the contact.

/// Rate and state with the ageing law: `mu = mu_0 + a ln(V/V_0) + b ln(V_0 theta/D_c)`, `dtheta/dt = 1 - V theta/D_c`; coefficients
/// over `mu_s`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateAndState {
    /// Direct effect.
    pub a: f64,
    /// Evolution effect.
    pub b: f64,
    /// Slip over which the state follows a change of speed, in units of `P mu_s l/E`.
    pub d_c: f64,
    /// Reference speed, in units of `P mu_s/sqrt(E rho)`.
    pub v_0: f64,
    /// Coefficient of steady sliding at the reference speed.
    pub mu_0: f64,
    /// State at the start, t*.
    pub theta_0: f64,
    /// A block counts as sliding above this speed.
    pub slip_speed: f64,
}
