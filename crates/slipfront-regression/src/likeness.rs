//! How far a vector lies from a sample of vectors that depend on parameters.

use crate::dense::Factor;

/// Number of parts of the sample, of which each is judged by the others.
const PARTS: usize = 10;

/// Share of the identity in the correlation of residuals: fewer samples than numbers leave it singular.
const SHRUNK: f64 = 0.2;

/// Largest distance from the mean that counts, in standard deviations.
const MOST: f64 = 1e3;

/// How far a vector lies from a sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Distance {
    /// Share of the vectors of the sample that lie at least as far from the others, with the vector itself as
    /// one of them.
    pub rank: f64,
    /// Mahalanobis distance of the vector, over the one that half of the sample exceeds.
    pub ratio: f64,
    /// Distance of every number of the vector from the mean, in standard deviations of the sample.
    pub deviations: Vec<f64>,
}

/// A sample as a linear function of its parameters, with residuals:
///
/// ```text
/// z = (v - mean)/deviation = B q + e,   E = (1 - SHRUNK) <e e'> + SHRUNK diag <e^2>,   Q = <q q'>
/// ```
///
/// with `q` the parameters less their mean.
struct Fit {
    mean: Vec<f64>,
    deviation: Vec<f64>,
    /// Mean of the parameters.
    centre: Vec<f64>,
    /// Rows of B.
    slopes: Vec<Vec<f64>>,
    /// Q, row by row.
    spread: Vec<f64>,
    /// E, row by row.
    residuals: Vec<f64>,
}

/// Variance of the parameters over that of the sample: the vector may belong to parameters at the edge of the
/// sample.
const WIDENED: f64 = 4.0;

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

impl Fit {
    fn of(vectors: &[&Vec<f64>], parameters: &[&Vec<f64>]) -> Self {
        let (mean, centre) = (means(vectors), means(parameters));
        let (d, p) = (mean.len(), centre.len());
        let deviation = |k: usize| {
            let squares: f64 = vectors.iter().map(|row| (row[k] - mean[k]).powi(2)).sum();
            // Numbers that are the same in all vectors but for rounding have no deviation of their own.
            let rounding = 1e-9 * mean[k].abs() + 1e-100;
            (squares / vectors.len() as f64).sqrt().max(rounding)
        };
        let deviation = (0..d).map(deviation).collect();
        let mut fit = Self {
            mean,
            deviation,
            centre,
            slopes: Vec::new(),
            spread: Vec::new(),
            residuals: Vec::new(),
        };
        let z: Vec<Vec<f64>> = vectors.iter().map(|row| fit.scaled(row)).collect();
        let less_mean = |row: &Vec<f64>| {
            row.iter()
                .zip(&fit.centre)
                .map(|(q, centre)| q - centre)
                .collect()
        };
        let q: Vec<Vec<f64>> = parameters.iter().map(|row| less_mean(row)).collect();
        fit.spread = (0..p * p).map(|at| product(&q, at / p, &q, at % p)).collect();
        let factor = fit.factor_of_spread();
        let slope = |k: usize| {
            let mut slope: Vec<f64> = (0..p).map(|j| product(&z, k, &q, j)).collect();
            factor.solve(&mut slope);
            slope
        };
        fit.slopes = (0..d).map(slope).collect();
        let residual = |(z, q): (&Vec<f64>, &Vec<f64>)| {
            let of = |(z, slope): (&f64, &Vec<f64>)| z - dot(slope, q);
            z.iter().zip(&fit.slopes).map(of).collect()
        };
        let e: Vec<Vec<f64>> = z.iter().zip(&q).map(residual).collect();
        let entry = |at: usize| {
            let share = if at / d == at % d { 1.0 } else { 1.0 - SHRUNK };
            share * product(&e, at / d, &e, at % d)
        };
        fit.residuals = (0..d * d).map(entry).collect();
        fit
    }

