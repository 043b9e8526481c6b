//! Requests and messages that the server refuses.

use std::io::Write;
use std::time::{Duration, Instant};

use serde_json::json;
use tungstenite::Message;

use crate::laboratory::{Served, TIMEOUT};
use crate::page::{NONCE, Page, TAB, proof, protocols, try_connect};

const SMALL: &str = "slider.blocks = [8, 8]\n";

#[test]
fn pages_of_other_sites_are_refused() {
    let lab = Served::new();
    let host = lab.host();
    for origin in [
        "http://evil.example",
        "null",
        "https://127.0.0.1",
        "http://127.0.0.1:1",
        "file://",
    ] {
        let line = format!("Origin: {origin}\r\n");
        assert_eq!(lab.status("/", &host, &line), 403, "{origin}");
        let refused = try_connect(&lab, &lab.token, &[("origin", origin)]).err();
        assert_eq!(refused, Some(403), "{origin}");
    }
    let own = format!("http://{host}");
    assert!(try_connect(&lab, &lab.token, &[("origin", &own)]).is_ok());
}

/// Names of other sites that resolve to 127.0.0.1.
#[test]
fn other_names_of_this_machine_are_refused() {
    let lab = Served::new();
    let port = lab.port;
    for host in [
        "evil.example",
        &format!("evil.example:{port}"),
        "127.0.0.1",
        "127.0.0.1:1",
        "",
        &format!("127.0.0.1.evil:{port}"),
    ] {
        assert_eq!(lab.status("/", host, ""), 421, "{host:?}");
    }
    assert_eq!(
        try_connect(&lab, &lab.token, &[("host", "evil.example")]).err(),
        Some(421)
    );
    let own = lab.host();
    assert_eq!(lab.status("/", &own, "Host: evil.example\r\n"), 421);
    assert_eq!(lab.status("http://evil.example/", &own, ""), 421);
    assert_eq!(lab.status("/", &format!("localhost:{port}"), ""), 200);
}

#[test]
fn without_the_token_there_is_no_session() {
    let lab = Served::new();
    let most = &lab.token[1..];
    for token in [
        "",
        "0123456789abcdef",
        most,
        &format!("{}0", lab.token),
        &lab.token.to_uppercase(),
    ] {
        // A token of digits alone has no upper case.
        if *token == lab.token {
            continue;
        }
        assert_eq!(try_connect(&lab, token, &[]).err(), Some(401), "{token:?}");
    }
    // A proof is valid for one tab and one nonce, and the proof of the server is no proof of a page.
    let right = protocols(&proof(&lab.token, "page"));
    assert!(try_connect(&lab, "", &[("sec-websocket-protocol", &right)]).is_ok());
    let other = "f".repeat(32);
    for wrong in [
        "slipfront.lab.v2".to_owned(),
        format!("slipfront.lab.v2, token.{}", lab.token),
        protocols(&lab.token),
        protocols(&proof(&lab.token, "server")),
        protocols(&"x".repeat(64)),
        protocols(""),
        right.replace(TAB, &other),
        right.replace(NONCE, &other),
        right.replace(NONCE, ""),
        right[..right.len() - 1].to_owned(),
    ] {
        let refused = try_connect(&lab, "", &[("sec-websocket-protocol", &wrong)]).err();
        assert_eq!(refused, Some(401), "{wrong}");
    }
    // Public answers do not contain the token.
    let page = lab.answer(&format!(
        "GET / HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
        lab.host()
    ));
    assert!(page.contains("200 OK") && !page.contains(&lab.token));
    assert_eq!(lab.token.len(), 32);
    assert_ne!(lab.token, Served::new().token);
}

