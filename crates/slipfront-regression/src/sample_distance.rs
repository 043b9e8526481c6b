//! Distance of a vector from a sample of vectors that depend on parameters.

use crate::dense::Factor;

/// Number of parts of the sample; each part is compared with the others.
const PARTS: usize = 10;

/// Share of the diagonal in the covariance of residuals: with fewer samples than numbers, the covariance
/// alone is singular.
const SHRUNK: f64 = 0.2;

/// Largest distance from the mean, in standard deviations; larger ones are clamped.
const MOST: f64 = 1e3;

/// Ratio of the assumed variance of the parameters to that of the sample: the vector may have parameters at
/// the edge of the sample.
const WIDENED: f64 = 4.0;

/// Distance of a vector from a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    /// Share of vectors that lie at least as far from the others, with the vector itself as one of the
    /// sample.
    pub rank: f64,
    /// Mahalanobis distance of the vector, divided by the median of the sample.
    pub ratio: f64,
    /// Distance of every number of the vector from the mean, in standard deviations of the sample.
    pub deviations: Vec<f64>,
}

/// Means and standard deviations of a sample.
struct Scale {
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl Scale {
    fn from_sample(sample: &[&Vec<f64>]) -> Self {
        let mean = means(sample);
        let deviation = |k: usize| {
            let squares: f64 = sample.iter().map(|row| (row[k] - mean[k]).powi(2)).sum();
            // Numbers that are equal in all vectors up to rounding have no standard deviation of their own.
            let rounding = 1e-9 * mean[k].abs() + 1e-100;
            (squares / sample.len() as f64).sqrt().max(rounding)
        };
        let deviation = (0..mean.len()).map(deviation).collect();
        Self { mean, deviation }
    }

    fn scaled(&self, vector: &[f64]) -> Vec<f64> {
        let columns = vector.iter().zip(&self.mean).zip(&self.deviation);
        columns
            .map(|((value, mean), deviation)| ((value - mean) / deviation).clamp(-MOST, MOST))
            .collect()
    }
}

/// A sample as a linear function of its parameters, with residuals:
///
/// ```text
/// z = (v - mean)/deviation = B q + e,   E = (1 - SHRUNK) <e e'> + SHRUNK diag <e^2>,   Q = <q q'>
/// V = E + WIDENED B Q B'
/// ```
///
/// with `q` the parameters less their mean.
struct Fit {
    scale: Scale,
    /// Factor of V.
    covariance: Factor,
}

impl Fit {
    fn new(vectors: &[&Vec<f64>], parameters: &[&Vec<f64>]) -> Self {
        let (scale, centre) = (Scale::from_sample(vectors), means(parameters));
        let (d, p) = (scale.mean.len(), centre.len());
        let z: Vec<Vec<f64>> = vectors.iter().map(|row| scale.scaled(row)).collect();
        let less_mean = |row: &Vec<f64>| row.iter().zip(&centre).map(|(q, centre)| q - centre).collect();
        let q: Vec<Vec<f64>> = parameters.iter().map(|row| less_mean(row)).collect();
        let spread: Vec<f64> = (0..p * p).map(|at| product(&q, at / p, &q, at % p)).collect();
        // Constant parameters would make the matrix singular.
        let largest = (0..p).map(|j| spread[j * p + j]).fold(1e-100, f64::max);
        let of_spread = factor(spread.clone(), 1e-9 * largest);
        let slope = |k: usize| {
            let mut slope: Vec<f64> = (0..p).map(|j| product(&z, k, &q, j)).collect();
            of_spread.solve(&mut slope);
            slope
        };
        let slopes: Vec<Vec<f64>> = (0..d).map(slope).collect();
        let residual = |(z, q): (&Vec<f64>, &Vec<f64>)| {
            let of = |(z, slope): (&f64, &Vec<f64>)| z - dot(slope, q);
            z.iter().zip(&slopes).map(of).collect()
        };
        let e: Vec<Vec<f64>> = z.iter().zip(&q).map(residual).collect();
        let effect = |a: usize, b: usize| -> f64 {
            let entry = |at: usize| slopes[a][at / p] * spread[at] * slopes[b][at % p];
            (0..p * p).map(entry).sum()
        };
        let entry = |at: usize| {
            let (a, b) = (at / d, at % d);
            // The factorization reads only the lower half.
            if a < b {
                return 0.0;
            }
            let share = if a == b { 1.0 } else { 1.0 - SHRUNK };
            share * product(&e, a, &e, b) + WIDENED * effect(a, b)
        };
        let covariance = factor((0..d * d).map(entry).collect(), 1e-6);
        Self { scale, covariance }
    }

