//! Tests of sessions without threads: what is due when, and the search for a better texture.

use std::time::Duration;

use serde_json::{Value, json};

use crate::live::LiveRun;
use crate::testing::TestSession;

const PLAIN: &str = "slider.blocks = [20, 20]\ndrive.v_star = 0.1\n";

/// More calls of a session than any finished job needs.
const MOST_LOOKS: usize = 10_000;

impl TestSession {
    /// Begins a search, and returns the sentence if it is refused.
    fn find(&mut self) -> Option<String> {
        let replies = self.ask(json!({ "do": "find", "gesture": 1000 }));
        let refused = replies.iter().find(|reply| reply["is"] == "refused");
        refused.map(|reply| reply["sentence"].as_str().unwrap().to_owned())
    }

    /// Calls the session until a reply of this name fulfils a condition; returns all replies up to then.
    fn follow(&mut self, is: &str, holds: impl Fn(&Value) -> bool) -> Vec<Value> {
        let mut all = Vec::new();
        for _ in 0..MOST_LOOKS {
            self.now += Duration::from_millis(250);
            self.advance();
            all.extend(self.replies());
            if let Some(end) = all.iter().position(|reply| reply["is"] == is && holds(reply)) {
                all.truncate(end + 1);
                return all;
            }
        }
        panic!("no {is} came after {all:?}");
    }

    /// Passes a request, and calls the session until a reply of this name; returns all replies up to then.
    fn ask_for(&mut self, request: Value, is: &str) -> Vec<Value> {
        let mut all = self.ask(request);
        if count(&all, is) == 0 {
            all.extend(self.follow(is, |_| true));
        }
        all.retain(|reply| reply["is"] != "curve");
        all
    }

    /// The reply with the result of the search.
    fn found(&mut self) -> Value {
        self.follow("found", |_| true).pop().unwrap()
    }

    fn textured(&self) -> Vec<bool> {
        let live = self.session.live.as_ref().unwrap();
        live.case().model.surface.textured.clone()
    }

