//! Fit of two sheets with the response of a bulk body.

/// Ratio of the largest to the smallest wave number of the fit.
pub(super) const RANGE: f64 = 8.0;
/// Number of wave numbers of the fit, at equal ratios.
const WAVES: usize = 41;
/// Initial guess of a fit, in units of the body's mean stiffness at the shortest wave over its wave number:
/// the sheets of a deep body.
const DEEP: [f64; 4] = [0.064, 0.6, 4.2, 0.58];
/// Number of updates of the weights, and of least-squares steps with each set of weights.
const WEIGHTINGS: usize = 30;
const STEPS: usize = 5;
/// Weight of the initial guess relative to that of a wave. It makes the fit unique for a thin layer, which
/// needs fewer than four numbers.
const GUESS: f64 = 1e-4;
/// Product of wave number and height below which a bonded layer deforms only by shear, with stiffness G/H,
/// within a thousandth: a fit to longer waves would be a fit to rounding errors.
pub(super) const THIN: f64 = 0.05;

/// Ratio of traction to displacement along and across a wave of wave number q, over G q, for `x = q H`.
pub(super) fn response(x: f64, poisson: f64) -> [f64; 2] {
    let kappa = 3.0 - 4.0 * poisson;
    // Numerator and denominator are multiplied by exp(-2 x) to avoid overflow.
    let decay = libm::exp(-2.0 * x);
    let decay_of_x = |power: f64| {
        if decay > 0.0 {
            4.0 * libm::pow(x, power) * decay
        } else {
            0.0
        }
    };
    let cosh = kappa * (1.0 + decay * decay) + (1.0 + kappa * kappa) * decay + decay_of_x(2.0);
    let sinh = kappa * (1.0 - decay * decay) + decay_of_x(1.0);
    let along = cosh / sinh / (1.0 - poisson);
    [along, (1.0 + decay) / (1.0 - decay)]
}

/// Stiffness of a sheet along and across a wave over [their mean](super::OF_SHEET).
pub(super) fn directions(along_to_across: f64) -> [f64; 2] {
    let root = along_to_across.sqrt();
    [root, 1.0 / root]
}

/// A body, in units of G q_a and q_a.
struct Body {
    waves: [f64; WAVES],
    /// Logarithms of the geometric mean of the stiffness along and across, for these waves.
    stiffness: [f64; WAVES],
    /// Logarithms of the [initial guess](DEEP).
    guess: [f64; 4],
}

/// Two sheets, in units of G q_a and q_a.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    /// Logarithms of the stiffness over q^2 of the lower and the upper sheet, averaged over both directions,
    /// of the coupling and of the mount.
    logarithms: [f64; 4],
    /// Stiffness of a sheet along and across, over the mean of both.
    directions: [f64; 2],
    /// Largest relative difference from the body.
    pub(super) error: f64,
}

impl Body {
    fn new(height: f64, poisson: f64) -> Self {
        let waves: [f64; WAVES] = std::array::from_fn(|k| libm::pow(RANGE, k as f64 / (WAVES - 1) as f64));
        let stiffness = waves.map(|q| {
            let [along, across] = response(q * height, poisson);
            q * (along * across).sqrt()
        });
        let unit = stiffness[WAVES - 1] / RANGE;
        let mut guess = DEEP.map(|of_deep| of_deep * unit);
        // To long waves, a layer is as stiff as a mount.
        guess[3] += (stiffness[0] - unit).max(0.0);
        Self {
            waves,
            stiffness: stiffness.map(libm::log),
            guess: guess.map(libm::log),
        }
    }
}

impl Fit {
    /// The fit to a body of height `q_a H` with the least maximum of the relative difference. Least squares
    /// find it by iteration: each weight is multiplied by the size of its difference (C. L. Lawson, 1961).
    pub(super) fn of(height: f64, poisson: f64, along_to_across: f64) -> Self {
        let body = Body::new(height, poisson);
        let mut fit = Self {
            logarithms: body.guess,
            directions: directions(along_to_across),
            error: f64::INFINITY,
        };
        let mut best = fit;
        let mut weights = [1.0; WAVES];
        for _ in 0..WEIGHTINGS {
            fit.approach(&body, &weights);
            let sizes = fit.differences(&body).map(|(difference, _)| difference.abs());
            fit.error = sizes.iter().copied().fold(0.0, f64::max);
            if fit.error < best.error {
                best = fit;
            }
            for (weight, size) in weights.iter_mut().zip(sizes) {
                *weight *= size;
            }
            let mean = weights.iter().sum::<f64>() / WAVES as f64;
            weights = weights.map(|weight| weight / mean);
        }
        best
    }

