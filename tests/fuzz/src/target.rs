//! A fuzz target, and its run within bounds of memory and time.

use std::time::Duration;

use crate::{memory, time};

/// A check of one parser, which is run on arbitrary bytes.
#[derive(Clone, Copy)]
pub struct Target {
    /// The name, also of the folders of its inputs below `seeds/` and `findings/`.
    pub name: &'static str,
    /// Reads the input and panics if something is wrong.
    pub(crate) check: fn(&[u8]),
    /// Makes seeds in code, so that they follow the format.
    pub(crate) generated: fn() -> Vec<Vec<u8>>,
    /// Seeds among the files of the repository: paths, or a folder and an ending such as `cases/*.toml`.
    pub(crate) files: &'static [&'static str],
    /// A file in `dictionaries/` with words of the format, which mutations insert.
    pub dictionary: Option<&'static str>,
    /// The longest input that is tried, in bytes.
    pub max_bytes: usize,
    /// The most memory that the check may take.
    pub(crate) memory: Memory,
    /// The most processor time that the check may take.
    pub(crate) time: Time,
    /// Mutations that `cargo test` tries, within a fraction of a second.
    pub mutations: usize,
    /// Long inputs that `cargo test` tries.
    pub repetitions: usize,
    /// Makes long inputs in code: many of each thing of which the format allows any number, and where it is
    /// long or deep.
    pub(crate) long: fn() -> Vec<Vec<u8>>,
}

/// Largest memory at once: a constant, and a multiple of the length of the input.
#[derive(Clone, Copy)]
pub(crate) struct Memory {
    pub(crate) bytes: usize,
    pub(crate) per_byte: usize,
}

/// Longest processor time: a constant, and a multiple of the length of the input.
#[derive(Clone, Copy)]
pub(crate) struct Time {
    pub(crate) seconds: f64,
    pub(crate) us_per_byte: f64,
}

impl Time {
    /// Time of most checks: eight times what was measured of the slowest long input, since processor time
    /// doubles where cores share their units, and again on a slow machine. Time that grows with the square of
    /// the length, at a nanosecond for each pair of bytes, takes more than twice this for the long inputs.
    pub(crate) const READING: Self = Self {
        seconds: 8.0,
        us_per_byte: 100.0,
    };

    /// Time of checks that read pictures several times: 2^28 pixels at most, however few bytes hold them.
    pub(crate) const DRAWN: Self = Self {
        seconds: 30.0,
        us_per_byte: 25.0,
    };
}

impl Target {
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
