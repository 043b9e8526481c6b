//! Sets the identity of the build from a hash of the sources, the platform, and, in a git checkout of the
//! project, the revision.

mod hash_sources;

use std::path::Path;
use std::process::Command;

/// Files that determine the numbers of a run, relative to this crate; changes elsewhere in the checkout do
/// not mark the revision as changed.
const SOURCES: [&str; 6] = [
    "../slipfront-kernel/src",
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
        // A missing file would count as changed in every build.
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

/// The commit, marked `-dirty` if the sources differ from it; none outside of git.
fn revision() -> Option<String> {
    // In a vendored copy, this would be the revision of the other repository.
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