#[test]
fn answers_forbid_what_the_page_does_not_need() {
    let lab = Served::new();
    let host = lab.host();
    for (path, status) in [("/", "200 OK"), ("/nothing.js", "404 Not Found")] {
        let answer = lab.answer(&format!(
            "GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        ));
        assert!(answer.contains(status), "{answer}");
        for line in [
            "content-security-policy: default-src 'none'; script-src 'self'; style-src 'self';",
            "frame-ancestors 'none'",
            "x-content-type-options: nosniff",
            "referrer-policy: no-referrer",
            "cross-origin-resource-policy: same-origin",
        ] {
            assert!(answer.contains(line), "{line} in {answer}");
        }
    }
}

#[test]
fn files_of_the_machine_are_not_served() {
    let lab = Served::new();
    let host = lab.host();
    for path in [
        "/../../../../etc/passwd",
        "/..%2f..%2f..%2fetc/passwd",
        "/%2e%2e/Cargo.toml",
        "//etc/passwd",
        "/../Cargo.toml",
        "/web/../../Cargo.toml",
        "/\\..\\Cargo.toml",
        "/cases/circle.toml",
    ] {
        assert_eq!(lab.status(path, &host, ""), 404, "{path}");
    }
}

#[test]
fn paths_out_of_the_folder_are_refused() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, SMALL);
    page.reply("case");
    std::fs::create_dir_all(lab.results()).unwrap();
    for name in [
        "../stolen",
        "/tmp/stolen",
        "a/b",
        "a\\b",
        "..",
        ".",
        ".hidden",
        "",
        "con:",
        &"x".repeat(101),
        "a\0b",
    ] {
        let said = page.refusal(&json!({ "do": "save", "name": name }));
        assert!(said.contains("is no name for a folder"), "{said}");
        let said = page.refusal(&json!({ "do": "open", "source": { "folder": name } }));
        assert!(said.contains("is no run of the folder of results"), "{said}");
    }
    // A case that a page sends can use only the files that were sent with it.
    let secret = lab.results().join("secret.csv");
    std::fs::write(&secret, "1,1\n1,1\n").unwrap();
    let secret = secret.to_str().unwrap();
    for name in [
        secret,
        "../secret.csv",
        "secret.csv",
        "/etc/passwd.csv",
        "..\\secret.csv",
    ] {
        for key in ["friction.mu_static_field", "load.pressure_field"] {
            let toml = format!("slider.blocks = [2, 2]\n{key} = '{name}'\n");
            let said = page.refusal(&json!({ "do": "open", "source": { "toml": toml } }));
            assert!(said.contains("cannot be read"), "{said}");
            page.send(&json!({ "do": "set", "keys": { key: name, "slider.blocks": [2, 2] }, "gesture": 1 }));
            page.reply("refused");
        }
    }
    let said = page.refusal(&json!({ "do": "open", "source": { "preset": "../Cargo" } }));
    assert!(said.contains("there is no case"), "{said}");
}

#[test]
fn what_is_no_request_ends_the_connection_with_a_reason() {
    let lab = Served::new();
    let nested = format!(
        "{{\"do\":\"set\",\"gesture\":1,\"keys\":{{\"a\":{}1",
        "[".repeat(5000)
    );
    for text in [
        "",
        "{}",
        "[]",
        "null",
        "{\"do\":\"explode\"}",
        "{\"do\":\"step\",\"count\":-1}",
        &nested,
        "{\"do\":\"view\",\"colour\":\"red\"}",
        "{\"do\":\"paint\",\"points\":[[1]],\"radius\":1,\"textured\":true,\"gesture\":1}",
    ] {
        let mut page = Page::open(&lab);
        page.socket.send(Message::text(text)).unwrap();
        let (code, reason) = page.end().unwrap();
        assert_eq!(code, 1008, "{text}");
        assert!(reason.starts_with("not a request"), "{reason}");
    }
    let mut page = Page::open(&lab);
    page.socket.send(Message::binary(vec![1, 2, 3])).unwrap();
    assert_eq!(page.end(), Some((1008, "requests are texts".to_owned())));
}

#[test]
fn huge_and_torn_messages_end_the_connection_alone() {
    let lab = Served::new();
    let mut watching = Page::with_case(&lab, SMALL);
    watching.reply("case");
    // One byte more than a message may have.
    let mut page = Page::open(&lab);
    let _ = page.socket.send(Message::text("x".repeat((8 << 20) + 1)));
    page.end();
    // Frames written by hand: a text of 2^40 bytes; pieces of a text without end; invalid UTF-8; half a
    // frame.
    let endless: Vec<u8> = [0x01, 0xfe, 0xff, 0xff, 0, 0, 0, 0]
        .into_iter()
        .chain([b' '; 65535])
        .collect();
    let parts: Vec<u8> = [0x00, 0xfe, 0xff, 0xff, 0, 0, 0, 0]
        .into_iter()
        .chain([b' '; 65535])
        .collect();
    let attacks = [
        vec![0x81, 0xff, 0, 0, 1, 0, 0, 0, 0, 0, 1, 2, 3, 4],
        endless.into_iter().chain(parts.repeat(200)).collect(),
        vec![0x81, 0x82, 0, 0, 0, 0, 0xff, 0xfe],
        vec![0x81, 0xfe, 0x10],
        vec![0xf7, 0x80, 0, 0, 0, 0],
    ];
    for attack in attacks {
        let mut page = Page::open(&lab);
        let stream = page.socket.get_mut();
        let _ = stream.write_all(&attack);
        let _ = stream.shutdown(std::net::Shutdown::Write);
        page.end();
    }
    // Other pages are served as before.
    watching.send(&json!({ "do": "view", "paused": true }));
    watching.reply("numbers");
    Page::with_case(&lab, SMALL).reply("case");
}

