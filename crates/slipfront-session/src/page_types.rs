//! Tests that `types/protocol.d.ts` of slipfront-lab, with which the page is written, agrees with
//! `protocol.rs`, by samples of messages.
//!
//! The tests write the samples to `types/samples.ts`, parse every request among them, and ensure that the
//! samples contain every key, word and kind of this crate. `tsc` (`tests/browser/run.sh`) checks the samples
//! against the types of the page, and ensures that the samples contain all of these types.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use serde_json::{Value, json};
use slipfront_case::case_file::{Key, KeyKind, SECTIONS};
use slipfront_run::measured::{Measure, TableColumn};
use slipfront_run::summary::{Summary, summary_json};

use crate::controls::{CONTROLS, ControlValue};
use crate::document::Document;
use crate::picture::DisplayedField;
use crate::protocol::{
    CalibratedReply, CalibratingReply, CalibrationOutcome, CalibrationResults, CalibrationStage, CaseReply,
    CurveReply, DrawingFormat, DrawingReply, Estimate, FindingReply, FoundOutcome, FoundReply, NumbersReply,
    PeakReply, PresetEntry, ProbeReply, RecordCurve, RecordReply, RepeatedReply, Reply, Request, SavingEntry,
    SearchLimits, SensitivityReply, Units, UnknownReply,
};
use crate::shapes;

/// Requests that the page may send: every key with every kind of value, and without every key that is
/// optional.
const REQUESTS: [&str; 39] = [
    r#"{"do":"open","source":{}}"#,
    r#"{"do":"open","source":{"preset":"circle"}}"#,
    r#"{"do":"open","source":{"folder":"run"}}"#,
    r#"{"do":"open","source":{"toml":"","name":"case","files":{"mask.png":""}}}"#,
    r#"{"do":"open","source":{"run":{"manifest.json":""}}}"#,
    r#"{"do":"set","keys":{"drive.v_star":0.1,"load.pressure":"1 MPa","drive.held":true,"slider.blocks":[50,50],"output":{"snapshots":"auto"},"texture":[{"shape":"cavity","coverage":5}],"friction.seed":null},"gesture":1}"#,
    r#"{"do":"paint","points":[[0.5,0.5]],"radius":0.5,"textured":true,"gesture":1}"#,
    r#"{"do":"image","png":"","threshold":0.5,"gesture":1}"#,
    r#"{"do":"undo"}"#,
    r#"{"do":"redo"}"#,
    r#"{"do":"rest"}"#,
    r#"{"do":"view"}"#,
    r#"{"do":"view","field":"contact_stress","visible":true,"after_change":"rest"}"#,
    r#"{"do":"view","field":"traction","paused":true,"after_change":"go_on"}"#,
    r#"{"do":"view","field":"displacement","pace":25}"#,
    r#"{"do":"view","field":"speed","loading_pace":0}"#,
    r#"{"do":"view","field":"sliding","twin":true}"#,
    r#"{"do":"view","field":"first_slip","kymograph":true}"#,
    r#"{"do":"view","field":"front"}"#,
    r#"{"do":"view","frames_per_second":60}"#,
    r#"{"do":"view","probe":[1,1]}"#,
    r#"{"do":"view","probe":null}"#,
    r#"{"do":"step","count":1}"#,
    r#"{"do":"repeat","seeds":1}"#,
    r#"{"do":"find","gesture":1}"#,
    r#"{"do":"find_stop"}"#,
    r#"{"do":"save","name":"run"}"#,
    r#"{"do":"save_stop","name":"run"}"#,
    r#"{"do":"export"}"#,
    r#"{"do":"frames_of","index":1}"#,
    r#"{"do":"frames_of","index":null}"#,
    r#"{"do":"read_record","record":{"name":"rig.csv","bytes":""}}"#,
    r#"{"do":"read_record","record":{"name":"rig.csv","bytes":"","x":"1","y":"2","x_unit":"ms","y_unit":"N"}}"#,
    r#"{"do":"calibrate","record":{"name":"rig.csv","bytes":""},"shift":0.5,"noise":0.01,"runs":200,"unknowns":{"friction.r_star":[0.4,0.9],"drive.total_stiffness":{"from":"80 N/m","to":"350 N/m","scale":"log"}}}"#,
    r#"{"do":"calibrate","record":{"name":"rig.csv","bytes":"","x":"1","y":"2","x_unit":"ms","y_unit":"N"},"shift":0.5,"from":0.5,"to":1.5,"noise":0.01,"runs":200,"unknowns":{}}"#,
    r#"{"do":"calibrate_stop"}"#,
    r#"{"do":"sensitivity","control":"load"}"#,
    r#"{"do":"drawing","format":"dxf"}"#,
    r#"{"do":"drawing","format":"svg"}"#,
];

