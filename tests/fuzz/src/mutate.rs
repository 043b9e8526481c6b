//! Random changes of inputs, which depend on a seed alone.

use std::collections::VecDeque;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

/// Bytes that often reveal errors of parsers.
const SPECIAL: [&[u8]; 24] = [
    b"\0",
    b"\n",
    b"\r\n",
    b"\"",
    b"\\",
    b"'",
    b"=",
    b".",
    b",",
    b"-",
    b"[",
    b"]",
    b"{",
    b"}",
    b"0",
    b"1e999",
    b"-0.0",
    b"nan",
    b"\xff",
    b"\xc2\xb5",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"\x80\0\0\0",
    b"9223372036854775808",
];

/// Makes new inputs from seeds.
pub struct Mutator {
    random: ChaCha8Rng,
    words: Vec<Vec<u8>>,
    max_bytes: usize,
}

impl Mutator {
    /// `dictionary` is the text of a dictionary; inputs become no longer than `max_bytes`.
    pub fn new(seed: u64, dictionary: &str, max_bytes: usize) -> Self {
        let words = dictionary.lines().filter_map(word);
        Self {
            random: ChaCha8Rng::seed_from_u64(seed),
            words: words.chain(SPECIAL.map(<[u8]>::to_vec)).collect(),
            max_bytes,
        }
    }

    /// One of the seeds after one to eight changes.
    pub fn mutated(&mut self, seeds: &[Vec<u8>]) -> Vec<u8> {
        let mut input = seeds[self.below(seeds.len())].clone();
        for _ in 0..=self.below(8) {
            self.change(&mut input, seeds);
        }
        input.truncate(self.max_bytes);
        input
    }

    /// A seed in which a piece is repeated until the input has about this length; half of the inputs number
    /// the repetitions.
    pub fn repeated(&mut self, seeds: &[Vec<u8>], length: usize) -> Vec<u8> {
        let seed = seeds[self.below(seeds.len())].clone();
        let (start, end) = self.range(seed.len());
        let piece = match self.below(3) {
            0 => self.word(),
            1 => lines_around(&seed, start, end).to_vec(),
            _ => seed[start..end].to_vec(),
        };
        let mut input = seed[..start].to_vec();
        let mut number = 0;
        let counted = self.below(2) == 0;
        while input.len() + seed.len() - end < length {
            input.extend_from_slice(&piece);
            if counted || piece.is_empty() {
                number += 1;
                input.extend_from_slice(number.to_string().as_bytes());
            }
        }
        input.extend_from_slice(&seed[end..]);
        input
    }

    fn change(&mut self, input: &mut Vec<u8>, seeds: &[Vec<u8>]) {
        let (start, end) = self.range(input.len());
        match self.below(7) {
            0 if !input.is_empty() => {
                let at = self.below(input.len());
                input[at] ^= 1 << self.below(8);
            }
            1 if !input.is_empty() => {
                let at = self.below(input.len());
                input[at] = self.below(256) as u8;
            }
            2 => {
                input.drain(start..end);
            }
            3 => {
                let piece = input[start..end].to_vec();
                let at = self.below(input.len() + 1);
                input.splice(at..at, piece);
            }
            4 => {
                let other = &seeds[self.below(seeds.len())];
                let (from, to) = self.range(other.len());
                input.splice(start..end, other[from..to].iter().copied());
            }
            5 => {
                let word = self.word();
                let end = (start + word.len()).min(input.len());
                input.splice(start..end, word);
            }
            _ => {
                let word = self.word();
                input.splice(start..start, word);
            }
        }
    }

    fn word(&mut self) -> Vec<u8> {
        let which = self.below(self.words.len());
        self.words[which].clone()
    }

    /// A random range within so many bytes, in three of four cases a short one.
    fn range(&mut self, length: usize) -> (usize, usize) {
        let start = self.below(length + 1);
        let most = if self.below(4) == 0 { length } else { 16 };
        (start, start + self.below((length - start).min(most) + 1))
    }

    fn below(&mut self, bound: usize) -> usize {
        (self.random.next_u64() % bound.max(1) as u64) as usize
    }
}

/// The whole lines around a range.
fn lines_around(text: &[u8], start: usize, end: usize) -> &[u8] {
    let first = text[..start]
        .iter()
        .rposition(|&byte| byte == b'\n')
        .map_or(0, |at| at + 1);
    let last = text[end..]
        .iter()
        .position(|&byte| byte == b'\n')
        .map_or(text.len(), |at| end + at + 1);
    &text[first..last]
}

/// The word of a line of a dictionary in the format of libFuzzer: `name="\x00word"`.
fn word(line: &str) -> Option<Vec<u8>> {
    if line.starts_with('#') {
        return None;
    }
    let quoted = line.split_once('"')?.1.strip_suffix('"')?;
    let mut bytes: VecDeque<u8> = quoted.bytes().collect();
    let mut word = Vec::new();
    while let Some(byte) = bytes.pop_front() {
        let escaped = (byte == b'\\').then(|| bytes.pop_front()).flatten();
        word.push(match escaped {
            None => byte,
            Some(b'x') => {
                let digits: String = bytes.drain(..2).map(char::from).collect();
                u8::from_str_radix(&digits, 16).unwrap()
            }
            Some(other) => other,
        });
    }
    Some(word)
}
