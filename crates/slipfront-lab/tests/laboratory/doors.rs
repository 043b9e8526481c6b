//! Clients that send nothing, send too much or do not read; attempts to take the port; and the end of the
//! server.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::sync::mpsc::channel;
use std::thread;
use std::time::{Duration, Instant};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use serde_json::json;

use crate::laboratory::{Served, TIMEOUT};
use crate::page::{NONCE, Page, TAB, proof, try_connect};

/// Number of connections that an attacker opens: more than the 64 that the server holds.
const MANY: usize = 100;

/// Whether the server has closed a connection, or answered.
fn is_over(stream: &mut TcpStream) -> bool {
    stream.set_nonblocking(true).unwrap();
    let read = stream.read(&mut [0; 64]);
    !matches!(read, Err(error) if error.kind() == ErrorKind::WouldBlock)
}

/// Ends the server, and fails if that takes too long.
fn end(mut lab: Served) -> Duration {
    let (done, told) = channel();
    let began = Instant::now();
    thread::spawn(move || {
        lab.stop();
        done.send(began.elapsed()).unwrap();
        drop(lab);
    });
    // Pages have 5 s at most, and unfinished work 10 s.
    told.recv_timeout(2 * TIMEOUT).expect("the server has not ended")
}

/// Requests 25 answers of a megabyte; the system buffers only a few of them.
fn ask_for_much(page: &mut Page) {
    let number = format!("0.5{}", "0".repeat(253));
    let row = vec![number; 64].join(",") + "\n";
    let files = json!({ "mu.csv": BASE64_STANDARD.encode(row.repeat(64)) });
    let toml = "slider.blocks = [64, 64]\nfriction.mu_static_field = 'mu.csv'\n";
    page.send(&json!({ "do": "open", "source": { "toml": toml, "files": files } }));
    page.reply("case");
    for _ in 0..25 {
        page.send(&json!({ "do": "export" }));
    }
}

/// A case that takes minutes: it reads an image of 2^28 white pixels, of some ten kilobytes, a hundred times.
#[cfg(target_os = "linux")]
fn case_of_minutes() -> serde_json::Value {
    let mut image = Vec::new();
    let mut encoder = png::Encoder::new(&mut image, 1 << 14, 1 << 14);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::One);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&vec![0xff; 1 << 25]).unwrap();
    writer.finish().unwrap();
    // Each threshold makes the image be read again.
    let texture = |k: u32| format!("[[texture]]\nshape = 'mask'\nfile = 'a.png'\nthreshold = 0.{k}\n");
    let toml: String = (1000..1100).map(texture).collect();
    json!({ "do": "open", "source": { "toml": toml, "files": { "a.png": BASE64_STANDARD.encode(image) } } })
}

/// Processor time that the threads of sessions have taken, in hundredths of a second; none if there is no
/// such thread.
#[cfg(target_os = "linux")]
fn time_of_sessions() -> Option<u64> {
    let tasks = std::fs::read_dir("/proc/self/task").unwrap();
    // The entry of a thread that has just ended cannot be read.
    let stats = tasks.filter_map(|task| std::fs::read_to_string(task.ok()?.path().join("stat")).ok());
    let of_sessions = stats.filter_map(|stat| {
        let (_, fields) = stat.split_once("(session) ")?;
        fields.split(' ').nth(11)?.parse::<u64>().ok()
    });
    of_sessions.reduce(|all, one| all + one)
}

/// A link from a stranger may lead to a case that takes minutes to make.
#[cfg(target_os = "linux")]
#[test]
fn a_page_that_is_gone_leaves_no_case_that_is_being_made() {
    let name = "doors::a_page_that_is_gone_leaves_no_case_that_is_being_made";
    // The sessions of other tests are in the same process.
    slipfront::testing::alone(name, || {
        let wait_until = |what: &str, holds: &dyn Fn(Option<u64>) -> bool| {
            let began = Instant::now();
            while !holds(time_of_sessions()) {
                assert!(began.elapsed() < TIMEOUT, "{what}");
                thread::sleep(Duration::from_millis(10));
            }
        };
        // While requests wait for a session, the server does not read from its page, and notices in another
        // way that the page is gone.
        for waiting in [0, 40] {
            let lab = Served::new();
            let mut page = Page::open(&lab);
            page.send(&case_of_minutes());
            for _ in 0..waiting {
                page.send(&json!({ "do": "undo" }));
            }
            wait_until("no case is made", &|time| time.is_some_and(|time| time > 20));
            drop(page);
            wait_until("the case is made for nobody", &|time| time.is_none());
        }
    });
}

#[test]
fn connections_that_say_nothing_keep_no_page_out() {
    let lab = Served::impatient();
    let mut idle: Vec<TcpStream> = (0..MANY).map(|_| lab.connect()).collect();
    for stream in &mut idle {
        // Some connections are already closed to make room for later ones.
        let _ = stream.write_all(b"G");
    }
    assert_eq!(lab.status("/", &lab.host(), ""), 200);
    Page::open(&lab).reply("hello");
    // Few connections stay open, and none for long.
    let began = Instant::now();
    while !idle.iter_mut().all(is_over) {
        assert!(
            began.elapsed() < TIMEOUT,
            "connections without a request are kept"
        );
        thread::sleep(Duration::from_millis(50));
    }
}

