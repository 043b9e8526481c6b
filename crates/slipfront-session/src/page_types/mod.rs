//! Holds `types/protocol.d.ts` of slipfront-lab, which the page is written against, against `protocol.rs`:
//! requests as the page may send them are read, and replies have the keys and values that the page expects.

mod declarations;

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};
use slipfront_case::case_file::{KeyKind, SECTIONS};
use slipfront_run::summary::{Summary, summary_json};

use self::declarations::{Declarations, Seen, Type};
use crate::controls::{self, CONTROLS};
use crate::document::Document;
use crate::picture::DisplayedField;
use crate::protocol::{
    CaseReply, CurveReply, Estimate, FindingReply, FoundOutcome, FoundReply, NumbersReply, PeakReply,
    PresetEntry, ProbeReply, RepeatedReply, Reply, Request, SavingEntry, Units,
};
use crate::{search, shapes};

fn declarations() -> Declarations {
    Declarations::parse(include_str!("../../../slipfront-lab/types/protocol.d.ts"))
}

/// The names in marks at the end of an error of serde: what it expected.
fn expected<T: std::fmt::Debug>(read: Result<T, serde_json::Error>) -> BTreeSet<String> {
    let error = read.unwrap_err().to_string();
    let (_, names) = error.rsplit_once("expected").unwrap_or_else(|| panic!("{error}"));
    names.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

fn names<'a>(of: impl IntoIterator<Item = &'a String>) -> BTreeSet<String> {
    of.into_iter().cloned().collect()
}

/// Reads a request with `value` at a place in it.
fn read(name: &str, place: &[&str], value: Value) -> Result<Request, serde_json::Error> {
    let inner = place
        .iter()
        .rev()
        .fold(value, |value, key| json!({ *key: value }));
    let mut request = json!({ "do": name });
    request
        .as_object_mut()
        .unwrap()
        .extend(inner.as_object().unwrap().clone());
    serde_json::from_value(request)
}

/// Holds the keys of an interface at a place of a request, and the words that they take, against those that
/// are read.
fn check_request(declared: &Declarations, request: &str, place: &[&str], interface: &str) {
    let keys = &declared.interface(interface).keys;
    if keys.is_empty() {
        return;
    }
    let found = expected(read(request, place, json!({ "no such key": 0 })));
    assert_eq!(found, names(keys.keys()), "{interface}");
    for (key, declared_key) in keys {
        let at = [place, &[key.as_str()]].concat();
        let alternatives = declared.alternatives(&declared_key.holds);
        let words = alternatives.iter().filter_map(|one| match one {
            Type::Literal(word) => Some(word),
            _ => None,
        });
        let words = names(words);
        if !words.is_empty() {
            assert_eq!(
                expected(read(request, &at, json!("no such word"))),
                words,
                "{interface}.{key}"
            );
        }
        if let Type::Named(inner) = &declared_key.holds
            && declared.is_interface(inner)
        {
            check_request(declared, request, &at, inner);
        }
    }
}

#[test]
fn requests_are_read_as_the_page_sends_them() {
    let declared = declarations();
    let requests = &declared.interface("Requests").keys;
    let known = expected(serde_json::from_value::<Request>(
        json!({ "do": "no such request" }),
    ));
    assert_eq!(known, names(requests.keys()));
    for (name, key) in requests {
        let Type::Named(interface) = &key.holds else {
            panic!("{name}")
        };
        for sample in declared.samples(&key.holds) {
            let request =
                read(name, &[], sample.clone()).unwrap_or_else(|error| panic!("{name} {sample}: {error}"));
            assert_eq!(request.name(), name);
        }
        check_request(&declared, name, &[], interface);
    }
}

