//! Replies, pictures and files that the server sends to a page.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::laboratory::{Served, TIMEOUT};
use crate::page::Page;

const CIRCLE: &str = "slider.blocks = [20, 20]\nfriction.sigma_static_star = 0\ntime.duration_star = 200\n[[texture]]\nshape = 'cavity'\n\
                      coverage = 10\n";

/// The code of the field of a picture.
const CONTACT_STRESS: u8 = 0;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Runs to the end, as fast as possible.
fn ended(page: &mut Page) -> Value {
    page.send(&json!({ "do": "view", "pace": 0 }));
    page.wait_for("the end", |reply| {
        reply["is"] == "numbers" && reply["ended"] == true && !reply["change_percent"].is_null()
    })
}

/// Numbers on the page equal the numbers of a run of the same case, to the last digit.
#[test]
fn the_numbers_are_those_of_a_run() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, CIRCLE);
    let end = ended(&mut page);
    let summary = |text: &str| {
        let case = slipfront_case::case::Case::parse(text, "case", "", &[]).unwrap();
        slipfront_run::running::run(&std::sync::Arc::new(case), 1)
            .unwrap()
            .summary
    };
    let (run, twin) = (summary(CIRCLE), summary(CIRCLE.split("[[").next().unwrap()));
    assert_eq!(number(&end["peak"]["mu_star"]), run.static_friction_star);
    assert_eq!(number(&end["twin_peak"]["mu_star"]), twin.static_friction_star);
    let change = 100.0 * (run.static_friction_star / twin.static_friction_star - 1.0);
    assert_eq!(number(&end["change_percent"]), change);
    assert_eq!(
        number(&end["summary"]["kinetic_friction_star"]),
        run.kinetic_friction_star.unwrap()
    );
    assert_eq!(
        number(&end["summary"]["front_speed_c_s"]),
        run.front_speed_c_s.unwrap()
    );
    for instant in &run.instants {
        let letter = instant.instant.to_string();
        assert_eq!(number(&end["instants"][&letter]), instant.time_star, "{letter}");
    }
}

/// A run saved by the page has the same bytes as with `slipfront run`, except in the manifest, which names
/// the program and the time.
#[test]
fn a_saved_run_has_the_bytes_of_the_command() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, CIRCLE);
    page.reply("case");
    // The saved case includes the painted texture.
    page.send(
        &json!({ "do": "paint", "points": [[4, 4], [16, 4]], "radius": 1.5, "textured": true, "gesture": 1 }),
    );
    page.wait_for("the case", |reply| reply["why"] == "change");
    page.send(&json!({ "do": "save", "name": "painted" }));
    let saved = page.reply("saved");
    assert_eq!(saved["folders"], json!(["painted"]));
    page.send(&json!({ "do": "export" }));
    let exported = page.reply("exported");

    let folder = tempfile::tempdir().unwrap();
    for (name, text) in exported["files"].as_object().unwrap() {
        use base64::Engine as _;
        let bytes = base64::prelude::BASE64_STANDARD
            .decode(text.as_str().unwrap())
            .unwrap();
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    let path = folder.path().join("painted.toml");
    std::fs::write(&path, exported["toml"].as_str().unwrap()).unwrap();
    let out = folder.path().join("out");
    let status = slipfront_run_of(&path, &out);
    assert!(status);
    let [mut ours, mut theirs] = [lab.results().join("painted"), out].map(|folder| files(&folder));
    for files in [&mut ours, &mut theirs] {
        files.retain(|(name, _)| name != "manifest.json");
    }
    let names = |files: &[(String, Vec<u8>)]| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&ours), names(&theirs));
    assert!(names(&ours).len() > 8, "{:?}", names(&ours));
    for ((name, one), (_, other)) in ours.iter().zip(&theirs) {
        assert!(one == other, "{name} differs");
    }
    // A folder is never replaced.
    let said = page.refusal(&json!({ "do": "save", "name": "painted" }));
    assert!(said.contains("exists already"), "{said}");
}

/// Runs the case into a folder with the functions of `slipfront run`.
fn slipfront_run_of(case: &std::path::Path, out: &std::path::Path) -> bool {
    use slipfront_case::case::{Case, Ranks};
    use slipfront_run::manifest::Processors;
    use slipfront_run::{pictures, results, run_folder::RunFolder, running};
    let case = std::sync::Arc::new(Case::load(case, &[], &mut |_| true, Ranks::ALONE).unwrap());
    let mut folder = RunFolder::prepare(out, false, &case.inputs).unwrap();
    results::write_case(&case, &mut folder).unwrap();
    let mut record = running::run(&case, 1).unwrap();
    pictures::write_run(
        &case,
        &mut record,
        folder,
        slipfront_run::clock::now(),
        Processors::threads(1),
    )
    .is_ok()
}

