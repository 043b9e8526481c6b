//! The search for a texture that is better than the painted one, and its end when the page or the server
//! ends.

use std::time::{Duration, Instant};

use serde_json::json;

use crate::laboratory::Served;
use crate::page::Page;

/// A texture takes some hundredths of a second, so the search continues until it is stopped.
const CASE: &str = "slider.blocks = [100, 100]\n";

/// A page with a search under way.
fn searching(lab: &Served) -> Page {
    let mut page = Page::with_case(lab, CASE);
    page.reply("case");
    page.send(&json!({ "do": "find", "gesture": 1 }));
    page.reply("finding");
    page
}

/// The page gets the progress of a search even while the run is paused and nothing else happens.
#[test]
fn a_search_goes_on_while_the_run_is_paused() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, "slider.blocks = [20, 20]\ndrive.v_star = 0.1\n");
    page.reply("case");
    page.send(&json!({ "do": "view", "paused": true }));
    page.send(&json!({ "do": "find", "gesture": 1 }));
    page.wait_for("a texture", |reply| {
        reply["is"] == "finding" && reply["best_percent"].as_f64().is_some()
    });
    page.send(&json!({ "do": "find_stop" }));
    assert_eq!(page.reply("found")["outcome"], "replaced");
}

#[test]
fn a_search_ends_with_its_page_and_with_the_server() {
    let mut lab = Served::new();
    drop(searching(&lab));
    let _page = searching(&lab);
    let began = Instant::now();
    lab.stop();
    // The server waits at most 10 s for work that continues.
    assert!(began.elapsed() < Duration::from_secs(10), "{:?}", began.elapsed());
}