#[test]
fn a_fifth_page_is_refused_until_one_is_closed() {
    let lab = Served::new();
    let mut pages: Vec<Page> = (0..4).map(|_| Page::open(&lab)).collect();
    assert_eq!(try_connect(&lab, &lab.token, &[]).err(), Some(503));
    for page in &mut pages {
        page.reply("hello");
    }
    pages.pop();
    let began = Instant::now();
    while try_connect(&lab, &lab.token, &[]).is_err() {
        assert!(began.elapsed() < TIMEOUT, "its place was not given free");
        std::thread::sleep(Duration::from_millis(20));
    }
}

#[test]
fn cases_beyond_what_is_shown_are_refused() {
    let lab = Served::new();
    let mut page = Page::open(&lab);
    let said = page.refusal(&json!({ "do": "open", "source": { "toml": "slider.blocks = [2000, 2000]" } }));
    assert!(
        said.contains("2000 x 2000 blocks are more than the 524288") && said.contains("slipfront run"),
        "{said}"
    );
    page.send(&json!({ "do": "open", "source": { "toml": SMALL } }));
    page.reply("case");
    let said = page.refusal(&json!({ "do": "set", "keys": { "drive.v_star": -1 }, "gesture": 1 }));
    assert!(said.contains("v_star"), "{said}");
    assert_eq!(page.reply("case")["why"], "refused");
    for (request, sentence) in [
        (json!({ "do": "repeat", "seeds": 33 }), "33 seeds"),
        (json!({ "do": "view", "pace": -1 }), "the pace is -1"),
        (
            json!({ "do": "view", "frames_per_second": 1000 }),
            "1000 pictures",
        ),
        (
            json!({ "do": "paint", "points": [], "radius": 1, "textured": true, "gesture": 2 }),
            "a stroke has 1 to",
        ),
        (
            json!({ "do": "paint", "points": [[1, 1]], "radius": 1e9, "textured": true, "gesture": 2 }),
            "the radius of the brush",
        ),
        (
            json!({ "do": "image", "png": "???", "threshold": 0.5, "gesture": 3 }),
            "not Base64",
        ),
    ] {
        let said = page.refusal(&request);
        assert!(said.contains(sentence), "{said}");
    }
    // An invalid image is detected when it is meshed.
    page.send(&json!({ "do": "image", "png": "aGVsbG8=", "threshold": 0.5, "gesture": 4 }));
    let said = page.reply("refused")["sentence"].to_string();
    assert!(said.contains("PNG"), "{said}");
}

/// Nested tables are read and freed recursively: a few thousand levels would overflow the stack and crash the
/// process.
#[test]
fn deep_keys_and_values_are_refused() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, SMALL);
    page.reply("case");
    let long = |parts: usize| vec!["a"; parts].join(".");
    for key in [
        long(5),
        long(4600),
        long(1_000_000),
        format!("drive.{}", long(100_000)),
        ".".repeat(10_000),
    ] {
        for value in [json!(1), json!(null)] {
            let said = page.refusal(&json!({ "do": "set", "keys": { key.as_str(): value }, "gesture": 1 }));
            assert!(
                said.contains("up to four names with dots between them") && said.len() < 500,
                "{said}"
            );
        }
    }
    // As deep as JSON allows, and deeper with every key.
    let nested = format!("{}1{}", "{\"a\":".repeat(100), "}".repeat(100));
    let nested: serde_json::Value = serde_json::from_str(&nested).unwrap();
    for key in ["drive.v_star", "texture", "a.b.c.d"] {
        let said = page.refusal(&json!({ "do": "set", "keys": { key: nested }, "gesture": 2 }));
        assert!(said.contains("more than 64 levels deep"), "{said}");
        page.reply("case");
    }
    // Dotted keys within brackets, in a case that a page sends.
    let key = long(79);
    let toml = format!("x = {}1{}", format!("{{ {key} = ").repeat(75), "}".repeat(75));
    let said = page.refusal(&json!({ "do": "open", "source": { "toml": toml } }));
    assert!(said.contains("more than 64 levels deep"), "{said}");
    page.send(&json!({ "do": "rest" }));
    page.reply("case");
}

