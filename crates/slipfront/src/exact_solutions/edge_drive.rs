//! A slider that is driven at an edge.

/// Load of a chain, driven at one end, after an event that has reached `length` times its length
/// (precursors):
///
/// ```text
/// F_T(lambda)/F_N = mu_k [(1 - theta) lambda + theta lambda^2]
/// ```
///
/// The part that has slipped bears kinetic friction, which the drive balances: the integral of `mu_k p(x)`
/// over this part, with the pressure `p(x) = P (1 + theta (2 x/L - 1))` at the distance x from the driven
/// end. In units of `mu_s`, with `r_star` in place of `mu_k`, the load is mu*.
///
/// ```
/// use slipfront::exact_solutions::precursor_load;
/// // Half of a chain under an equal pressure bears half of the friction; the half with 3/8 of the load, 3/8.
/// assert_eq!(precursor_load(0.5, 0.45, 0.0), 0.225);
/// assert_eq!(precursor_load(0.5, 0.5, 0.5), 0.1875);
/// ```
pub fn precursor_load(length: f64, mu_kinetic: f64, relative_slope: f64) -> f64 {
    mu_kinetic * ((1.0 - relative_slope) * length + relative_slope * length * length)
}
