//! Messages of the laboratory's page, each to a session that has had those before it.
//!
//! An input that begins with a brace holds messages as they are, one in a line. The bytes of any other input
//! choose messages of every kind, with keys of the case and others, long paths, nested values, huge numbers,
//! shapes, images.

use std::thread;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::{Map, Value, json};
use slipfront_case::case_file::{KeyKind, SECTIONS};
use slipfront_lab::OfflineSession;

use crate::checks::readable;
use crate::long::{many, nested as nest};
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// Messages of a page.
pub(crate) const REQUESTS: Target = Target {
    name: "requests",
    check: requests,
    generated,
    files: &[],
    dictionary: Some("requests.dict"),
    max_bytes: 2048,
    // Eight runs of the 18 MB that opening 12 x 9 blocks was measured to take: the case and its twin, those
    // of the case before until they have ended, one that is saved, one repeated, and two of a search. A
    // message holds its text several times, and its tables take some tens of bytes a value.
    memory: Memory {
        bytes: 8 * 18_000_000,
        per_byte: 2048,
    },
    time: Time::READING,
    mutations: 150,
    repetitions: 10,
    long,
};

/// Messages with many of each thing that they may have, and with long and deep ones, each to a session with a
/// case.
fn long() -> Vec<Vec<u8>> {
    let open = "{\"do\":\"open\",\"source\":{\"toml\":\"slider.blocks = [12, 9]\"}}\n";
    let message = |begin: &str, piece: &str, end: &str| many(&format!("{open}{begin}"), piece, end);
    let set = "{\"do\":\"set\",\"gesture\":1,\"keys\":{";
    let toml = "{\"do\":\"open\",\"source\":{\"toml\":\"";
    vec![
        message(set, "\"friction.a#\":1,", "\"b\":1}}"),
        message(set, "\"texture.#.coverage\":1,", "\"b\":1}}"),
        message(set, "\"a#.b.c.d.e\":1,", "\"b\":1}}"),
        message(&format!("{set}\""), "a.", "a\":1}}"),
        message(
            &format!("{set}\"texture\":["),
            "{\"shape\":\"cavity\",\"coverage\":1},",
            "{}]}}",
        ),
        message(&format!("{set}\"output.snapshots\":["), "#,", "1e9]}}"),
        message(&format!("{set}\"friction.law\":\""), "\\n\\u00e9", "\"}}"),
        nest(&format!("{open}{set}\"texture\":"), "[", "", "]", "}}"),
        nest(&format!("{open}{set}\"texture\":"), "{\"a\":", "1", "}", "}}"),
        message(
            "{\"do\":\"paint\",\"radius\":2,\"textured\":true,\"gesture\":1,\"points\":[",
            "[1,1],[9,#],",
            "[1,1]]}",
        ),
        message(
            "{\"do\":\"image\",\"threshold\":0.5,\"gesture\":1,\"png\":\"",
            "AAAA",
            "\"}",
        ),
        message(toml, "[[texture]]\\nshape = 'cavity'\\ncoverage = 1\\n", "\"}}"),
        message(toml, "friction.mu_statik# = 1\\n", "\"}}"),
        message(&format!("{toml}a."), "a.", "a = 1\"}}"),
        message(
            "{\"do\":\"open\",\"source\":{\"toml\":\"\",\"files\":{",
            "\"a#\":\"AAAA\",",
            "\"b\":\"\"}}}",
        ),
        message(
            "{\"do\":\"open\",\"source\":{\"run\":{",
            "\"a#\":\"AAAA\",",
            "\"b\":\"\"}}}",
        ),
        message("{\"do\":\"save\",\"name\":\"", "a", "\"}"),
    ]
}

/// Stack of the thread that answers: an eighth of that of a page's own thread, so that excessive use shows
/// early. A stack that overflows ends the process.
const STACK: usize = 256 << 10;

/// Most messages of an input.
const MAX_MESSAGES: usize = 12;

