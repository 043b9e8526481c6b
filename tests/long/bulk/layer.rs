//! An elastic layer that is glued to a rigid face on top, under a sinusoidal traction on its free lower face:
//! the equations of elasticity over the height, integrated numerically.

/// Steps over the height.
const STEPS: usize = 400;

/// Traction over displacement along and across a wave, where `x` is its wave number times the height, in
/// units of G over the height.
pub(crate) fn response(x: f64, poisson: f64) -> [f64; 2] {
    // Over the height: z from 0 to 1, q = x, G = 1. Along the wave, with u = U cos, w = W sin, shear stress
    // T cos and normal stress S sin: U' = T - q W, W' = (S + lambda q U)/M, T' = M q^2 U - lambda q W' - ...
    let lambda = 2.0 * poisson / (1.0 - 2.0 * poisson);
    let modulus = lambda + 2.0;
    let along = |[u, w, t, s]: [f64; 4]| {
        let w_slope = (s + lambda * x * u) / modulus;
        let stress = lambda * w_slope - modulus * x * u;
        [t - x * w, w_slope, -x * stress, x * t]
    };
    // Unit displacements along the wave and normal to it, and a unit traction, each alone at the lower face.
    let [by_u, by_w, by_t] = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]
        .map(|start| integrated(start, along));
    // Both displacements are zero at the upper face: U + T = 0 in the first two rows, for U = 1.
    let determinant = by_w[0] * by_t[1] - by_w[1] * by_t[0];
    let t = -(by_w[0] * by_u[1] - by_w[1] * by_u[0]) / determinant;
    // Across the wave: v' = T, T' = q^2 v.
    let across = |[v, t]: [f64; 2]| [t, x * x * v];
    let [by_v, by_shear] = [[1.0, 0.0], [0.0, 1.0]].map(|start| integrated(start, across));
    // The stress of the layer on its lower face pulls back.
    [-t, by_v[0] / by_shear[0]]
}

/// The solution at z = 1 that starts at z = 0, by the fourth-order Runge-Kutta method.
fn integrated<const N: usize>(start: [f64; N], slope: impl Fn([f64; N]) -> [f64; N]) -> [f64; N] {
    let step = 1.0 / STEPS as f64;
    let moved =
        |from: [f64; N], by: [f64; N], share: f64| std::array::from_fn(|i| from[i] + share * step * by[i]);
    let mut now = start;
    for _ in 0..STEPS {
        let one = slope(now);
        let two = slope(moved(now, one, 0.5));
        let three = slope(moved(now, two, 0.5));
        let four = slope(moved(now, three, 1.0));
        now =
            std::array::from_fn(|i| now[i] + step / 6.0 * (one[i] + 2.0 * two[i] + 2.0 * three[i] + four[i]));
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Long waves shear the layer as a whole, and for short waves it is a half-space.
    #[test]
    fn a_layer_is_a_block_or_a_half_space() {
        for poisson in [0.0, 0.25, 0.45] {
            let [along, across] = response(1e-3, poisson);
            // The differences fall with the square of the wave number.
            assert!((along - 1.0).abs() < 1e-5 && (across - 1.0).abs() < 1e-5);
            let x = 8.0;
            let [along, across] = response(x, poisson);
            // The lower face feels the upper one by exp(-2 x) times a few x^2.
            assert!((along * (1.0 - poisson) / x - 1.0).abs() < 1e-4, "{along}");
            assert!((across / x - 1.0).abs() < 1e-6, "{across}");
        }
    }
}
