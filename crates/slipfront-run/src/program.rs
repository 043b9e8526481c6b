//! The identity of this program: for the manifest, and for distinguishing programs that may not give the same
//! bits.

use std::sync::LazyLock;

/// Version of slipfront.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The git commit from which the program was built, with `-dirty` if its sources were changed; none outside
/// of a checkout.
pub const REVISION: Option<&str> = option_env!("SLIPFRONT_REVISION");

/// The platform that the program was built for, as the compiler names it.
pub const PLATFORM: &str = env!("SLIPFRONT_PLATFORM");

/// Version, identity of the build, git commit and platform, a line for each, as `--version` prints them after
/// the name.
pub fn version_lines() -> &'static str {
    static LINES: LazyLock<String> = LazyLock::new(|| {
        format!(
            "{VERSION}\nbuild     {}\ncommit    {}\nplatform  {PLATFORM}, vectors: {}",
            this_build(),
            REVISION.unwrap_or("not known"),
            vectors(),
        )
    });
    &LINES
}

/// The vector instructions of the kernels; the baseline of a processor architecture also has the name of its
/// instructions.
fn vectors() -> String {
    let name = slipfront::simd_width();
    let here = if cfg!(target_arch = "aarch64") {
        " (NEON)"
    } else if cfg!(target_arch = "x86_64") {
        " (SSE2)"
    } else {
        ""
    };
    format!("{name}{}", if name == "baseline" { here } else { "" })
}

/// Name of this program in words.
pub fn this_program() -> String {
    in_words(VERSION, REVISION)
}

/// A program in words.
pub fn in_words(version: &str, revision: Option<&str>) -> String {
    match revision {
        Some(revision) => format!("slipfront {version} ({revision})"),
        None => format!("slipfront {version}"),
    }
}

/// The identity of the build: version, and a hash of the sources of slipfront-base, slipfront-kernel,
/// slipfront, slipfront-case and slipfront-run and of the locked versions of the crates they use. Builds with
/// the same identity give the same bits, whatever program they are part of.
pub fn this_build() -> &'static str {
    static BUILD: LazyLock<String> = LazyLock::new(|| {
        let hashes = [
            slipfront_base::SOURCE_HASH,
            slipfront::KERNEL_SOURCE_HASH,
            slipfront::SOURCE_HASH,
            slipfront_case::SOURCE_HASH,
            env!("SLIPFRONT_SOURCE_HASH"),
        ];
        let hash = blake3::hash(hashes.concat().as_bytes()).to_hex();
        format!("slipfront {VERSION}, sources {}", &hash[..16])
    });
    &BUILD
}
