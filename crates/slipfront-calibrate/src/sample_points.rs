//! Sample points of a record, times or displacements, at which it is compared with the curves of runs. Values
//! that are interpolated between those of a record would have less noise.

use std::sync::Arc;

use slipfront_run::instrument::Instrument;
use slipfront_run::interpolation::interpolate;
use slipfront_run::measured::{Measure, MeasuredRecord};
use slipfront_run::run_curve::RunCurve;

use crate::features::MIN_VALUES;

/// Largest number of values of a curve for the features: more values are averaged over neighbours.
const MAX_VALUES: usize = 400;

/// Places at which friction of a record is known.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplePoints {
    /// Quantity of the places: time or displacement.
    pub(crate) along: Measure,
    /// Quantity at the places: force or coefficient.
    pub(crate) quantity: Measure,
    /// Places of the values of the record, in ascending order.
    x: Arc<[f64]>,
    /// Number of neighbouring values that are averaged.
    merged: usize,
    /// Least and largest value that the instrument can record.
    pub(crate) range: Option<[f64; 2]>,
}

impl SamplePoints {
    /// The places of the values of a record; none for a record that is too short or does not advance.
    pub fn from_record(record: &MeasuredRecord) -> Option<Self> {
        Self::at(record.along, record.quantity, record.x.clone())
    }

    /// The places of a planned record of coefficients, `count` equal steps from 0 to `end`; none if they are
    /// too few, or `end` is not positive.
    pub(crate) fn planned(along: Measure, end: f64, count: usize) -> Option<Self> {
        let step = end / (count.max(2) - 1) as f64;
        Self::at(
            along,
            Measure::Coefficient,
            (0..count).map(|k| k as f64 * step).collect(),
        )
    }

    fn at(along: Measure, quantity: Measure, x: Vec<f64>) -> Option<Self> {
        (x.len() >= MIN_VALUES && x.last() > x.first()).then(|| Self {
            along,
            quantity,
            merged: x.len().div_ceil(MAX_VALUES),
            x: x.into(),
            range: None,
        })
    }

    /// The places of a record that is `times` times as long, with the same spacing: these places, repeated
    /// one after the other.
    pub(crate) fn longer(&self, times: usize) -> Self {
        let again = self.end() + self.mean_step() - self.x[0];
        let x = (0..times).flat_map(|part| self.x.iter().map(move |x| x + part as f64 * again));
        Self {
            merged: (times * self.x.len()).div_ceil(MAX_VALUES),
            x: x.collect(),
            ..self.clone()
        }
    }

    fn mean_step(&self) -> f64 {
        (self.end() - self.x[0]) / (self.x.len() - 1) as f64
    }

    /// Adds everything that determines the values at the places to a hash.
    pub(crate) fn add_to(&self, hasher: &mut blake3::Hasher) {
        let Self {
            along,
            quantity,
            x,
            merged,
            range,
        } = self;
        hasher.update(format!("{along:?}{quantity:?}{merged}{range:?}").as_bytes());
        for place in x.iter() {
            hasher.update(&place.to_le_bytes());
        }
    }

    /// The sample points over the same path of a drive that takes `times` times as long; displacements are
    /// unchanged.
    pub(crate) fn slower(&self, times: f64) -> Self {
        let times = if self.along == Measure::Time { times } else { 1.0 };
        Self {
            x: self.x.iter().map(|x| times * x).collect(),
            ..self.clone()
        }
    }

    /// The first place.
    pub(crate) fn begin(&self) -> f64 {
        self.x[0]
    }

    /// The last place.
    pub fn end(&self) -> f64 {
        self.x.last().copied().unwrap_or(f64::NAN)
    }

    /// Number of averages, the values of a curve.
    pub(crate) fn n_values(&self) -> usize {
        self.x.len() / self.merged
    }

    /// Standard deviation of the noise of an average over that of a value.
    pub(crate) fn noise_share(&self) -> f64 {
        1.0 / (self.merged as f64).sqrt()
    }

    /// Places of the averages.
    pub fn places(&self) -> Vec<f64> {
        self.merge(&self.x)
    }

    /// The values of a record with these places, averaged over neighbours.
    pub fn record(&self, record: &MeasuredRecord) -> Vec<f64> {
        self.merge(&record.y)
    }

    /// The curve of a run in the form of a record, as an instrument records it; none if the run ends earlier
    /// than the record, or its friction is a torque.
    pub(crate) fn curve(&self, curve: &RunCurve, instrument: Option<&Instrument>) -> Option<Vec<f64>> {
        let x = curve.along(self.along);
        // Rounding may end a run slightly before the last place.
        if *x.last()? < self.end() - 0.5 * self.mean_step() {
            return None;
        }
        let unit = match self.quantity {
            Measure::Force => curve.unit_force?,
            _ => 1.0,
        };
        let friction: Vec<f64> = curve.coefficient.iter().map(|value| value * unit).collect();
        let Some(instrument) = instrument else {
            return Some(self.averages(x, &friction));
        };
        Some(self.averages(x, &instrument.record(&curve.time, &friction)))
    }

