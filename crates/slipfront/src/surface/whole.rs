//! What is known of the surface as a whole, whichever ranks hold its blocks.

use std::ops::Range;

use rayon::prelude::*;

use super::coefficients::Coefficients;
use crate::communicator::Communicator;
use crate::fixed_point::{FixedPoint, join, split};

/// Numbers of the whole surface, the same to the last bit on every rank and for any number of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Whole {
    pub(super) n_blocks: usize,
    pub(super) n_contact: usize,
    pub(super) negative_draws: usize,
    /// The smallest `max(mu_si, mu_ki)` of a block in contact.
    pub(super) min_coefficient: f64,
    /// `sum mu_si` over the blocks in contact.
    pub(super) sum_static: f64,
    /// `sum mu_ki` over the blocks in contact.
    pub(super) sum_kinetic: f64,
}

/// Blocks that a thread looks at at once.
const PART: usize = 1 << 16;

/// What no blocks have: the largest static and the largest kinetic coefficient, and minus the smallest `max(mu_si, mu_ki)`.
const NO_EXTREMES: [f64; 3] = [0.0, 0.0, f64::NEG_INFINITY];

fn larger(one: [f64; 3], other: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| one[k].max(other[k]))
}

impl Whole {
    /// Found with all other ranks that hold a part of the surface, of coefficients that are 0 over a texture.
    pub(super) fn find(coefficients: &Coefficients, textured: &[bool], ranks: &dyn Communicator) -> Self {
        let arrays = [&coefficients.mu_static, &coefficients.mu_kinetic];
        let [mu_static, mu_kinetic] = arrays;
        // Neither maxima nor sums of integers depend on how the blocks are divided among threads.
        let parts = || {
            let starts = (0..textured.len()).into_par_iter().step_by(PART);
            starts.map(|first| first..textured.len().min(first + PART))
        };
        let count = |blocks: Range<usize>| {
            let (mut n_contact, mut extremes) = (0, NO_EXTREMES);
            for b in blocks.filter(|&b| !textured[b]) {
                let (mu_static, mu_kinetic) = (mu_static[b], mu_kinetic[b]);
                n_contact += 1;
                let found = [mu_static, mu_kinetic, -mu_static.max(mu_kinetic)];
                extremes = larger(extremes, found);
            }
            (n_contact, extremes)
        };
        let (n_contact, mut extremes) = parts().map(count).reduce(
            || (0, NO_EXTREMES),
            |(n, one), (m, other)| (n + m, larger(one, other)),
        );
        ranks.largest(&mut extremes);

        let fixed = [0, 1].map(|k| FixedPoint::new(extremes[k]));
        let [[a, b], [c, d]] = [0, 1].map(|k| {
            let sum = |blocks: Range<usize>| fixed[k].sum(blocks.len(), |b| arrays[k][blocks.start + b]);
            split(parts().map(sum).sum())
        });
        let counts = [textured.len(), n_contact, coefficients.negative_draws];
        let [n_blocks, n_contact, negative_draws] = counts.map(|count| count as i64);
        let mut sums = [n_blocks, n_contact, negative_draws, a, b, c, d];
        ranks.sum(&mut sums);
        let [n_blocks, n_contact, negative_draws, a, b, c, d] = sums;
        Self {
            n_blocks: n_blocks as usize,
            n_contact: n_contact as usize,
            negative_draws: negative_draws as usize,
            min_coefficient: -extremes[2],
            sum_static: fixed[0].value(join([a, b])),
            sum_kinetic: fixed[1].value(join([c, d])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::communicator::Alone;

    /// Coefficients that are integers, with the extremes in the middle and the last part.
    #[test]
    fn every_part_of_a_large_surface_counts() {
        let n = 2 * PART + 5;
        let mut coefficients = Coefficients::given(vec![2.0; n], vec![3.0; n]);
        let mut textured = vec![false; n];
        for b in [0, PART, n - 2] {
            textured[b] = true;
            (coefficients.mu_static[b], coefficients.mu_kinetic[b]) = (0.0, 0.0);
        }
        coefficients.mu_static[PART + 1] = 1e6;
        (coefficients.mu_static[n - 1], coefficients.mu_kinetic[n - 1]) = (0.0, 1.0);
        let found = Whole::find(&coefficients, &textured, &Alone);
        let expected = Whole {
            n_blocks: n,
            n_contact: n - 3,
            negative_draws: 0,
            min_coefficient: 1.0,
            sum_static: 1e6 + 2.0 * (n - 5) as f64,
            sum_kinetic: 1.0 + 3.0 * (n - 4) as f64,
        };
        assert_eq!(found, expected);
    }
}
