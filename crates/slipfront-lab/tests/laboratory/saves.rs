//! Saving of runs, even if the page that asked for it is closed.

use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::laboratory::{Served, TIMEOUT};
use crate::page::Page;

const SMALL: &str = "slider.blocks = [20, 20]\ntime.duration_star = 200\n";

/// Takes some minutes; every test stops the runs that it has begun.
const LONG: &str = "slider.blocks = [300, 300]\ntime.duration_star = 1e5\n";

/// Waits until a condition holds.
fn wait_until(what: &str, holds: impl Fn() -> bool) {
    let began = Instant::now();
    while !holds() {
        assert!(began.elapsed() < TIMEOUT, "{what} did not come");
        std::thread::sleep(Duration::from_millis(10));
    }
}

fn names(reply: &Value) -> Vec<String> {
    let all = reply["under_way"].as_array().unwrap();
    all.iter()
        .map(|one| one["name"].as_str().unwrap().to_owned())
        .collect()
}

/// Waits for the next list of saves that has these names.
fn wait_for_names(page: &mut Page, wanted: &[&str]) -> Value {
    page.wait_for("the list of saves", |reply| {
        reply["is"] == "saving" && names(reply) == wanted
    })
}

/// Reloading or closing a page does not end the saving of its runs.
#[test]
fn a_page_that_goes_ends_no_save() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, SMALL);
    page.reply("case");
    page.send(&json!({ "do": "save", "name": "kept" }));
    wait_for_names(&mut page, &["kept"]);
    drop(page);
    let folder = lab.results().join("kept");
    wait_until("the run", || folder.join("manifest.json").exists());
    wait_until("a word in the terminal", || !lab.told_of("kept").is_empty());
    assert_eq!(
        lab.told_of("kept"),
        [format!("the run is saved in {}", folder.display())]
    );
    let run = slipfront_run::verify::inspect(&folder).unwrap();
    assert_eq!(
        slipfront_run::verify::verify_run(&run, &std::sync::atomic::AtomicBool::new(false))
            .unwrap()
            .differences,
        [""; 0]
    );
}

#[test]
fn a_new_page_is_told_what_is_being_saved_and_can_stop_it() {
    let lab = Served::new();
    let mut first = Page::with_case(&lab, LONG);
    first.reply("case");
    for name in ["one", "two"] {
        first.send(&json!({ "do": "save", "name": name }));
    }
    wait_for_names(&mut first, &["one", "two"]);
    drop(first);
    let mut second = Page::with_case(&lab, SMALL);
    wait_for_names(&mut second, &["one", "two"]);
    let moving = |reply: &Value| reply["under_way"][0]["share"].as_f64().unwrap() > 0.0;
    second.wait_for("progress", |reply| reply["is"] == "saving" && moving(reply));
    second.send(&json!({ "do": "save_stop", "name": "one" }));
    wait_for_names(&mut second, &["two"]);
    assert!(!lab.results().join("one").exists());
    let told = lab.told_of("one");
    assert!(
        told[0].contains("was not saved: it was stopped after"),
        "{told:?}"
    );
    // A request to stop saving an unknown name stops nothing.
    second.send(&json!({ "do": "save_stop", "name": "none" }));
    second.send(&json!({ "do": "save_stop", "name": "two" }));
    wait_for_names(&mut second, &[]);
    // All pages are notified when a run of any page is saved.
    let mut third = Page::with_case(&lab, SMALL);
    third.reply("case");
    third.send(&json!({ "do": "save", "name": "three" }));
    assert_eq!(second.reply("saved")["name"], "three");
    assert_eq!(third.reply("saved")["folders"], json!(["three"]));
}

#[test]
fn names_and_numbers_of_saves_are_bounded() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, LONG);
    page.reply("case");
    for name in ["a", "b", "c", "d"] {
        page.send(&json!({ "do": "save", "name": name }));
    }
    wait_for_names(&mut page, &["a", "b", "c", "d"]);
    let said = page.refusal(&json!({ "do": "save", "name": "e" }));
    assert!(said.contains("4 runs are being saved already"), "{said}");
    let said = page.refusal(&json!({ "do": "save", "name": "a" }));
    assert!(said.contains("take another name"), "{said}");
    page.send(&json!({ "do": "save_stop", "name": "d" }));
    wait_for_names(&mut page, &["a", "b", "c"]);
    assert!(!lab.results().join("d").exists());
}

/// The server does not write through a link in the folder of results.
#[cfg(unix)]
#[test]
fn nothing_is_saved_through_a_link() {
    let lab = Served::new();
    let elsewhere = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(lab.results()).unwrap();
    std::os::unix::fs::symlink(elsewhere.path(), lab.results().join("link")).unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join("none"), lab.results().join("nowhere")).unwrap();
    let mut page = Page::with_case(&lab, SMALL);
    page.reply("case");
    for name in ["link", "nowhere"] {
        let said = page.refusal(&json!({ "do": "save", "name": name }));
        assert!(said.contains("exists already"), "{said}");
    }
    assert_eq!(std::fs::read_dir(elsewhere.path()).unwrap().count(), 0);
}

/// A save that the end of the server interrupts is reported in the terminal, and leaves no unfinished folder.
#[test]
fn the_end_of_the_server_gives_up_what_is_being_saved() {
    let mut lab = Served::new();
    let mut page = Page::with_case(&lab, LONG);
    page.reply("case");
    page.send(&json!({ "do": "save", "name": "long" }));
    page.wait_for("progress", |reply| {
        reply["is"] == "saving" && reply["under_way"][0]["share"].as_f64() > Some(0.0)
    });
    lab.stop();
    assert_eq!(
        page.end().unwrap().1,
        "the laboratory was stopped in its terminal"
    );
    assert!(!lab.results().join("long").exists());
    let told = lab.told_of("long");
    assert!(
        told.len() == 1
            && told[0].contains("was not saved: the laboratory ended after")
            && told[0].ends_with("% of the run, whose unfinished folder is removed"),
        "{told:?}"
    );
}
