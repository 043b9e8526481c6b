//! Start and end of the laboratory.

use std::fs::{self, File};
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::process::CommandExt;
use std::process::{Command, Stdio};

use crate::support::process::{Running, ignores_hangup, output, send, stderr, stdout, wait_for};
use crate::support::workspace::Workspace;

/// Starts the command; returns it and the address that it prints.
fn open(workspace: &Workspace, line: &str) -> (Running, String) {
    let mut process = workspace.process(line);
    fs::create_dir_all(workspace.path("temporary")).unwrap();
    start(process.env("TMPDIR", workspace.path("temporary")))
}

/// Starts a command; returns it and the address that it prints.
fn start(process: &mut Command) -> (Running, String) {
    let mut child = Running::start(process.stdout(Stdio::piped()).stderr(Stdio::piped()));
    let printed = child.first_line();
    let address = printed
        .split_whitespace()
        .find(|word| word.starts_with("http://"));
    let address = address
        .unwrap_or_else(|| panic!("no address in {printed:?}"))
        .to_owned();
    (child, address)
}

/// The host and the token of an address.
fn parts(address: &str) -> (&str, &str) {
    let (host, rest) = address.strip_prefix("http://").unwrap().split_once('/').unwrap();
    (host, rest.split_once("#token=").unwrap().1)
}

#[test]
fn it_serves_its_page_until_a_signal() {
    let workspace = Workspace::small();
    workspace.write("large.toml", "slider.blocks = [300, 300]\n");
    let link = "http://127.0.0.1:1234/#case=q1Yqyc_NUbJSSinKLEvVK4svLkksUrBVMNAzjMlT0lFKy8xJLVayqq6tBQA";
    for (case, signal) in [("", "-INT"), ("large.toml", "-TERM"), (link, "-HUP")] {
        let (child, address) = open(&workspace, &format!("lab --no-open {case}"));
        let (host, token) = parts(&address);
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
        // A client that begins a request and never ends it.
        let mut idle = TcpStream::connect(host).unwrap();
        idle.write_all(b"G").unwrap();
        let signal = if signal == "-HUP" && ignores_hangup() {
            "-INT"
        } else {
            signal
        };
        send(&child, signal);
        let output = child.ended();
        assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    }
}

/// A desktop for one test: programs by name, before those of the system.
struct Desktop(Workspace);

impl Desktop {
    /// A desktop with an `xdg-open` that records the file to open and runs as long as that record exists,
    /// like a browser that shows a page.
    fn new() -> Self {
        let desktop = Self(Workspace::small());
        let note = desktop.0.path("opened");
        let note = note.display();
        desktop.program(
            "bin/xdg-open",
            &format!(
                "echo \"$1\" > {note}.new; mv {note}.new {note}; while [ -e {note} ]; do sleep 0.1; done"
            ),
        );
        desktop.default_program("firefox.desktop", "firefox.desktop");
        desktop.entry("Exec=firefox %u");
        desktop.program("bin/firefox", "");
        fs::create_dir(desktop.0.path("tmp")).unwrap();
        desktop
    }

    fn program(&self, name: &str, script: &str) {
        self.0.write(name, format!("#!/bin/sh\n{script}\n"));
        fs::set_permissions(self.0.path(name), PermissionsExt::from_mode(0o755)).unwrap();
    }

    /// Sets the default programs for HTML files and for addresses.
    fn default_program(&self, pages: &str, addresses: &str) {
        let script = format!("case $3 in text/html) echo {pages} ;; *) echo {addresses} ;; esac");
        self.program("bin/xdg-mime", &script);
    }

    fn entry(&self, text: &str) {
        self.0.write(
            "share/applications/firefox.desktop",
            format!("[Desktop Entry]\n{text}\n"),
        );
    }

    fn process(&self, line: &str) -> Command {
        let mut process = self.0.process(line);
        let path = format!(
            "{}:{}",
            self.0.path("bin").display(),
            std::env::var("PATH").unwrap()
        );
        process
            .env("PATH", path)
            .env("TMPDIR", self.0.path("tmp"))
            .env("XDG_DATA_HOME", self.0.path("share"))
            .env_remove("BROWSER");
        process
    }
}

/// Output of a program as the user `nobody`; none if this user may not become another user.
fn as_nobody(script: &str) -> Option<String> {
    let mut shell = Command::new("sh");
    let output = shell.args(["-c", script]).uid(65534).gid(65534).output().ok()?;
    Some(stdout(&output) + &stderr(&output))
}

#[test]
fn no_other_user_can_read_the_token() {
    let desktop = Desktop::new();
    let (child, address) = start(&mut desktop.process("lab"));
    let (_, token) = parts(&address);
    desktop.0.wait_for("opened");
    let page = desktop.0.read_text("opened").trim().to_owned();
    assert!(fs::read_to_string(&page).unwrap().contains(token));
    let temporary = desktop.0.path("tmp").display().to_string();
    assert!(page.starts_with(&temporary), "{page}");
    let script = format!(
        "cat /proc/[0-9]*/cmdline /proc/[0-9]*/environ | tr '\\0' '\\n'; cat {page}; ls -R {temporary}; \
         find {temporary} -type f -exec cat {{}} +"
    );
    match as_nobody(&script) {
        Some(seen) => {
            assert!(
                seen.contains(&page),
                "the arguments of the browser were not seen: {seen}"
            );
            assert!(!seen.contains(token), "another user has read the token");
        }
        None => eprintln!("skipped: only root can look as another user does"),
    }
    send(&child, "-TERM");
    let output = child.ended();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
    assert_eq!(fs::read_dir(&temporary).unwrap().count(), 0);
}