fn read(request: Value) -> Result<Request, String> {
    serde_json::from_value(request).map_err(|error| error.to_string())
}

/// The names in backticks after "expected" in an error of serde, in order.
fn expected(error: &str) -> Vec<String> {
    let (_, names) = error.rsplit_once("expected").unwrap_or_else(|| panic!("{error}"));
    names.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Keys and texts that the requests have at one place.
#[derive(Default)]
struct Place {
    keys: BTreeSet<String>,
    words: BTreeSet<String>,
}

/// Adds the keys and texts in a value, at a place that begins with the name of its request.
fn add_places(value: &Value, at: &[&str], places: &mut BTreeMap<Vec<String>, Place>) {
    let place = at.iter().map(|&key| key.to_owned()).collect();
    let place = places.entry(place).or_default();
    match value {
        Value::String(word) => drop(place.words.insert(word.clone())),
        Value::Object(keys) => {
            place.keys.extend(keys.keys().cloned());
            for (key, value) in keys {
                add_places(value, &[at, &[key.as_str()]].concat(), places);
            }
        }
        _ => {}
    }
}

/// The error for a request with only this value, at this place; empty if it is accepted.
fn error_at(place: &[String], value: Value) -> String {
    let within = place[1..].iter().rev();
    let mut request = within.fold(value, |value, key| json!({ key: value }));
    request["do"] = json!(place[0]);
    read(request).err().unwrap_or_default()
}

#[test]
fn requests_are_read_and_show_every_key_and_word_that_is() {
    let mut places = BTreeMap::new();
    for text in REQUESTS {
        let mut request: Value = serde_json::from_str(text).unwrap();
        let name = read(request.clone())
            .unwrap_or_else(|error| panic!("{text}: {error}"))
            .name();
        assert_eq!(request["do"], name);
        request.as_object_mut().unwrap().remove("do");
        add_places(&request, &[name], &mut places);
    }
    let names: BTreeSet<_> = places.keys().map(|place| &place[0]).collect();
    let known = expected(&read(json!({ "do": "no such request" })).unwrap_err());
    assert_eq!(names, known.iter().collect());

    let (mut any_key, mut of_words) = (Vec::new(), Vec::new());
    for (place, Place { keys, words }) in &places {
        let at = place.join(".");
        // Keys of the case are the case's own business.
        if at.starts_with("set.keys.") || at.starts_with("calibrate.unknowns.") {
            continue;
        }
        if !keys.is_empty() {
            let error = error_at(place, json!({ "no such key": 0 }));
            if error.starts_with("unknown field") {
                assert_eq!(keys, &expected(&error).into_iter().collect(), "{at}");
            } else {
                any_key.push(at.clone());
            }
        }
        if !words.is_empty() {
            let error = error_at(place, json!("no such word"));
            if error.starts_with("unknown variant") {
                assert_eq!(words, &expected(&error).into_iter().collect(), "{at}");
                of_words.push(at);
            }
        }
    }
    assert_eq!(
        any_key,
        [
            "calibrate.unknowns",
            "open.source.files",
            "open.source.run",
            "set.keys"
        ]
    );
    assert_eq!(of_words, ["drawing.format", "view.after_change", "view.field"]);
}

/// Keys of `summary.json` that the page shows, in alphabetical order: other numbers of runs do not change the
/// samples.
const SHOWN_OF_SUMMARY: [&str; 9] = [
    "energy_error",
    "front_duration_star",
    "front_speed_c_s",
    "front_speed_m_s",
    "kinetic_friction_star",
    "nucleation_sites",
    "onset_time_star",
    "static_friction_star",
    "transition",
];

/// Calls `check` with replies of every kind that together contain every kind of value of each of their keys.
fn each_reply(check: &mut impl FnMut(&Reply)) {
    let text = "[[texture]]\npoints = [['10 um', '10 um'], ['20 um', '10 um'], ['10 um', '20 um']]\nshape = 'polygon'\n";
    let document = Document::new("case", text, |_| Err("there is no file".to_owned())).unwrap();
    let case = document.case(&mut |_| true).unwrap();
    let presets = [PresetEntry {
        name: "circle",
        group: "holes",
        picture: "",
        is_study: false,
        title: "A circle",
    }];
    for results in [None, Some("results")] {
        check(&Reply::Hello {
            version: "1",
            presets: &presets,
            folders: &["run".to_owned()],
            results,
            max_blocks: 1,
            controls: &CONTROLS[..3],
        });
    }
    for (kinetic_from_star, too_coarse) in [(1.0, None), (f64::INFINITY, Some("too coarse".to_owned()))] {
        check(&Reply::Case(Box::new(CaseReply {
            name: "case",
            toml: document.toml(),
            files: vec!["mask.png"],
            link_files_bytes: 1,
            blocks: [50, 50],
            block_size_m: 1e-6,
            n_blocks: 2500,
            texture_percent: 5.0,
            texture: document.textures(),
            shapes: shapes::outlines(&case),
            values: BTreeMap::from([
                (
                    "speed",
                    ControlValue {
                        star: 0.1,
                        si: Some(0.5),
                    },
                ),
                ("r_star", ControlValue { star: 0.5, si: None }),
            ]),
            units: Units {
                time_s: 1.0,
                displacement_m: 1.0,
                speed_m_s: 1.0,
                stress_pa: 1.0,
                friction_n: too_coarse.is_none().then_some(0.5),
                friction_coefficient: 0.5,
            },
            dt_star: 0.1,
            duration_star: 400.0,
            kinetic_from_star,
            onset_star: 80.0,
            drive_degrees: too_coarse.is_none().then_some(30.0),
            loading_rate: too_coarse.is_none().then_some(0.01),
            steady_level: 0.5,
            can_undo: true,
            can_redo: false,
            leg: 0,
            why: "open",
            time_before_s: 0.0,
            twin: true,
            has_memory: false,
            mesh: "the block decides".to_owned(),
            warnings: vec!["a warning".to_owned()],
            seeds: too_coarse.is_none().then_some("a note"),
            too_coarse,
            search: SearchLimits {
                width_blocks: 4,
                most_percent: 30.0,
            },
        })));
    }
    for recorded in [None, Some(&[0.5][..])] {
        check(&Reply::Curve(CurveReply {
            leg: 0,
            from_rest: true,
            t: vec![0.5],
            mu: vec![0.5],
            sliding: vec![0.5],
            twin_reset: false,
            twin_t: vec![0.5],
            twin_mu: vec![0.5],
            recorded_t: recorded,
            recorded_mu: recorded,
        }));
    }
    let summaries = [
        Summary::default(),
        Summary {
            kinetic_friction_star: Some(0.5),
            front_speed_c_s: Some(0.5),
            front_speed_m_s: Some(0.5),
            front_duration_star: Some(0.5),
            nucleation_sites: Some(1),
            ..Summary::default()
        },
    ];
    let summaries = summaries.map(|summary| {
        let all: Value = serde_json::from_str(&summary_json(&summary)).unwrap();
        let shown = SHOWN_OF_SUMMARY.iter();
        shown
            .map(|&key| (key, all.get(key).unwrap().clone()))
            .collect::<Value>()
    });
    let peak = PeakReply {
        t_star: 1.0,
        mu_star: 1.0,
        certain: true,
    };
    for (present, summary) in [
        (true, Some(&summaries[0])),
        (true, Some(&summaries[1])),
        (false, None),
    ] {
        check(&Reply::Numbers(Box::new(NumbersReply {
            step: 1,
            t_star: 0.5,
            time_s: 0.5,
            mu_star: 0.5,
            sliding_percent: 0.5,
            peak: present.then_some(peak),
            twin_peak: present.then_some(peak),
            change_percent: present.then_some(0.5),
            kinetic: present.then_some(0.5),
            instants: BTreeMap::from([('A', 0.5)]),
            crossed: false,
            steps_per_second: 0.5,
            ended: true,
            summary: summary.cloned(),
        })));
        check(&Reply::Probe(ProbeReply {
            block: [0, 0],
            exists: true,
            textured: true,
            sliding: true,
            mu_static: 0.5,
            mu_kinetic: 0.5,
            contact_stress_pa: 0.5,
            traction_pa: 0.5,
            displacement_m: 0.5,
            speed_m_s: 0.5,
            first_slip_star: present.then_some(0.5),
        }));
        for half_width in [None, Some(0.5)] {
            let estimate = present.then_some(Estimate {
                mean: 0.5,
                half_width,
            });
            check(&Reply::Repeated(RepeatedReply {
                done: 1,
                of: 2,
                finished: false,
                change_percent: estimate,
                with: estimate,
                without: estimate,
                without_transition: 0,
            }));
        }
    }
    for half_width in [None, Some(0.5)] {
        let estimate = Some(Estimate {
            mean: -30.0,
            half_width,
        });
        check(&Reply::Finding(FindingReply {
            seconds: 1.0,
            of_seconds: 60.0,
            textures: 32,
            compares: false,
            best_percent: half_width,
            best_texture: vec![[0, 1, 4]],
        }));
        for outcome in [
            FoundOutcome::Replaced,
            FoundOutcome::Kept,
            FoundOutcome::GivenUp,
            FoundOutcome::Failed,
        ] {
            check(&Reply::Found(FoundReply {
                outcome,
                textures: 32,
                surfaces: 8,
                best: estimate.filter(|_| outcome == FoundOutcome::Kept),
                painted: estimate.filter(|_| outcome == FoundOutcome::Kept),
            }));
        }
    }
    check(&Reply::Saving {
        under_way: vec![SavingEntry {
            name: "run",
            share: 0.5,
        }],
    });
    check(&Reply::Saved {
        name: "run",
        folder: "results/run",
        folders: &["run".to_owned()],
    });
    check(&Reply::Exported {
        toml: "",
        files: BTreeMap::from([("mask.png", String::new())]),
        zip: String::new(),
    });
    check(&Reply::Recorded {
        times_star: vec![0.5],
    });
    records_and_calibrations(check);
    check(&Reply::Refused {
        of: "set",
        sentence: String::new(),
    });
    check(&Reply::Failed {
        sentence: String::new(),
    });
}

/// Calls `check` with the replies about records, calibrations, sensitivities and drawings.
fn records_and_calibrations(check: &mut impl FnMut(&Reply)) {
    for (along, of) in [
        (Measure::Time, Measure::Force),
        (Measure::Displacement, Measure::Coefficient),
    ] {
        let is_read = along == Measure::Time;
        let curve = RecordCurve {
            columns: [0, 1],
            along,
            of,
            values: 1,
            x: vec![0.5],
            y: vec![0.5],
            noise_percent: 0.5,
        };
        for (curve, problem) in [(Some(curve), None), (None, Some("no unit".to_owned()))] {
            check(&Reply::Record(RecordReply {
                name: "rig.csv".to_owned(),
                columns: vec![TableColumn {
                    name: "t".to_owned(),
                    unit: is_read.then(|| "s".to_owned()),
                }],
                curve,
                problem,
                notes: vec!["a note".to_owned()],
            }));
        }
    }
    for stage in [
        CalibrationStage::Training,
        CalibrationStage::Closest,
        CalibrationStage::Prediction,
        CalibrationStage::OtherStep,
    ] {
        let (runs, of) = (1, 360);
        check(&Reply::Calibrating(CalibratingReply { stage, runs, of }));
    }
    for outcome in [
        CalibrationOutcome::Done,
        CalibrationOutcome::Stopped,
        CalibrationOutcome::GivenUp,
        CalibrationOutcome::Failed,
    ] {
        let unknown = |unit: Option<&str>| UnknownReply {
            key: "friction.r_star".to_owned(),
            unit: unit.map(str::to_owned),
            median: 0.5,
            interval: [0.4, 0.6],
            range: [0.25, 0.75],
            is_determined: true,
        };
        let results = (outcome == CalibrationOutcome::Done).then(|| CalibrationResults {
            unknowns: vec![unknown(None), unknown(Some("N/m"))],
            is_refused: false,
            report: "a report".to_owned(),
            toml: "[base]".to_owned(),
            set: [("friction.r_star".to_owned(), json!(0.5))].into_iter().collect(),
        });
        check(&Reply::Calibrated(CalibratedReply {
            outcome,
            sentence: (outcome == CalibrationOutcome::Failed).then(|| "why".to_owned()),
            results: results.map(|results| serde_json::to_value(results).unwrap()),
        }));
    }
    for percent in [None, Some(0.5)] {
        let (control, values) = ("load".to_owned(), [1e6, 1.1e6]);
        check(&Reply::Sensitivity(SensitivityReply {
            control,
            values,
            percent,
        }));
    }
    for format in [DrawingFormat::Dxf, DrawingFormat::Svg] {
        let (text, notes) = (String::new(), vec!["a note".to_owned()]);
        check(&Reply::Drawing(DrawingReply { format, text, notes }));
    }
}

/// Lists all kinds of replies and names the kind of a reply. The compiler demands that a new kind is listed
/// here, and then the test demands a sample of it.
macro_rules! kinds {
    ($($kind:ident)*) => {
        const KINDS: &[&str] = &[$(stringify!($kind)),*];

        fn kind(reply: &Reply) -> &'static str {
            match reply {
                $(Reply::$kind { .. } => stringify!($kind),)*
            }
        }
    };
}
kinds! { Hello Case Curve Numbers Probe Repeated Finding Found Saving Saved Exported Recorded Record Calibrating Calibrated Sensitivity Drawing Refused Failed }

