//! A search over vectors of numbers that adapts the distribution of its drafts to their losses.
//!
//! The method is the matrix adaptation evolution strategy: H.-G. Beyer and B. Sendhoff, Simplify your
//! covariance matrix adaptation evolution strategy, IEEE Transactions on Evolutionary Computation 21 (2017)
//! 746-759, doi:10.1109/TEVC.2017.2680320, with the weights and constants given there.

use crate::draws::Draws;

/// A normal distribution of vectors x = m + s M z, where z are standard normal numbers.
#[derive(Debug)]
pub struct Adaptation {
    /// The mean m.
    mean: Vec<f64>,
    /// The length s of a step.
    step: f64,
    /// The matrix M, row-major.
    matrix: Vec<f64>,
    /// Exponentially fading sum of the steps of the mean.
    path: Vec<f64>,
}

impl Adaptation {
    /// A distribution with this mean, and this standard deviation in every direction.
    pub fn new(mean: Vec<f64>, step: f64) -> Self {
        let n = mean.len();
        let mut matrix = vec![0.0; n * n];
        matrix
            .iter_mut()
            .step_by(n + 1)
            .for_each(|diagonal| *diagonal = 1.0);
        Self {
            path: vec![0.0; n],
            mean,
            step,
            matrix,
        }
    }

    /// Length s of a step.
    pub fn step(&self) -> f64 {
        self.step
    }

    /// Draws standard normal numbers z, and returns them with the vector x.
    pub fn draw(&self, draws: &mut Draws) -> (Vec<f64>, Vec<f64>) {
        let z: Vec<f64> = self.mean.iter().map(|_| draws.normal()).collect();
        let x = self.mean.iter().zip(self.times(&z));
        (z.clone(), x.map(|(mean, y)| mean + self.step * y).collect())
    }

    /// The product M z.
    fn times(&self, z: &[f64]) -> Vec<f64> {
        let rows = self.matrix.chunks_exact(z.len());
        rows.map(|row| dot(row, z)).collect()
    }

    /// Adapts the distribution to the numbers z of at least two drafts, the best first. d_i are the numbers
    /// of the better half, and w_i decreasing weights with a sum of 1:
    ///
    /// ```text
    /// w_i ~ ln(mu + 1/2) - ln i,   mu_e = 1/sum_i w_i^2,   d = sum_i w_i d_i
    /// m <- m + s M d
    /// p <- (1 - c_s) p + sqrt(mu_e c_s (2 - c_s)) d
    /// M <- M (1 + c_1/2 (p p^T - 1) + c_w/2 (sum_i w_i d_i d_i^T - 1))
    /// s <- s exp(c_s/d_s (|p|/chi - 1)),   chi = sqrt(n) (1 - 1/(4 n) + 1/(21 n^2))
    /// c_s = (mu_e + 2)/(n + mu_e + 5),   d_s = 1 + c_s + 2 max(0, sqrt((mu_e - 1)/(n + 1)) - 1)
    /// c_1 = 2/((n + 1.3)^2 + mu_e),   c_w = min(1 - c_1, 2 (mu_e + 1/mu_e - 2)/((n + 2)^2 + mu_e))
    /// ```
    pub fn adapt(&mut self, drafts: &[&[f64]]) {
        let size = self.mean.len();
        let n = size as f64;
        let parents = &drafts[..drafts.len() / 2];
        let raw = |i: usize| libm::log(parents.len() as f64 + 0.5) - libm::log((i + 1) as f64);
        let sum: f64 = (0..parents.len()).map(raw).sum();
        let weights: Vec<f64> = (0..parents.len()).map(|i| raw(i) / sum).collect();
        let effective = 1.0 / dot(&weights, &weights);
        let mut moved = vec![0.0; size];
        for (weight, parent) in weights.iter().zip(parents) {
            add(&mut moved, *weight, parent);
        }
        let fading = (effective + 2.0) / (n + effective + 5.0);
        let damping = 1.0 + fading + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0);
        let of_path = 2.0 / ((n + 1.3) * (n + 1.3) + effective);
        let of_parents = (2.0 * (effective + 1.0 / effective - 2.0) / ((n + 2.0) * (n + 2.0) + effective))
            .min(1.0 - of_path);

        let moved_by = self.times(&moved);
        add(&mut self.mean, self.step, &moved_by);
        self.path.iter_mut().for_each(|p| *p *= 1.0 - fading);
        add(
            &mut self.path,
            (effective * fading * (2.0 - fading)).sqrt(),
            &moved,
        );
        // M v v^T is the product of the column M v and the row v^T.
        let mut changed = self.matrix.clone();
        changed
            .iter_mut()
            .for_each(|entry| *entry *= 1.0 - 0.5 * (of_path + of_parents));
        let mut add_product = |share: f64, vector: &[f64]| {
            let columns = self.times(vector);
            for (row, column) in changed.chunks_exact_mut(size).zip(columns) {
                add(row, 0.5 * share * column, vector);
            }
        };
        add_product(of_path, &self.path);
        for (weight, parent) in weights.iter().zip(parents) {
            add_product(of_parents * weight, parent);
        }
        self.matrix = changed;
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
        let length = dot(&self.path, &self.path).sqrt();
        self.step *= libm::exp(fading / damping * (length / expected - 1.0));
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Adds a multiple of a vector.
fn add(to: &mut [f64], factor: f64, vector: &[f64]) {
    for (to, value) in to.iter_mut().zip(vector) {
        *to += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Least value of a function that is found with this many drafts, and the final mean of the distribution.
    fn least(function: impl Fn(&[f64]) -> f64, start: Vec<f64>, mut drafts: usize) -> (f64, Vec<f64>) {
        let mut draws = Draws::new(3);
        let mut adaptation = Adaptation::new(start, 0.5);
        let mut least = f64::INFINITY;
        while drafts > 0 {
            let mut found: Vec<(f64, Vec<f64>)> = (0..8)
                .map(|_| {
                    let (z, x) = adaptation.draw(&mut draws);
                    (function(&x), z)
                })
                .collect();
            drafts = drafts.saturating_sub(found.len());
            found.sort_by(|a, b| a.0.total_cmp(&b.0));
            least = least.min(found[0].0);
            adaptation.adapt(&found.iter().map(|(_, z)| z.as_slice()).collect::<Vec<_>>());
        }
        (least, adaptation.mean)
    }

    /// The ellipsoid is rotated, and its axes differ by a factor of a thousand: a search with isotropic
    /// drafts would need a million times as many.
    #[test]
    fn the_middle_of_a_long_tilted_ellipsoid_is_found() {
        let [cos, sin] = [0.6, 0.8];
        let middle = [0.3, -0.7, 1.1, 0.2];
        let of = |x: &[f64]| {
            let d: Vec<f64> = x.iter().zip(middle).map(|(x, middle)| x - middle).collect();
            let [along, across] = [cos * d[0] + sin * d[1], cos * d[1] - sin * d[0]];
            along * along + 1e6 * across * across + 1e3 * d[2] * d[2] + d[3] * d[3]
        };
        let (found, mean) = least(of, vec![0.0; 4], 3000);
        assert!(found < 1e-10, "{found:e}");
        for (mean, middle) in mean.iter().zip(middle) {
            assert!((mean - middle).abs() < 1e-4, "{mean} where {middle} is the least");
        }
    }

    /// Along a slope, steps become longer.
    #[test]
    fn steps_adapt_to_the_slope() {
        let (found, _) = least(|x| x[0], vec![0.0; 3], 1000);
        assert!(found < -1e6, "{found:e}");
    }
}
