//! Fuzz targets: one for every parser, each defined once.
//!
//! A [`Target`] takes any bytes and panics when a parser does something that it must not: panic itself, give an error
//! message that cannot be read, take more memory than its limit, or read something that does not survive writing and reading
//! again. `cargo test` runs all targets on seeds, earlier findings and a fixed number of mutations
//! (`tests/replay.rs`); libFuzzer runs one of them for hours (`run.sh`).

// Checks fail by panicking.
#![allow(clippy::unwrap_used)]

mod checks;
pub mod inputs;
mod memory;
mod mutate;
mod scratch;
mod targets;

pub use mutate::Mutator;
pub use targets::TARGETS;

/// A check of one parser, which is run on arbitrary bytes.
#[derive(Clone, Copy)]
pub struct Target {
    /// The name, also of the folders of its inputs below `seeds/` and `findings/`.
    pub name: &'static str,
    /// Reads the input and panics if something is wrong.
    check: fn(&[u8]),
    /// Makes seeds in code, so that they follow the format.
    generated: fn() -> Vec<Vec<u8>>,
    /// Seeds among the files of the repository: paths, or a folder and an ending such as `cases/*.toml`.
    files: &'static [&'static str],
    /// A file in `dictionaries/` with words of the format, which mutations insert.
    pub dictionary: Option<&'static str>,
    /// The longest input that is tried, in bytes.
    pub max_bytes: usize,
    /// The most memory that the check may take.
    memory: Memory,
    /// Mutations that `cargo test` tries, within a fraction of a second.
    pub mutations: usize,
    /// Long inputs that `cargo test` tries.
    pub repetitions: usize,
}

/// Largest memory at once: a constant, and a multiple of the length of the input.
#[derive(Clone, Copy)]
struct Memory {
    bytes: usize,
    per_byte: usize,
}

impl Target {
    /// The target with this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Runs the check, and measures its memory.
    ///
    /// # Panics
    /// When the check fails or takes too much memory.
    pub fn run(&self, input: &[u8]) {
        let most = self.memory.bytes + self.memory.per_byte * input.len();
        let taken = memory::peak_of(|| (self.check)(input));
        assert!(
            taken <= most,
            "{taken} bytes of memory at once where {} bytes of input may take {most}",
            input.len()
        );
    }
}
