//! Sliding against place and time, `kymograph.nc`.

use std::sync::Arc;

use slipfront_case::case::Case;
use slipfront_run::fields::{kymograph_bytes, read_kymograph};
use slipfront_run::running;

use super::fields::long_headers;
use crate::checks::readable;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// Reads the file.
pub(crate) const KYMOGRAPH: Target = Target {
    name: "kymograph",
    check: kymograph,
    generated: || {
        let cases = [
            "slider.blocks = [3, 2]\ntime.duration_star = 2",
            "slider.blocks = [1, 1]\ntime.duration_star = 0.1",
            "slider.blocks = [4, 1]\ndrive.direction = 180\ntime.duration_star = 5\n\
             texture = [{ shape = 'groove', orientation = 'across', width = \"1 um\" }]",
        ];
        cases.map(file).into()
    },
    files: &[],
    dictionary: Some("netcdf.dict"),
    max_bytes: 8192,
    // A value of one byte becomes one of eight.
    memory: Memory {
        bytes: 1 << 20,
        per_byte: 128,
    },
    time: Time::READING,
    mutations: 2000,
    repetitions: 15,
    long: long_headers,
};

/// The bytes of the file of a run.
fn file(case: &str) -> Vec<u8> {
    let case = Arc::new(Case::parse(case, "case", "", &[]).unwrap());
    let record = running::run(&case, 1).unwrap();
    kymograph_bytes(&record.kymograph, &case)
}

fn kymograph(input: &[u8]) {
    match read_kymograph(scratch::file("run/kymograph.nc", input)) {
        Err(error) => readable(&error),
        Ok(data) => {
            assert_eq!(data.columns() * data.time_star.len(), data.sliding_share.len());
            assert!(data.columns() > 0 && data.places.iter().all(|place| !place.is_nan()));
        }
    }
}
