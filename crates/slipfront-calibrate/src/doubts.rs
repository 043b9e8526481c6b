//! Properties of a record that no run of the model has, and how to correct each of them.

use std::path::Path;

use slipfront_base::number_format::with_si_prefix;
use slipfront_base::text::display_path;
use slipfront_run::measured::MeasuredRecord;

use crate::sample_points::SamplePoints;

/// Share of the largest friction: a record that begins at 0 with more than that does not begin with unloaded
/// springs.
const LOOSE: f64 = 0.25;
/// Number of standard deviations of the noise within which friction counts as constant.
const STILL: f64 = 5.0;

/// Warnings about a record that the model can hardly have made; `noise` is a share of the mean friction.
/// There are warnings about:
///
/// - a negative mean;
/// - rest after the drive starts, at 0: the line through the first points at a quarter and at half of the
///   rise to the largest friction is extrapolated back to the first value of friction. The crossing is later
///   than the time between these two points, and friction is constant within [`STILL`] standard deviations
///   until then;
/// - a record that begins at 0 with more than [`LOOSE`] of its largest friction, while the springs of a run
///   begin unloaded.
pub(crate) fn doubts(record: &MeasuredRecord, grid: &SamplePoints, noise: f64, path: &Path) -> Vec<String> {
    let (places, values) = (grid.places(), grid.record(record));
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let path = display_path(path);
    if mean < 0.0 {
        return vec![format!(
            "the mean friction of {path} is negative: `y_factor = -1` changes its sign"
        )];
    }
    let (first, largest) = (values[0], values.iter().copied().fold(values[0], f64::max));
    let unit = grid.along.unit();
    let bound = STILL * noise * mean * grid.noise_share();
    let rises = |share: f64| {
        let crossed = values
            .iter()
            .position(|value| *value >= first + share * (largest - first));
        crossed.map_or(f64::NAN, |at| places[at])
    };
    let (quarter, half) = (rises(0.25), rises(0.5));
    let rest_ends = quarter - (half - quarter);
    let rest = rest_ends - places[0].max(0.0);
    let still = places
        .iter()
        .zip(&values)
        .take_while(|(place, _)| **place < rest_ends);
    let is_still = still.clone().all(|(_, value)| (value - first).abs() < bound);
    if rest > half - quarter && still.count() >= 3 && is_still && first.abs() < 0.5 * largest {
        let zero = match first.abs() > bound {
            true => format!(
                ", and `y_offset` removes the {} there",
                with_si_prefix(first, grid.quantity.unit())
            ),
            false => String::new(),
        };
        return vec![format!(
            "{path} begins with {} of rest, but the drive of the model starts at 0: `shift = \"{}\"` moves the record to 0{zero}",
            with_si_prefix(rest, unit),
            with_si_prefix(-rest_ends, unit)
        )];
    }
    let begins_loose = record.x[0] != 0.0 || record.y[0] < LOOSE * largest;
    if begins_loose {
        return Vec::new();
    }
    vec![format!(
        "{path} begins at 0 with {:.0} % of its largest friction, but the springs of the model start unloaded. If the record \
         begins during sliding, add the previous {} of the drive with `shift`; if it has an offset, correct it with `y_offset`",
        100.0 * record.y[0] / largest,
        match unit {
            "s" => "time",
            _ => "displacement",
        }
    )]
}

#[cfg(test)]
mod tests {
    use slipfront_run::measured::Measure;
    use test_case::test_case;

    use super::*;

    /// Warnings about a record of 200 values from `start` on, with a stated noise of 1 %. Friction is `curve`
    /// with pseudorandom noise of up to `noise`.
    fn doubts_of(start: f64, noise: f64, curve: impl Fn(f64) -> f64) -> Vec<String> {
        let x: Vec<f64> = (0..200).map(|k| start + 0.01 * f64::from(k)).collect();
        let noise = |k: usize| noise * ((k * 7919 % 200) as f64 / 100.0 - 1.0);
        let y = x.iter().enumerate().map(|(k, x)| curve(*x) + noise(k)).collect();
        let record = MeasuredRecord::new(x, y, Measure::Time, Measure::Coefficient);
        let grid = SamplePoints::from_record(&record).unwrap();
        doubts(&record, &grid, 0.01, Path::new("r.csv"))
    }

    /// Friction that rises to 1 within 0.2 s after `start`, and then falls to 0.8.
    fn slide(start: f64) -> impl Fn(f64) -> f64 {
        move |x| {
            if x < start + 0.2 {
                5.0 * (x - start).max(0.0)
            } else {
                0.8
            }
        }
    }

    #[test_case(0.0; "loading")]
    #[test_case(-0.5; "rest before the drive begins")]
    #[test_case(0.5; "a part of the slide")]
    fn records_of_the_model_are_not_doubtful(start: f64) {
        assert!(doubts_of(start, 0.01, slide(0.0)).is_empty());
    }

    #[test]
    fn the_other_sign_is_told() {
        assert!(doubts_of(0.0, 0.01, |x| -slide(0.0)(x))[0].contains("`y_factor = -1`"));
    }

    #[test]
    fn a_slide_that_begins_at_0_is_told() {
        let doubts = doubts_of(0.0, 0.005, |x| 0.5 * slide(0.0)(x) + 0.4);
        assert!(doubts[0].starts_with("r.csv begins at 0 with 4"), "{doubts:?}");
    }

    /// Half a second of rest, without and with an offset of the load cell.
    #[test_case(0.0, ""; "zero")]
    #[test_case(0.2, ", and `y_offset` removes the "; "offset")]
    fn rest_is_told(offset: f64, words: &str) {
        let doubts = doubts_of(0.0, 0.005, |x| offset + slide(0.5)(x));
        assert!(
            doubts[0].contains(" of rest, but the drive of the model starts at 0: `shift = \"-"),
            "{doubts:?}"
        );
        assert!(
            doubts[0].contains(words) && doubts[0].contains("y_offset") == (offset > 0.0),
            "{doubts:?}"
        );
    }
}
