//! Springs between slider and substrate that break and form again.

/// First peak of friction over its mean in sliding of a rigid slider that is moved slowly, on springs whose thresholds are spread
/// evenly over 1 - w to 1 + w, w <= 1/3. All springs are stretched alike until the weakest breaks, at 1 - w; later each is at all
/// extensions alike, and bears half its threshold on average. A spring that keeps its threshold x breaks as often as 1/x:
///
/// ```text
/// kept:   2 (1 - w)          drawn anew:   2 (1 - w)/(1 + w^2/3),   since the mean is <x^2>/(2 <x>)
/// ```
///
/// ```
/// # use slipfront::exact_solutions::static_over_kinetic_of_springs;
/// assert_eq!(static_over_kinetic_of_springs(0.25, false), 1.5);
/// for (w, ratio) in [(0.05, 1.8984), (0.1, 1.7940), (0.2, 1.5789)] {
///     assert!((static_over_kinetic_of_springs(w, true) - ratio).abs() < 5e-5);
/// }
/// ```
pub fn static_over_kinetic_of_springs(w: f64, redrawn: bool) -> f64 {
    let kept = 2.0 * (1.0 - w);
    if redrawn { kept / (1.0 + w * w / 3.0) } else { kept }
}

/// Force on the first block of a chain of `n` at which its spring to the substrate breaks, over the threshold of that spring, in
/// equilibrium: springs of stiffness `k` between the blocks, of stiffness `k_t` to the substrate.
///
/// ```text
/// F/(mu_s F_n) = sinh(q n)/(2 sinh(q/2) cosh(q (n - 1/2))),   cosh q = 1 + k_t/(2 k)
/// ```
///
/// ```
/// # use slipfront::exact_solutions::chain_slip_force;
/// // One block; two blocks, of which k u_1 = (k + k_t) u_2: F = k_t (u_1 + u_2).
/// assert!((chain_slip_force(1, 0.75, 0.1) - 1.0).abs() < 1e-12);
/// assert!((chain_slip_force(2, 0.75, 0.25) - 1.75).abs() < 1e-12);
/// ```
pub fn chain_slip_force(n: usize, k: f64, k_t: f64) -> f64 {
    let q = (1.0 + 0.5 * k_t / k).acosh();
    let n = n as f64;
    (q * n).sinh() / (2.0 * (0.5 * q).sinh() * (q * (n - 0.5)).cosh())
}