/// Most digits of a number that may be one of blocks: larger lattices take time and memory rightly.
const MAX_DIGITS: usize = 2;

fn requests(input: &[u8]) {
    let messages = match input {
        [b'{', ..] => {
            let Ok(text) = std::str::from_utf8(input) else {
                return;
            };
            text.lines().take(MAX_MESSAGES).map(with_small_numbers).collect()
        }
        _ => chosen(input),
    };
    // An abort leaves no other trace of what has led to it: see run.sh.
    scratch::file("requests-input", input);
    // A file and no folder: names are looked at, and no run goes to its end, of which pictures would take all
    // the time.
    let results = scratch::file("results", b"");
    thread::scope(|scope| {
        let session = thread::Builder::new().stack_size(STACK);
        let work = || converse(&messages, results);
        session.spawn_scoped(scope, work).unwrap().join().unwrap();
    });
}

/// Says the messages one after the other, and checks what is replied.
fn converse(messages: &[String], results: std::path::PathBuf) {
    let mut session = OfflineSession::new(results);
    // It steps when it is told to: else it would take steps for a picture's time after every message.
    session.handle("{\"do\":\"view\",\"paused\":true}").unwrap();
    let mut toml = None;
    for message in messages {
        let Ok(replies) = session.handle(message) else {
            continue;
        };
        let replies: Vec<Value> = replies
            .iter()
            .map(|text| serde_json::from_str(text).unwrap())
            .collect();
        let (mut is_refused, mut is_changed) = (false, false);
        for reply in &replies {
            assert_ne!(reply["is"], "failed", "{message:.200}: {reply}");
            is_refused |= reply["is"] == "refused";
            is_changed |= reply["is"] == "case" && reply["why"] != "refused";
            if reply["is"] == "refused" {
                readable(&reply["sentence"].as_str().unwrap());
            }
        }
        let now = exported(&mut session);
        if is_refused && !is_changed {
            let texts = [&toml, &now].map(|case| case.as_ref().map(|case| case["toml"].clone()));
            assert_eq!(
                texts[0], texts[1],
                "a refused message has changed the case: {message:.200}"
            );
        }
        toml = now;
    }
    // What a link holds is the case.
    if let Some(case) = toml {
        let source = json!({ "toml": case["toml"], "files": case["files"] });
        session
            .handle(&json!({ "do": "open", "source": source }).to_string())
            .unwrap();
        let again = exported(&mut session).unwrap();
        assert_eq!((&again["toml"], &again["files"]), (&case["toml"], &case["files"]));
    }
    session.end();
}

/// The case as a page keeps it; none if none is open.
fn exported(session: &mut OfflineSession) -> Option<Value> {
    let replies = session.handle("{\"do\":\"export\"}").unwrap();
    let replies = replies
        .iter()
        .map(|text| serde_json::from_str::<Value>(text).unwrap());
    replies.into_iter().find(|reply| reply["is"] == "exported")
}

/// A text whose numbers of a lattice are small: longer ones are cut, unless they are beyond all lattices.
fn with_small_numbers(text: &str) -> String {
    let mut out = String::new();
    let mut digits = String::new();
    for c in text.chars().chain(['\n']) {
        if c.is_ascii_digit() {
            digits.push(c);
            continue;
        }
        if (MAX_DIGITS + 1..=7).contains(&digits.len()) {
            digits.truncate(MAX_DIGITS);
        }
        out.push_str(&digits);
        digits.clear();
        out.push(c);
    }
    out
}

/// Bytes that make choices; zeros when they are used up.
struct Choices<'b> {
    bytes: &'b [u8],
}

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.bytes.split_first() else {
            return 0;
        };
        self.bytes = rest;
        *first
    }

    fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count.max(1)
    }

    fn one_of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }
}

/// Messages that bytes choose.
fn chosen(input: &[u8]) -> Vec<String> {
    let mut choices = Choices { bytes: input };
    let mut messages = Vec::new();
    while !choices.bytes.is_empty() && messages.len() < MAX_MESSAGES {
        messages.push(message(&mut choices));
    }
    messages
}

