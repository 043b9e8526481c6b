//! The program that makes calls of a command fail, for the tests of this crate and of slipfront-mpi.

use std::process::Command;
use std::sync::OnceLock;

/// Path of the watcher, compiled with the C compiler that Rust links with; none without the right to watch a
/// process.
pub(crate) fn watcher() -> Option<&'static str> {
    static WATCHER: OnceLock<Option<String>> = OnceLock::new();
    let make = || {
        let path = format!("{}/faults-{}", env!("CARGO_TARGET_TMPDIR"), std::process::id());
        let source = format!("{path}.c");
        std::fs::write(&source, include_str!("faults.c")).unwrap();
        let compiled = Command::new("cc")
            .args(["-O2", "-Wall", "-Wextra", "-Werror", "-o", &path, &source])
            .status();
        // Not skipped: without it these tests would pass, whatever the command did.
        assert!(
            compiled.is_ok_and(|status| status.success()),
            "faults.c does not compile"
        );
        let works = Command::new(&path)
            .args(["/nowhere", "EIO", "0", "0", "/dev/null", "true"])
            .status()
            .is_ok_and(|status| status.success());
        if !works {
            eprintln!("SKIPPED: no right to watch a process: no file-system call fails in these tests");
        }
        works.then_some(path)
    };
    WATCHER.get_or_init(make).as_deref()
}
