//! Clipping: values at the end of the range of a sensor.

use serde::Serialize;
use slipfront_run::measured::MeasuredRecord;

use crate::record_noise::noise;

/// Least number of equal values that are not chance, also as a multiple of the number at the next value:
/// values of a record become rarer towards the largest one.
const EQUAL: usize = 5;

/// Values that differ by less than this share of the range of a record are equal.
const ROUNDING: f64 = 1e-9;

/// Largest distance of the next value, in standard deviations of the noise: a resolution coarser than the
/// noise makes equal values, too.
const FINE: f64 = 2.0;

/// Equal values at the end of a record's range.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Clipped {
    /// Number of the record, from 0.
    pub record: usize,
    /// Number of the values.
    pub values: usize,
    /// Number of the values as a share of the record.
    pub share: f64,
}

impl Clipped {
    /// The values of largest magnitude in the record of this number, if more of them are equal than by
    /// chance.
    pub fn find(record: usize, measured: &MeasuredRecord) -> Option<Self> {
        let mut sorted: Vec<f64> = measured.y.iter().map(|y| y.abs()).collect();
        sorted.sort_by(|one, other| other.total_cmp(one));
        let (largest, least) = (*sorted.first()?, *sorted.last()?);
        let equal_to = |value: f64| {
            let near = |y: &&f64| (**y - value).abs() <= ROUNDING * (largest - least);
            sorted.iter().filter(near).count()
        };
        let values = equal_to(largest);
        let next = *sorted.get(values)?;
        let is_fine = largest - next <= FINE * noise(&measured.y);
        (is_fine && values >= EQUAL && values > EQUAL * equal_to(next)).then(|| Self {
            record,
            values,
            share: values as f64 / sorted.len() as f64,
        })
    }
}

#[cfg(test)]
mod tests {
    use slipfront_run::measured::Measure;

    use super::*;
    use crate::synthetic_noise::{Stream, normals};

    /// Values with noise of 0.01, as a record.
    fn clipped(values: impl Iterator<Item = f64>) -> Option<Clipped> {
        let y: Vec<f64> = values.collect();
        let x = (0..y.len()).map(|k| 1e-3 * k as f64).collect();
        Clipped::find(0, &MeasuredRecord::new(x, y, Measure::Time, Measure::Coefficient))
    }

    fn noisy() -> impl Iterator<Item = f64> {
        let saw = (0..2000).map(|k| 0.3 + 1e-3 * f64::from(k % 200));
        saw.zip(normals(Stream::Noise, 1, 0)).map(|(y, z)| y + 0.01 * z)
    }

    #[test]
    fn the_end_of_a_range_is_seen_of_either_sign() {
        for sign in [1.0, -1.0] {
            let found = clipped(noisy().map(|y| sign * y.min(0.48))).unwrap();
            assert!((0.05..0.2).contains(&found.share), "{found:?}");
        }
        // The converter has a resolution of 0.002.
        let found = clipped(noisy().map(|y| 0.002 * (y.min(0.48) / 0.002).round()));
        assert!(found.is_some_and(|found| found.share > 0.05), "{found:?}");
    }

    #[test]
    fn whole_records_and_few_digits_are_not_clipped() {
        assert_eq!(clipped(noisy()), None);
        for digit in [0.002, 0.01, 0.02, 0.03, 0.05] {
            assert_eq!(clipped(noisy().map(|y| digit * (y / digit).round())), None);
        }
        // Steady sliding at one constant value to the end.
        assert_eq!(clipped((0..500).map(|k| f64::from(k.min(50)))), None);
        assert_eq!(clipped((0..500).map(|_| 1.0)), None);
    }
}
