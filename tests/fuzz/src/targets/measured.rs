//! Tables of measured records, as instruments write them.

use std::path::Path;

use slipfront_case::table::{TableLayout, TableOptions};
use slipfront_run::measured::{Column, Measure, MeasuredRecord};

use crate::checks::readable;
use crate::long::many;
use crate::target::{Memory, Target, Time};

/// Tables of text with lines of an instrument above them, of any encoding.
pub(crate) const MEASURED: Target = Target {
    name: "measured",
    check: measured,
    generated,
    files: &["cases/calibrations/basalt.csv"],
    dictionary: Some("table.dict"),
    max_bytes: 4096,
    // Every field of the head is looked at, with 24 bytes in a list that grows, for one separator after the
    // other; a row of two columns is two numbers.
    memory: Memory {
        bytes: 256 << 10,
        per_byte: 128,
    },
    time: Time::READING,
    mutations: 1000,
    repetitions: 20,
    long,
};

fn generated() -> Vec<Vec<u8>> {
    let texts = [
        "time_s,force_n\n0,1\n1,2\n",
        "Test;7\nDate;2024-01-01\n\nZeit;Kraft\ns;mN\n0;0,5\n1;1,25\n2;\nEnd\n",
        "t / ms\tF / N\r\n0\t1\r\n1\t2\r\n",
        "# t mu\n0.0 0.5\n1e-1  0.6\n",
        "\"Time, s\",\"COF, -\"\n10:00:01,0.5\n10:00:02.5,0.6\n",
        "t;F\n1;997\n2;1,050\n",
        "0,000,0,0000\n0,500,0,0175\n",
        "u (um),mu [-]\n0.1,1\n0.05,1\n0.2,1\n0.3,1\n9,2\n",
    ];
    let utf_16 = "t (\u{b5}s);F (N)\n0;1\n1;2\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes);
    let latin = b"t (\xb5s);F (N)\n0;1\n1;2\n".to_vec();
    let mut seeds: Vec<Vec<u8>> = texts.iter().map(|text| text.as_bytes().to_vec()).collect();
    seeds.extend([utf_16.collect(), latin]);
    seeds
}

fn long() -> Vec<Vec<u8>> {
    vec![
        many("t,F\n", "#,1\n", ""),
        many("a", ",b#", "\n1\n2\n"),
        many("", "line # of an instrument\n", "t;F\n0;1\n1;2\n"),
        many("t;F\n", ";", "\n0;1\n1;2\n"),
        many("t,F\n0,1\n1,\"", "a\"\"", "\"\n"),
        many("t,F\n0,1\n1,2\n", "end\n", ""),
    ]
}

/// A record that is read goes forwards, with a finite friction for each of its places.
fn measured(input: &[u8]) {
    match TableLayout::find(input, TableOptions::default()) {
        Err(error) => readable(&error),
        Ok(layout) => assert!(layout.took().is_none_or(|took| !took.is_empty())),
    }
    let column = |name: &str, unit: &str| Column {
        name: name.to_owned(),
        unit: Some(unit.to_owned()),
    };
    for (along, unit) in [(Measure::Time, "s"), (Measure::Displacement, "um")] {
        let columns = [&column("1", unit), &column("2", "N")];
        let read = MeasuredRecord::parse(
            input,
            Path::new("record.csv"),
            columns,
            along,
            TableOptions::default(),
        );
        match read {
            Err(error) => readable(&error),
            Ok(record) => {
                assert!(record.x.is_sorted() && record.x.len() == record.y.len());
                let mut values = record.x.iter().chain(&record.y);
                assert!(values.all(|value| value.is_finite()));
            }
        }
    }
}
