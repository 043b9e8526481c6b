//! The slip front, computed after a run from the times at which the blocks in contact first slipped: where
//! slip nucleates, how fast its front runs, and how long it takes to pass.

mod nucleation;
mod speed;

use self::nucleation::nucleations;
use self::speed::passages;
use crate::lattice::Lattice;

/// Least number of blocks of a nucleation site.
const SITE_MIN_BLOCKS: usize = 9;
/// Number of blocks in contact per block of the smallest nucleation site.
const SITE_MIN_SHARE: usize = 100;

/// Least share of the windows through which a front must pass for it to have a speed. For random times,
/// correlated over as many blocks as a window has, a front passes through less than a fifth of the windows.
const LEAST_SHARE: f64 = 0.5;

/// How slip has spread over a slider.
#[derive(Clone, Debug, PartialEq)]
pub struct Front {
    /// The first block of every nucleation site, the earliest first; of blocks that slip at the same time,
    /// the one with the lowest index counts as the first.
    pub nucleations: Vec<usize>,
    /// Speed of the front, in blocks per unit of time; none if a front passes through less than half of the
    /// windows, as when all blocks slip at once or each by itself.
    pub speed: Option<Quantiles>,
    /// Share of the windows through which a front passes; none if there is no window.
    pub share: Option<f64>,
    /// Time from 5 % to 95 % of the first slips.
    pub duration: f64,
}

/// Quantiles of some numbers, interpolated linearly between neighbours: of n numbers in rising order, the
/// quantile q has the position q (n - 1), counted from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantiles {
    /// Quantile of 5 %.
    pub low: f64,
    /// Median.
    pub median: f64,
    /// Quantile of 95 %.
    pub high: f64,
}

impl Front {
    /// The front of a lattice from the `times` at which its blocks first slipped, NaN for blocks that have
    /// not slipped or have no contact; `n_contact` blocks are in contact. None if no block has slipped.
    ///
    /// Slip nucleates in clusters of neighbouring slipped blocks, which grow block by block in order of time;
    /// blocks that slip at the same time are ordered by index. Where clusters meet, the oldest absorbs the
    /// others. A cluster that reaches
    ///
    /// ```text
    /// max(9, n_contact/100) blocks
    /// ```
    ///
    /// or all of them before an older cluster absorbs it is a nucleation site, unless its blocks slipped all
    /// at once; the position of the site is its first block. A site absorbs smaller clusters of any age: a
    /// block that slips alone and early is not a nucleation.
    ///
    /// The front speed is `1/|g|`, with the slope g of the least-squares plane through the times of 7 x 7
    /// blocks around a slipped block; 7 blocks in a chain. There are windows around all slipped blocks except
    /// those at which slip nucleates and those with too few slipped blocks around them: fewer than 25, or
    /// fewer than 5 per row (or column) if the lattice, or the part of it that has slipped, has fewer than
    /// five. A front passes through a window if the plane explains half of the variance of the times, and g
    /// turns by no more than 60 degrees to the windows 3 blocks away along either axis: where two fronts meet
    /// it turns by more.
    ///
    /// ```
    /// use slipfront::{Lattice, observe::Front};
    ///
    /// // A chain in which slip runs from the first block on, two units of time for each.
    /// let times: Vec<f64> = (0..20).map(|i| 2.0 * f64::from(i)).collect();
    /// let front = Front::find(&Lattice::free(20, 1), &times, 20).unwrap();
    /// assert_eq!((front.nucleations, front.speed.unwrap().median), (vec![0], 0.5));
    /// // Of 20 times 5 % lie before the 0.95th, counted from 0, and 95 % before the 18.05th.
    /// assert!((front.duration - 2.0 * (18.05 - 0.95)).abs() < 1e-12);
    /// ```
    ///
    /// # Panics
    /// If there is not one time per block.
    pub fn find(lattice: &Lattice, times: &[f64], n_contact: usize) -> Option<Self> {
        assert_eq!(times.len(), lattice.n_blocks(), "one time per block");
        let slipped = times.iter().copied().filter(|time| !time.is_nan()).collect();
        let first_slips = Quantiles::new(slipped)?;
        let least = n_contact
            .div_ceil(SITE_MIN_SHARE)
            .max(SITE_MIN_BLOCKS)
            .min(n_contact);
        let nucleations = nucleations(lattice, times, least);
        let passages = passages(lattice, times, &nucleations);
        let share =
            (passages.n_windows > 0).then(|| passages.speeds.len() as f64 / passages.n_windows as f64);
        let is_front = share.is_some_and(|share| share >= LEAST_SHARE);
        Some(Self {
            speed: Quantiles::new(passages.speeds).filter(|_| is_front),
            share,
            nucleations,
            duration: first_slips.high - first_slips.low,
        })
    }
}

impl Quantiles {
    fn new(mut values: Vec<f64>) -> Option<Self> {
        let last = values.len().checked_sub(1)?;
        let mut at = |share: f64| {
            let place = share * last as f64;
            let (_, &mut lower, above) = values.select_nth_unstable_by(place as usize, f64::total_cmp);
            let upper = above.iter().copied().reduce(f64::min).unwrap_or(lower);
            lower + place.fract() * (upper - lower)
        };
        Some(Self {
            low: at(0.05),
            median: at(0.5),
            high: at(0.95),
        })
    }
}

#[cfg(test)]
mod tests;
