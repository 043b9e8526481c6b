//! Events by which work beside a session reports to it, and the worker that does such work.

use std::ops::Deref;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::protocol::{CalibratingReply, Estimate};

/// Static friction mu_s* with one seed: of the case and, if it has texture, of the case without; none of a
/// run without a transition.
pub(crate) type Frictions = Vec<Option<f64>>;

/// Whoever does work beside a session: it passes on what the work tells, and tells it the time and whether it
/// shall stop.
pub trait Worker {
    /// Passes an event of the work on to the session.
    fn tell(&self, event: Event);

    /// Whether the work shall stop: nobody listens to it any more.
    fn stop(&self) -> &AtomicBool;

    /// The time since some instant.
    fn now(&self) -> Duration;
}

/// A report of work beside a session to the session, which can be sent as JSON.
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
    /// Static friction with the next of the seeds, or why it cannot be found.
    Repeated(Result<Frictions, String>),
    /// How far a search is.
    Tried(Tried),
    /// The best texture of a search, or why there is none.
    Searched(Result<Mask, String>),
    /// The comparison of the best texture of a search with the painted one, or why they cannot be compared.
    Compared(Result<Comparison, String>),
    /// A reply to the page, as JSON, with which the work ends.
    Replied(String),
    /// How far a calibration is.
    Calibrating(CalibratingReply),
    /// Runs that a calibration needs before it can go on.
    Wants(Vec<WantedRun>),
    /// The curves of the next of the runs that a calibration wanted, as JSON, or why they cannot be made.
    Made(Result<String, String>),
    /// The results of a calibration as the page is sent them, or why there are none.
    Calibrated(Result<Value, String>),
    /// The work has ended by a defect of its own.
    Lost,
}

/// A run that a calibration wants, as JSON that the calibration alone understands.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct WantedRun(pub(crate) String);

/// A run that a calibration wanted, with its curves as JSON.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct MadeRun {
    pub(crate) wanted: WantedRun,
    pub(crate) curves: String,
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
    /// Change of static friction by the best texture tried, against the slider without texture, %.
    pub(crate) best_percent: Option<f64>,
    /// Textured blocks of the best texture tried.
    pub(crate) best_texture: Option<Mask>,
}

/// Comparison of the best texture of a search with the painted one, on surfaces that the search has not seen.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Comparison {
    /// Number of surfaces on which the textures are compared.
    pub(crate) surfaces: usize,
    /// Change of static friction by the best texture of the search, against the slider without texture, %.
    pub(crate) best: Option<Estimate>,
    /// Change of static friction by the painted texture, against the slider without texture, %; none where
    /// nothing is painted.
    pub(crate) painted: Option<Estimate>,
    /// Whether the best texture of the search is better than the painted one, by more than the scatter over
    /// surfaces.
    pub(crate) is_better: bool,
}