/// A snap or a Flatpak sees only its own temporary files.
#[test]
fn a_browser_that_cannot_read_the_page_is_not_started() {
    let desktop = Desktop::new();
    let said = |change: &dyn Fn(&mut Command)| {
        let mut process = desktop.process("lab");
        change(&mut process);
        let (child, _) = start(&mut process);
        send(&child, "-TERM");
        let output = child.ended();
        assert_eq!(output.status.code(), Some(0));
        stderr(&output)
    };
    let refused = |change: &dyn Fn(&mut Command), words: &str| {
        let said = said(change);
        assert!(
            said.starts_with("note: no browser was started, because ") && said.contains(words),
            "{words}: {said}"
        );
        assert!(!desktop.0.exists("opened"), "{words}");
        assert_eq!(fs::read_dir(desktop.0.path("tmp")).unwrap().count(), 0, "{words}");
    };
    desktop.entry("Name=Firefox\nExec=env A=B /snap/bin/firefox %u");
    refused(&|_| {}, "/snap/bin/firefox %u` is a snap or a Flatpak");
    desktop.entry("Exec=/usr/bin/flatpak run --file-forwarding org.mozilla.firefox @@u %u @@");
    refused(&|_| {}, "org.mozilla.firefox");
    // Programs that are scripts or links.
    desktop.entry("Exec=firefox %u");
    desktop.program("bin/firefox", "exec /snap/bin/firefox \"$@\"");
    refused(&|_| {}, "`firefox %u`");
    desktop.program("bin/firefox", "");
    desktop.program("elsewhere/bin/snap", "");
    std::os::unix::fs::symlink(desktop.0.path("elsewhere/bin/snap"), desktop.0.path("bin/web")).unwrap();
    let web = |process: &mut Command| {
        process.env("BROWSER", "firefox:web --new-window %s");
    };
    refused(&web, "`web --new-window %s`");
    // An editor of HTML files would show their source.
    desktop.default_program("editor.desktop", "firefox.desktop");
    refused(&|_| {}, "editor.desktop opens HTML files on this system");
    // There is no objection to other programs.
    desktop.default_program("firefox.desktop", "firefox.desktop");
    assert_eq!(said(&|_| {}), "");
    desktop.0.wait_for("opened");
    desktop.0.remove("opened");
    desktop.program("bin/xdg-mime", "exit 4");
    assert_eq!(said(&|_| {}), "");
    desktop.0.wait_for("opened");
}

/// A log that others can read names a private file, which exists as long as the server.
#[test]
fn the_address_is_not_printed_into_a_file_that_others_can_read() {
    let workspace = Workspace::small();
    fs::create_dir(workspace.path("tmp")).unwrap();
    let in_temporary = || fs::read_dir(workspace.path("tmp")).unwrap().count();
    for (mode, signal, is_hidden) in [
        (0o644, "-TERM", true),
        (0o640, "-KILL", true),
        (0o604, "-TERM", true),
        (0o600, "-TERM", false),
    ] {
        let log = File::create(workspace.path("log")).unwrap();
        log.set_permissions(PermissionsExt::from_mode(mode)).unwrap();
        let mut process = workspace.process("lab --no-open");
        let process = process
            .env("TMPDIR", workspace.path("tmp"))
            .stdout(log)
            .stderr(Stdio::piped());
        let child = Running::start(process);
        let printed = || workspace.read_text("log");
        wait_for("address", || printed().ends_with('\n'));
        let shown = printed().split_whitespace().last().unwrap().to_owned();
        assert_eq!(printed().contains("#token="), !is_hidden, "{shown}");
        if is_hidden {
            let address = fs::read_to_string(&shown).unwrap();
            let (host, _) = parts(address.trim());
            assert!(TcpStream::connect(host).is_ok(), "{address}");
            let mode = fs::metadata(&shown).unwrap().permissions().mode();
            assert_eq!(mode & 0o777, 0o600);
            if let Some(seen) = as_nobody(&format!("cat {shown}")) {
                assert!(!seen.contains("#token="), "another user has read the token");
            }
            // Files of the previous server are gone.
            assert_eq!(in_temporary(), 1);
        }
        send(&child, signal);
        let output = child.ended();
        let said = stderr(&output);
        assert_eq!(
            said.contains("other users can read this output"),
            is_hidden,
            "{said}"
        );
        if signal == "-KILL" {
            assert_eq!(in_temporary(), 1);
        } else {
            assert_eq!((output.status.code(), in_temporary()), (Some(0), 0), "{said}");
        }
    }
}

/// The next laboratory removes the temporary folder of the start page of a killed one.
#[test]
fn what_a_killed_one_left_is_removed_by_the_next() {
    let desktop = Desktop::new();
    let in_temporary = || fs::read_dir(desktop.0.path("tmp")).unwrap().count();
    for (signal, left) in [("-KILL", 1), ("-KILL", 1), ("-TERM", 0)] {
        let (mut child, _) = start(&mut desktop.process("lab"));
        desktop.0.wait_for("opened");
        assert_eq!(in_temporary(), 1);
        send(&child, signal);
        child.wait().unwrap();
        assert_eq!(in_temporary(), left, "{signal}");
        desktop.0.remove("opened");
    }
}

#[test]
fn the_files_of_a_case_are_kept_in_memory() {
    let workspace = Workspace::masked();
    let (child, _) = open(&workspace, "lab --no-open masked.toml");
    assert_eq!(fs::read_dir(workspace.path("temporary")).unwrap().count(), 0);
    send(&child, "-TERM");
    assert_eq!(child.ended().status.code(), Some(0));
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
        let output = output(&mut workspace.process(line));
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{line}: {said}");
        assert!(
            said.starts_with("error: ") && said.contains(words),
            "{line}: {said}"
        );
    }
}
