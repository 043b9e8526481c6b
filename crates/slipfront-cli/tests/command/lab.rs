//! The laboratory is opened and ended.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Stdio};

use crate::support::process::{send, stderr};
use crate::support::workspace::Workspace;

/// Starts the command; gives the address that it prints.
fn open(workspace: &Workspace, line: &str) -> (Child, String) {
    let mut process = workspace.process(line);
    std::fs::create_dir_all(workspace.path("temporary")).unwrap();
    let mut child = process
        .env("TMPDIR", workspace.path("temporary"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut printed = String::new();
    BufReader::new(child.stdout.as_mut().unwrap())
        .read_line(&mut printed)
        .unwrap();
    let address = printed
        .split_whitespace()
        .find(|word| word.starts_with("http://"));
    let address = address
        .unwrap_or_else(|| panic!("no address in {printed:?}"))
        .to_owned();
    (child, address)
}

#[test]
fn it_serves_its_page_until_a_signal() {
    let workspace = Workspace::small();
    workspace.write("large.toml", "slider.blocks = [300, 300]\n");
    let link = "http://127.0.0.1:1234/#case=q1Yqyc_NUbJSSinKLEvVK4svLkksUrBVMNAzjMlT0lFKy8xJLVayqq6tBQA";
    for (case, signal) in [("", "-INT"), ("large.toml", "-TERM"), (link, "-INT")] {
        let (child, address) = open(&workspace, &format!("lab --no-open {case}"));
        let (host, rest) = address.strip_prefix("http://").unwrap().split_once('/').unwrap();
        let (_, token) = rest.split_once("#token=").unwrap();
        let passed_on = token.split_once("&case=").map(|(_, link)| link);
        assert_eq!(passed_on, case.split_once("#case=").map(|(_, link)| link));
        let mut stream = TcpStream::connect(host).unwrap();
        write!(
            stream,
            "GET / HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n\r\n"
        )
        .unwrap();
        let mut page = String::new();
        stream.read_to_string(&mut page).unwrap();
        assert!(
            page.starts_with("HTTP/1.1 200 OK") && page.contains("<title"),
            "{page}"
        );
        send(&child, signal);
        let output = child.wait_with_output().unwrap();
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    }
}

/// Its folder for temporary files goes with it, or with the next one.
#[test]
fn what_a_killed_one_left_is_removed_by_the_next() {
    let workspace = Workspace::masked();
    let in_temporary = || std::fs::read_dir(workspace.path("temporary")).unwrap().count();
    for (signal, left) in [("-KILL", 1), ("-KILL", 1), ("-TERM", 0)] {
        let (mut child, _) = open(&workspace, "lab --no-open masked.toml");
        assert_eq!(in_temporary(), 1);
        send(&child, signal);
        child.wait().unwrap();
        assert_eq!(in_temporary(), left, "{signal}");
    }
}

#[test]
fn what_cannot_be_opened_is_refused() {
    let workspace = Workspace::small();
    workspace.write("bad.toml", "[drive]\nv_star = -1\n");
    workspace.write("huge.toml", "slider.blocks = [3000, 3000]\n");
    workspace.write("folder/other.txt", "text");
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    for (line, words) in [
        ("lab --no-open none.toml", "none.toml"),
        ("lab --no-open bad.toml", "`drive.v_star`"),
        (
            "lab --no-open huge.toml",
            "3000 x 3000 blocks are more than the 524288",
        ),
        ("lab --no-open folder", "folder"),
        (
            &format!("lab --no-open --port {port}"),
            "choose another one with --port",
        ),
    ] {
        let output = workspace.process(line).output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {said}");
        assert!(
            said.starts_with("error: ") && said.contains(words),
            "{line}: {said}"
        );
    }
}
