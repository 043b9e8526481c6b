//! Jobs outside a session: computations that its host may run anywhere.

use serde::{Deserialize, Serialize};

use crate::controls::TwoValues;
use crate::document::Document;
use crate::event::{MadeRun, Mask};
use crate::protocol::{CalibrateRequest, DrawingFormat, RecordFile};

/// A computation outside a session. It reports its results as events, and can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Job {
    pub(crate) document: Document,
    pub(crate) kind: JobKind,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum JobKind {
    /// Computes static friction with each of these seeds.
    Repeat(Vec<u64>),
    /// Searches for a texture with less static friction than the painted one.
    Search,
    /// Compares the best texture of a search with the painted one.
    Compare(Mask),
    /// Computes static friction at two values of the quantity of a slider.
    Sensitivity(TwoValues),
    /// Reads the record in a file.
    ReadRecord(RecordFile),
    /// Calibrates the case.
    Calibrate {
        request: Box<CalibrateRequest>,
        /// Runs that it needs and that other jobs have made, each with its curves.
        made: Vec<MadeRun>,
        /// Whether other jobs make the runs, instead of the threads of this one.
        is_elsewhere: bool,
    },
    /// Makes runs of a calibration, which it has listed as JSON.
    MakeRuns {
        request: Box<CalibrateRequest>,
        wanted: Vec<String>,
    },
    /// Draws the texture.
    Draw(DrawingFormat),
}

impl Job {
    pub(crate) fn new(document: Document, kind: JobKind) -> Self {
        Self { document, kind }
    }
}
