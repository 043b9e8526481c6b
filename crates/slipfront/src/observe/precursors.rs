//! Slip events of a slider that is driven at an edge: precursors, which stop within the slider, and events
//! that cross it.

use serde::{Deserialize, Serialize};

use super::observer::Observer;
use crate::error::RunError;
use crate::kernel::block::Field;
use crate::lattice::Edge;
use crate::snapshot::Snapshot;

/// An event: consecutive steps in which some block in contact slides.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SlipEvent {
    /// t* at which the event begins.
    pub from_star: f64,
    /// Largest distance from the driven edge at which a block in contact has slid, over the length of the
    /// slider.
    pub length: f64,
    /// mu* at the beginning of the event.
    pub mu_star_before: f64,
    /// t* at which all blocks in contact are stuck again, and mu* then; none for an event that has not ended.
    pub after: Option<(f64, f64)>,
}

/// All events of a run. The observer must be called at every step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Precursors {
    edge: Edge,
    events: Vec<SlipEvent>,
}

impl Precursors {
    /// The recording of a slider that is driven at `edge`, with no event yet.
    pub fn new(edge: Edge) -> Self {
        Self {
            edge,
            events: Vec::new(),
        }
    }

    /// The events in order of time; the last may not have ended.
    pub fn events(&self) -> &[SlipEvent] {
        &self.events
    }

    /// The first event that crosses the whole slider.
    pub fn crossing(&self) -> Option<&SlipEvent> {
        self.events.iter().find(|event| event.length >= 1.0)
    }

    /// Whether the recording can have begun as `new` and been called up to `time_star`.
    pub fn is_consistent_with(&self, new: &Self, time_star: f64) -> bool {
        let ended = self
            .events
            .split_last()
            .is_none_or(|(_, earlier)| earlier.iter().all(|event| event.after.is_some()));
        let times = self
            .events
            .iter()
            .flat_map(|event| [Some(event.from_star), event.after.map(|(time, _)| time)]);
        let is_rising = times.flatten().chain([time_star]).is_sorted();
        self.edge == new.edge && ended && is_rising
    }

    /// Distance from the edge up to which blocks in contact slide from this instant on, over the length of
    /// the slider.
    fn length(&self, now: &Snapshot) -> f64 {
        let (lattice, edge) = (&now.model.lattice, self.edge);
        let first = now.model.first_block();
        let mut reached = 0;
        now.read_rows(Field::Sliding, 1, |j, i, part| {
            let row = j * lattice.nx + i;
            for (k, _) in part.iter().enumerate().filter(|(_, slides)| **slides > 0.0) {
                if !now.model.surface.textured[row + k] {
                    reached = reached.max(edge.distance(lattice, first + row + k) + 1);
                }
            }
        });
        now.communicator
            .largest_of(reached as f64 / edge.n_across(lattice) as f64)
    }
}

impl Observer for Precursors {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let mu_star = now.point.mu_star;
        let slides = now.totals.n_slipping > 0;
        let goes_on = self.events.last().is_some_and(|event| event.after.is_none());
        if slides && !goes_on {
            self.events.push(SlipEvent {
                from_star: now.time_star,
                length: 0.0,
                mu_star_before: mu_star,
                after: None,
            });
        }
        // Blocks are not read once slip has reached the whole slider.
        let length = match self.events.last() {
            Some(event) if slides && event.length < 1.0 => self.length(now),
            _ => 0.0,
        };
        if let Some(event) = self.events.last_mut() {
            event.length = event.length.max(length);
            if !slides && goes_on {
                event.after = Some((now.time_star, mu_star));
            }
        }
        Ok(())
    }
}