    /// Stiffness over q^2 of the lower and the upper sheet, of the coupling and of the mount.
    pub(super) fn stiffness(&self) -> [f64; 4] {
        self.logarithms.map(libm::exp)
    }

    /// For every wave, the logarithm of the geometric mean of the stiffness along and across over the body's,
    /// and its derivatives with respect to the logarithms of the four numbers.
    fn differences(&self, body: &Body) -> [(f64, [f64; 4]); WAVES] {
        let [lower, upper, coupling, mount] = self.stiffness();
        std::array::from_fn(|k| {
            let (mut product, mut slopes) = (1.0, [0.0; 4]);
            for direction in self.directions {
                let square = direction * body.waves[k] * body.waves[k];
                let above = mount + upper * square;
                let both = coupling + above;
                let of_above = (coupling / both) * (coupling / both);
                let response = lower * square + coupling * above / both;
                let of_response = [
                    lower * square,
                    upper * square * of_above,
                    coupling * (above / both) * (above / both),
                    mount * of_above,
                ];
                product *= response;
                for (slope, of_response) in slopes.iter_mut().zip(of_response) {
                    *slope += 0.5 * of_response / response;
                }
            }
            (0.5 * libm::log(product) - body.stiffness[k], slopes)
        })
    }

    /// Takes [`STEPS`] Levenberg-Marquardt steps to reduce the sum of weighted squares (K. Levenberg, 1944).
    fn approach(&mut self, body: &Body, weights: &[f64; WAVES]) {
        let mut damping = 1e-3;
        let mut square = self.weighted_square(body, weights);
        for _ in 0..STEPS {
            let mut next = *self;
            for (x, step) in next.logarithms.iter_mut().zip(self.step(body, weights, damping)) {
                *x += step.clamp(-1.0, 1.0);
            }
            let next_square = next.weighted_square(body, weights);
            if next_square < square {
                (*self, square, damping) = (next, next_square, 0.1 * damping);
            } else {
                damping *= 10.0;
            }
        }
    }

    /// Sum of the weighted squares of the differences from the body and from the initial guess.
    fn weighted_square(&self, body: &Body, weights: &[f64; WAVES]) -> f64 {
        let differences = self.differences(body);
        let of_waves = weights.iter().zip(differences);
        let of_guess = self.logarithms.iter().zip(body.guess);
        of_waves
            .map(|(weight, (difference, _))| weight * difference * difference)
            .sum::<f64>()
            + of_guess
                .map(|(x, guess)| GUESS * (x - guess) * (x - guess))
                .sum::<f64>()
    }

    /// A damped step of the logarithms to reduce the sum of squares.
    fn step(&self, body: &Body, weights: &[f64; WAVES], damping: f64) -> [f64; 4] {
        let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
        for (weight, (difference, slopes)) in weights.iter().zip(self.differences(body)) {
            for i in 0..4 {
                right[i] -= weight * slopes[i] * difference;
                for j in 0..4 {
                    matrix[i][j] += weight * slopes[i] * slopes[j];
                }
            }
        }
        for i in 0..4 {
            right[i] -= GUESS * (self.logarithms[i] - body.guess[i]);
            matrix[i][i] = (matrix[i][i] + GUESS) * (1.0 + damping);
        }
        solution(matrix, right)
    }
}

/// Solution of four linear equations with a positive definite matrix, by elimination.
fn solution(mut matrix: [[f64; 4]; 4], mut right: [f64; 4]) -> [f64; 4] {
    for i in 0..4 {
        for below in i + 1..4 {
            let (factor, pivot) = (matrix[below][i] / matrix[i][i], matrix[i]);
            for (entry, above) in matrix[below].iter_mut().zip(pivot) {
                *entry -= factor * above;
            }
            right[below] -= factor * right[i];
        }
    }
    for i in (0..4).rev() {
        let known: f64 = (i + 1..4).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}
