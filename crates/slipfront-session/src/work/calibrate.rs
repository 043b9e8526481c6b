//! A calibration of the case from a record of the page.

use std::path::Path;

use serde::Deserialize;
use serde_json::Map;
use slipfront_calibrate::{
    CalibrationInMemory, CalibrationProgress, CalibrationStage as Stage, Outcome, WantedRun,
};
use slipfront_run::measured::{Measure, columns_of};
use toml::{Table, Value};

use super::record::Chosen;
use crate::base64;
use crate::document::Document;
use crate::event::{Event, EventKind, MadeRun, Worker};
use crate::protocol::{
    CalibrateRequest, CalibratingReply, CalibrationResults, CalibrationStage, UnknownReply,
};
use crate::sentence::sentence;

/// Calibrates a case. If other jobs make its runs, all except those of a search for the closest curve, this
/// job ends with the list of runs that it needs first.
pub(super) fn calibrate(
    document: &Document,
    request: &CalibrateRequest,
    made: &[MadeRun],
    is_elsewhere: bool,
    worker: &dyn Worker,
) {
    let found = find(document, request, made, is_elsewhere, worker);
    worker.send(Event(
        found.unwrap_or_else(|sentence| EventKind::Calibrated(Err(sentence))),
    ));
}

/// Makes runs that a calibration wants, and reports each.
pub(super) fn make_runs(
    document: &Document,
    request: &CalibrateRequest,
    wanted: &[String],
    worker: &dyn Worker,
) {
    let send = |made| worker.send(Event(EventKind::Made(made)));
    let calibration = match Request::read(document, request).and_then(|request| request.calibration()) {
        Ok(calibration) => calibration,
        Err(sentence) => return send(Err(sentence)),
    };
    for run in wanted {
        let made = read_wanted(run).and_then(|run| calibration.make(&run, worker.stop()).map_err(sentence));
        match made {
            Ok(Some(curves)) => send(Ok(json(&curves))),
            Ok(None) => return,
            Err(sentence) => return send(Err(sentence)),
        }
    }
}

/// Returns the event with the results of a calibration, or with the runs that it needs first.
fn find(
    document: &Document,
    request: &CalibrateRequest,
    made: &[MadeRun],
    is_elsewhere: bool,
    worker: &dyn Worker,
) -> Result<EventKind, String> {
    let request = Request::read(document, request)?;
    let mut calibration = request.calibration()?;
    for made in made {
        let curves = serde_json::from_str(&made.curves).map_err(sentence)?;
        calibration.add(read_wanted(&made.wanted)?, curves);
    }
    let mut watch = |now: &CalibrationProgress| {
        worker.send(Event(EventKind::Calibrating(CalibratingReply {
            stage: stage(now.stage),
            runs: made.len() + now.runs,
            of: made.len() + now.total,
        })));
    };
    let found = calibration.find(is_elsewhere, worker.stop(), &mut watch);
    match found.map_err(sentence)? {
        Outcome::Found(found) => {
            let results = serde_json::to_value(request.results(found)?).map_err(sentence)?;
            Ok(EventKind::Calibrated(Ok(results)))
        }
        Outcome::Wants(wanted) => Ok(EventKind::Wants(wanted.iter().map(json).collect())),
    }
}

/// Serialises a value as JSON.
fn json(value: &impl serde::Serialize) -> String {
    // Structs of texts and finite numbers: serialisation cannot fail.
    serde_json::to_string(value).expect("a run is JSON")
}

fn read_wanted(run: &str) -> Result<WantedRun, String> {
    serde_json::from_str(run).map_err(sentence)
}

/// Stage in the progress report for a page; calibrations of a page reach no other stages.
fn stage(stage: Stage) -> CalibrationStage {
    match stage {
        Stage::Training | Stage::FinerBlocks | Stage::Further | Stage::Planning => CalibrationStage::Training,
        Stage::Closest => CalibrationStage::Closest,
        Stage::Prediction => CalibrationStage::Prediction,
        Stage::OtherStep => CalibrationStage::OtherStep,
    }
}

/// A calibration that a page requests: its file and its record.
struct Request<'a> {
    document: &'a Document,
    toml: String,
    name: &'a str,
    bytes: Vec<u8>,
}

impl<'a> Request<'a> {
    fn read(document: &'a Document, request: &'a CalibrateRequest) -> Result<Self, String> {
        let file = &request.record;
        let bytes = base64::decode(&file.bytes)?;
        let columns = columns_of(&bytes, Path::new(&file.name)).map_err(sentence)?;
        Ok(Self {
            document,
            toml: calibration_file(document, request, Chosen::find(file, &columns)?)?,
            name: &file.name,
            bytes,
        })
    }

    fn calibration(&self) -> Result<CalibrationInMemory, String> {
        let files = self.document.files_in_memory();
        let record = (self.name, self.bytes.clone());
        let threads = rayon::current_num_threads();
        CalibrationInMemory::new(&self.toml, files, record, threads).map_err(sentence)
    }

    fn results(&self, found: slipfront_calibrate::CalibrationResults) -> Result<CalibrationResults, String> {
        /// The part of the results that a page shows in addition to the report.
        #[derive(Deserialize)]
        struct Findings {
            unknowns: Vec<UnknownReply>,
            is_refused: bool,
        }
        let findings = serde_json::from_str(&found.numbers);
        let Findings { unknowns, is_refused } = findings.map_err(sentence)?;
        let set = found.set.into_iter();
        let set: Map<_, _> = set
            .map(|(key, value)| (key, serde_json::to_value(value).unwrap_or_default()))
            .collect();
        Ok(CalibrationResults {
            unknowns,
            is_refused,
            report: found.report,
            toml: self.toml.clone(),
            set,
        })
    }
}

/// The calibration file for the request of a page.
///
/// # Errors
/// A sentence, if a range is invalid.
fn calibration_file(
    document: &Document,
    request: &CalibrateRequest,
    chosen: Chosen,
) -> Result<String, String> {
    let ranges = request.unknowns.iter();
    let ranges = ranges.map(|(key, range)| Ok((key.clone(), Value::try_from(range)?)));
    let ranges: Result<Vec<(String, Value)>, toml::ser::Error> = ranges.collect();
    let ranges = ranges.map_err(sentence)?;
    let (against, unit) = match chosen.along {
        Measure::Displacement => ("displacement", "m"),
        _ => ("time", "s"),
    };
    let [x, y] = chosen.columns;
    let place = |place: f64| format!("{place} {unit}");
    let shift = (request.shift != 0.0).then(|| place(request.shift));
    let texts = [
        ("x", Some(x.name)),
        ("y", Some(y.name)),
        ("x_unit", x.unit),
        ("y_unit", y.unit),
        ("against", Some(against.to_owned())),
        ("shift", shift),
        ("from", request.from.map(place)),
        ("to", request.to.map(place)),
    ];
    let texts = texts.into_iter();
    let texts = texts.filter_map(|(key, text)| Some((key.to_owned(), Value::from(text?))));
    let numbers = [
        ("noise", Value::from(request.noise)),
        ("runs", Value::from(i64::from(request.runs))),
        ("finer_runs", Value::from(0)),
        ("unknowns", Value::Table(ranges.into_iter().collect())),
    ];
    let numbers = numbers.map(|(key, value)| (key.to_owned(), value));
    let file = Table::from_iter([
        ("base".to_owned(), Value::Table(document.keys().clone())),
        (
            "calibrate".to_owned(),
            Value::Table(texts.chain(numbers).collect()),
        ),
    ]);
    toml::to_string_pretty(&file).map_err(sentence)
}