/// A page that sends requests without end, and reads nothing.
#[test]
fn a_flood_does_not_fill_the_memory() {
    let lab = Served::new();
    let mut page = Page::with_case(&lab, SMALL);
    page.socket
        .get_mut()
        .set_write_timeout(Some(Duration::from_millis(200)))
        .unwrap();
    let request = json!({ "do": "export" }).to_string();
    let mut sent = 0;
    while sent < 2_000_000 && page.socket.send(Message::text(request.as_str())).is_ok() {
        sent += 1;
    }
    assert!(
        sent < 2_000_000,
        "the server took {sent} requests whose answers nobody reads"
    );
    let mut other = Page::with_case(&lab, SMALL);
    other.reply("case");
}

/// A JSON value takes many times the memory of its text, so the server limits the number of values in a
/// message to what a page needs.
#[test]
fn millions_of_values_are_no_request() {
    let lab = Served::new();
    let list = |values: usize| format!("[{}1]", "1,".repeat(values - 1));
    let mut page = Page::with_case(&lab, SMALL);
    page.reply("case");
    page.socket
        .send(Message::text(format!(
            "{{\"do\":\"set\",\"gesture\":1,\"keys\":{{\"drive.v_star\":{}}}}}",
            list(10_000)
        )))
        .unwrap();
    let said = page.reply("refused")["sentence"].to_string();
    assert!(said.contains("v_star") && said.len() < 1000, "{said}");
    let texts = [
        format!(
            "{{\"do\":\"set\",\"gesture\":1,\"keys\":{{\"drive.v_star\":{}}}}}",
            list(4_000_000)
        ),
        format!("{{\"do\":\"explode\",\"a\":{}", "[".repeat(8_000_000)),
        format!("{{\"do\":\"explode\",\"a\":\"\\\"\",\"b\":{}}}", list(4_000_000)),
    ];
    for text in texts {
        let mut page = Page::open(&lab);
        page.socket.send(Message::text(text)).unwrap();
        let end = page.end();
        let reason = "not a request: it has more than 20000 values".to_owned();
        assert_eq!(end, Some((1008, reason)));
    }
    // Commas inside a text do not count.
    let toml = format!("# {}\n{SMALL}", ",[".repeat(100_000));
    page.send(&json!({ "do": "open", "source": { "toml": toml } }));
    page.reply("case");
}

/// Thousands of small requests, pings, pieces of one byte, and sessions that begin and end at once: another
/// page is still served.
#[test]
fn floods_of_small_things_keep_nobody_out() {
    let lab = Served::new();
    let mut watching = Page::with_case(&lab, SMALL);
    watching.reply("case");
    let mut is_served = |after: &str| {
        watching.send(&json!({ "do": "view", "paused": true }));
        let reply = watching.reply("numbers");
        assert_eq!(reply["is"], "numbers", "after {after}");
    };
    // A client that reads nothing can send until the window of its connection is full, or send everything.
    let frame = |first: u8, text: &[u8]| [&[first, 0x80 | text.len() as u8, 0, 0, 0, 0], text].concat();
    for (what, bytes) in [
        ("requests", frame(0x81, br#"{"do":"view","paused":true}"#)),
        ("pings", frame(0x89, &[b'x'; 125])),
        ("pieces", frame(0x01, b" ")),
    ] {
        let mut page = Page::open(&lab);
        let stream = page.socket.get_mut();
        stream
            .set_write_timeout(Some(Duration::from_millis(200)))
            .unwrap();
        let rest = if what == "pieces" {
            frame(0x00, b" ")
        } else {
            bytes.clone()
        };
        let _ = stream.write_all(&bytes);
        let many = rest.repeat(100);
        let _ = (0..100).try_for_each(|_| stream.write_all(&many));
        is_served(what);
    }
    for number in 0..300 {
        // An ending session may still hold a place.
        if let Ok(mut page) = try_connect(&lab, &lab.token, &[])
            && number % 3 == 0
        {
            page.send(&json!({ "do": "open", "source": { "toml": SMALL } }));
        }
    }
    is_served("sessions");
}
