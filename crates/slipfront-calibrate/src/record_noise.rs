//! The noise of the values of a record, and its fastest change of friction.

use slipfront_run::measured::MeasuredRecord;

use crate::features::quantiles;
use slipfront_study::statistics::mean;

/// Smallest change of friction that is not attributed to noise, in standard deviations of the noise.
const CHANGE: f64 = 12.0;

/// Standard deviation of the noise of a record, from its second differences. Where friction is linear over
/// three values, their standard deviation is sqrt(6) times that of the noise. Half of the values of a normal
/// distribution exceed 0.6745 standard deviations in magnitude.
pub(crate) fn noise(y: &[f64]) -> f64 {
    let second = y.windows(3).map(|y| (y[0] - 2.0 * y[1] + y[2]).abs());
    quantiles(&second.collect::<Vec<_>>(), [0.5])[0] / (0.6745 * 6.0_f64.sqrt())
}

/// Standard deviation of the noise of a record over its mean friction.
pub fn noise_share(record: &MeasuredRecord) -> f64 {
    noise(&record.y) / mean(&record.y).abs()
}

/// Number of standard errors by which the noise of a record must be below the stated noise to count as less.
const CERTAIN: f64 = 3.0;

/// Standard deviation, over mean friction, of the noise that has to be added to a record to reach the stated
/// noise; 0 if the difference may be chance. The relative error of the standard deviation of n values is
/// about 1/sqrt(n).
pub(crate) fn missing_noise(record: &MeasuredRecord, stated: f64) -> f64 {
    let own = noise_share(record);
    let most = own * (1.0 + CERTAIN / (record.y.len() as f64).sqrt());
    match most < stated {
        true => (stated * stated - own * own).sqrt(),
        false => 0.0,
    }
}

/// Frequency in Hz of a sinusoid with the range and the fastest rate of change of the record:
/// `f = rate/(pi range)`. The rate is taken over the shortest time in which friction changes by more than
/// noise does; none if there is no such change.
pub(crate) fn fastest_swing(record: &MeasuredRecord) -> Option<f64> {
    let (x, y) = (&record.x, &record.y);
    let [low, high] = quantiles(y, [0.0, 1.0]);
    let least = CHANGE * noise(y);
    let mut distance = 1;
    while distance < y.len() {
        let rates = (distance..y.len()).filter_map(|k| {
            let change = (y[k] - y[k - distance]).abs();
            let time = x[k] - x[k - distance];
            (change > least && time > 0.0).then(|| change / time)
        });
        if let Some(fastest) = rates.max_by(f64::total_cmp) {
            return Some(fastest / (std::f64::consts::PI * (high - low)));
        }
        distance *= 2;
    }
    None
}

#[cfg(test)]
mod tests {
    use slipfront_run::measured::Measure;

    use super::*;
    use crate::synthetic_noise::{Stream, normals};

    fn record(y: Vec<f64>) -> MeasuredRecord {
        let x = (0..y.len()).map(|k| 1e-3 * k as f64).collect();
        MeasuredRecord::new(x, y, Measure::Time, Measure::Coefficient)
    }

    /// A sinusoid of 14 Hz and amplitude 0.1 about 0.5, sampled every millisecond. Over 8 ms it changes by
    /// more than twelve times the noise. The mean rate over that time is (2 pi 14 0.004)^2/6 = 2 % less than
    /// the largest rate, and noise adds some 3 standard deviations to such a change.
    #[test]
    fn a_swing_has_its_frequency_and_its_noise() {
        let swing = |k: usize| 0.5 + 0.1 * (std::f64::consts::TAU * 0.014 * k as f64).sin();
        let noise = normals(Stream::Noise, 1, 0);
        let found = record(
            (0..2000)
                .map(swing)
                .zip(noise)
                .map(|(y, z)| y + 0.005 * z)
                .collect(),
        );
        let frequency = fastest_swing(&found).unwrap();
        assert!((frequency / 14.0 - 1.0).abs() < 0.3, "{frequency}");
        // 2000 values give a standard deviation to 2 %; the curvature of the sinusoid adds
        // `0.1 (2 pi 0.014)^2` to 0.012.
        let share = noise_share(&found);
        assert!((share / 0.01 - 1.0).abs() < 0.1, "{share}");
    }

    /// 2000 values give a standard deviation to 2 %: where 1 % is stated, noise is missing below 0.94 %.
    #[test]
    fn a_quiet_record_lacks_noise() {
        let with = |noise: f64| {
            let normals = normals(Stream::Noise, 1, 0).take(2000);
            record(normals.map(|z| 0.5 * (1.0 + noise * z)).collect())
        };
        assert_eq!(missing_noise(&with(0.0), 0.01), 0.01);
        assert_eq!(missing_noise(&with(0.01), 0.01), 0.0);
        assert_eq!(missing_noise(&with(0.03), 0.01), 0.0);
        let missing = missing_noise(&with(0.006), 0.01);
        assert!((missing / 0.008 - 1.0).abs() < 0.1, "{missing}");
    }

    #[test]
    fn noise_alone_has_no_swing() {
        let noise = normals(Stream::Noise, 1, 0).take(500);
        assert_eq!(
            fastest_swing(&record(noise.map(|z| 1.0 + 0.01 * z).collect())),
            None
        );
    }
}