fn message(choices: &mut Choices) -> String {
    let gesture = choices.below(3);
    let message = match choices.below(16) {
        0 | 1 => json!({ "do": "open", "source": source(choices) }),
        2..=6 => json!({ "do": "set", "keys": keys(choices), "gesture": gesture }),
        7 => {
            let points: Vec<Value> = (0..choices.below(5))
                .map(|_| json!([number(choices), number(choices)]))
                .collect();
            json!({ "do": "paint", "points": points, "radius": number(choices), "textured": choices.below(4) > 0, "gesture": gesture })
        }
        8 => {
            json!({ "do": "image", "png": image(choices), "threshold": number(choices), "gesture": gesture })
        }
        9 => match choices.one_of(&["undo", "redo", "rest", "export", "find", "find_stop"]) {
            "find" => json!({ "do": "find", "gesture": gesture }),
            other => json!({ "do": other }),
        },
        10 => {
            json!({ "do": "view", choices.one_of(&["pace", "frames_per_second", "twin", "field", "probe", "after_change"]): view(choices) })
        }
        11 => json!({ "do": "step", "count": choices.one_of(&[0, 1, 7, 50]) }),
        12 => json!({ "do": "repeat", "seeds": choices.one_of(&[0, 2, 1, 33, u64::MAX]) }),
        13 => json!({ "do": choices.one_of(&["save", "save_stop"]), "name": name(choices) }),
        14 => {
            json!({ "do": "frames_of", "index": choices.one_of(&[json!(null), json!(0), json!(u64::MAX)]) })
        }
        // A value in the place of anything.
        _ => {
            let mut message =
                json!({ "do": "set", "keys": keys(choices), "gesture": 0, "source": {}, "name": "a" });
            let place = choices.one_of(&["do", "keys", "gesture", "source", "name"]);
            message[place] = value(choices, 0);
            message
        }
    };
    let text = message.to_string();
    match choices.below(16) {
        // Brackets beyond what is read of JSON.
        0 => text.replacen("null", &"[".repeat(10 * choices.below(256)), 1),
        _ => text,
    }
}

fn source(choices: &mut Choices) -> Value {
    match choices.below(8) {
        0 => json!({ "preset": choices.one_of(&["single_block", "../circle", "paper/", ""]) }),
        1 => json!({ "folder": name(choices) }),
        _ => {
            let mut toml = String::from("slider.blocks = [12, 9]\n");
            for _ in 0..choices.below(6) {
                let section = &SECTIONS[choices.below(SECTIONS.len())];
                toml += &if section.is_shape {
                    format!("[[texture]]\nshape = \"{}\"\n", section.name)
                } else {
                    format!("[{}]\n", section.name)
                };
                for _ in 0..choices.below(4) {
                    let (key, value) = (key(choices), value(choices, 0));
                    let value = toml_of(&value);
                    toml += &format!("{} = {value}\n", key.rsplit('.').next().unwrap_or_default());
                }
            }
            let files = json!({ "a.png": image(choices), name(choices): image(choices) });
            json!({ "toml": toml, "name": name(choices), "files": files })
        }
    }
}

/// A value of JSON as TOML writes it.
fn toml_of(value: &Value) -> String {
    match value {
        Value::Null => "nan".to_owned(),
        Value::Array(values) => format!("[{}]", values.iter().map(toml_of).collect::<Vec<_>>().join(", ")),
        Value::Object(entries) => {
            let entry = |(key, value): (&String, &Value)| format!("{key} = {}", toml_of(value));
            format!(
                "{{ {} }}",
                entries.iter().map(entry).collect::<Vec<_>>().join(", ")
            )
        }
        other => other.to_string(),
    }
}

fn keys(choices: &mut Choices) -> Map<String, Value> {
    let count = 1 + choices.below(4);
    (0..count).map(|_| (key(choices), value(choices, 0))).collect()
}

