//! Events that a job reports to its session, and the worker that runs the job.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::protocol::{CalibratingReply, FoundReply};

/// Static friction mu_s* with one seed: with the texture and, if there is one, without it; none for a run
/// without a transition.
pub(crate) type Frictions = Vec<Option<f64>>;

/// The worker of a job: it passes events on to the session, and gives the job the time and the request to
/// stop.
pub trait Worker {
    /// Passes an event of the job on to the session.
    fn send(&self, event: Event);

    /// Whether the job is to stop, because nobody receives its events any more.
    fn stop(&self) -> &AtomicBool;

    /// The time since a fixed instant.
    fn now(&self) -> Duration;
}

/// A report of a job to its session, which can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Event(pub(crate) EventKind);

impl Event {
    /// The event that the job has crashed.
    pub fn lost() -> Self {
        Self(EventKind::Lost)
    }
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum EventKind {
    /// Static friction with the next seed, or why it cannot be found.
    Repeated(Result<Frictions, String>),
    /// Progress of a search.
    Tried(SearchUpdate),
    /// The best texture of a search, or why there is none.
    Searched(Result<Mask, String>),
    /// The comparison of the best texture of a search with the painted one, without the number of textures
    /// that were tried, or why they cannot be compared.
    Compared(Result<FoundReply, String>),
    /// A reply to the page, as JSON, with which the work ends.
    Replied(String),
    /// Progress of a calibration.
    Calibrating(CalibratingReply),
    /// Runs that a calibration needs before it can continue, each as JSON that only the calibration reads.
    Wants(Vec<String>),
    /// The curves of the next run that a calibration wanted, as JSON, or why they cannot be computed.
    Made(Result<String, String>),
    /// The results of a calibration in the form for the page, or why there are none.
    Calibrated(Result<Value, String>),
    /// The job has crashed.
    Lost,
}

/// A run that a calibration wanted, and its curves, each as JSON that only the calibration reads.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct MadeRun {
    pub(crate) wanted: String,
    pub(crate) curves: String,
}

/// Textured blocks. They are sent as a text with one digit per block.
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

/// Progress of a search.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct SearchUpdate {
    /// Number of textures tried.
    pub(crate) textures: usize,
    /// Change of static friction by the best texture tried, relative to the slider without texture, %.
    pub(crate) best_percent: Option<f64>,
    /// Textured blocks of the best texture tried.
    pub(crate) best_texture: Option<Mask>,
}
