//! The schedule of a sweep: the work on every tile of a band. There is none if nothing moves in or around the
//! tile and none of its blocks may slip.

use std::sync::atomic::{AtomicU32, Ordering};

use super::band::{Band, TileTask};
use super::layout::{Layout, TILE, VECTORS};
use super::vector::LANES;

/// Largest number of vectors of a tile that are swept one by one: sweeping more of them costs more than
/// sweeping the whole tile.
const MAX_SPARSE_VECTORS: u32 = 14;

/// Largest number of touched vectors in a tile for which the tile settles: after this sweep its vectors are
/// swept one by one.
const MAX_SETTLING_VECTORS: u32 = 9;

/// Number of moving vectors in a tile above which everything around the tile is marked, not the surroundings
/// of each vector.
const MAX_MARKED_VECTORS: usize = 10;

/// Conditions common to all tiles in a sweep.
#[derive(Clone, Copy, Debug)]
pub struct SweepConditions {
    /// Number of the step.
    pub number: u64,
    /// Whether tiles at rest are skipped.
    pub skips: bool,
    /// Whether the sums that skipped tiles keep have become invalid.
    pub renews_sums: bool,
    /// Whether there was no sweep before.
    pub is_first: bool,
    /// Whether the latest sweep was made at the step before.
    pub is_next: bool,
}

impl Band {
    /// Marks all vectors that contain a moving element or a neighbour of one: one bit per vector for every
    /// tile of the rank.
    pub fn mark_touched(&self, layout: &Layout, touched: &[AtomicU32]) {
        let mark = |from: usize, to: usize| {
            layout.mark_around((self.first + from) as isize, (self.first + to) as isize, touched);
        };
        // Bands mark tiles of each other at the same time. They only set bits, in any order, and no band
        // reads them before all have finished marking.
        for t in (0..self.tiles.len()).filter(|&t| self.tiles[t].moving) {
            let moving = self.vectors(t).filter(|&v| self.moving[v] != 0);
            if moving.clone().count() > MAX_MARKED_VECTORS {
                let elements = self.elements(t);
                mark(elements.start, elements.end - 1);
                continue;
            }
            for v in moving {
                let (first, last) = (
                    self.moving[v].trailing_zeros(),
                    7 - self.moving[v].leading_zeros(),
                );
                mark(v * LANES + first as usize, v * LANES + last as usize);
            }
        }
    }

    /// Decides the work on every tile, and clears the marks.
    pub fn schedule(&mut self, sweep: &SweepConditions, touched: &[AtomicU32]) {
        for t in 0..self.tiles.len() {
            let all = u32::MAX >> (VECTORS - self.vectors(t).len());
            let (tile, before) = (self.tiles[t], self.tasks[t].active);
            let mut task = TileTask {
                active: all,
                touched: touched[self.first_tile + t].swap(0, Ordering::Relaxed) & all,
                ..TileTask::default()
            };
            // Differences along springs change on both sides of a moving block, also in a tile in which all
            // blocks rest.
            if task.touched != 0 {
                self.tiles[t].displacements_are_old = true;
            }
            if sweep.skips && !sweep.renews_sums && tile.settled {
                task.active = task.touched;
                if tile.active_from_step <= sweep.number {
                    task.active |= self.vectors_that_may_slip(t, sweep.number);
                }
                // True also if no vector is active: then the tile is skipped.
                task.sparse = task.active.count_ones() <= MAX_SPARSE_VECTORS;
            }
            if !task.sparse {
                task.active = all;
                task.settles = sweep.skips && task.touched.count_ones() <= MAX_SETTLING_VECTORS;
            }
            // The stress of vectors skipped at the step before is checked for that step. If that whole sweep
            // was skipped, all vectors were.
            task.was_skipped = match (sweep.is_first, sweep.is_next) {
                (true, _) => 0,
                (_, true) => task.active & !before,
                _ => task.active,
            };
            self.tasks[t] = task;
        }
        // After all tasks are known: a whole tile also needs the springs that lead up to it, from tiles
        // before it that may be skipped. A sparse tile computes all of its springs itself.
        for t in 0..self.tiles.len() {
            if self.tasks[t].sparse {
                continue;
            }
            self.tasks[t].needs_springs = true;
            let elements = self.elements(t);
            // Springs from before the band are computed in any case.
            if let Some(last) = elements.end.checked_sub(self.stride) {
                let first = elements.start.saturating_sub(self.stride + 1);
                for below in &mut self.tasks[first / TILE..=last / TILE] {
                    below.needs_springs = true;
                }
            }
        }
    }

    /// The first tile after `t` that will be swept as a whole.
    pub fn next_whole_tile(&self, t: usize) -> Option<usize> {
        let later = self.tasks.get(t + 1..)?.iter();
        later.clone().position(|task| !task.sparse).map(|n| t + 1 + n)
    }
}