/// Possible values of a key of a texture.
fn texture_values(key: &Key) -> Vec<Value> {
    match key.kind {
        KeyKind::Number { .. } | KeyKind::Whole { .. } => vec![json!(1)],
        KeyKind::Quantity { .. } | KeyKind::Words(_) | KeyKind::File(_) => vec![json!("text")],
        KeyKind::Switch => vec![json!(true)],
        KeyKind::Table(..) | KeyKind::Special(_) => match key.name {
            "w" => vec![json!(0.1)],
            "missing" => vec![json!(-9999), json!("nan")],
            "center" | "pitch" | "pixel_size" => vec![json!("1 um"), json!(["1 um", "1 um"])],
            "array" => vec![json!("auto"), json!([3, 3])],
            "points" => vec![json!([["0 um", "0 um"], ["1 um", "0 um"], ["0 um", "1 um"]])],
            "repeat" => vec![json!({ "array": [3, 3] })],
            name => panic!("{name} has a form of its own, which this does not know"),
        },
    }
}

/// A texture of each shape without keys, and with each value of each key.
fn textures() -> Vec<String> {
    let mut all = Vec::new();
    for section in SECTIONS.iter().filter(|section| section.is_shape) {
        all.push(format!(r#"{{"shape":"{}"}}"#, section.name));
        for key in section.keys {
            let values = texture_values(key).into_iter();
            all.extend(
                values.map(|value| format!(r#"{{"shape":"{}","{}":{value}}}"#, section.name, key.name)),
            );
        }
    }
    all
}

/// Text of the messages, grouped by kind, which is the first value of each message.
fn by_kind(messages: &[String]) -> String {
    let mut text = String::new();
    let mut last = "";
    for message in messages {
        let kind = message.split('"').nth(3).unwrap();
        if kind != last {
            let end = if last.is_empty() { "" } else { "  ],\n" };
            text += &format!("{end}  {kind}: [\n");
            last = kind;
        }
        text += &format!("    {message},\n");
    }
    text + "  ],\n"
}

#[test]
fn samples_are_those_that_the_page_is_checked_with() {
    let mut replies = Vec::new();
    let mut shown = BTreeSet::new();
    each_reply(&mut |reply| {
        shown.insert(kind(reply));
        replies.push(reply.json());
    });
    assert_eq!(shown, KINDS.iter().copied().collect());
    replies.sort_by_key(|reply| reply.split('"').nth(3).map(str::to_owned));
    let requests = by_kind(&REQUESTS.map(str::to_owned));
    let textures: String = textures().iter().map(|one| format!("  {one},\n")).collect();
    let text = format!(
        "// Messages of every kind, written by the tests `page_types` of slipfront-session: with UPDATE=1 anew.\n\
         import {{ Replies, Requests, Texture }} from './protocol';\n\
         import {{ Samples, Some }} from './sample_lists';\n\n\
         export const requests = {{\n{requests}}} satisfies Samples<Requests, 'do'>;\n\n\
         export const replies = {{\n{}}} satisfies Samples<Replies, 'is'>;\n\n\
         export const textures = [\n{textures}] satisfies Some<Texture>;\n",
        by_kind(&replies)
    );
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../slipfront-lab/types/samples.ts");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(
        written == text,
        "types/samples.ts of slipfront-lab has other messages: write them anew with \
         `UPDATE=1 cargo test --workspace --lib page_types`, and run tests/browser/run.sh"
    );
}

#[test]
fn fields_have_the_numbers_of_pictures() {
    let error = error_at(&["view".to_owned(), "field".to_owned()], json!("no such field"));
    let mut names = Vec::new();
    for (number, name) in expected(&error).iter().enumerate() {
        let shown: DisplayedField = serde_json::from_value(json!(name)).unwrap();
        assert_eq!(shown as usize, number, "{name}");
        names.push(format!("'{name}'"));
    }
    let list = format!("FIELDS = [{}];", names.join(", "));
    assert!(
        include_str!("../../slipfront-lab/web/frames.js").contains(&list),
        "{list}"
    );
}