    /// Square of the Mahalanobis distance, `z' V^-1 z`.
    fn squared_distance(&self, vector: &[f64]) -> f64 {
        let z = self.scale.scaled(vector);
        let mut solved = z.clone();
        self.covariance.solve(&mut solved);
        dot(&z, &solved)
    }
}

/// Mean of the products of two columns of some rows.
fn product(rows: &[Vec<f64>], a: usize, others: &[Vec<f64>], b: usize) -> f64 {
    let products = rows.iter().zip(others).map(|(row, other)| row[a] * other[b]);
    products.sum::<f64>() / rows.len() as f64
}

/// Means of the columns of some rows.
fn means(rows: &[&Vec<f64>]) -> Vec<f64> {
    let mean = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / rows.len() as f64;
    (0..rows[0].len()).map(mean).collect()
}

/// Factor of a covariance, with an addition to its diagonal that exceeds rounding errors.
fn factor(covariance: Vec<f64>, added: f64) -> Factor {
    let n = covariance.len().isqrt();
    let factor = Factor::new(covariance, std::iter::repeat_n(added, n));
    factor.unwrap_or_else(|| panic!("a covariance of finite numbers is positive"))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Distance of a vector from a sample of vectors with known parameters.
///
/// The sample is divided into ten parts. The vectors of each part are compared with the other parts, and so
/// is the tested vector; the median of its ten distances counts.
///
/// # Panics
/// If the sample has fewer than twenty vectors, or a number is not finite.
pub fn distance_from(sample: &[Vec<f64>], parameters: &[Vec<f64>], vector: &[f64]) -> Distance {
    assert!(sample.len() >= 2 * PARTS);
    let (mut own, mut others) = (Vec::new(), Vec::new());
    for part in 0..PARTS {
        let rest = |rows: &'_ [Vec<f64>]| (0..rows.len()).filter(|k| k % PARTS != part).collect::<Vec<_>>();
        let vectors: Vec<&Vec<f64>> = rest(sample).iter().map(|&k| &sample[k]).collect();
        let theirs: Vec<&Vec<f64>> = rest(sample).iter().map(|&k| &parameters[k]).collect();
        let fit = Fit::new(&vectors, &theirs);
        let held_out = sample.iter().skip(part).step_by(PARTS);
        others.extend(held_out.map(|row| fit.squared_distance(row)));
        own.push(fit.squared_distance(vector));
    }
    own.sort_by(f64::total_cmp);
    let own = 0.5 * (own[(PARTS - 1) / 2] + own[PARTS / 2]);
    let as_far = others.iter().filter(|other| **other >= own).count();
    others.sort_by(f64::total_cmp);
    Distance {
        rank: (as_far + 1) as f64 / (others.len() + 1) as f64,
        ratio: (own / others[others.len() / 2]).sqrt(),
        deviations: Scale::from_sample(&sample.iter().collect::<Vec<_>>()).scaled(vector),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::for_tests::chance;

    /// Vectors of five numbers: twice the parameter and minus the parameter, both with noise, noise alone,
    /// and a constant. The noise is four numbers between 0 and 1.
    fn vector(parameter: f64, noise: &[f64]) -> Vec<f64> {
        let noise = |j: usize| 0.2 * (noise[j] - 0.5);
        vec![
            2.0 * parameter + noise(0),
            noise(1) - parameter,
            noise(2),
            noise(3),
            3.0,
        ]
    }

    /// A hundred vectors with parameters between -1 and 1, and one more with the parameter 0.8 and noise
    /// within a standard deviation.
    fn sample() -> (Vec<Vec<f64>>, Vec<Vec<f64>>, Vec<f64>) {
        let numbers = chance(500);
        let parameters = numbers.chunks_exact(5).map(|row| vec![2.0 * row[4] - 1.0]);
        let parameters: Vec<Vec<f64>> = parameters.collect();
        let rows = numbers.chunks_exact(5).zip(&parameters);
        let vectors = rows.map(|(row, parameter)| vector(parameter[0], row));
        (vectors.collect(), parameters, vector(0.8, &[0.3, 0.6, 0.4, 0.7]))
    }

    #[test]
    fn a_vector_of_another_parameter_is_near_and_one_of_none_is_far() {
        let (sample, parameters, good) = sample();
        let distance = |vector: &[f64]| distance_from(&sample, &parameters, vector);
        let own = distance(&good);
        assert!(own.rank > 0.05 && own.ratio < 2.0, "{own:?}");
        // Each number alone lies within the sample, but both together fit no parameter.
        let foreign = distance(&[1.0, 0.5, 0.0, 0.0, 3.0]);
        assert!(foreign.rank == 1.0 / 101.0 && foreign.ratio > 3.0, "{foreign:?}");
        assert!(foreign.deviations.iter().all(|z| z.abs() < 2.0), "{foreign:?}");
    }

    /// A number that is constant in the sample reveals a vector with another value.
    #[test]
    fn what_never_differs_counts_where_it_does() {
        let (sample, parameters, mut other) = sample();
        other[4] = 3.001;
        assert_eq!(distance_from(&sample, &parameters, &other).rank, 1.0 / 101.0);
    }
}
