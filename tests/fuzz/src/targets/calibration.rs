//! Calibration files, with the record of basalt beside them, and the instruments that they describe.

use std::sync::LazyLock;

use slipfront_calibrate::CalibrationFile;
use slipfront_run::instrument::InstrumentKeys;
use slipfront_run::measured::Measure;

use crate::checks::readable;
use crate::long::{many, nested};
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// The text of a calibration, its set-up for a record, and a curve behind its instrument.
pub(crate) const CALIBRATION_FILE: Target = Target {
    name: "calibration_file",
    check: calibration_file,
    generated,
    files: &["cases/calibrations/*.toml"],
    dictionary: Some("calibration.dict"),
    max_bytes: 4096,
    // The case of a calibration may have as many blocks as there is memory for: they are counted and not
    // made.
    memory: Memory {
        bytes: 512 << 20,
        per_byte: 1024,
    },
    time: Time::READING,
    mutations: 200,
    repetitions: 20,
    long,
};

const BEGIN: &str = "base = 'basalt.toml'\n[calibrate]\nx = 'time_s'\ny = 'mu'\nnoise = 0.01\n";

fn generated() -> Vec<Vec<u8>> {
    let mut instruments: Vec<String> = [
        "filter = 'butterworth'\norder = 4\ncutoff = '20 Hz'\nsampling = '1 kHz'\ngain = 1.01\noffset = 0.01\nrange = [0, 0.9]\n",
        "filter = 'moving_mean'\ntime = '0.1 s'\nmass = '20 g'\nstiffness = '10 kN/m'\ndamping_ratio = 0.1\n",
    ]
    .map(str::to_owned)
    .to_vec();
    for number in ["1e-300", "1e-18", "1e-9", "1e9", "1e18", "1e300"] {
        instruments.extend([
            format!("filter = 'first_order'\ncutoff = '{number} Hz'\n"),
            format!("filter = 'butterworth'\norder = 10\ncutoff = '{number} Hz'\n"),
            format!("filter = 'moving_mean'\ntime = '{number} s'\n"),
            format!("sampling = '{number} Hz'\n"),
            format!("mass = '{number} kg'\nstiffness = '1 N/m'\ndamping_ratio = 0.999\n"),
            format!("mass = '1 g'\nstiffness = '{number} N/m'\ndamping_ratio = 1e-300\n"),
            format!("gain = {number}\noffset = -{number}\nrange = [-{number}, {number}]\n"),
        ]);
    }
    let with = |keys: &str| {
        format!(
            "[base]\nslider.blocks = [1, 1]\n[calibrate]\nx = 't'\ny = 'mu'\nnoise = 0.01\nunknowns = {{ 'friction.r_star' = [0.5, 0.98], \
             'instrument.gain' = [0.9, 1.1] }}\n[instrument]\n{keys}"
        )
    };
    instruments.iter().map(|keys| with(keys).into_bytes()).collect()
}

fn long() -> Vec<Vec<u8>> {
    let unknowns = |piece: &str, end: &str| many(&format!("{BEGIN}unknowns = {{ "), piece, end);
    vec![
        unknowns("'friction.a#' = [1, 2], ", "'friction.b' = [1, 2] }"),
        unknowns("'instrument.gain#' = [1, 2], ", "'friction.b' = [1, 2] }"),
        many(BEGIN, "[[calibrate.records]]\nset = { drive.v_star = 0.# }\n", ""),
        many(BEGIN, "[[calibrate.next]]\ndrive.v_star = 0.#\n", ""),
        many("[instrument]\n", "gian# = 1\n", ""),
        many("[instrument]\nrange = [", "'#', ", "1]"),
        nested("calibrate = ", "{ calibrate = ", "1", " }", ""),
    ]
}

/// A curve that rises and falls at times that are not equally far apart.
static CURVE: LazyLock<[Vec<f64>; 2]> = LazyLock::new(|| {
    let time: Vec<f64> = (0..200).map(|k| 1e-3 * f64::from(k * k)).collect();
    let friction = (0..200).map(|k| 0.6 + 0.1 * f64::from(k % 7)).collect();
    [time, friction]
});

fn calibration_file(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else {
        return;
    };
    let folder = scratch::repository("cases/calibrations");
    match CalibrationFile::parse(text, "fit.toml", "fit", &folder) {
        // A text that is nested too deep is none for the parser below.
        Err(error) => return readable(&error),
        Ok(file) => {
            let records = file.read(&[folder.join("basalt.csv")]);
            let checked = records.and_then(|records| file.check_memory(&records, 1));
            checked.err().iter().for_each(readable);
            file.planned("2 s", 100).err().iter().for_each(readable);
        }
    }
    let table = text.parse::<toml::Table>().ok();
    if let Some(keys) = table
        .as_ref()
        .and_then(|table| table.get("instrument")?.as_table())
    {
        let instrument =
            InstrumentKeys::from_table(keys).and_then(|keys| keys.instrument(Measure::Coefficient));
        match instrument {
            Err(error) => readable(&error),
            Ok(instrument) => {
                let [time, friction] = &*CURVE;
                let record = instrument.record(time, friction);
                assert!(record.len() == time.len() && record.iter().all(|value| value.is_finite()));
            }
        }
    }
}