    fn step(&self) -> u64 {
        self.session.live.as_ref().unwrap().step()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Number of replies with this name.
fn count(replies: &[Value], is: &str) -> usize {
    replies.iter().filter(|reply| reply["is"] == is).count()
}

#[test]
fn nothing_is_due_before_a_case_is_open_and_while_nothing_moves() {
    let mut test = TestSession::new();
    assert_eq!(test.advance(), None);
    // A page sends its view first, when there is nothing to draw yet.
    test.ask(json!({ "do": "view", "field": "speed" }));
    assert_eq!(test.advance(), None);
    test.ask(json!({ "do": "open", "source": { "toml": PLAIN } }));
    assert!(test.advance().is_some());
    test.ask(json!({ "do": "view", "paused": true }));
    test.advance();
    assert_eq!(test.advance(), None);
    let step = test.step();
    test.ask(json!({ "do": "step", "count": 7 }));
    assert_eq!((test.step(), test.advance()), (step + 7, None));
    // Another call changes nothing.
    let pictures = test.host.pictures.take().len();
    test.now += Duration::from_secs(1);
    assert_eq!(
        (test.advance(), test.host.pictures.take().len()),
        (None, 0),
        "after {pictures}"
    );
    // A hidden page does not advance, and a page that reads nothing gets nothing.
    test.ask(json!({ "do": "view", "paused": false, "visible": false }));
    assert_eq!(test.advance(), None);
    test.host.is_full.set(true);
    test.ask(json!({ "do": "view", "visible": true }));
    let due = test.advance().unwrap();
    assert!(due > test.now, "it asks at once, for ever");
    assert_eq!(test.step(), step + 7);
}

/// With 25 t* per second and steps of 1 ms, a second has 25 / dt* steps, and a picture comes every 1/60 s.
#[test]
fn steps_keep_the_pace_and_pictures_their_rate() {
    let mut test = TestSession::new();
    test.ask(json!({ "do": "open", "source": { "toml": PLAIN } }));
    let dt_star = test.session.live.as_ref().unwrap().case().time_plan.dt_star;
    let began = Duration::from_secs(1);
    test.advance_until(began, Duration::from_millis(1));
    let (before, pictures) = (test.step(), test.host.pictures.take().len());
    assert!(pictures > 30, "{pictures}");
    test.advance_until(2 * began, Duration::from_millis(1));
    let steps = test.step() - before;
    // The tolerance is the steps of one picture at either end.
    let due = 25.0 / dt_star;
    assert!(
        (steps as f64 - due).abs() <= due / 30.0,
        "{steps} steps in a second, where {due} are due"
    );
    let pictures = test.host.pictures.take().len();
    assert!((55..=60).contains(&pictures), "{pictures}");
}

/// A run has a pace of 40 t* per second until a block in contact slips, and of 2 t* per second afterwards.
#[test]
fn a_run_is_loaded_at_a_pace_of_its_own() {
    let mut test = TestSession::new();
    test.ask(json!({ "do": "view", "pace": 2, "loading_pace": 40 }));
    test.ask(json!({ "do": "open", "source": { "toml": PLAIN } }));
    let now = |test: &TestSession| {
        let live = test.session.live.as_ref().unwrap();
        (live.has_slipped(), live.time_star())
    };
    let after = |test: &mut TestSession, milliseconds| {
        test.advance_until(
            test.now + Duration::from_millis(milliseconds),
            Duration::from_millis(1),
        );
        now(test)
    };
    // 10 t*, minus the steps of one picture at either end.
    let (has_slipped, loaded) = after(&mut test, 250);
    assert!(!has_slipped && loaded > 8.5, "{has_slipped} {loaded}");
    while !after(&mut test, 20).0 {
        assert!(test.now < Duration::from_secs(2), "no block slips");
    }
    let (_, slipped) = now(&test);
    let (_, later) = after(&mut test, 1000);
    assert!((later - slipped - 2.0).abs() < 0.2, "{slipped} {later}");
}

/// A page changes the case at every movement of the pointer, but the case is made only once per picture.
#[test]
fn changes_between_two_pictures_are_run_once() {
    let mut test = TestSession::new();
    test.ask(json!({ "do": "view", "pace": 0 }));
    test.ask(json!({ "do": "open", "source": { "toml": PLAIN } }));
    let mut replies = Vec::new();
    for number in 0..100 {
        test.now += Duration::from_millis(1);
        let keys = json!({ "friction.r_star": 0.3 + 0.001 * f64::from(number) });
        replies.extend(test.ask(json!({ "do": "set", "keys": keys, "gesture": 1 })));
    }
    let cases = count(&replies, "case");
    assert!((5..=8).contains(&cases), "{cases} cases in 100 ms");
    test.advance_until(test.now + Duration::from_millis(40), Duration::from_millis(1));
    let live = test.session.live.as_ref().unwrap();
    assert_eq!(live.case().groups.r_star, 0.3 + 0.001 * 99.0);
    // All changes of one gesture are undone together.
    test.ask(json!({ "do": "undo" }));
    let live = test.session.live.as_ref().unwrap();
    assert_eq!(live.case().groups.r_star, 0.5);
}

/// Each stage of the transition is reported in the step in which it is detected. The field of the front then
/// has sliding blocks, blocks that have slipped and blocks that have not.
#[test]
fn the_stages_of_a_transition_are_told_at_once() {
    let mut test = TestSession::new();
    test.ask(json!({ "do": "view", "pace": 25, "field": "front" }));
    let toml = "slider.blocks = [20, 20]\nfriction.sigma_static_star = 0.1\ndrive.v_star = 0.03\n";
    test.ask(json!({ "do": "open", "source": { "toml": toml } }));
    let (mut stages, mut kinds) = (0, [false; 3]);
    while stages < 3 {
        let before = test.session.live.as_mut().unwrap().look_for_stages();
        assert_eq!(before, stages, "a stage was not told");
        test.now = test.advance().unwrap().max(test.now + Duration::from_millis(1));
        let replies = test.replies();
        for numbers in replies.iter().filter(|reply| reply["is"] == "numbers") {
            let seen = [
                !numbers["instants"]["B"].is_null(),
                numbers["peak"]["certain"] == true,
                numbers["crossed"] == true,
            ];
            stages = seen.into_iter().filter(|is_seen| *is_seen).count();
        }
        for picture in test.host.pictures.take() {
            let values = &picture[36..];
            kinds[0] |= values.contains(&252);
            kinds[1] |= values.contains(&253);
            kinds[2] |= values.iter().any(|value| *value <= 250);
        }
    }
    assert_eq!(kinds, [true; 3]);
}

/// At rest no value is above 0, and the scale ends at the unit itself, not at a small power of ten.
#[test]
fn the_scale_of_a_slider_at_rest_goes_to_1() {
    let mut test = TestSession::with(PLAIN);
    for field in ["traction", "displacement", "speed"] {
        test.ask(json!({ "do": "view", "field": field }));
        let picture = test.host.pictures.borrow_mut().pop().unwrap();
        assert_eq!(
            picture[24..32],
            [0.0_f32, 1.0].map(f32::to_le_bytes).concat(),
            "{field}"
        );
    }
}

/// The ends of the run and of its twin are each reported once, and then nothing is due.
#[test]
fn a_run_and_its_twin_go_to_their_ends() {
    let mut test = TestSession::new();
    test.ask(json!({ "do": "view", "pace": 0 }));
    let toml = "slider.blocks = [6, 6]\ndrive.v_star = 0.1\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n";
    test.ask(json!({ "do": "open", "source": { "toml": toml } }));
    test.advance_until(Duration::from_secs(600), Duration::from_millis(2));
    assert_eq!(test.advance(), None);
    test.host.pictures.take();
    test.now += Duration::from_secs(1);
    assert_eq!((test.advance(), test.host.pictures.take().len()), (None, 0));
    let replies = test.replies();
    let last = replies
        .iter()
        .rev()
        .find(|reply| reply["is"] == "numbers")
        .unwrap();
    assert_eq!(last["ended"], true);
    assert!(!last["summary"].is_null());
    assert!(number(&last["change_percent"]) < 0.0, "{last}");
}

/// The curves that a page has drawn from the replies.
#[derive(Default)]
struct DrawnCurves {
    run: Vec<[f64; 2]>,
    twin: Vec<[f64; 2]>,
    recorded: usize,
}

impl DrawnCurves {
    fn take(&mut self, replies: &[Value]) {
        for reply in replies {
            if reply["is"] == "case" && reply["why"] == "open" {
                self.recorded = 0;
            }
            if reply["is"] != "curve" {
                continue;
            }
            if reply["from_rest"] == true {
                self.run.clear();
            }
            if reply["twin_reset"] == true {
                self.twin.clear();
            }
            let points = |t: &str, mu: &str| {
                let of = |key: &str| {
                    reply[key]
                        .as_array()
                        .unwrap()
                        .iter()
                        .map(number)
                        .collect::<Vec<_>>()
                };
                std::iter::zip(of(t), of(mu))
                    .map(|(t, mu)| [t, mu])
                    .collect::<Vec<_>>()
            };
            self.run.extend(points("t", "mu"));
            self.twin.extend(points("twin_t", "twin_mu"));
            self.recorded += reply["recorded_t"].as_array().map_or(0, Vec::len);
        }
    }
}

/// Checks a curve against the rows of its run: all rows of the present leg are there, and no row is missing
/// at the end of a previous leg.
fn assert_whole(curve: &[[f64; 2]], live: &LiveRun) {
    let before = live.before.drive_time_star;
    let rows = live.running().rows().iter();
    let rows: Vec<[f64; 2]> = rows
        .map(|row| [before + row.drive_time_star, row.point.mu_star])
        .collect();
    assert!(curve.ends_with(&rows));
    assert!(live.leg > 0 || curve.len() == rows.len());
    let spacing = rows[1][0] - rows[0][0];
    assert!(curve[0][0] <= spacing);
    for pair in curve.windows(2) {
        let gap = pair[1][0] - pair[0][0];
        // Times are sums over some ten legs, each of them rounded.
        assert!((0.0..spacing * (1.0 + 1e-9)).contains(&gap), "{gap} {spacing}");
    }
}

/// After any sequence of opening, changing, undoing and replaying cases, the page has the whole curves of the
/// run and of the slider without texture.
#[test]
fn curves_are_whole_after_any_order_of_requests() {
    const KEYS: &str = "slider.blocks = [6, 6]\ndrive.v_star = 0.1\ntime.duration_star = 20\n";
    let textured = |percent: u32| format!("{KEYS}[[texture]]\nshape = 'cavity'\ncoverage = {percent}\n");
    let [one, two] = [textured(10), textured(20)];
    let surface = format!("{one}[friction]\nmu_static_field = 'mu.csv'\n");
    let rows = |mu: &str| vec![[mu; 6].join(","); 6].join("\n");
    let files = |mu: &str| json!({ "mu.csv": crate::base64::encode(rows(mu).as_bytes()) });
    let run = run_files(&one);
    let open = |source: Value| json!({ "do": "open", "source": source });
    let requests = [
        open(json!({ "toml": one })),
        open(json!({ "toml": two })),
        open(json!({ "toml": KEYS })),
        open(json!({ "toml": surface, "files": files("0.5") })),
        open(json!({ "toml": surface, "files": files("0.6") })),
        open(json!({ "name": "kept", "run": run })),
        open(json!({ "toml": "slider.blocks = [0, 6]" })),
        json!({ "do": "set", "keys": { "friction.r_star": 0.5 }, "gesture": 1 }),
        json!({ "do": "set", "keys": { "friction.r_star": 0.7 }, "gesture": 4 }),
        json!({ "do": "set", "keys": { "texture": [{ "shape": "cavity", "coverage": 15 }] }, "gesture": 2 }),
        json!({ "do": "paint", "points": [[2.5, 2.5]], "radius": 0.3, "textured": true, "gesture": 3 }),
        json!({ "do": "undo" }),
        json!({ "do": "redo" }),
        json!({ "do": "rest" }),
        json!({ "do": "view", "twin": false }),
        json!({ "do": "view", "twin": true }),
        json!({ "do": "view", "after_change": "go_on" }),
        json!({ "do": "view", "after_change": "rest" }),
        json!({ "do": "view", "paused": true }),
        json!({ "do": "view", "paused": false }),
    ];
    let mut random: u32 = 1;
    let mut below = |bound: u32| {
        // A 32-bit generator: its upper half has no short period.
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 16) % bound
    };
    let (mut ends_with_twin, mut ends_with_legs) = (0, 0);
    for _ in 0..60 {
        let mut test = TestSession::new();
        let mut drawn = DrawnCurves::default();
        drawn.take(&test.ask(open(json!({ "toml": one }))));
        for _ in 0..12 {
            let request = &requests[below(requests.len() as u32) as usize];
            drawn.take(&test.ask(request.clone()));
            let end = test.now + Duration::from_millis(u64::from(below(600)));
            test.advance_until(end, Duration::from_millis(2));
            drawn.take(&test.replies());
        }
        drawn.take(&test.ask(json!({ "do": "view", "paused": false, "pace": 0 })));
        test.advance_until(test.now + Duration::from_secs(600), Duration::from_millis(2));
        drawn.take(&test.replies());
        let session = &test.session;
        assert_whole(&drawn.run, session.live.as_ref().unwrap());
        match &session.twin {
            Some(twin) => assert_whole(&drawn.twin, &twin.live),
            None => assert!(drawn.twin.is_empty()),
        }
        let recorded = session.recorded.as_ref();
        assert_eq!(
            drawn.recorded,
            recorded.map_or(0, |recorded| recorded.time_star.len())
        );
        ends_with_twin += usize::from(session.twin.is_some());
        ends_with_legs += usize::from(session.twin.as_ref().is_some_and(|twin| twin.live.leg > 0));
    }
    assert!(
        ends_with_twin > 15 && ends_with_legs > 1,
        "{ends_with_twin} {ends_with_legs}"
    );
}

#[test]
fn static_friction_over_seeds_is_told_seed_by_seed_and_saving_is_left_to_the_host() {
    let mut test = TestSession::with(PLAIN);
    let mut replies = test.ask(json!({ "do": "repeat", "seeds": 3 }));
    replies.extend(test.follow("repeated", |reply| reply["finished"] == true));
    let done: Vec<_> = replies
        .iter()
        .filter(|reply| reply["is"] == "repeated")
        .map(|reply| reply["done"].as_u64().unwrap())
        .collect();
    assert_eq!(done, [1, 2, 3]);
    assert!(test.session.repeating.is_none());
    for seeds in [1, 33] {
        let said = test.ask(json!({ "do": "repeat", "seeds": seeds }));
        assert_eq!(count(&said, "refused"), 1, "{said:?}");
    }
    test.ask(json!({ "do": "save", "name": "run" }));
    test.ask(json!({ "do": "save_stop", "name": "run" }));
    assert_eq!(
        (test.host.saves.take(), test.host.stops.take()),
        (vec!["run".to_owned()], vec!["run".to_owned()])
    );
}

#[test]
fn the_best_of_a_stopped_search_replaces_the_painted_texture_and_undo_brings_it_back() {
    let mut test = TestSession::with(PLAIN);
    // A single row is no texture that a search would try.
    test.ask(json!({
        "do": "paint", "points": [[0.5, 0.5], [4.5, 0.5]], "radius": 0.3, "textured": true, "gesture": 1,
    }));
    let painted = test.textured();
    assert_eq!(painted.iter().filter(|block| **block).count(), 5);
    assert_eq!(test.find(), None);
    let said = test.find().unwrap();
    assert!(said.contains("is being searched for already"), "{said}");
    let seen = test.follow("finding", |reply| !reply["best_percent"].is_null());
    let seen = seen.last().unwrap();
    assert!(
        number(&seen["textures"]) > 0.0 && number(&seen["best_percent"]) < 0.0,
        "{seen}"
    );
    assert!(!seen["best_texture"].as_array().unwrap().is_empty());
    assert_eq!(test.textured(), painted);
    let mut replies = test.ask(json!({ "do": "find_stop" }));
    replies.extend(test.follow("found", |_| true));
    assert!(
        replies
            .iter()
            .any(|reply| reply["is"] == "finding" && reply["compares"] == true)
    );
    let found = replies.last().unwrap();
    let case = replies.iter().find(|reply| reply["is"] == "case").unwrap();
    assert_eq!(found["outcome"], "replaced", "{found}");
    assert!(
        number(&found["best"]["mean"]) < number(&found["painted"]["mean"]),
        "{found}"
    );
    assert!(
        number(&found["best"]["half_width"]) > 0.0 && found["surfaces"] == 8,
        "{found}"
    );
    assert_eq!((&case["is"], &case["why"]), (&json!("case"), &json!("change")));
    // A search may cover 3 % if less is painted.
    let percent = number(&case["texture_percent"]);
    assert!(percent > 1.25 && percent <= 3.0, "{percent}");
    assert_ne!(test.textured(), painted);
    test.ask(json!({ "do": "undo" }));
    assert_eq!(test.textured(), painted);
    test.ask(json!({ "do": "redo" }));
    assert_ne!(test.textured(), painted);
}

/// The search of this host reports its best texture, but does not end.
#[test]
fn a_search_ends_when_its_time_is_over() {
    let mut test = TestSession::with(PLAIN);
    test.host.is_endless.set(true);
    assert_eq!(test.find(), None);
    let began = test.now;
    let found = test.found();
    assert!(test.now - began >= Duration::from_secs(60));
    // Nothing was painted.
    assert!(
        found["outcome"] == "replaced" && found["painted"].is_null(),
        "{found}"
    );
    assert!(number(&found["best"]["mean"]) < -1.0, "{found}");
}

/// The slider has room for one square, in three places. A first search finds the best of them.
#[test]
fn a_texture_that_nothing_is_better_than_stays() {
    let mut test = TestSession::with("slider.blocks = [9, 3]\ndrive.v_star = 0.1\n");
    test.ask(json!({
        "do": "paint", "points": [[1.5, 1.5]], "radius": 1.6, "textured": true, "gesture": 1,
    }));
    assert_eq!(test.textured().iter().filter(|block| **block).count(), 9);
    assert_eq!(test.find(), None);
    test.found();
    let best = test.textured();
    assert_eq!(test.find(), None);
    let replies = test.follow("found", |_| true);
    assert!(replies.iter().all(|reply| reply["is"] != "case"), "{replies:?}");
    let found = replies.last().unwrap();
    assert_eq!(found["outcome"], "kept", "{found}");
    assert_eq!(found["best"], found["painted"]);
    assert_eq!(test.textured(), best);
}

#[test]
fn a_change_by_hand_gives_a_search_up() {
    for change in [
        json!({ "do": "set", "keys": { "friction.r_star": 0.4 }, "gesture": 2 }),
        json!({ "do": "paint", "points": [[5, 5]], "radius": 2, "textured": true, "gesture": 3 }),
        json!({ "do": "undo" }),
        json!({ "do": "open", "source": { "toml": PLAIN } }),
    ] {
        let mut test = TestSession::with(PLAIN);
        test.ask(json!({ "do": "set", "keys": { "friction.r_star": 0.3 }, "gesture": 1 }));
        assert_eq!(test.find(), None);
        // Requests that change nothing do not end the search.
        for other in [
            json!({ "do": "rest" }),
            json!({ "do": "redo" }),
            json!({ "do": "view", "pace": 3 }),
        ] {
            test.ask(other);
        }
        test.ask(json!({ "do": "set", "keys": { "friction.r_star": -1 }, "gesture": 1 }));
        assert!(test.session.search.is_some());
        let replies = test.ask(change.clone());
        assert!(test.session.search.is_none(), "{change}");
        let found = replies.iter().find(|reply| reply["is"] == "found").unwrap();
        assert_eq!(found["outcome"], "given_up");
    }
}

#[test]
fn what_cannot_be_searched_for_is_refused_with_the_reason() {
    let said = TestSession::new().find().unwrap();
    assert_eq!(said, "no case is open yet");
    for (case, reason) in [
        (
            "slider.blocks = [1, 2]",
            "the slider has 1 x 2 blocks, where the narrowest feature",
        ),
        (
            "slider.blocks = [700, 700]\ndrive.v_star = 0.001",
            "the slider is too large for a search of a minute: to try a texture takes",
        ),
    ] {
        let said = TestSession::with(case).find().unwrap();
        assert!(said.starts_with(reason), "{said}");
    }
    // This is known only once the search has begun.
    let mut narrow = TestSession::with("slider.blocks = [7, 3]\ndrive.v_star = 0.1");
    assert_eq!(narrow.find(), None);
    let replies = narrow.follow("found", |found| found["outcome"] == "failed");
    let refused = replies.iter().find(|reply| reply["is"] == "refused").unwrap();
    let said = refused["sentence"].as_str().unwrap();
    assert!(
        said.starts_with("no texture whose features and gaps are 3 blocks wide covers as little"),
        "{said}"
    );
}

/// A search that is stopped before it has reported anything.
#[test]
fn a_search_that_is_stopped_at_once_has_found_nothing() {
    let mut test = TestSession::with(PLAIN);
    test.session
        .handle(crate::protocol::Message::parse(&json!({ "do": "find", "gesture": 5 }).to_string()).unwrap());
    let search = test.session.search.as_mut().unwrap();
    // Events up to now are ignored.
    search.task = Box::new(Silent);
    let replies = test.ask(json!({ "do": "find_stop" }));
    let refused = replies.iter().find(|reply| reply["is"] == "refused").unwrap();
    assert_eq!(
        refused["sentence"],
        "the search was stopped before it had tried a texture: nothing has changed"
    );
    assert_eq!(count(&replies, "found"), 1);
}

/// A task without events.
struct Silent;

impl crate::host::Task for Silent {
    fn next_event(&mut self) -> Option<crate::event::Event> {
        None
    }
}

/// Shapes of the textures of the present case.
fn shapes(test: &TestSession) -> Vec<String> {
    let textures = test.session.document().unwrap().textures();
    let shape = |texture: &Value| texture["shape"].as_str().unwrap().to_owned();
    textures.as_array().unwrap().iter().map(shape).collect()
}

/// Painting between shapes, erasing the paint, and erasing part of a shape.
#[test]
fn paint_is_a_layer_beside_the_shapes_until_a_part_of_one_is_taken_away() {
    let mut test = TestSession::with(
        "slider.blocks = [20, 20]\ntexture = [{ shape = 'cavity', coverage = 5 }, { shape = 'groove', coverage = 10, offset = '-8 um' }]\n",
    );
    let before = test.textured();
    let mut paint = |y: f64, textured: bool, gesture: u64| {
        test.ask(json!({
            "do": "paint", "points": [[6.5, y], [17.5, y]], "radius": 0.3, "textured": textured, "gesture": gesture,
        }));
        (shapes(&test), test.textured())
    };
    // Two strokes form one layer with 12 blocks in each row. None of them are blocks of the groove.
    for (y, blocks) in [(1.5, 12), (3.5, 24)] {
        let (shapes, textured) = paint(y, true, 1);
        assert_eq!(shapes, ["cavity", "groove", "mask"]);
        let added = textured.iter().zip(&before).filter(|(now, then)| now != then);
        assert_eq!(added.count(), blocks);
    }
    // Without paint there is no layer.
    assert_eq!(paint(1.5, false, 2).0, ["cavity", "groove", "mask"]);
    let (shapes, textured) = paint(3.5, false, 2);
    assert_eq!(
        (shapes, &textured),
        (vec!["cavity".to_owned(), "groove".to_owned()], &before)
    );
    // No texture can remove part of another one, so all become one mask.
    let (shapes, textured) = paint(10.5, false, 3);
    assert_eq!(shapes, ["mask"]);
    let row: Vec<usize> = (0..400).filter(|&b| before[b] != textured[b]).collect();
    assert!(!row.is_empty() && row.iter().all(|b| (10 * 20 + 6..10 * 20 + 18).contains(b)));
}

/// Paint below a shape stays, and is visible when the shape is moved away.
#[test]
fn paint_below_a_shape_stays() {
    let mut test =
        TestSession::with("slider.blocks = [20, 20]\ntexture = [{ shape = 'cavity', coverage = 5 }]\n");
    test.ask(
        json!({ "do": "paint", "points": [[10.5, 10.5]], "radius": 0.3, "textured": true, "gesture": 1 }),
    );
    let table = json!([{ "shape": "cavity", "coverage": 5, "center": ["4 um", "4 um"] }, { "shape": "mask", "file": "texture.png" }]);
    test.ask(json!({ "do": "set", "keys": { "texture": table }, "gesture": 2 }));
    assert!(test.textured()[10 * 20 + 10]);
}

/// The files of a run's folder, in Base64.
fn run_files(case: &str) -> serde_json::Map<String, Value> {
    let document = crate::document::Document::new("case", case, |_| Err("there is none".to_owned())).unwrap();
    let case = std::sync::Arc::new(document.case(&mut |_| true).unwrap());
    let mut record = slipfront_run::running::run(&case, 1).unwrap();
    let files = slipfront_run::results::in_memory(&case, &mut record).unwrap();
    let encoded = files.into_iter();
    encoded
        .map(|(name, contents)| (name, crate::base64::encode(&contents).into()))
        .collect()
}

#[test]
fn the_files_of_a_run_are_replayed_and_other_files_are_refused() {
    let mut test = TestSession::with(PLAIN);
    let files = run_files("slider.blocks = [4, 4]\ntime.duration_star = 20\noutput.snapshots = [5, 10]\n");
    let open = |files: &serde_json::Map<String, Value>| json!({ "do": "open", "source": { "name": "kept", "run": files } });
    let replies = test.ask(open(&files));
    let recorded = replies.iter().find(|reply| reply["is"] == "recorded").unwrap();
    assert_eq!(recorded["times_star"], json!([5.0, 10.0]));
    let case = replies.iter().find(|reply| reply["is"] == "case").unwrap();
    assert_eq!((&case["name"], &case["blocks"]), (&json!("kept"), &json!([4, 4])));
    let refused = |files: &serde_json::Map<String, Value>, test: &mut TestSession| {
        let replies = test.ask(open(files));
        let refused = replies.iter().find(|reply| reply["is"] == "refused");
        refused.map(|reply| reply["sentence"].as_str().unwrap().to_owned())
    };
    // A run without its file of fields, as when that is too large, is accepted.
    let mut without = files.clone();
    without.remove("fields.nc");
    assert_eq!(refused(&without, &mut test), None);
    for name in ["case.toml", "series.csv", "summary.json"] {
        let mut without = files.clone();
        without.remove(name);
        let said = refused(&without, &mut test).unwrap();
        assert_eq!(said, format!("kept is no folder of a run: it has no {name}"));
        let mut damaged = files.clone();
        damaged.insert(name.to_owned(), crate::base64::encode(b"[").into());
        let said = refused(&damaged, &mut test).unwrap();
        assert!(said.contains(name) || said.contains("kept:"), "{name}: {said}");
    }
    let mut damaged = files;
    damaged.insert("fields.nc".to_owned(), crate::base64::encode(b"CDF").into());
    let said = refused(&damaged, &mut test).unwrap();
    assert!(said.contains("fields.nc"), "{said}");
}

/// A slider of equal blocks that sticks and slips under a drive of constant speed.
const STICKS: &str = "slider.blocks = [4, 4]\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }\n\
                      drive.v_star = 0.1\n";

/// The file of a record that rises and falls, over 60 t*.
fn record() -> Value {
    let case = slipfront_case::case::Case::parse(STICKS, "case", "", &[]).unwrap();
    let row = |k: u32| {
        let t = f64::from(k);
        let mu = 0.6 * (0.05 * t).min(0.7 + 0.02 * (t % 7.0));
        format!("{},{mu}\n", t * case.scales.time())
    };
    let rows: String = (0..60).map(row).collect();
    let bytes = crate::base64::encode(format!("t (s),mu\n{rows}").as_bytes());
    json!({ "name": "rig.csv", "bytes": bytes })
}

fn calibration(unknowns: &Value) -> Value {
    json!({ "do": "calibrate", "record": record(), "shift": 0, "noise": 0.02, "runs": 200, "unknowns": unknowns })
}

fn two_unknowns() -> Value {
    json!({ "friction.mu_static": [0.3, 0.9], "friction.r_star": [0.4, 0.9] })
}

#[test]
fn a_record_is_read_and_stays_where_the_case_changes() {
    let mut test = TestSession::with(STICKS);
    // The session has not checked the job when the case changes.
    let message = json!({ "do": "read_record", "record": record() }).to_string();
    test.session
        .handle(crate::protocol::Message::parse(&message).unwrap());
    let replies = test.ask_for(
        json!({ "do": "set", "keys": { "drive.v_star": 0.2 }, "gesture": 1 }),
        "record",
    );
    let read = replies.iter().find(|reply| reply["is"] == "record").unwrap();
    assert_eq!(read["curve"]["values"], 60, "{read}");
    assert_eq!(read["curve"]["of"], "coefficient");
}

/// The host of the tests has two workers, which make the runs that the calibration wants.
#[test]
fn a_calibration_finds_what_one_of_the_command_finds() {
    let mut test = TestSession::with(STICKS);
    let replies = test.ask_for(calibration(&two_unknowns()), "calibrated");
    let stages: Vec<&Value> = replies
        .iter()
        .filter(|reply| reply["is"] == "calibrating")
        .collect();
    assert!(stages.len() > 2, "{stages:?}");
    let done = replies.last().unwrap();
    assert_eq!(done["outcome"], "done", "{done}");
    let results = &done["results"];
    // The calibration file from the page gives the same bits in one go.
    let toml = results["toml"].as_str().unwrap();
    let bytes = crate::base64::decode(record()["bytes"].as_str().unwrap()).unwrap();
    let files = slipfront_case::case::FilesInMemory::new();
    let mut alone =
        slipfront_calibrate::CalibrationInMemory::new(toml, files, ("rig.csv", bytes), 1).unwrap();
    let go_on = std::sync::atomic::AtomicBool::new(false);
    let found = alone.find(false, &go_on, &mut |_| {}).unwrap();
    let slipfront_calibrate::Outcome::Found(found) = found else {
        panic!("runs are wanted")
    };
    let numbers: Value = serde_json::from_str(&found.numbers).unwrap();
    for (k, unknown) in results["unknowns"].as_array().unwrap().iter().enumerate() {
        assert_eq!(unknown["median"], numbers["unknowns"][k]["median"]);
        assert_eq!(unknown["interval"], numbers["unknowns"][k]["interval"]);
    }
    assert_eq!(results["report"], found.report);
    assert_eq!(results["set"].as_object().unwrap().len(), 2);
    // The case accepts the medians as keys.
    let replies = test.ask(json!({ "do": "set", "keys": results["set"], "gesture": 2 }));
    assert_eq!(count(&replies, "refused"), 0, "{replies:?}");
}

#[test]
fn a_calibration_ends_with_its_case_and_by_a_stop() {
    for (request, outcome) in [
        (json!({ "do": "calibrate_stop" }), "stopped"),
        (
            json!({ "do": "set", "keys": { "drive.v_star": 0.2 }, "gesture": 1 }),
            "given_up",
        ),
    ] {
        let mut test = TestSession::with(STICKS);
        test.ask(calibration(&two_unknowns()));
        let replies = test.ask_for(request, "calibrated");
        let ended = replies.iter().find(|reply| reply["is"] == "calibrated").unwrap();
        assert_eq!(ended["outcome"], outcome);
    }
}

#[test]
fn what_cannot_be_calibrated_says_why() {
    let mut test = TestSession::with(STICKS);
    let one = test.ask(calibration(&json!({ "friction.r_star": [0.4, 0.9] })));
    let refused = one.iter().find(|reply| reply["is"] == "refused").unwrap();
    assert!(
        refused["sentence"].as_str().unwrap().contains("2 to 4"),
        "{refused}"
    );
    let wrong = json!({ "friction.mu_static": [0.3, 0.9], "friction.no_such": [0.4, 0.9] });
    let failed = test.ask_for(calibration(&wrong), "calibrated").pop().unwrap();
    assert_eq!(failed["outcome"], "failed");
    assert!(
        failed["sentence"].as_str().unwrap().contains("no_such"),
        "{failed}"
    );
}

#[test]
fn sensitivity_is_the_change_between_two_runs() {
    let mut test = TestSession::with("slider.blocks = [10, 10]\ndrive.v_star = 0.1");
    let kinetic = test
        .ask_for(json!({ "do": "sensitivity", "control": "r_star" }), "sensitivity")
        .pop()
        .unwrap();
    assert_eq!(kinetic["values"], json!([0.5, 0.55]));
    let scatter = test
        .ask_for(json!({ "do": "sensitivity", "control": "sigma" }), "sensitivity")
        .pop()
        .unwrap();
    // With more scatter, slip begins earlier.
    assert!(number(&scatter["percent"]) < -0.1, "{scatter}");
    for control in ["seed", "no such"] {
        let replies = test.ask(json!({ "do": "sensitivity", "control": control }));
        assert_eq!(count(&replies, "refused"), 1, "{replies:?}");
    }
}

#[test]
fn a_texture_is_drawn() {
    let mut test =
        TestSession::with("slider.blocks = [20, 20]\ntexture = [{ shape = 'cavity', coverage = 10 }]");
    let drawn = test
        .ask_for(json!({ "do": "drawing", "format": "dxf" }), "drawing")
        .pop()
        .unwrap();
    assert!(drawn["text"].as_str().unwrap().contains("CIRCLE"), "{drawn}");
    let mut plain = TestSession::with(STICKS);
    let refused = plain
        .ask_for(json!({ "do": "drawing", "format": "svg" }), "refused")
        .pop()
        .unwrap();
    assert!(
        refused["sentence"].as_str().unwrap().contains("no texture"),
        "{refused}"
    );
}
