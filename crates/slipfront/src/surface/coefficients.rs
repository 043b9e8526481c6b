//! Local friction coefficients: Gaussian draws (Eq. 1) from named random streams, or given block by block.

use std::cell::RefCell;
use std::ops::Range;

use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};

use crate::parallel::*;

/// Mean and standard deviation of a Gaussian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Distribution {
    /// Turns standard normals into coefficients.
    fn scale(self, normals: impl Iterator<Item = f64>, coefficients: &mut [f64]) {
        for (coefficient, z) in coefficients.iter_mut().zip(normals) {
            *coefficient = self.mean + self.deviation * z;
        }
    }
}

/// Local coefficients of every block, as if there were no texture. Draws may be negative:
/// [`Surface`](super::Surface) sets these to 0, and counts those of blocks in contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Coefficients {
    /// Static coefficients `mu_si`, one per block.
    pub mu_static: Vec<f64>,
    /// Kinetic coefficients `mu_ki`, one per block.
    pub mu_kinetic: Vec<f64>,
}

/// Named random streams of one seed: drawing from one does not change the numbers of another.
#[derive(Clone, Copy)]
pub(super) enum Stream {
    MuStatic = 0,
    MuKinetic = 1,
}

/// Name and ChaCha8 stream number of each quantity that is drawn with the seed.
pub const STREAMS: [(&str, u64); 2] = [
    ("mu_static", Stream::MuStatic as u64),
    ("mu_kinetic", Stream::MuKinetic as u64),
];

impl Coefficients {
    /// Draws `mu_si` and `mu_ki` for `n_blocks` blocks, textured or not, in block order.
    ///
    /// The standard normals depend only on `seed` and the index of the block; mean and deviation shift and
    /// scale them.
    pub fn draw(n_blocks: usize, mu_static: Distribution, mu_kinetic: Distribution, seed: u64) -> Self {
        Self::draw_blocks(0..n_blocks, mu_static, mu_kinetic, seed)
    }

    /// Draws `mu_si` and `mu_ki` as [`draw`](Self::draw) does, but only for these blocks of a lattice.
    pub fn draw_blocks(
        blocks: Range<usize>,
        mu_static: Distribution,
        mu_kinetic: Distribution,
        seed: u64,
    ) -> Self {
        let draw = |distribution: Distribution, stream: Stream| {
            let mut coefficients = vec![0.0; blocks.len()];
            let normals = |first| standard_normals(seed, stream, BY_BLOCK, blocks.start + first);
            if blocks.len() > MAX_KEPT {
                let parts = coefficients.par_chunks_mut(PART).enumerate();
                parts.for_each(|(k, part)| distribution.scale(normals(k * PART), part));
            } else {
                LAST_NORMALS.with_borrow_mut(|last| {
                    let (of_seed, of_blocks, kept) = &mut last[stream as usize];
                    if *of_seed != seed || *of_blocks != blocks {
                        kept.clear();
                        kept.extend(normals(0).take(blocks.len()));
                        (*of_seed, *of_blocks) = (seed, blocks.clone());
                    }
                    distribution.scale(kept.iter().copied(), &mut coefficients);
                });
            }
            coefficients
        };
        Self {
            mu_static: draw(mu_static, Stream::MuStatic),
            mu_kinetic: draw(mu_kinetic, Stream::MuKinetic),
        }
    }

    /// Coefficients given block by block, row by row from y = 0; both arrays of the same length.
    pub fn given(mu_static: Vec<f64>, mu_kinetic: Vec<f64>) -> Self {
        assert_eq!(
            mu_static.len(),
            mu_kinetic.len(),
            "one static and one kinetic coefficient per block"
        );
        Self {
            mu_static,
            mu_kinetic,
        }
    }

    /// Sets the coefficients of textured blocks and negative draws to 0. Returns the number of negative
    /// draws, static and kinetic together, of blocks in contact.
    pub(super) fn restrict(&mut self, textured: &[bool]) -> usize {
        let restrict = |coefficients: &mut [f64]| -> usize {
            let pairs = coefficients.par_iter_mut().with_min_len(PART).zip(textured);
            let is_negative = |(coefficient, &textured): (&mut f64, &bool)| {
                let is_negative = *coefficient < 0.0;
                if is_negative || textured {
                    *coefficient = 0.0;
                }
                usize::from(is_negative && !textured)
            };
            pairs.map(is_negative).sum()
        };
        restrict(&mut self.mu_static) + restrict(&mut self.mu_kinetic)
    }
}

/// Largest number of blocks for which standard normals are cached. The normals of more blocks are drawn on
/// several threads.
const MAX_KEPT: usize = 10_000;

/// Number of blocks for which a thread draws at once: some tenths of a millisecond of work. Waking a thread
/// is not worth while for fewer.
pub(super) const PART: usize = 1 << 13;

/// Standard normals, with the seed and the blocks for which they were drawn.
type CachedNormals = (u64, Range<usize>, Vec<f64>);

thread_local! {
    /// The standard normals drawn last from each stream, which most cases of a study share.
    static LAST_NORMALS: RefCell<[CachedNormals; STREAMS.len()]> =
        const { RefCell::new([(0, 0..0, Vec::new()), (0, 0..0, Vec::new())]) };
}

/// Number of 32-bit words that a standard normal takes from its stream: two uniforms of two words.
const WORDS_PER_DRAW: u128 = 4;

/// Row of the numbers that are drawn block by block; other rows belong to nodes of a grid.
const BY_BLOCK: u64 = 0;

