//! Tests of quantities: accepted spellings, prefixes of units, and messages.

use proptest::prelude::*;

use super::*;

fn error<K: Kind>(text: &str) -> String {
    text.parse::<Quantity<K>>().unwrap_err().to_string()
}

#[test]
fn accepted_spellings() {
    let length = |text: &str| text.parse::<Length>().unwrap().si();
    for text in [
        "1 um",
        "1um",
        "1 \u{b5}m",
        "1\u{3bc}m",
        "1e-3 mm",
        "  1.0e+0   um ",
        "+1 um",
        "1000e-3um",
        ".1e1 um",
    ] {
        assert_eq!(length(text), 1e-6, "{text}");
    }
    assert_eq!(length("1e-3 m"), 1e-3);
    assert_eq!(length("-2.5 cm"), -0.025);
    assert_eq!(length("3 fm"), 3e-15);
    assert_eq!(length("2 Mm"), 2e6);
    for text in [
        "2500 kg/m^3",
        "2.5 g/cm^3",
        "2.5 g cm^-3",
        "2.5 g\u{b7}cm\u{207b}\u{b3}",
        "2.5e3 kg/m\u{b3}",
        "2.5e3 kg/m/m/m",
    ] {
        assert_eq!(text.parse::<Density>().unwrap().si(), 2500.0, "{text}");
    }
    for text in [
        "1e5 Pa",
        "100kPa",
        "1 bar",
        "0.1 N/mm^2",
        "1e5 N*m^-2",
        "1e5 kg/m/s^2",
        "1000 hPa",
    ] {
        assert_eq!(text.parse::<Pressure>().unwrap().si(), 1e5, "{text}");
    }
    for text in [
        "5 1/s",
        "5/s",
        "5 /s",
        "5 Hz",
        "5 s^-1",
        "0.005 ms^-1",
        "5 s\u{207b}\u{b9}",
    ] {
        assert_eq!(text.parse::<Rate>().unwrap().si(), 5.0, "{text}");
    }
    assert_eq!("0.0949 mm/s".parse::<Speed>().unwrap().si(), 0.0000949);
    assert_eq!("84 ns".parse::<Duration>().unwrap().si(), 84e-9);
    assert_eq!("0 ns".parse::<Duration>().unwrap().si(), 0.0);
}

#[test]
fn every_prefix_with_every_unit() {
    for (unit, dimension, power) in UNITS {
        assert_eq!(find_symbol(unit), Some((dimension, power)));
        for (prefix, shift) in PREFIXES {
            assert_eq!(
                find_symbol(&format!("{prefix}{unit}")),
                Some((dimension, power + shift)),
                "{prefix}{unit}"
            );
        }
    }
    for unknown in [
        "min", "h", "mm2", "in", "J", "W", "kk", "um2", "", "1", "mum", "dam", "Em",
    ] {
        assert_eq!(find_symbol(unknown), None, "{unknown}");
    }
}

#[test]
fn messages_say_what_to_write() {
    assert_eq!(
        error::<kind::Pressure>("3 mm/s"),
        "\"3 mm/s\" is a speed (m s^-1); give a pressure, such as \"100 kPa\""
    );
    assert_eq!(
        error::<kind::Pressure>("100"),
        "100 has no unit; write a pressure as a string with its unit, such as \"100 kPa\""
    );
    assert_eq!(
        error::<kind::Pressure>("100 kpa"),
        "unknown unit `kpa` in \"100 kpa\": did you mean `kPa`?"
    );
    // Of units that differ by capitals alone, the one with the usual size.
    for (said, near) in [("2 mpa", "MPa"), ("0.5 MPA", "MPa"), ("210000 mpa", "MPa")] {
        assert!(
            error::<kind::Pressure>(said).ends_with(&format!("did you mean `{near}`?")),
            "{said}"
        );
    }
    assert!(error::<kind::Duration>("5 MS").ends_with("did you mean `ms`?"));
    assert!(error::<kind::Force>("30 mn").ends_with("did you mean `mN`?"));
    assert!(error::<kind::Length>("3 parsec").contains("the units are m, g"));
    assert!(error::<kind::Length>("3 m^2").contains("is another quantity (m^2)"));
    assert!(error::<kind::Length>("3 m/m").contains("is another quantity (1)"));
    assert!(error::<kind::Length>("3 m^x").contains("a power is a whole number"));
    assert!(error::<kind::Length>("3 m^").contains("a power is a whole number"));
    assert!(error::<kind::Length>("3 m^99999999999").contains("a power is a whole number"));
    assert!(error::<kind::Density>("3 kg/m m^2").contains("ambiguous"));
    for text in ["3 m/", "3 /", "3 m//s", "3 *"] {
        assert!(error::<kind::Speed>(text).contains("a unit is missing"), "{text}");
    }
    for text in [
        "nan m", "inf m", "-inf m", "m", "", "- m", ". m", "1.2.3 m", "x m",
    ] {
        assert!(
            error::<kind::Length>(text).contains("does not begin with a number"),
            "{text}"
        );
    }
    for text in ["1e999 m", "1e99999999999999999999 m", "1e308 km"] {
        assert!(error::<kind::Length>(text).contains("too large"), "{text}");
    }
    for text in ["1e-999 m", "1e-99999999999999999999 m", "1e-323 fm"] {
        assert!(error::<kind::Length>(text).contains("too small"), "{text}");
    }
    assert!(error::<kind::Length>(&"1".repeat(201)).contains("201 bytes"));
}