/// A key of a case, or one that was changed, up to a length that only a program writes.
fn key(choices: &mut Choices) -> String {
    let section = &SECTIONS[choices.below(SECTIONS.len())];
    let key = section.keys[choices.below(section.keys.len())].name;
    let table = if section.is_shape {
        format!("texture.{}", choices.below(3))
    } else {
        section.name.to_owned()
    };
    let whole = format!("{table}.{key}");
    match choices.below(12) {
        0 => "texture".to_owned(),
        1 => table,
        2 => key.to_owned(),
        3 => format!("{whole}.{}", choices.below(3)),
        4 => format!("{whole}.").repeat(1 + 40 * choices.below(256)) + "a",
        5 => ".".repeat(choices.below(256)),
        6 => word(choices),
        _ => whole,
    }
}

fn number(choices: &mut Choices) -> Value {
    // None that a lattice could have and that would take long.
    let numbers = [
        json!(0),
        json!(1),
        json!(-1),
        json!(2),
        json!(9),
        json!(40),
        json!(0.5),
        json!(0.03),
        json!(-0.0),
        json!(1e-300),
        json!(5e-324),
        json!(1e9),
        json!(1e300),
        json!(f64::MAX),
        json!(i64::MIN),
        json!(u64::MAX),
        json!(9_007_199_254_740_993_u64),
    ];
    choices.one_of(&numbers)
}

fn word(choices: &mut Choices) -> String {
    let section = &SECTIONS[choices.below(SECTIONS.len())];
    let words = match section.keys[choices.below(section.keys.len())].kind {
        KeyKind::Words(words) => words(),
        KeyKind::Number { words, .. } => words,
        _ => &[],
    };
    match choices.below(10) {
        0 => "a.png".to_owned(),
        1 => "../a.csv".to_owned(),
        2 => "/etc/passwd".to_owned(),
        3 => "1 um".to_owned(),
        4 => format!("{} kPa", number(choices)),
        5 => "x".repeat(100 * choices.below(256)),
        6 => "\u{1b}[31m\0\n\u{202e}\u{1f600}".to_owned(),
        7 => "a'b\"c\\\n[x]\n".to_owned(),
        _ => words
            .get(choices.below(words.len()))
            .map_or(String::new(), |word| (*word).to_owned()),
    }
}

fn value(choices: &mut Choices, depth: usize) -> Value {
    match choices.below(16) {
        0 => Value::Null,
        1 => json!(choices.below(2) == 0),
        2..=5 => json!(word(choices)),
        6 | 7 if depth < 6 => (0..choices.below(5)).map(|_| value(choices, depth + 1)).collect(),
        8 | 9 if depth < 6 => Value::Object(keys_of(choices, depth)),
        10 => nested(choices),
        11 => json!([number(choices), number(choices)]),
        12 if depth < 6 => json!([shape(choices), shape(choices)]),
        _ => number(choices),
    }
}

fn keys_of(choices: &mut Choices, depth: usize) -> Map<String, Value> {
    let count = choices.below(4);
    let name = |choices: &mut Choices| {
        let key = key(choices);
        key.rsplit('.').next().unwrap_or_default().to_owned()
    };
    (0..count)
        .map(|_| (name(choices), value(choices, depth + 1)))
        .collect()
}

/// Tables or lists within each other.
fn nested(choices: &mut Choices) -> Value {
    let levels = choices.below(256);
    let is_list = choices.below(2) == 0;
    let mut value = number(choices);
    for _ in 0..levels {
        value = if is_list {
            json!([value])
        } else {
            json!({ "a": value })
        };
    }
    value
}

/// A texture, most of whose keys are its own.
fn shape(choices: &mut Choices) -> Value {
    let shapes: Vec<_> = SECTIONS.iter().filter(|section| section.is_shape).collect();
    let shape = shapes[choices.below(shapes.len())];
    let mut table = Map::from_iter([("shape".to_owned(), json!(shape.name))]);
    for _ in 0..choices.below(5) {
        let key = shape.keys[choices.below(shape.keys.len())].name;
        table.insert(key.to_owned(), value(choices, 6));
    }
    table.into()
}