/// Hands `check` every kind of reply, which between them have every kind of value that each of their keys may
/// hold.
fn each_reply(check: &mut impl FnMut(&Reply)) {
    let text = "[[texture]]\nshape = 'cavity'\ncoverage = 5\n";
    let document = Document::new("case", text, |_| Err("there is no file".to_owned())).unwrap();
    let case = document.case(&mut |_| true).unwrap();
    let presets = [PresetEntry {
        name: "circle",
        group: "cases",
        title: "A circle",
    }];
    for results in [None, Some("results")] {
        check(&Reply::Hello {
            version: "1",
            presets: &presets,
            folders: &["run".to_owned()],
            results,
            max_blocks: 1,
            controls: &CONTROLS,
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
            values: controls::values(&case),
            units: Units {
                time_s: 1.0,
                displacement_m: 1.0,
                speed_m_s: 1.0,
                stress_pa: 1.0,
            },
            dt_star: 0.1,
            duration_star: 400.0,
            kinetic_from_star,
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
            too_coarse,
            search: search::limits(&case),
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
    let summaries = summaries.map(|summary| serde_json::from_str(&summary_json(&summary)).unwrap());
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
    check(&Reply::Refused {
        of: "set",
        sentence: String::new(),
    });
    check(&Reply::Failed {
        sentence: String::new(),
    });
}

#[test]
fn replies_have_the_keys_and_values_that_the_page_expects() {
    let declared = declarations();
    let replies = &declared.interface("Replies").keys;
    let (mut seen, mut all) = (Seen::new(), Seen::new());
    let mut shown = BTreeSet::new();
    each_reply(&mut |reply| {
        let mut value = serde_json::to_value(reply).unwrap();
        let is = value.as_object_mut().unwrap().remove("is").unwrap();
        let name = is.as_str().unwrap();
        assert!(
            declared.check(&value, &replies[name].holds, &mut seen),
            "{name}: {value}"
        );
        shown.insert(name.to_owned());
    });
    assert_eq!(shown, names(replies.keys()));
    for key in replies.values() {
        let Type::Named(interface) = &key.holds else {
            panic!("{key:?}")
        };
        declared.all_of(interface, "Texture", &mut all);
    }
    // Its keys are those of the case file.
    seen.retain(|(interface, ..)| interface != "Texture");
    let odd: Vec<_> = seen.symmetric_difference(&all).collect();
    assert!(
        odd.is_empty(),
        "declared and never seen, or the other way round: {odd:?}"
    );
}

#[test]
fn textures_have_the_keys_of_the_case_file() {
    let declared = declarations();
    let keys = &declared.interface("Texture").keys;
    let shapes = SECTIONS.iter().filter(|section| section.is_shape);
    let mut known = BTreeSet::from(["shape".to_owned()]);
    for key in shapes.clone().flat_map(|section| section.keys) {
        known.insert(key.name.to_owned());
        let holds = match key.kind {
            KeyKind::Number { .. } | KeyKind::Whole { .. } => Type::Number,
            KeyKind::Quantity { .. } | KeyKind::Words(_) | KeyKind::File(_) => Type::Text,
            KeyKind::Switch => Type::Boolean,
            KeyKind::Table(..) | KeyKind::Special(_) => continue,
        };
        assert_eq!(keys[key.name].holds, holds, "{}", key.name);
    }
    assert_eq!(names(keys.keys()), known);
    let words = shapes.map(|section| Type::Literal(section.name.to_owned()));
    assert_eq!(
        declared.alternatives(&keys["shape"].holds),
        words.collect::<Vec<_>>()
    );
}

#[test]
fn fields_have_the_numbers_of_pictures() {
    let fields = declarations().alternatives(&Type::Named("Field".to_owned()));
    let names: Vec<String> = fields
        .iter()
        .enumerate()
        .map(|(number, field)| {
            let Type::Literal(name) = field else {
                panic!("{field:?}")
            };
            let shown: DisplayedField = serde_json::from_value(json!(name)).unwrap();
            assert_eq!(shown as usize, number, "{name}");
            format!("'{name}'")
        })
        .collect();
    let list = format!("FIELDS = [{}];", names.join(", "));
    assert!(
        include_str!("../../../slipfront-lab/web/frames.js").contains(&list),
        "{list}"
    );
}
