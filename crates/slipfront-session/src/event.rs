//! Messages of work beside a session, and the worker who does such work.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::protocol::{Estimate, RepeatedReply};

/// Whoever does work beside a session: it passes on what the work tells, and tells it the time and whether it shall stop.
pub trait Worker {
    /// Passes on what the work tells.
    fn tell(&self, event: Event);

    /// Whether the work shall stop: nobody listens to it any more.
    fn stop(&self) -> &AtomicBool;

    /// The time since some instant.
    fn now(&self) -> Duration;
}

/// Message of work beside a session. It can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Event(pub(crate) EventKind);

impl Event {
    /// Tells that the work has ended by a defect of its own.
    pub fn lost() -> Self {
        Self(EventKind::Lost)
    }
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum EventKind {
    /// Static friction over the seeds up to now.
    Repeated(RepeatedReply),
    /// Why static friction over seeds cannot be found.
    NotRepeated(String),
    /// How far a search is.
    Tried(Tried),
    /// The best texture of a search, or why there is none.
    Searched(Result<Mask, String>),
    /// The best texture beside what is painted, or why they cannot be compared.
    Compared(Result<Comparison, String>),
    /// The work has ended by a defect of its own.
    Lost,
}

/// Textured blocks. They are sent as a text of a digit for each block.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub(crate) struct Mask(pub(crate) Arc<Vec<bool>>);

impl Deref for Mask {
    type Target = [bool];

    fn deref(&self) -> &[bool] {
        &self.0
    }
}

impl From<String> for Mask {
    fn from(digits: String) -> Self {
        Self(Arc::new(digits.bytes().map(|digit| digit == b'1').collect()))
    }
}

impl From<Mask> for String {
    fn from(mask: Mask) -> Self {
        let digit = |textured: &bool| if *textured { '1' } else { '0' };
        mask.iter().map(digit).collect()
    }
}

/// How far a search is.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Tried {
    /// Textures that were tried.
    pub(crate) textures: usize,
    /// Change of static friction by the best of them, %.
    pub(crate) best_percent: Option<f64>,
    /// Textured blocks of the best of them.
    pub(crate) best_texture: Option<Mask>,
}

/// Static friction of the texture that a search has found and of the painted one, on surfaces that the search has not seen.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Comparison {
    /// Number of the surfaces.
    pub(crate) surfaces: usize,
    /// Change of static friction against the slider without texture, %.
    pub(crate) best: Option<Estimate>,
    /// Change of static friction by the painted texture, %; none where nothing is painted.
    pub(crate) painted: Option<Estimate>,
    /// Whether what was found is better than what is painted, by more than the scatter over surfaces.
    pub(crate) is_better: bool,
}
