//! Events of slip: when and where each begins, how many blocks slide in it, and how far.

use serde::{Deserialize, Serialize};

use slipfront_kernel::fixed_point::sum_over;
use slipfront_kernel::reductions;

use super::observer::Observer;
use crate::error::RunError;
use crate::model::Model;
use crate::snapshot::Snapshot;
use crate::vector_field::dot;

/// An event: consecutive steps in which some block in contact slides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Event {
    /// t* at which the event begins.
    pub from_star: f64,
    /// t* of the drive at which the event begins.
    pub drive_from_star: f64,
    /// Column and row of the block in contact that slides first; if there are several, the one with the least
    /// index.
    pub nucleation: [u32; 2],
    /// Number of blocks in contact that slide in the event.
    pub blocks: usize,
    /// Sum over these blocks of the slip along the drive, in units of displacement: from the instant at which
    /// the block first slides in the event to the end of the event.
    pub moment: f64,
    /// Largest speed of a block in contact that slides.
    pub speed_max: f64,
    /// mu* at the beginning of the event.
    pub mu_star_before: f64,
    /// t* at which no block in contact slides any more, and mu* then; none for an event that has not ended.
    pub after: Option<(f64, f64)>,
}

/// The events of a run, listing the first [`Events::MAX`] of them. The observer must be called at every step.
/// It reads blocks only while one slides.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Events {
    /// Number of blocks in contact, of all ranks.
    n_contact: usize,
    events: Vec<Event>,
    unlisted: u64,
    /// Whether a block in contact slides from the latest instant on.
    slides: bool,
    /// Displacement along the drive of every block of this rank when it first slid in the present event; NaN
    /// for other blocks. Empty before the first event.
    #[serde(skip)]
    paths_before: Vec<f64>,
    /// Number of blocks in contact of this rank that have not slid in the present event.
    #[serde(skip)]
    n_stuck: usize,
}

impl Events {
    /// Largest number of events that are listed.
    pub const MAX: usize = 1_000_000;

    /// The recording of a run of this model, with no event yet.
    pub fn new(model: &Model) -> Self {
        Self {
            n_contact: model.surface.n_contact(),
            events: Vec::new(),
            unlisted: 0,
            slides: false,
            paths_before: Vec::new(),
            n_stuck: 0,
        }
    }

    /// The events in order of time; the last may not have ended.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Number of listed events in which all blocks in contact slide.
    pub fn n_whole(&self) -> usize {
        let is_whole = |event: &&Event| event.blocks == self.n_contact;
        self.events.iter().filter(is_whole).count()
    }

    /// Number of events after the last listed one.
    pub fn unlisted(&self) -> u64 {
        self.unlisted
    }

    /// Displacement along the drive of every block of this rank when it first slid in the present event, NaN
    /// for other blocks; none between events. A checkpoint keeps them in addition to the serialised fields.
    pub fn paths_before(&self) -> Option<&[f64]> {
        self.goes_on().then_some(&self.paths_before)
    }

    /// Whether a listed event has not ended.
    pub fn goes_on(&self) -> bool {
        self.slides && self.unlisted == 0
    }

    /// Continues within an event, with the [paths](Self::paths_before) of a checkpoint.
    pub fn resume(&mut self, model: &Model, paths_before: Vec<f64>) {
        let blocks = paths_before.iter().zip(&model.surface.textured);
        self.n_stuck = blocks
            .filter(|(path, textured)| path.is_nan() && !**textured)
            .count();
        self.paths_before = paths_before;
    }

    /// Whether the recording can have begun as `new` and been called up to `time_star`.
    pub fn is_consistent_with(&self, new: &Self, time_star: f64) -> bool {
        let times = self
            .events
            .iter()
            .flat_map(|event| [Some(event.from_star), event.after.map(|(time, _)| time)]);
        let is_rising = times.flatten().chain([time_star]).is_sorted();
        let last_goes_on = self.events.last().is_some_and(|event| event.after.is_none());
        let n_going_on = self.events.iter().filter(|event| event.after.is_none()).count();
        let has_lengths =
            self.events.len() <= Self::MAX && (self.unlisted == 0 || self.events.len() == Self::MAX);
        self.n_contact == new.n_contact
            && is_rising
            && self.events.iter().all(|event| event.blocks <= self.n_contact)
            && last_goes_on == self.goes_on()
            && n_going_on == usize::from(last_goes_on)
            && has_lengths
    }