#[test]
fn connections_before_a_header_is_there_are_few() {
    let lab = Served::new();
    let mut idle: Vec<TcpStream> = (0..MANY).map(|_| lab.connect()).collect();
    // The server accepts connections in order.
    lab.status("/", &lab.host(), "");
    let open = idle
        .iter_mut()
        .filter_map(|stream| (!is_over(stream)).then_some(()))
        .count();
    assert!(open <= 64, "{open} connections are held open");
}

#[test]
fn large_headers_are_refused() {
    let lab = Served::new();
    let line = |bytes| format!("X: {}\r\n", "a".repeat(bytes));
    assert_eq!(lab.status("/", &lab.host(), &line(8 << 10)), 200);
    assert_eq!(lab.status("/", &lab.host(), &line(17 << 10)), 431);
    // The server does not read an endless header to its end.
    let mut stream = lab.connect();
    stream.set_write_timeout(Some(TIMEOUT)).unwrap();
    let begun = format!("GET / HTTP/1.1\r\nHost: {}\r\nX: ", lab.host());
    stream.write_all(begun.as_bytes()).unwrap();
    let piece = [b'a'; 1 << 16];
    let sent = (0..1000).take_while(|_| stream.write_all(&piece).is_ok()).count();
    assert!(sent < 1000, "{sent} pieces of a header were taken");
}

#[test]
fn the_server_ends_whatever_is_open() {
    let lab = Served::new();
    let idle: Vec<TcpStream> = (0..10).map(|_| lab.connect()).collect();
    for mut stream in &idle {
        stream.write_all(b"G").unwrap();
    }
    let page = Page::open(&lab);
    end(lab);
    drop((idle, page));
}

/// The server does not wait for a page that does not read, and drops its messages.
#[test]
fn a_page_that_does_not_read_is_dropped() {
    let lab = Served::impatient();
    let mut pages: Vec<Page> = (0..4).map(|_| Page::open(&lab)).collect();
    ask_for_much(&mut pages[0]);
    // The place of the dropped page becomes free, and no other page has to go.
    let began = Instant::now();
    while try_connect(&lab, &lab.token, &[]).is_err() {
        assert!(
            began.elapsed() < TIMEOUT,
            "a page that does not read keeps its place"
        );
        thread::sleep(Duration::from_millis(50));
    }
    pages[3].reply("hello");
}

#[test]
fn the_end_does_not_wait_for_a_page_that_does_not_read() {
    let lab = Served::impatient();
    let mut page = Page::open(&lab);
    ask_for_much(&mut page);
    end(lab);
}

/// The server proves that it knows the token before a page proves anything.
#[test]
fn the_server_proves_that_it_is_the_one() {
    let lab = Served::new();
    let prove = |tab: &str, nonce: &str| {
        lab.answer(&format!(
            "GET /proof/{tab}/{nonce} HTTP/1.1\r\nHost: {}\r\nConnection: close\r\n\r\n",
            lab.host()
        ))
    };
    let expected = proof(&lab.token, "server");
    let answer = prove(TAB, NONCE);
    assert!(answer.ends_with(&expected), "{answer}");
    assert_ne!(expected, proof(&lab.token, "page"));
    let other = "f".repeat(32);
    for (tab, nonce) in [(TAB, &*other), (&*other, NONCE)] {
        let answer = prove(tab, nonce);
        assert!(
            answer.starts_with("HTTP/1.1 200") && !answer.contains(&expected),
            "{answer}"
        );
    }
    for (tab, nonce) in [
        ("0", NONCE),
        (TAB, "0"),
        (&TAB[1..], NONCE),
        (TAB, "page%20345678901234567890123456789"),
    ] {
        assert!(prove(tab, nonce).starts_with("HTTP/1.1 404"), "{tab} {nonce}");
    }
    // Another server on the same port cannot prove it.
    let stranger = Served::new();
    assert_ne!(proof(&stranger.token, "server"), expected);
    // The first message on the connection itself is the proof.
    let mut page = Page::open(&lab);
    let first = page.read().unwrap().unwrap();
    assert_eq!(first, json!({ "is": "proof", "proof": expected }));
}

#[test]
fn the_start_page_is_there_until_a_page_has_connected_or_the_server_ends() {
    let lab = Served::new();
    let page = std::fs::read_to_string(&lab.start_page).unwrap();
    assert!(
        page.contains(&format!("url=http://{}/#token={}\"", lab.host(), lab.token)),
        "{page}"
    );
    // A client without the token does not remove the start page.
    assert_eq!(lab.status("/", &lab.host(), ""), 200);
    assert_eq!(try_connect(&lab, "wrong", &[]).err(), Some(401));
    assert!(lab.start_page.exists());
    Page::open(&lab).reply("hello");
    assert!(!lab.start_page.exists());

    let unseen = Served::new();
    let path = unseen.start_page.clone();
    assert!(path.exists());
    end(unseen);
    assert!(!path.exists());
}
