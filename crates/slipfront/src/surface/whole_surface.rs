//! Values for the surface as a whole, independent of the division among ranks.

use std::array;
use std::ops::Range;

use super::coefficients::Coefficients;
use crate::communicator::Communicator;
use crate::parallel::*;
use slipfront_kernel::fixed_point::{FixedPoint, join, split};

/// Values for the whole surface, equal to the last bit on every rank and for any number of ranks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Whole {
    /// Number of existing blocks that face the substrate.
    pub(super) n_blocks: usize,
    pub(super) n_contact: usize,
    pub(super) negative_draws: usize,
    /// Sum `sum mu_si` over the blocks in contact.
    pub(super) sum_static: f64,
    /// Sum `sum mu_ki` over the blocks in contact.
    pub(super) sum_kinetic: f64,
    /// Sum `sum mu_si p_i/P` over the blocks in contact.
    pub(super) sum_static_pressure: f64,
    /// Sum `sum mu_ki p_i/P` over the blocks in contact.
    pub(super) sum_kinetic_pressure: f64,
    /// Sum `sum p_i/P` over all these blocks, and over those in contact.
    pub(super) sum_pressure: [f64; 2],
}

/// Number of blocks that a thread adds up at once.
const PART: usize = 1 << 16;

/// Number of sums over blocks: `mu_si`, `mu_ki`, `mu_ki p_i/P`, `p_i/P`, `p_i/P` of a block in contact, and
/// `mu_si p_i/P`.
const SUMS: usize = 6;

impl Whole {
    /// Computes the values together with all other ranks that hold a part of the surface, from coefficients
    /// as [restricted](Coefficients::restrict), the number of negative draws, and local pressures in units of
    /// `P`, 1 everywhere if not given. `faces`: whether each block exists, and whether it faces the
    /// substrate; the others count as textured.
    pub(super) fn find(
        coefficients: &Coefficients,
        negative_draws: usize,
        textured: &[bool],
        pressure: Option<&[f64]>,
        faces: [Option<&[bool]>; 2],
        ranks: &dyn Communicator,
    ) -> Self {
        let [mu_static, mu_kinetic] = [&coefficients.mu_static, &coefficients.mu_kinetic];
        let is_facing = |b: usize| faces.iter().flatten().all(|is_so| is_so[b]);
        let terms = |b: usize| {
            let p = match pressure {
                _ if !is_facing(b) => 0.0,
                Some(pressure) => pressure[b],
                None => 1.0,
            };
            let contact = if textured[b] { 0.0 } else { p };
            [
                mu_static[b],
                mu_kinetic[b],
                mu_kinetic[b] * p,
                p,
                contact,
                mu_static[b] * p,
            ]
        };
        // Neither maxima nor sums of integers depend on the division of blocks among threads.
        let parts = || {
            let starts = (0..textured.len()).into_par_iter().step_by(PART);
            starts.map(|first| first..textured.len().min(first + PART))
        };
        let none = || [0.0; SUMS];
        let larger = |one: [f64; SUMS], other: [f64; SUMS]| array::from_fn(|k| f64::max(one[k], other[k]));
        let largest = |blocks: Range<usize>| blocks.map(terms).fold(none(), larger);
        let mut largest: [f64; SUMS] = reduce(parts().map(largest), none, larger);
        ranks.largest(&mut largest);

        let fixed = largest.map(FixedPoint::new);
        let sum = |blocks: Range<usize>| {
            let mut sums = [0_i128; SUMS];
            for terms in blocks.map(terms) {
                for ((sum, fixed), term) in sums.iter_mut().zip(fixed).zip(terms) {
                    *sum += i128::from(fixed.integer(term));
                }
            }
            sums
        };
        let added = |one: [i128; SUMS], other: [i128; SUMS]| array::from_fn(|k| one[k] + other[k]);
        let sums: [i128; SUMS] = reduce(parts().map(sum), || [0; SUMS], added);
        let n_contact = parts().map(|blocks| textured[blocks].iter().filter(|&&textured| !textured).count());
        let n_facing = parts().map(|blocks| blocks.filter(|&b| is_facing(b)).count());
        let counts = [n_facing.sum::<usize>(), n_contact.sum(), negative_draws];
        let mut words = [[0; 2]; SUMS + 2];
        for (words, sum) in words.iter_mut().zip(sums) {
            *words = split(sum);
        }
        words[SUMS] = [counts[0] as i64, counts[1] as i64];
        words[SUMS + 1][0] = counts[2] as i64;
        ranks.sum(words.as_flattened_mut());
        let value = |k: usize| fixed[k].value(join(words[k]));
        Self {
            n_blocks: words[SUMS][0] as usize,
            n_contact: words[SUMS][1] as usize,
            negative_draws: words[SUMS + 1][0] as usize,
            sum_static: value(0),
            sum_kinetic: value(1),
            sum_static_pressure: value(5),
            sum_kinetic_pressure: value(2),
            sum_pressure: [value(3), value(4)],
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
        let found = Whole::find(&coefficients, 7, &textured, None, [None; 2], &Alone);
        let expected = Whole {
            n_blocks: n,
            n_contact: n - 3,
            negative_draws: 7,
            sum_static: 1e6 + 2.0 * (n - 5) as f64,
            sum_kinetic: 1.0 + 3.0 * (n - 4) as f64,
            sum_static_pressure: 1e6 + 2.0 * (n - 5) as f64,
            sum_kinetic_pressure: 1.0 + 3.0 * (n - 4) as f64,
            sum_pressure: [n as f64, (n - 3) as f64],
        };
        assert_eq!(found, expected);
        // Half the pressure on every second block, beginning with the first; of the blocks without contact,
        // one has the full pressure.
        let pressure: Vec<f64> = (0..n).map(|b| if b % 2 == 0 { 0.5 } else { 1.0 }).collect();
        let found = Whole::find(&coefficients, 0, &textured, Some(&pressure), [None; 2], &Alone);
        let all = 0.5 * (n.div_ceil(2)) as f64 + (n / 2) as f64;
        assert_eq!(found.sum_pressure, [all, all - 2.0]);
        // The block of 10^6 has an odd index; the last has an even one, and the coefficients 0 and 1.
        assert_eq!(found.sum_static_pressure, 2.0 * (all - 2.0 - 1.0 - 0.5) + 1e6);
        assert_eq!(found.sum_kinetic_pressure, 3.0 * (all - 2.0 - 0.5) + 0.5);
    }
}