    /// Begins a listed event.
    fn begin(&mut self, now: &Snapshot) {
        let mut paths = std::mem::take(&mut self.paths_before);
        paths.clear();
        paths.resize(now.model.surface.n_blocks(), f64::NAN);
        self.resume(now.model, paths);
        self.events.push(Event {
            from_star: now.time_star,
            drive_from_star: now.drive_time_star,
            nucleation: [0; 2],
            blocks: 0,
            moment: 0.0,
            speed_max: 0.0,
            mu_star_before: now.point.mu_star,
            after: None,
        });
        let first = self.follow(now);
        let first = first.map_or(f64::INFINITY, |b| (now.model.first_block() + b) as f64);
        let first = now.communicator.least_of(first);
        let (i, j) = now.model.lattice.column_row(first as usize);
        if let Some(event) = self.events.last_mut() {
            event.nucleation = [i, j].map(|index| index as u32);
        }
    }

    /// Reads the blocks that slide in an event. Returns the first block of this rank that slides in it for
    /// the first time.
    fn follow(&mut self, now: &Snapshot) -> Option<usize> {
        let event = self.events.last_mut()?;
        // Blocks are not read if all have slid and none can exceed the largest speed so far.
        let bound = now
            .engine
            .motion_bounds()
            .map_or(f64::INFINITY, |bounds| bounds.speed);
        let may_be_faster = bound > event.speed_max;
        let (paths, n_stuck) = (&mut self.paths_before, &mut self.n_stuck);
        let (mut square, mut first) = (0.0, None);
        // The motion of an upright sheet along y is not slip.
        let across = f64::from(u8::from(now.model.friction.interface().is_none()));
        if may_be_faster || *n_stuck > 0 {
            now.engine.read_sliding(now.model, &mut |start, slides, [x, y]| {
                let n = slides.len();
                let textured = &now.model.surface.textured[start..][..n];
                let (x, y) = (&x[..n], &y[..n]);
                let slips = |k: usize| slides[k] & !textured[k];
                let of_block = |k: usize| {
                    if slips(k) {
                        x[k] * x[k] + across * (y[k] * y[k])
                    } else {
                        0.0
                    }
                };
                square = reductions::largest(n, of_block).max(square);
                if *n_stuck == 0 {
                    return;
                }
                for (k, path) in paths[start..][..n].iter_mut().enumerate() {
                    if slips(k) & path.is_nan() {
                        *path = path_of(now, start + k);
                        *n_stuck -= 1;
                        first = first.or(Some(start + k));
                    }
                }
            });
        }
        if may_be_faster {
            let speed = now.communicator.largest_of(square.sqrt());
            event.speed_max = event.speed_max.max(speed);
        }
        first
    }

    /// Adds up the slip of the blocks in an event that ends here, or that has not ended at the end of the
    /// run.
    fn end(&mut self, now: &Snapshot) {
        let paths = &self.paths_before;
        let slip = |b: usize| {
            if paths[b].is_nan() {
                0.0
            } else {
                path_of(now, b) - paths[b]
            }
        };
        let moment = sum_over(now.communicator, paths.len(), slip);
        let blocks = now
            .communicator
            .sum_of(paths.iter().filter(|path| !path.is_nan()).count());
        if let Some(event) = self.events.last_mut() {
            (event.moment, event.blocks) = (moment, blocks);
            event.after = (!self.slides).then_some((now.time_star, now.point.mu_star));
        }
    }
}

/// Displacement along the drive of block `b` of this rank.
fn path_of(now: &Snapshot, b: usize) -> f64 {
    let direction = now
        .model
        .drive
        .direction_at(&now.model.lattice, now.model.first_block() + b);
    dot(now.engine.motion(b)[0], direction)
}

impl Observer for Events {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let goes_on = self.goes_on();
        let begins = now.totals.n_slipping > 0 && !self.slides;
        self.slides = now.totals.n_slipping > 0;
        if begins && self.events.len() == Self::MAX {
            self.unlisted += 1;
        } else if begins {
            self.begin(now);
        } else if goes_on && self.slides {
            self.follow(now);
        }
        let is_last = now.last && self.goes_on();
        if goes_on && !self.slides || is_last {
            self.end(now);
        }
        Ok(())
    }
}