/// A suggestion has the wanted dimension, and a known foreign unit is converted.
#[test]
fn suggestions_are_of_the_wanted_dimension() {
    let psi = error::<kind::Pressure>("5 psi");
    assert_eq!(psi, "unknown unit `psi` in \"5 psi\": write \"34473.8 Pa\"");
    for (said, written) in [
        (error::<kind::Speed>("1 m/min"), "0.0166667 m/s"),
        (error::<kind::Speed>("36 km/h"), "10 m/s"),
        (error::<kind::Duration>("3 min"), "180 s"),
        (error::<kind::Length>("5 A"), "5e-10 m"),
        (error::<kind::Density>("7.8 g/cc"), "7800 kg/m^3"),
        (error::<kind::Pressure>("1 kgf/cm^2"), "98066.5 Pa"),
    ] {
        assert!(said.ends_with(&format!("write \"{written}\"")), "{said}");
    }
    // The suggestion can be read, and equals the original value to the six digits that are printed.
    for (symbol, dimension, size) in FOREIGN_UNITS {
        if dimension == Pressure::DIMENSION {
            let said = error::<kind::Pressure>(&format!("3 {symbol}"));
            let written = said.split('"').nth(3).unwrap();
            let read = written.parse::<Pressure>().unwrap().si();
            assert!((read / (3.0 * size) - 1.0).abs() < 5e-6, "{said}");
        }
    }
    assert!(error::<kind::Pressure>("3 lbf").contains("is a force"));
    assert!(error::<kind::Speed>("3 m/x").contains("write it as in \"0.0949 mm/s\""));
    assert!(error::<kind::Pressure>("1 N/mm2").ends_with("did you mean `mm^2`?"));
    assert!(error::<kind::Speed>("1,5 mm/s").ends_with("the decimal sign is a point"));
    assert!(error::<kind::Pressure>("1 N/mm3").contains("write it as in"));
    assert!(error::<kind::Pressure>("1 kPaa").ends_with("did you mean `kPa`?"));
    // `ps` is not a pressure; of `mN` and `ms`, only the second is a time.
    assert!(error::<kind::Pressure>("5 psy").contains("write it as in \"100 kPa\""));
    assert!(error::<kind::Speed>("1 m/mn").ends_with("did you mean `ms`?"));
}

#[test]
fn a_bare_toml_number_is_refused_with_advice() {
    for (toml, value) in [
        ("x = 100", "100"),
        ("x = 0.5", "0.5"),
        ("x = nan", "NaN"),
        ("x = 18446744073709551615", "1844"),
    ] {
        let error = toml::from_str::<std::collections::BTreeMap<String, Pressure>>(toml).unwrap_err();
        assert!(error.message().starts_with(value), "{error}");
        assert!(error.message().contains("such as \"100 kPa\""), "{error}");
    }
}

/// `digits` x 10^`exponent` in positional notation, so that the reader sees no exponent.
fn positional(digits: u64, exponent: i32) -> String {
    let zeros = |n: i32| "0".repeat(usize::try_from(n).unwrap_or(0));
    let digits = digits.to_string();
    if exponent >= 0 {
        return digits + &zeros(exponent);
    }
    let padded = zeros(1 - exponent - digits.len() as i32) + &digits;
    let point = padded.len() - exponent.unsigned_abs() as usize;
    format!("{}.{}", &padded[..point], &padded[point..])
}

proptest! {
    #[test]
    fn rounds_once(digits in any::<u64>(), exponent in -30..30_i32, unit in 0..PREFIXES.len()) {
        let (prefix, shift) = PREFIXES[unit];
        let read: Length = format!("{digits}e{exponent} {prefix}m").parse().unwrap();
        let exact: f64 = positional(digits, exponent + shift).parse().unwrap();
        prop_assert_eq!(read.si().to_bits(), exact.to_bits());
    }

    #[test]
    fn the_nearest_double_is_found(digits in 1..1_000_000_000_u64) {
        let read = format!("{digits} um").parse::<Length>().unwrap().si();
        // read = mantissa x 2^-e. In whole numbers: mantissa x 10^6 lies within half a spacing of digits x
        // 2^e.
        let bits = read.to_bits();
        let e = 1075 - (bits >> 52);
        let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
        let distance = (u128::from(digits) << e).abs_diff(mantissa * 1_000_000);
        prop_assert!(2 * distance <= 1_000_000, "{digits}: {distance}");
    }

    #[test]
    fn print_and_read_is_the_identity(si in any::<f64>().prop_filter("finite", |x| x.is_finite())) {
        let printed = Density::from_si(si);
        prop_assert_eq!(printed.to_string().parse::<Density>().unwrap(), printed);
    }

    #[test]
    fn no_text_panics(text in "\\PC*", unit in "[0-9eE.+ */^-]{0,6}[a-zA-Z\u{b5}\u{b2}\u{207b} */^]{0,12}") {
        let _ = text.parse::<Length>();
        let _ = unit.parse::<Rate>();
    }
}