    /// The first places, up to a share of all.
    pub(crate) fn beginning(&self, share: f64) -> Self {
        let values = (share * self.n_values() as f64) as usize;
        Self {
            x: self.x[..self.merged * values.max(1)].into(),
            ..self.clone()
        }
    }

    /// Standard deviation of the noise of a curve at the places; `noise` is that of a value of the record, as
    /// a share of the mean.
    pub(crate) fn deviation(&self, curve: &[f64], noise: f64) -> f64 {
        let share = noise * self.noise_share();
        share * curve.iter().sum::<f64>().abs() / curve.len() as f64
    }

    /// Adds white noise to a curve at the places: for a value of the record, the standard deviation is the
    /// share `noise` of the mean. The result is limited to the range of the instrument.
    pub(crate) fn noisy(&self, curve: &[f64], noise: f64, normals: impl Iterator<Item = f64>) -> Vec<f64> {
        let deviation = self.deviation(curve, noise);
        let mut values: Vec<f64> = curve
            .iter()
            .zip(normals)
            .map(|(y, z)| y + deviation * z)
            .collect();
        if let Some([low, high]) = self.range {
            values
                .iter_mut()
                .for_each(|value| *value = value.clamp(low, high));
        }
        values
    }

    /// Means over neighbours of y, interpolated between the values at x, which are in ascending order.
    fn averages(&self, x: &[f64], y: &[f64]) -> Vec<f64> {
        let values = self.x.iter().map(|&place| interpolate(x, y, place));
        self.merge(&values.collect::<Vec<_>>())
    }

    /// Means over neighbours.
    fn merge(&self, values: &[f64]) -> Vec<f64> {
        let means = values.chunks_exact(self.merged);
        means
            .map(|chunk| chunk.iter().sum::<f64>() / self.merged as f64)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(count: usize) -> MeasuredRecord {
        let x: Vec<f64> = (0..count).map(|k| 0.5 * k as f64).collect();
        let y = x.iter().map(|x| 3.0 * x).collect();
        MeasuredRecord::new(x, y, Measure::Time, Measure::Coefficient)
    }

    /// Values that are interpolated between those of a record would have less noise.
    #[test]
    fn a_record_is_itself_whatever_its_steps_are() {
        let mut record = record(50);
        for (k, x) in record.x.iter_mut().enumerate() {
            *x += 0.1 * (k as f64).sin();
        }
        let grid = SamplePoints::from_record(&record).unwrap();
        assert_eq!((grid.places(), grid.record(&record)), (record.x, record.y));
    }

    #[test]
    fn a_longer_record_goes_on_in_its_steps() {
        let grid = SamplePoints::planned(Measure::Time, 9.9, 100).unwrap().longer(2);
        let places = grid.places();
        assert!(
            places.len() == 200
                && places
                    .iter()
                    .enumerate()
                    .all(|(k, x)| (x - 0.1 * k as f64).abs() < 1e-12)
        );
    }

    #[test]
    fn neighbours_of_a_long_record_are_averaged() {
        let record = record(1000);
        let grid = SamplePoints::from_record(&record).unwrap();
        let (places, values) = (grid.places(), grid.record(&record));
        assert_eq!((places.len(), places[0], places[1]), (333, 0.5, 2.0));
        assert!(places.iter().zip(values).all(|(x, y)| (y - 3.0 * x).abs() < 1e-9));
        assert_eq!(grid.noise_share(), 1.0 / 3.0_f64.sqrt());
    }

    #[test]
    fn what_has_no_length_has_no_grid() {
        let still = MeasuredRecord::new(vec![1.0; 100], vec![1.0; 100], Measure::Time, Measure::Force);
        assert_eq!(SamplePoints::from_record(&still), None);
        assert_eq!(SamplePoints::from_record(&record(MIN_VALUES - 1)), None);
    }

    #[test]
    fn a_run_that_ends_too_soon_has_no_curve() {
        let record = record(50);
        let grid = SamplePoints::from_record(&record).unwrap();
        let mut run = RunCurve {
            displacement: record.x.clone(),
            time: record.x,
            coefficient: record.y,
            unit_force: None,
        };
        assert!(grid.curve(&run, None).is_some());
        run.time.truncate(48);
        assert_eq!(grid.curve(&run, None), None);
    }
}
