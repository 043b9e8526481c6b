//! Fuzz targets: one for every parser, each defined once.
//!
//! A [`Target`] takes any bytes and panics when a parser does something that it must not: panic itself, give an error
//! that is no sentence, take more memory than input or a stated limit allow, or read something that it cannot write
//! and read again. `cargo test` runs all targets on seeds, earlier findings and a fixed number of mutations
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

/// What is run on bytes that may be anything.
#[derive(Clone, Copy)]
pub struct Target {
    /// Its name: that of its folders below `seeds/` and `findings/`.
    pub name: &'static str,
    /// What it reads and checks.
    check: fn(&[u8]),
    /// Inputs that are made here.
    made: fn() -> Vec<Vec<u8>>,
    /// Inputs that stand in the repository: files, or folders of files of one ending.
    files: &'static [&'static str],
    /// Its words, a file in `dictionaries/`.
    pub dictionary: Option<&'static str>,
    /// The longest input that is tried, in bytes.
    pub longest: usize,
    /// The memory that it may take.
    memory: Memory,
    /// Mutations that `cargo test` tries: a share of a second.
    pub mutations: usize,
    /// Long inputs that `cargo test` tries.
    pub repetitions: usize,
}

/// Most memory at once: a limit that the parser states, or what follows from the length of the input.
#[derive(Clone, Copy)]
struct Memory {
    bytes: usize,
    per_byte: usize,
}

impl Target {
    /// The target of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Runs all checks.
    ///
    /// # Panics
    /// When one fails.
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
