//! Fuzz targets: one for every parser, each defined once.
//!
//! A [`Target`] takes any bytes and panics when a parser does something that it must not: panic itself, give an error
//! message that cannot be read, take more memory or processor time than its limit, or read something that does not survive
//! writing and reading again. `cargo test` runs all targets on seeds, earlier findings and a fixed number of mutations
//! (`tests/replay.rs`); libFuzzer runs one of them for hours (`run.sh`).

// Checks fail by panicking.
#![allow(clippy::unwrap_used)]

mod checks;
pub mod inputs;
mod long;
mod memory;
mod mutate;
mod scratch;
mod targets;
mod time;

use std::time::Duration;

pub use long::LONG_BYTES;
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
    /// The most processor time that the check may take.
    time: Time,
    /// Mutations that `cargo test` tries, within a fraction of a second.
    pub mutations: usize,
    /// Long inputs that `cargo test` tries.
    pub repetitions: usize,
    /// Makes long inputs in code: many of each thing of which the format allows any number, and where it is long or deep.
    long: fn() -> Vec<Vec<u8>>,
}

/// Largest memory at once: a constant, and a multiple of the length of the input.
#[derive(Clone, Copy)]
struct Memory {
    bytes: usize,
    per_byte: usize,
}

/// Longest processor time: a constant, and a multiple of the length of the input.
#[derive(Clone, Copy)]
struct Time {
    seconds: f64,
    us_per_byte: f64,
}

impl Time {
    /// Time of most checks: more than twice what was measured of the slowest long input, and ten times that of most, so that a busy
    /// machine does not come near. Time that grows with the square of the length, at a nanosecond for each pair of bytes, takes ten times
    /// this for the long inputs.
    const READING: Self = Self {
        seconds: 2.0,
        us_per_byte: 25.0,
    };

    /// Time of checks that read pictures several times: 2^28 pixels at most, however few bytes hold them.
    const DRAWN: Self = Self {
        seconds: 30.0,
        us_per_byte: 25.0,
    };
}

impl Target {
    /// The target with this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TARGETS.iter().find(|target| target.name == name)
    }

    /// Runs the check, and measures its memory and time.
    ///
    /// # Panics
    /// When the check fails or takes too much memory or time.
    pub fn run(&self, input: &[u8]) {
        let most = self.memory.bytes + self.memory.per_byte * input.len();
        let longest = self.time.seconds + 1e-6 * self.time.us_per_byte * input.len() as f64;
        let mut time = Duration::ZERO;
        let taken = memory::peak_of(|| time = time::time_of(|| (self.check)(input)));
        assert!(
            taken <= most,
            "{taken} bytes of memory at once where {} bytes of input may take {most}",
            input.len()
        );
        let time = time.as_secs_f64();
        assert!(
            time <= longest,
            "{time} s of processor time where {} bytes of input may take {longest} s",
            input.len()
        );
    }
}
