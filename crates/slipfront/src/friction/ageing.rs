//! Static friction that grows while a block is stuck.

/// Logarithmic ageing: `mu_s(t) = mu_s [1 + beta ln(1 + t_stuck/tau)]`, with age 0 at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ageing {
    /// `beta`.
    pub beta: f64,
    /// `tau`, t*.
    pub time: f64,
}
