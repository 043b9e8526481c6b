//! Numbers as text for people: for messages, reports and tables that no program reads back.

/// A number with all its digits; very small or large ones with a power of ten: 10, 0.9058, 1e-12.
pub fn exact(number: f64) -> String {
    let size = number.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) {
        format!("{number:e}")
    } else {
        format!("{number}")
    }
}

/// A number to four digits, without trailing zeros.
pub fn four_digits(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        return format!("{value:.3e}");
    }
    let digits = (3 - libm::log10(value.abs().max(1e-9)).floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// A number to four decimal places, or to four digits where it is too small for four places.
pub fn four_places(value: f64) -> String {
    if value != 0.0 && value.abs() < 1e-3 {
        four_digits(value)
    } else {
        format!("{value:.4}")
    }
}

/// A value and its uncertainty, both rounded to the second digit of the uncertainty; to four places if there
/// is no uncertainty.
pub fn with_uncertainty(value: f64, uncertainty: Option<f64>) -> String {
    match uncertainty {
        Some(error) if error > 0.0 => {
            let places = (1 - libm::log10(error).floor() as i32).clamp(0, 12) as usize;
            format!("{value:.places$} \u{b1} {error:.places$}")
        }
        Some(_) => format!("{} \u{b1} 0", four_places(value)),
        None => four_places(value),
    }
}

/// A value and the half width of its interval, both rounded to the third digit of the value, or to the second
/// digit of the half width if that is coarser. A half width below this place is rounded to its own first
/// digit. If the larger of the two is very small or large, both are in brackets before the power of ten.
pub fn with_half_width(value: f64, half: Option<f64>) -> String {
    let Some(half) = half else {
        return four_places(value);
    };
    let decade = |number: f64| libm::log10(number.abs()).floor();
    let size = value.abs().max(half);
    if size != 0.0 && !(-3.0..6.0).contains(&decade(size)) {
        let scale = libm::pow(10.0, decade(size));
        let scaled = with_half_width(value / scale, Some(half / scale));
        return format!("({scaled})e{}", decade(size));
    }
    let place = |number: f64, digit: f64| {
        let place = if number == 0.0 {
            12.0
        } else {
            digit - 1.0 - decade(number)
        };
        place.clamp(0.0, 12.0) as usize
    };
    let places = place(value, 3.0).min(place(half, 2.0));
    let smallest = 0.5 * 0.1_f64.powi(places as i32);
    let half_places = if half < smallest { place(half, 1.0) } else { places };
    match half {
        0.0 => format!("{value:.places$} \u{b1} 0"),
        _ => format!("{value:.places$} \u{b1} {half:.half_places$}"),
    }
}

/// A value to `digits` places with the half width of its interval; a value below half the last place as a
/// power of ten.
pub fn with_interval(value: f64, interval: Option<[f64; 2]>, digits: usize) -> String {
    let small = value != 0.0 && value.abs() < 0.5 * 0.1_f64.powi(digits as i32);
    let value = if value == 0.0 {
        "0".to_owned()
    } else if small {
        format!("{value:.1e}")
    } else {
        format!("{value:.digits$}")
    };
    match interval {
        Some([low, high]) if high > low => {
            let half = 0.5 * (high - low);
            format!("{value} \u{b1} {half:.digits$}")
        }
        _ => value,
    }
}

/// A quantity to four digits, with an SI prefix: 0.025 s is `25 ms`.
pub fn with_si_prefix(value: f64, unit: &str) -> String {
    let (factor, prefix) = si_prefix(value);
    format!("{} {prefix}{unit}", four_digits(value / factor))
}

/// The SI prefix of a quantity of this size, and its factor; none for 0 and NaN.
pub fn si_prefix(value: f64) -> (f64, &'static str) {
    const PREFIXES: [&str; 13] = ["a", "f", "p", "n", "u", "m", "", "k", "M", "G", "T", "P", "E"];
    if !value.is_normal() {
        return (1.0, "");
    }
    let step = (libm::log10(value.abs()) / 3.0 + 1e-9).floor().clamp(-6.0, 6.0);
    (libm::pow(1000.0, step), PREFIXES[(step + 6.0) as usize])
}

/// SI prefix as figures print it.
pub fn in_print(prefix: &'static str) -> &'static str {
    if prefix == "u" { "\u{b5}" } else { prefix }
}

/// A number of things: 1 block, 2 blocks.
pub fn count(number: usize, thing: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {thing}{ending}")
}

/// A number of things and its verb: 1 block is, 2 blocks are.
pub fn are(number: usize, thing: &str) -> String {
    let verb = if number == 1 { "is" } else { "are" };
    format!("{} {verb}", count(number, thing))
}

/// A number of bytes: 22.9 GiB.
pub fn byte_size(bytes: f64) -> String {
    const UNITS: [&str; 7] = ["B", "KiB", "MiB", "GiB", "TiB", "PiB", "EiB"];
    let power = ((libm::log2(bytes.max(1.0)) / 10.0) as usize).min(UNITS.len() - 1);
    let digits = usize::from(power > 0);
    format!("{:.digits$} {}", bytes / 1024f64.powi(power as i32), UNITS[power])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_keep_what_counts() {
        assert_eq!(
            [10.0, 0.9058, 1e-12, -2e6].map(exact),
            ["10", "0.9058", "1e-12", "-2e6"]
        );
        assert_eq!(
            [0.0, 0.5, 12.3456, 1e7].map(four_digits),
            ["0", "0.5", "12.35", "1.000e7"]
        );
        assert_eq!([0.70631, 0.0001].map(four_places), ["0.7063", "1.000e-4"]);
        assert_eq!(with_uncertainty(0.70631, Some(0.0123)), "0.706 \u{b1} 0.012");
        assert_eq!(with_uncertainty(0.70631, Some(0.0)), "0.7063 \u{b1} 0");
        for (value, half, text) in [
            (37.80163, 0.00039, "37.8 \u{b1} 0.0004"),
            (22.79, 0.37, "22.8 \u{b1} 0.4"),
            (0.89194, 0.00116, "0.892 \u{b1} 0.001"),
            (0.865, 0.0531, "0.865 \u{b1} 0.053"),
            (37.8, 41.0, "38 \u{b1} 41"),
            (0.0, 2.5, "0.0 \u{b1} 2.5"),
            (0.5, 0.0, "0.500 \u{b1} 0"),
            (2.33e-8, 4.2e-10, "(2.33 \u{b1} 0.04)e-8"),
            (0.0, 2.5e-11, "(0.0 \u{b1} 2.5)e-11"),
            (-3e-5, 4.2e-4, "(-0.3 \u{b1} 4.2)e-4"),
            (2e-4, 0.53, "0.00 \u{b1} 0.53"),
        ] {
            assert_eq!(with_half_width(value, Some(half)), text);
        }
        assert_eq!(with_half_width(0.89194, None), "0.8919");
        assert_eq!([1, 2].map(|n| are(n, "block")), ["1 block is", "2 blocks are"]);
        assert_eq!(with_interval(0.5, Some([0.4, 0.6]), 2), "0.50 \u{b1} 0.10");
        assert_eq!(with_interval(0.001, None, 2), "1.0e-3");
        assert_eq!(with_si_prefix(0.025, "s"), "25 ms");
        assert_eq!(with_si_prefix(0.0, "s"), "0 s");
        assert_eq!(with_si_prefix(1e-308, "s"), "1.000e-308 s");
        assert_eq!(
            [0, 1, 2].map(|n| count(n, "block")),
            ["0 blocks", "1 block", "2 blocks"]
        );
    }

    #[test]
    fn bytes_have_the_unit_that_suits_them() {
        for (bytes, text) in [
            (0.0, "0 B"),
            (1023.0, "1023 B"),
            (1024.0, "1.0 KiB"),
            (24.6e9, "22.9 GiB"),
            (1e30, "867361737988.4 EiB"),
        ] {
            assert_eq!(byte_size(bytes), text);
        }
    }
}
