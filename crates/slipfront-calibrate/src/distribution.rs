//! Distribution of an unknown, from a prediction and the residuals of training runs.

use slipfront_regression::{Prediction, Regression};

/// Values of an unknown with their weights, in rising order: its distribution over its range, from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    values: Vec<f64>,
    /// Sums of the weights up to every value; the last is 1.
    sums: Vec<f64>,
}

impl Distribution {
    /// The distribution of an unknown: leave-one-out residuals of training runs like the record, in units of
    /// their scale, around the prediction from the record.
    ///
    /// ```text
    /// u = f + s (u_i - f_i)/s_i   with the weight exp(-(f - f_i)^2/(2 0.15^2) - log^2(s/s_i)/(2 0.5^2))
    /// ```
    pub(crate) fn new(regression: &Regression, unknown: &[f64], prediction: Prediction) -> Self {
        let weighted = unknown.iter().enumerate().map(|(run, &truth)| {
            let weight = libm::exp(-0.5 * regression.distance(run, &prediction));
            (regression.moved(run, truth, &prediction), weight)
        });
        Self::of_weighted(weighted.collect())
    }

    fn of_weighted(mut weighted: Vec<(f64, f64)>) -> Self {
        weighted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let total: f64 = weighted.iter().map(|(_, weight)| weight).sum();
        let mut sum = 0.0;
        let sums = weighted.iter().map(|(_, weight)| {
            sum += weight / total;
            sum
        });
        let sums = sums.collect();
        Self {
            values: weighted.into_iter().map(|(value, _)| value).collect(),
            sums,
        }
    }

    /// The value below which a share of the distribution lies.
    pub fn quantile(&self, share: f64) -> f64 {
        let place = self.sums.partition_point(|&sum| sum < share);
        self.values[place.min(self.values.len() - 1)]
    }

    /// The central interval with `share` of the distribution: equal shares are below and above.
    pub fn interval(&self, share: f64) -> [f64; 2] {
        [self.quantile(0.5 - 0.5 * share), self.quantile(0.5 + 0.5 * share)]
    }

    /// The share of the distribution below a value: uniformly distributed for the true values of records that
    /// were drawn from the prior.
    pub fn below(&self, value: f64) -> f64 {
        let place = self.values.partition_point(|&other| other < value);
        if place == 0 { 0.0 } else { self.sums[place - 1] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::design_point::design_point;
    use crate::synthetic_noise::{Stream, normals};

    #[test]
    fn quantiles_of_weighted_values() {
        let one = Distribution::of_weighted(vec![(0.5, 1.0), (0.1, 2.0), (0.9, 1.0)]);
        assert_eq!(
            [0.2, 0.5, 0.6, 1.0].map(|share| one.quantile(share)),
            [0.1, 0.1, 0.5, 0.9]
        );
        assert_eq!(
            [0.0, 0.1, 0.2, 0.9, 1.0].map(|value| one.below(value)),
            [0.0, 0.0, 0.5, 0.75, 1.0]
        );
        assert_eq!(one.interval(0.9), [0.1, 0.9]);
    }

    /// The feature is the unknown with normal noise; its standard deviation grows from 0.02 to 0.12 over the
    /// range.
    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        let truth = |run: usize| design_point(run, 1)[0];
        let feature = |run: usize| {
            let noise = normals(Stream::Noise, run, 0).next().unwrap();
            truth(run) - 0.5 + (0.02 + 0.1 * truth(run)) * noise
        };
        let training = 400;
        let table: Vec<f64> = (0..training).map(feature).collect();
        let truths: Vec<f64> = (0..training).map(truth).collect();
        let regression = Regression::learn(&table, &truths);
        let (mut held, mut all) = ([0.0; 2], [0.0; 2]);
        for run in training..training + 1000 {
            let prediction = regression.predict(&[feature(run)]);
            let [low, high] = Distribution::new(&regression, &truths, prediction).interval(0.9);
            let half = usize::from(truth(run) > 0.5);
            all[half] += 1.0;
            held[half] += f64::from(u8::from((low..=high).contains(&truth(run))));
        }
        // Two and a half standard deviations of the coverage: 0.3/sqrt(1000) from the records, and
        // 0.3/sqrt(400) from the training.
        let coverage = (held[0] + held[1]) / 1000.0;
        assert!(
            (coverage - 0.9).abs() < 2.5 * 0.3 * (1.0_f64 / 1000.0 + 1.0 / 400.0).sqrt(),
            "{coverage}"
        );
        // The noise in the upper half is three times that in the lower half, and so are the intervals.
        assert!(
            held[0] / all[0] > 0.84 && held[1] / all[1] > 0.84,
            "{held:?} {all:?}"
        );
    }
}