/// Names and contents of all files below a folder.
fn files(folder: &std::path::Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(
                files(&path)
                    .into_iter()
                    .map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)),
            );
        } else {
            found.push((name, std::fs::read(&path).unwrap()));
        }
    }
    found.sort();
    found
}

#[test]
fn paint_undo_and_redo_change_the_texture() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, "slider.blocks = [10, 8]\ntime.duration_star = 1e6\n");
    assert_eq!(number(&page.reply("case")["texture_percent"]), 0.0);
    let paint = |points: Value, radius: f64, textured: bool, gesture: u64| json!({ "do": "paint", "points": points, "radius": radius, "textured": textured, "gesture": gesture });
    let percent = |page: &mut Page, request: Value| {
        page.send(&request);
        number(&page.reply("case")["texture_percent"])
    };
    // The centres of 4 of 80 blocks are within 1 of the corner (5, 4); a line along the fifth row crosses all
    // 10.
    assert_eq!(percent(&mut page, paint(json!([[5, 4]]), 1.0, true, 1)), 5.0);
    assert_eq!(
        percent(&mut page, paint(json!([[0, 4.5], [10, 4.5]]), 0.4, true, 2)),
        15.0
    );
    // The same gesture again is undone together with the part before it.
    assert_eq!(percent(&mut page, paint(json!([[5, 4]]), 1.0, false, 2)), 10.0);
    assert_eq!(percent(&mut page, json!({ "do": "undo" })), 5.0);
    assert_eq!(percent(&mut page, json!({ "do": "undo" })), 0.0);
    assert_eq!(percent(&mut page, json!({ "do": "redo" })), 5.0);
    page.send(&json!({ "do": "redo" }));
    let case = page.reply("case");
    assert_eq!(
        (number(&case["texture_percent"]), &case["can_redo"]),
        (10.0, &json!(false))
    );
    // The picture shows the texture in its place: the row of y = 4 except for the four blocks in its middle
    // and below.
    page.send(&json!({ "do": "view", "field": "contact_stress", "paused": true }));
    // The picture may arrive before the numbers of the same time.
    while page.picture.get(1) != Some(&CONTACT_STRESS) {
        page.next_picture();
    }
    let (size, pixels) = page.picture.split_at(36);
    assert_eq!(size[32..36], [10, 0, 8, 0]);
    let textured: Vec<usize> = (0..80).filter(|&b| pixels[b] == 255).collect();
    assert_eq!(textured, [40, 41, 42, 43, 46, 47, 48, 49]);
}

#[test]
fn changes_go_on_or_begin_at_rest_as_was_chosen() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, "slider.blocks = [10, 10]\ntime.duration_star = 1e6\n");
    page.send(&json!({ "do": "view", "after_change": "go_on", "pace": 0 }));
    page.wait_for("some steps", |reply| {
        reply["is"] == "numbers" && number(&reply["step"]) > 100.0
    });
    page.send(&json!({ "do": "set", "keys": { "drive.speed": "0.2 mm/s" }, "gesture": 1 }));
    let case = page.wait_for("the change", |reply| reply["why"] == "change");
    assert_eq!(case["leg"], 1);
    let speed = number(&case["values"]["speed"]["si"]);
    // The speed was converted to V* and back.
    assert!((speed / 2e-4 - 1.0).abs() < 1e-15, "{speed}");
    assert!(number(&case["time_before_s"]) > 0.0);
    let numbers = page.wait_for("its numbers", |reply| {
        reply["is"] == "numbers" && !reply["instants"]["A"].is_null()
    });
    // Instants of a leg count from rest, like the curve.
    let before = number(&case["time_before_s"]) / number(&case["units"]["time_s"]);
    assert!(number(&numbers["instants"]["A"]) > before);
    // A change of the number of blocks makes another slider, which starts from rest.
    page.send(&json!({ "do": "set", "keys": { "slider.blocks": [12, 10] }, "gesture": 2 }));
    assert_eq!(
        page.wait_for("the change", |reply| reply["why"] == "change")["leg"],
        0
    );
    page.send(&json!({ "do": "rest" }));
    assert_eq!(page.wait_for("rest", |reply| reply["why"] == "rest")["leg"], 0);
}

/// A hidden page makes the server compute and send nothing.
#[test]
fn a_hidden_page_costs_nothing() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, "slider.blocks = [10, 10]\ntime.duration_star = 1e6\n");
    page.reply("numbers");
    page.send(&json!({ "do": "view", "visible": false }));
    // An answer shows that the request has arrived.
    page.send(&json!({ "do": "export" }));
    page.reply("exported");
    let pictures = page.pictures;
    page.socket
        .get_mut()
        .set_read_timeout(Some(Duration::from_millis(500)))
        .unwrap();
    let began = Instant::now();
    // Only messages under way may still arrive: one picture and its replies.
    while page.read().is_ok() {
        assert!(began.elapsed() < TIMEOUT, "messages do not end");
    }
    assert!(page.pictures <= pictures + 1);
}

