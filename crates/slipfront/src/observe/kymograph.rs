//! Share of sliding blocks against position along the drive and time.

use serde::{Deserialize, Serialize};

use super::observer::{Observer, Schedule, Scheduled};
use crate::error::RunError;
use crate::lattice::Lattice;
use crate::model::Model;
use crate::position_bins::PositionBins;
use crate::snapshot::Snapshot;

/// Counts the sliding blocks in contact, in [bins of their position](PositionBins), at every
/// [`Kymograph::INTERVAL`]-th step. There are at most [`Kymograph::MAX_ROWS`] rows of time: when they are
/// full, they are added up in pairs, so that memory does not grow with the run. All values are integers,
/// counted over all ranks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kymograph {
    /// Number of blocks in contact in every bin.
    in_contact: Vec<i64>,
    /// Number of instants at which blocks were counted.
    samples: u64,
    /// Number of instants in each row; the last row may have fewer.
    samples_per_row: u64,
    /// Sliding blocks, summed over the instants of each row: row after row, bin after bin.
    sliding: Vec<i64>,
}

impl Default for Kymograph {
    fn default() -> Self {
        Self {
            in_contact: Vec::new(),
            samples: 0,
            samples_per_row: 1,
            sliding: Vec::new(),
        }
    }
}

impl Kymograph {
    /// Largest number of rows.
    pub const MAX_ROWS: usize = 1024;
    /// Number of steps from one count to the next: few enough to resolve a front that takes some t*, and so
    /// many that counting does not slow down a run.
    pub const INTERVAL: u64 = 8;

    /// Largest number of counts of a run of `last_step` steps: rows of time times bins of position, for any
    /// direction of the drive.
    pub fn max_counts(lattice: &Lattice, last_step: u64) -> usize {
        let samples = last_step / Self::INTERVAL + 1;
        let rows = samples.min(Self::MAX_ROWS as u64) as usize;
        rows * (lattice.nx + lattice.ny).min(PositionBins::MAX)
    }

    /// The observer with its schedule.
    pub fn scheduled(&mut self) -> Scheduled<'_> {
        Scheduled::new(Schedule::EveryStep(Self::INTERVAL), self)
    }

    /// Number of blocks in contact in every bin.
    pub fn in_contact(&self) -> &[i64] {
        &self.in_contact
    }

    /// The rows, each with the middle of its instants, as a number of steps, and the share of the blocks in
    /// contact that slide, for every bin; NaN for a bin without contact.
    pub fn rows(&self) -> impl Iterator<Item = (f64, Vec<f32>)> {
        let rows = self.sliding.chunks(self.in_contact.len().max(1));
        rows.zip(0..).map(|(sliding, row)| {
            let (first, count) = self.samples_of(row);
            let middle = (first as f64 + 0.5 * (count - 1) as f64) * Self::INTERVAL as f64;
            let shares = sliding.iter().zip(&self.in_contact);
            let share = |(sliding, blocks): (&i64, &i64)| *sliding as f64 / (*blocks as f64 * count as f64);
            (middle, shares.map(|counts| share(counts) as f32).collect())
        })
    }

    /// The first instant of a row, and the number of its instants.
    fn samples_of(&self, row: u64) -> (u64, u64) {
        let first = row * self.samples_per_row;
        (first, self.samples_per_row.min(self.samples - first))
    }

    /// Whether the recording can belong to a run of this model up to `step`.
    pub fn is_consistent_with(&self, model: &Model, step: u64) -> bool {
        let samples = step / Self::INTERVAL + 1;
        let mut samples_per_row = 1;
        while samples.div_ceil(samples_per_row) > Self::MAX_ROWS as u64 {
            samples_per_row *= 2;
        }
        let bins = PositionBins::new(&model.lattice, &model.drive).count;
        let rows = samples.div_ceil(samples_per_row);
        let has_lengths = (self.samples, self.samples_per_row) == (samples, samples_per_row)
            && self.in_contact.len() == bins
            && self.sliding.len() as u64 == rows * bins as u64;
        let most = model.lattice.n_blocks() as i64;
        has_lengths
            && self.in_contact.iter().all(|blocks| (0..=most).contains(blocks))
            && self.sliding.chunks(bins).zip(0..).all(|(sliding, row)| {
                let (_, count) = self.samples_of(row);
                let mut blocks = sliding.iter().zip(&self.in_contact);
                blocks.all(|(sliding, blocks)| (0..=blocks * count as i64).contains(sliding))
            })
    }

    /// Adds up the rows in pairs.
    fn merge_rows(&mut self) {
        let bins = self.in_contact.len();
        for row in 0..Self::MAX_ROWS / 2 {
            for bin in 0..bins {
                let [one, other] = [2 * row, 2 * row + 1].map(|row| self.sliding[row * bins + bin]);
                self.sliding[row * bins + bin] = one + other;
            }
        }
        self.sliding.truncate(Self::MAX_ROWS / 2 * bins);
        self.samples_per_row *= 2;
    }
}

impl Observer for Kymograph {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let bins = PositionBins::new(&now.model.lattice, &now.model.drive);
        if self.samples == 0 {
            self.in_contact = blocks_in_contact(now, &bins);
        }
        if self.samples == Self::MAX_ROWS as u64 * self.samples_per_row {
            self.merge_rows();
        }
        if self.samples.is_multiple_of(self.samples_per_row) {
            self.sliding.resize(self.sliding.len() + bins.count, 0);
        }
        self.samples += 1;
        let row = self.sliding.len() - bins.count;
        let sliding = now.totals.n_slipping as i64;
        let stuck = self.in_contact.iter().sum::<i64>() - sliding;
        // Counts sliding or stuck blocks, whichever are fewer.
        let mut counts = vec![0; bins.count];
        if sliding.min(stuck) > 0 {
            now.engine
                .count_in_contact(now.model, &bins, sliding <= stuck, &mut counts);
            now.communicator.sum(&mut counts);
        }
        for ((total, counted), blocks) in self.sliding[row..].iter_mut().zip(counts).zip(&self.in_contact) {
            *total += if sliding <= stuck {
                counted
            } else {
                blocks - counted
            };
        }
        Ok(())
    }
}

fn blocks_in_contact(now: &Snapshot, bins: &PositionBins) -> Vec<i64> {
    let mut counts = vec![0; bins.count];
    for (b, textured) in (now.model.first_block()..).zip(&now.model.surface.textured) {
        let (i, j) = now.model.lattice.column_row(b);
        counts[bins.bin(i, j)] += i64::from(!textured);
    }
    now.communicator.sum(&mut counts);
    counts
}
