//! What is known of the surface as a whole, whichever ranks hold its blocks.

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

impl Whole {
    /// Found with all other ranks that hold a part of the surface, of coefficients that are 0 over a texture.
    pub(super) fn find(coefficients: &Coefficients, textured: &[bool], ranks: &dyn Communicator) -> Self {
        let arrays = [&coefficients.mu_static, &coefficients.mu_kinetic];
        let largest = |values: &Vec<f64>| values.iter().copied().fold(0.0, f64::max);
        let [mu_static, mu_kinetic] = arrays;
        let thresholds = mu_static.iter().zip(mu_kinetic).zip(textured);
        let in_contact = thresholds.filter(|(_, textured)| !**textured);
        let (mut n_contact, mut min_coefficient) = (0, f64::INFINITY);
        for ((mu_static, mu_kinetic), _) in in_contact {
            n_contact += 1;
            min_coefficient = mu_static.max(*mu_kinetic).min(min_coefficient);
        }
        let mut extremes = [largest(mu_static), largest(mu_kinetic), -min_coefficient];
        ranks.largest(&mut extremes);

        let fixed = [0, 1].map(|k| FixedPoint::new(extremes[k]));
        let [[a, b], [c, d]] = [0, 1].map(|k| split(fixed[k].sum(textured.len(), |b| arrays[k][b])));
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
