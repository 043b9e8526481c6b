//! Static friction that grows while a block is stuck.

/// Logarithmic ageing: `mu_s(t) = mu_s [1 + beta ln(1 + t_stuck/tau)]`, with age 0 at t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ageing {
    /// `beta`.
    pub beta: f64,
    /// `tau`, t*.
    pub time: f64,
}

impl Ageing {
    /// Static friction over that of age 0, less 1: `beta ln(1 + age/tau)`. The logarithm is that of `libm`.
    ///
    /// ```
    /// let ageing = slipfront::Ageing { beta: 0.1, time: 2.0 };
    /// assert_eq!(ageing.growth(0.0), 0.0);
    /// assert!((ageing.growth(2.0) - 0.1 * 2.0_f64.ln()).abs() < 1e-16);
    /// ```
    #[inline(always)]
    pub fn growth(&self, age: f64) -> f64 {
        self.beta * libm::log1p(age / self.time)
    }

    /// Static threshold `mu_s(t) F_n + tau_a l^2` of a block that has been stuck for `age`, from that of age 0. Adhesion does not
    /// age: the law is one of the coefficient.
    ///
    /// The operations have this order in every kernel: `x = age/tau`, `g = beta log1p(x)`, `m = max(S - tau_a l^2, 0)`, `S + g m`.
    #[inline(always)]
    pub(crate) fn static_limit(&self, young: f64, adhesion: f64, age: f64) -> f64 {
        young + self.growth(age) * (young - adhesion).max(0.0)
    }
}