    /// Factor of Q, of which parameters that never differ are kept from being singular.
    fn factor_of_spread(&self) -> Factor {
        let p = self.centre.len();
        let largest = (0..p).map(|j| self.spread[j * p + j]).fold(1e-100, f64::max);
        factor(&self.spread, 1e-9 * largest)
    }

    fn scaled(&self, vector: &[f64]) -> Vec<f64> {
        let columns = vector.iter().zip(&self.mean).zip(&self.deviation);
        columns
            .map(|((value, mean), deviation)| ((value - mean) / deviation).clamp(-MOST, MOST))
            .collect()
    }

    /// Factor of the covariance of the vectors, E + WIDENED B Q B'.
    fn covariance(&self) -> Factor {
        let (d, p) = (self.mean.len(), self.centre.len());
        let effect = |a: usize, b: usize| -> f64 {
            let entry = |at: usize| self.slopes[a][at / p] * self.spread[at] * self.slopes[b][at % p];
            (0..p * p).map(entry).sum()
        };
        let entry = |at: usize| self.residuals[at] + WIDENED * effect(at / d, at % d);
        factor(&(0..d * d).map(entry).collect::<Vec<f64>>(), 1e-6)
    }

    /// Square of the Mahalanobis distance, `z' V^-1 z`.
    fn squared_distance(&self, covariance: &Factor, vector: &[f64]) -> f64 {
        let z = self.scaled(vector);
        let mut solved = z.clone();
        covariance.solve(&mut solved);
        dot(&z, &solved)
    }
}

/// Cholesky factor of a positive matrix, whose diagonal gets as much more as rounding makes necessary.
fn factor(matrix: &[f64], added: f64) -> Factor {
    let n = matrix.len().isqrt();
    let mut more = added;
    loop {
        if let Some(factor) = Factor::of(matrix.to_vec(), std::iter::repeat_n(more, n)) {
            return factor;
        }
        more = (10.0 * more).max(1e-12);
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Distance of a vector from a sample, of which every vector has parameters.
///
/// The sample is divided into ten parts. The vectors of a part are held against the others, and so is the
/// vector that is judged, of which the median counts.
///
/// # Panics
/// If the sample has fewer than twenty vectors.
pub fn distance_from(sample: &[Vec<f64>], parameters: &[Vec<f64>], vector: &[f64]) -> Distance {
    assert!(sample.len() >= 2 * PARTS);
    let (mut own, mut others) = (Vec::new(), Vec::new());
    for part in 0..PARTS {
        let is_kept = |k: &usize| k % PARTS != part;
        let kept = |rows: &'_ [Vec<f64>]| (0..rows.len()).filter(is_kept).collect::<Vec<usize>>();
        let pick: Vec<usize> = kept(sample);
        let vectors: Vec<&Vec<f64>> = pick.iter().map(|&k| &sample[k]).collect();
        let theirs: Vec<&Vec<f64>> = pick.iter().map(|&k| &parameters[k]).collect();
        let fit = Fit::of(&vectors, &theirs);
        let covariance = fit.covariance();
        let held_out = sample.iter().skip(part).step_by(PARTS);
        others.extend(held_out.map(|row| fit.squared_distance(&covariance, row)));
        own.push(fit.squared_distance(&covariance, vector));
    }
    own.sort_by(f64::total_cmp);
    let own = 0.5 * (own[(PARTS - 1) / 2] + own[PARTS / 2]);
    let as_far = others.iter().filter(|other| **other >= own).count();
    others.sort_by(f64::total_cmp);
    let fit = Fit::of(
        &sample.iter().collect::<Vec<_>>(),
        &parameters.iter().collect::<Vec<_>>(),
    );
    Distance {
        rank: (as_far + 1) as f64 / (others.len() + 1) as f64,
        ratio: (own / others[others.len() / 2]).sqrt(),
        deviations: fit.scaled(vector),
    }
}
