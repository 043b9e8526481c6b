//! Numbers with units, and other words of the command line.

use slipfront_case::field_info::{field_info, field_named};
use slipfront_case::quantity::{Density, Duration, Kind, Length, Pressure, Quantity, Rate, Speed};
use slipfront_study::Shard;

use crate::checks::readable;
use crate::long::many;
use crate::target::{Memory, Target, Time};

/// The text as a quantity of every dimension, as a shard and as the name of a field.
pub(crate) const QUANTITY: Target = Target {
    name: "quantity",
    check: quantity,
    generated,
    files: &[],
    dictionary: Some("quantity.dict"),
    max_bytes: 256,
    memory: Memory {
        bytes: 64 << 10,
        per_byte: 64,
    },
    time: Time::READING,
    mutations: 5000,
    repetitions: 20,
    long: || {
        vec![
            many("1", "0", " um"),
            many("0.", "0", "1 um"),
            many("1", " ", "um"),
            many("1 ", "m/", "s"),
            many("1 ", "m ", "s"),
            many("1 m^", "1", ""),
            many("1 m", "\u{b2}", ""),
            many("1 ", "\u{b5}", "m"),
            many("1 ", "x#", ""),
            many("1", "e9", " m"),
            many("", "1/", "2"),
        ]
    },
};

fn generated() -> Vec<Vec<u8>> {
    let texts = [
        "1 um",
        "25 \u{b5}m",
        "100 GPa",
        "10 g/cm^3",
        "0.0949 mm/s",
        "84 ns",
        "3e8 1/s",
        "2.7e+8 s^-1",
        "-1.5e-3 kg m^-1 s\u{207b}\u{b2}",
        "1 N/mm\u{b2}",
        "1 kg\u{b7}m^-3",
        "5 MHz",
        "1.2.3 m",
        "1e999 m",
        "1 furlong",
        "1 m/s/s",
        "1 m/s s",
        "1 m^10",
        "3/7",
        "contact_stress_star",
        "",
    ];
    texts.map(|text| text.as_bytes().to_vec()).into()
}

fn quantity(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else {
        return;
    };
    read::<_>(text.parse::<Length>(), text);
    read::<_>(text.parse::<Pressure>(), text);
    read::<_>(text.parse::<Density>(), text);
    read::<_>(text.parse::<Speed>(), text);
    read::<_>(text.parse::<Duration>(), text);
    read::<_>(text.parse::<Rate>(), text);
    if let Some(name) = field_named(text) {
        assert_eq!(field_info(name).name, text);
    }
    // This word reads the environment.
    if text == "slurm" {
        return;
    }
    match text.parse::<Shard>() {
        Ok(shard) => {
            assert_eq!(shard.to_string().parse::<Shard>().unwrap(), shard);
            assert!(!shard.holds(0) || !shard.holds(1) || shard.to_string() == "1/1");
        }
        Err(error) => readable(&error),
    }
}

/// A quantity prints as it was written, and its value reads back as the same bits.
fn read<K: Kind>(quantity: Result<Quantity<K>, impl std::error::Error>, text: &str) {
    let quantity = match quantity {
        Ok(quantity) => quantity,
        Err(error) => return readable(&error),
    };
    assert!(quantity.si().is_finite());
    assert_eq!(quantity.to_string(), text);
    assert_eq!(quantity.to_string().parse::<Quantity<K>>().unwrap(), quantity);
    let printed = Quantity::<K>::from_si(quantity.si());
    let again = printed.to_string().parse::<Quantity<K>>().unwrap();
    assert_eq!(again.si().to_bits(), quantity.si().to_bits(), "{printed}");
}