#[test]
fn a_run_folder_is_shown_again() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, CIRCLE);
    page.reply("case");
    page.send(&json!({ "do": "save", "name": "first" }));
    page.reply("saved");
    page.send(&json!({ "do": "open", "source": { "folder": "first" } }));
    let case = page.wait_for("the case", |reply| {
        reply["why"] == "open" && reply["name"] == "first"
    });
    assert_eq!(case["blocks"], json!([20, 20]));
    let times = page.reply("recorded")["times_star"].clone();
    assert!(times.as_array().unwrap().len() >= 4, "{times}");
    let curve = page.wait_for("its curve", |reply| !reply["recorded_mu"].is_null());
    let largest = curve["recorded_mu"]
        .as_array()
        .unwrap()
        .iter()
        .map(number)
        .fold(0.0, f64::max);
    // The numbers are the same again.
    let end = ended(&mut page);
    assert_eq!(number(&end["summary"]["mu_star_max"]), largest);
    // A snapshot of the run can be shown.
    page.send(&json!({ "do": "frames_of", "index": 2 }));
    // The picture of the end may still be under way.
    while page.next_picture()[2] != 1 {}
    // A folder with changed files is not a run.
    std::fs::write(lab.results().join("first/case.toml"), "slider.blocks = [3, 3]").unwrap();
    let said = page.refusal(&json!({ "do": "open", "source": { "folder": "first" } }));
    assert!(said.contains("case.toml"), "{said}");
}

#[test]
fn the_uncertainty_is_that_of_several_seeds() {
    let lab = Served::new();
    let rough = CIRCLE.replace("sigma_static_star = 0\n", "sigma_static_star = 0.1\n");
    let mut page = Page::with_case(&lab, &rough);
    page.reply("case");
    page.send(&json!({ "do": "repeat", "seeds": 3 }));
    let repeated = page.wait_for("the last seed", |reply| reply["finished"] == true);
    let friction = |text: &str| -> Vec<f64> {
        (1..=3)
            .map(|seed| {
                let case =
                    slipfront_case::case::Case::parse(text, "case", "", &[format!("friction.seed={seed}")])
                        .unwrap();
                let record = slipfront_run::running::run(&std::sync::Arc::new(case), 1).unwrap();
                record.summary.static_friction_star
            })
            .collect()
    };
    let (with, without) = (friction(&rough), friction(rough.split("[[").next().unwrap()));
    let changes: Vec<f64> = with
        .iter()
        .zip(&without)
        .map(|(one, other)| 100.0 * (one / other - 1.0))
        .collect();
    let sample = slipfront_study::Sample::from_values(&changes, 0.95).unwrap();
    assert_eq!(number(&repeated["change_percent"]["mean"]), sample.mean);
    assert_eq!(
        number(&repeated["change_percent"]["half_width"]),
        sample.half_width.unwrap()
    );
    // Without a texture there is nothing to compare with.
    page.send(&json!({ "do": "set", "keys": { "texture": null }, "gesture": 1 }));
    page.send(&json!({ "do": "repeat", "seeds": 2 }));
    let repeated = page.wait_for("the last seed", |reply| reply["finished"] == true);
    assert_eq!(repeated["change_percent"], Value::Null);
    assert_eq!(repeated["without"], Value::Null);
}

#[test]
fn every_case_to_choose_from_can_be_shown() {
    let lab = Served::new();
    let mut page = Page::open(&lab);
    let hello = page.reply("hello");
    page.send(&json!({ "do": "view", "visible": false }));
    let presets = hello["presets"].as_array().unwrap();
    let cases = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases")).unwrap();
    let is_case = |path: &std::path::Path| path.extension().is_some_and(|ending| ending == "toml");
    let cases = cases
        .filter(|entry| is_case(&entry.as_ref().unwrap().path()))
        .count();
    assert_eq!(
        presets.iter().filter(|preset| preset["group"] != "paper").count(),
        cases
    );
    assert!(presets.iter().filter(|preset| preset["group"] == "paper").count() > 20);
    for preset in presets {
        assert!(!preset["title"].as_str().unwrap().is_empty(), "{preset}");
        page.send(&json!({ "do": "open", "source": { "preset": preset["name"] } }));
        let reply = page.wait_for("the case", |reply| {
            reply["is"] == "case" || reply["is"] == "refused"
        });
        assert_eq!(reply["is"], "case", "{preset}: {reply}");
    }
}