/// Names of folders and files.
fn name(choices: &mut Choices) -> String {
    let names = [
        "run", "..", "taken", "a/b", "/tmp/x", ".hidden", "a\0b", "", "\u{e9}", "a.png", "con:",
    ];
    match choices.below(12) {
        11 => "n".repeat(choices.below(256)),
        at => names[at].to_owned(),
    }
}

fn view(choices: &mut Choices) -> Value {
    let probe = [
        json!([0, 0]),
        json!([u64::MAX, 3]),
        json!("contact_stress"),
        json!("first_slip"),
        json!("go_on"),
    ];
    match choices.below(2) {
        0 => choices.one_of(&probe),
        _ => number(choices),
    }
}

/// An image as Base64, whole or not.
fn image(choices: &mut Choices) -> String {
    let side = 1 + choices.below(20) as u32;
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, side, side);
    encoder.set_color(png::ColorType::Grayscale);
    let pixels: Vec<u8> = (0..side * side).map(|pixel| (pixel * 37 % 256) as u8).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    match choices.below(5) {
        0 => bytes.truncate(choices.below(256)),
        1 => {
            let at = choices.below(bytes.len());
            bytes[at] ^= 1 << choices.below(8);
        }
        2 => return "???".to_owned(),
        _ => {}
    }
    BASE64_STANDARD.encode(&bytes)
}

fn generated() -> Vec<Vec<u8>> {
    let open = json!({ "do": "open", "source": { "toml": "slider.blocks = [12, 9]\n[[texture]]\nshape = \"cavity\"\ncoverage = 10\n" } });
    let conversations = [
        vec![
            open.clone(),
            json!({ "do": "set", "keys": { "drive.v_star": 0.05, "texture.0.coverage": 20 }, "gesture": 1 }),
            json!({ "do": "step", "count": 7 }),
            json!({ "do": "undo" }),
            json!({ "do": "redo" }),
            json!({ "do": "rest" }),
        ],
        vec![
            open.clone(),
            json!({ "do": "paint", "points": [[1, 1], [5, 5]], "radius": 1.5, "textured": true, "gesture": 2 }),
            json!({ "do": "view", "after_change": "go_on", "probe": [3, 3], "field": "speed", "kymograph": true }),
            json!({ "do": "step", "count": 50 }),
            json!({ "do": "image", "png": image(&mut Choices { bytes: &[7, 4] }), "threshold": 0.5, "gesture": 3 }),
            json!({ "do": "set", "keys": { "texture": null }, "gesture": 4 }),
        ],
        vec![
            json!({ "do": "open", "source": { "preset": "single_block" } }),
            json!({ "do": "repeat", "seeds": 2 }),
            json!({ "do": "save", "name": "run" }),
            json!({ "do": "save_stop", "name": "run" }),
            json!({ "do": "open", "source": { "folder": "run" } }),
            json!({ "do": "frames_of", "index": 0 }),
        ],
        vec![
            open,
            json!({ "do": "set", "keys": { format!("{}a", "a.".repeat(4600)): 1 }, "gesture": 1 }),
        ],
    ];
    let lines = |messages: &Vec<Value>| {
        messages
            .iter()
            .map(|message| format!("{message}\n"))
            .collect::<String>()
    };
    let mut seeds: Vec<Vec<u8>> = conversations
        .iter()
        .map(|messages| lines(messages).into_bytes())
        .collect();
    // Choices of every kind of message, one after the other.
    for seed in 1..16_u8 {
        seeds.push(
            (0..=255_u8)
                .map(|at| at.wrapping_mul(seed.wrapping_mul(2) | 1).wrapping_add(at / 7))
                .collect(),
        );
    }
    seeds
}
