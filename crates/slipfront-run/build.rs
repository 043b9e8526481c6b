//! Hashes the sources, for the identity of the build, hands on the platform, and asks for the git revision,
//! where it is built in a checkout of its own.

mod hash_sources;

use std::path::Path;
use std::process::Command;

/// Files that decide the numbers of a run, relative to this crate; a change elsewhere in the checkout does
/// not make it another program.
const SOURCES: [&str; 5] = [
    "../slipfront/src",
    "../slipfront-case/src",
    "src",
    "../../Cargo.toml",
    "../../Cargo.lock",
];

fn main() -> std::io::Result<()> {
    hash_sources::hash_sources()?;
    // HEAD changes with the branch; its log grows with every commit.
    let heads = ["HEAD", "logs/HEAD"].map(|name| git(&["rev-parse", "--git-path", name]));
    let heads = heads.iter().flatten().map(String::as_str);
    for path in SOURCES.into_iter().chain(["build.rs"]).chain(heads) {
        // What is not there would count as changed in every build.
        if Path::new(path).exists() {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    let platform = std::env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=SLIPFRONT_PLATFORM={platform}");
    if let Some(revision) = revision() {
        println!("cargo::rustc-env=SLIPFRONT_REVISION={revision}");
    }
    Ok(())
}

/// The commit, and whether the sources are those of the commit; none outside of git.
fn revision() -> Option<String> {
    // Vendored in another repository, the revision would be that one's.
    git(&["rev-parse", "--show-prefix"]).filter(|prefix| prefix == "crates/slipfront-run/")?;
    let commit = git(&["rev-parse", "HEAD"])?;
    let changes = git(&[&["status", "--porcelain", "--"], &SOURCES[..]].concat())?;
    let dirty = if changes.is_empty() { "" } else { "-dirty" };
    Some(format!("{commit}{dirty}"))
}

/// Output of a git command; none if there is no git, or it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let said = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| said.trim_end().to_owned())
}