/// Standard normals of a row from draw `first` on, by Box and Muller from two uniforms each, so that draw n
/// always has the same position in the stream. Sine and logarithm are those of `libm`, with the same bits on
/// every machine.
pub(super) fn standard_normals(
    seed: u64,
    stream: Stream,
    row: u64,
    first: usize,
) -> impl Iterator<Item = f64> {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8..16].copy_from_slice(&row.to_le_bytes());
    let mut rng = ChaCha8Rng::from_seed(key);
    rng.set_stream(stream as u64);
    rng.set_word_pos(WORDS_PER_DRAW * first as u128);
    std::iter::repeat_with(move || {
        const UNIT: f64 = 1.0 / (1u64 << 53) as f64;
        let radius = (-2.0 * libm::log(((rng.next_u64() >> 11) + 1) as f64 * UNIT)).sqrt();
        let angle = std::f64::consts::TAU * ((rng.next_u64() >> 11) as f64 * UNIT);
        radius * libm::cos(angle)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const STATIC: Distribution = Distribution {
        mean: 1.0,
        deviation: 0.05,
    };
    const KINETIC: Distribution = Distribution {
        mean: 0.5,
        deviation: 0.025,
    };

    #[test]
    fn streams_do_not_disturb_each_other() {
        let one = Coefficients::draw(100, STATIC, KINETIC, 7);
        let other = Coefficients::draw(
            100,
            Distribution {
                mean: 2.0,
                deviation: 0.4,
            },
            KINETIC,
            7,
        );
        assert_eq!(one.mu_kinetic, other.mu_kinetic);
        let longer = Coefficients::draw(200, STATIC, KINETIC, 7);
        assert_eq!(one.mu_static[..], longer.mu_static[..100]);
        assert_ne!(
            one.mu_static,
            Coefficients::draw(100, STATIC, KINETIC, 8).mu_static
        );
        assert_ne!(one.mu_static[0] - 1.0, 2.0 * (one.mu_kinetic[0] - 0.5));
    }

    #[test]
    fn draws_have_their_mean_and_deviation() {
        let n = 40_000;
        let mu = Coefficients::draw(n, STATIC, KINETIC, 1).mu_static;
        let mean = mu.iter().sum::<f64>() / n as f64;
        let variance = mu.iter().map(|m| (m - mean).powi(2)).sum::<f64>() / n as f64;
        // Five standard errors of a sample of this size.
        assert!((mean - 1.0).abs() < 5.0 * 0.05 / (n as f64).sqrt(), "{mean}");
        assert!(
            (variance.sqrt() / 0.05 - 1.0).abs() < 5.0 / (2.0 * n as f64).sqrt(),
            "{variance}"
        );
    }

    /// Only negative draws of blocks in contact count: a draw for a textured block changes nothing.
    #[test]
    fn negative_draws_become_zero_and_are_counted() {
        let wide = Distribution {
            mean: 0.1,
            deviation: 1.0,
        };
        let drawn = Coefficients::draw(1000, wide, KINETIC, 3);
        let textured: Vec<bool> = (0..1000).map(|b| b % 3 == 0).collect();
        let mut restricted = drawn.clone();
        let negative = restricted.restrict(&textured);
        let in_contact = (0..1000).filter(|b| b % 3 != 0);
        let zeros = in_contact.filter(|&b| restricted.mu_static[b] == 0.0).count();
        assert_eq!(zeros, negative);
        // 46 % of such draws of 666 blocks are 306 +- 13: five standard errors.
        assert!(zeros.abs_diff(306) < 65, "{zeros}");
        for (b, textured) in textured.iter().enumerate() {
            let [static_draw, kinetic_draw] = [drawn.mu_static[b], drawn.mu_kinetic[b]];
            let expected = if *textured {
                [0.0; 2]
            } else {
                [static_draw.max(0.0), kinetic_draw]
            };
            assert_eq!([restricted.mu_static[b], restricted.mu_kinetic[b]], expected);
        }
    }

    /// Draws of some blocks are a part of the draws of all, whether these are cached or not, at any starting
    /// position in the generator, which makes 64 words at a time.
    #[test]
    fn parts_of_a_lattice_draw_what_the_whole_does() {
        let wide = Distribution {
            mean: 0.1,
            deviation: 0.1,
        };
        for n in [1000, 3 * MAX_KEPT] {
            let whole = Coefficients::draw(n, wide, KINETIC, 5);
            for cuts in [
                vec![0, n],
                vec![0, 1, 16, 17, 333, n],
                vec![0, n / 3, n / 3, n - 1, n],
            ] {
                let parts = cuts
                    .windows(2)
                    .map(|cut| Coefficients::draw_blocks(cut[0]..cut[1], wide, KINETIC, 5));
                let mut joined = Coefficients::given(Vec::new(), Vec::new());
                for part in parts {
                    joined.mu_static.extend(part.mu_static);
                    joined.mu_kinetic.extend(part.mu_kinetic);
                }
                assert_eq!(joined, whole, "{cuts:?}");
            }
        }
    }

    /// The numbers are fixed: changing them would change every surface ever published with a seed.
    #[test]
    fn the_first_draws_of_seed_one_never_change() {
        let z: Vec<f64> = standard_normals(1, Stream::MuStatic, BY_BLOCK, 0)
            .take(3)
            .collect();
        let k: Vec<f64> = standard_normals(1, Stream::MuKinetic, BY_BLOCK, 0)
            .take(3)
            .collect();
        assert_eq!(z, PINNED_STATIC);
        assert_eq!(k, PINNED_KINETIC);
    }
    const PINNED_STATIC: [f64; 3] = [-0.3867112863449485, 0.5802850840980233, 0.35786655055672956];
    const PINNED_KINETIC: [f64; 3] = [0.8824039934920065, -0.443579855297724, 1.4083362703310385];
}
