//! The measuring chain between friction and a record: load cell, filter, sampling, gain, offset and range.

mod chain;
mod filter;
mod keys;

pub use self::chain::Instrument;
pub use self::keys::{InstrumentError, InstrumentKeys};

/// Reason why an instrument with memory cannot be combined with a held drive, and the remedy.
pub const HELD_DRIVE: &str = "a held drive has no time while blocks slide, but load cells, filters and sampling need a time: \
                              remove `drive.loading = \"held\"`, or give only gain, offset and range of the instrument";

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use slipfront_case::quantity::{Duration, Rate};
    use test_case::test_case;

    use super::*;
    use crate::measured::Measure;

    fn instrument(keys: &str) -> Instrument {
        InstrumentKeys::from_table(&keys.parse().unwrap())
            .unwrap()
            .instrument(Measure::Force)
            .unwrap()
    }

    /// Amplitude of an oscillation of this frequency after the instrument, from the last of 40 periods.
    fn gain(keys: &str, frequency: f64) -> f64 {
        const PER_PERIOD: usize = 1000;
        let time: Vec<f64> = (0..40 * PER_PERIOD)
            .map(|k| k as f64 / (PER_PERIOD as f64 * frequency))
            .collect();
        let signal: Vec<f64> = time.iter().map(|t| (TAU * frequency * t).sin()).collect();
        let found = instrument(keys).record(&time, &signal);
        let last = time.len() - PER_PERIOD;
        let part = |of: fn(f64) -> f64| {
            let products = time[last..].iter().zip(&found[last..]);
            products.map(|(t, y)| y * of(TAU * frequency * t)).sum::<f64>() * 2.0 / PER_PERIOD as f64
        };
        part(f64::sin).hypot(part(f64::cos))
    }

    /// The textbook's amplitude of each element. Linear interpolation between 1000 values per period loses
    /// (pi/1000)^2/3 of the amplitude, for the signal and again between up to three sections.
    #[test_case("filter = 'first_order'\ncutoff = '20 Hz'", |f| 1.0 / (1.0 + (f / 20.0).powi(2)).sqrt(); "first order by frequency")]
    #[test_case("filter = 'first_order'\ntime = '10 ms'", |f| 1.0 / (1.0 + (TAU * f * 0.01).powi(2)).sqrt(); "first order by time")]
    #[test_case("filter = 'butterworth'\ncutoff = '20 Hz'", |f| 1.0 / (1.0 + (f / 20.0).powi(4)).sqrt(); "second order")]
    #[test_case("filter = 'butterworth'\norder = 5\ncutoff = '20 Hz'", |f| 1.0 / (1.0 + (f / 20.0).powi(10)).sqrt(); "fifth order")]
    #[test_case("filter = 'moving_mean'\ntime = '30 ms'", |f| ((PI * f * 0.03).sin() / (PI * f * 0.03)).abs(); "moving mean")]
    #[test_case("mass = '10 g'\nstiffness = '400 N/m'\ndamping_ratio = 0.1", |f| {
        let r = TAU * f / 200.0;
        1.0 / ((1.0 - r * r).powi(2) + (0.2 * r).powi(2)).sqrt()
    }; "load cell")]
    fn swings_have_the_amplitude_of_the_textbook(keys: &str, amplitude: fn(f64) -> f64) {
        for frequency in [2.0, 13.0, 20.0, 31.0, 47.0] {
            let (found, exact) = (gain(keys, frequency), amplitude(frequency));
            assert!(
                (found - exact).abs() < 1e-5 * exact.max(1.0),
                "{frequency} {found} {exact}"
            );
        }
    }

    /// A ramp has the exact response of a first-order filter, whatever the spacing of the values.
    #[test]
    fn a_straight_signal_is_filtered_exactly() {
        let time: Vec<f64> = (0..20).map(|k| 0.03 * f64::from(k)).collect();
        let signal: Vec<f64> = time.iter().map(|t| 3.0 * t).collect();
        let found = instrument("filter = 'first_order'\ntime = '10 ms'").record(&time, &signal);
        for (t, y) in time.iter().zip(found) {
            let exact = 3.0 * (t - 0.01 * (1.0 - (-t / 0.01).exp()));
            assert!((y - exact).abs() < 1e-15, "{y} {exact}");
        }
    }

    /// A load cell with a resonance above the sampling rate stays bounded, and follows a slow signal.
    #[test]
    fn a_stiff_load_cell_changes_nothing() {
        let time: Vec<f64> = (0..1000).map(|k| 1e-2 * f64::from(k)).collect();
        let signal: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let found = instrument("mass = '1 g'\nstiffness = '1 GN/m'").record(&time, &signal);
        // The frequency is 10^6/s: a change of slope by 10^-2 causes oscillations of less than 10^-8.
        assert!(
            found
                .iter()
                .zip(&signal)
                .all(|(found, exact)| (found - exact).abs() < 1e-7)
        );
    }

    #[test]
    fn values_are_held_corrected_and_bounded() {
        let time: Vec<f64> = (0..=10).map(f64::from).collect();
        let held = instrument("sampling = '0.25 Hz'").record(&time, &time);
        assert_eq!(held, [0.0, 0.0, 0.0, 0.0, 4.0, 4.0, 4.0, 4.0, 8.0, 8.0, 8.0]);
        let bounded = instrument("gain = 2\noffset = '-500 mN'\nrange = ['0 N', 10]").record(&time, &time);
        assert_eq!(
            bounded,
            [0.0, 1.5, 3.5, 5.5, 7.5, 9.5, 10.0, 10.0, 10.0, 10.0, 10.0]
        );
    }

    /// The cutoff of a moving mean follows from its width: both keys give the same filter.
    #[test]
    fn the_bandwidth_is_the_cutoff() {
        let cutoff = |keys: &str| instrument(keys).bandwidth().unwrap();
        assert_eq!(
            cutoff("filter = 'butterworth'\norder = 3\ncutoff = '20 Hz'"),
            20.0
        );
        assert!((cutoff("filter = 'moving_mean'\ncutoff = '20 Hz'") - 20.0).abs() < 1e-13);
        assert!((gain("filter = 'moving_mean'\ncutoff = '20 Hz'", 20.0) - 0.5_f64.sqrt()).abs() < 1e-5);
        assert_eq!(
            cutoff("sampling = '100 Hz'\nfilter = 'first_order'\ncutoff = '1 kHz'"),
            50.0
        );
        assert_eq!(instrument("gain = 2").bandwidth(), None);
    }

    #[test_case("filter = 'butterworth'", "`filter`"; "no cutoff")]
    #[test_case("filter = 'butterworth'\ntime = '1 s'", "`time`"; "Butterworth by time")]
    #[test_case("filter = 'first_order'\ntime = '1 s'\ncutoff = '1 Hz'", "`time`"; "both")]
    #[test_case("filter = 'first_order'\norder = 2\ncutoff = '1 Hz'", "`order`"; "order of another filter")]
    #[test_case("filter = 'butterworth'\norder = 11\ncutoff = '1 Hz'", "`order`"; "order too high")]
    #[test_case("cutoff = '1 Hz'", "`cutoff`"; "cutoff of no filter")]
    #[test_case("filter = 'first_order'\ncutoff = '0 Hz'", "`cutoff`"; "cutoff of zero")]
    #[test_case("filter = 'butterworth'\ncutoff = '1e300 Hz'", "between 1e-18 and 1e18"; "cutoff of no filter that exists")]
    #[test_case("gain = -1e300", "`gain`"; "gain too large")]
    #[test_case("offset = nan", "`offset`"; "offset that is no number")]
    #[test_case("range = [-1e300, 1]", "`range`"; "range too wide")]
    #[test_case("mass = '1 g'", "`mass`"; "mass alone")]
    #[test_case("stiffness = '1 N/m'", "`stiffness`"; "stiffness alone")]
    #[test_case("damping_ratio = 0.1", "`damping_ratio`"; "damping of no load cell")]
    #[test_case("mass = '1 g'\nstiffness = '1 N/m'\ndamping_ratio = 1", "`damping_ratio`"; "overdamped")]
    #[test_case("sampling = '-1 Hz'", "`sampling`"; "negative rate")]
    #[test_case("gain = 0", "`gain`"; "no gain")]
    #[test_case("offset = '1 mm'", "`offset`"; "offset of another quantity")]
    #[test_case("range = [1, 1]", "`range`"; "empty range")]
    #[test_case("cuttoff = '1 Hz'", "unknown"; "unknown key")]
    fn what_is_wrong_is_said(keys: &str, sentence: &str) {
        let made = InstrumentKeys::from_table(&keys.parse().unwrap())
            .and_then(|keys| keys.instrument(Measure::Force));
        let error = made.unwrap_err().to_string();
        assert!(error.contains(sentence), "{error}");
    }

    #[test]
    fn units_are_those_of_cases() {
        assert_eq!("20 Hz".parse::<Rate>().unwrap().si(), 20.0);
        assert_eq!("10 ms".parse::<Duration>().unwrap().si(), 0.01);
    }
}
