//! Jobs beside a session: computations that its host runs wherever it can.

use serde::{Deserialize, Serialize};

use crate::controls::TwoValues;
use crate::document::Document;
use crate::event::{MadeRun, Mask, WantedRun};
use crate::protocol::{CalibrateRequest, DrawingFormat, RecordFile};

/// A computation beside a session. It reports what it finds by events, and can be sent as JSON.
#[derive(Debug, Serialize, Deserialize)]
pub struct Job {
    pub(crate) document: Document,
    pub(crate) kind: JobKind,
}

#[derive(Debug, Serialize, Deserialize)]
pub(crate) enum JobKind {
    /// A computation of static friction with each of these seeds.
    Repeat(Vec<u64>),
    /// A search for a texture with less static friction than the painted one.
    Search,
    /// A comparison of the best texture of a search with the painted one.
    Compare(Mask),
    /// A computation of static friction with two values of the quantity of a slider.
    Sensitivity(TwoValues),
    /// The record in a file.
    ReadRecord(RecordFile),
    /// A calibration of the case.
    Calibrate {
        request: Box<CalibrateRequest>,
        /// Runs that it needs and that have been made, each with its curves.
        made: Vec<MadeRun>,
        /// Whether the runs are made by other jobs, or by the threads of this one.
        is_elsewhere: bool,
    },
    /// Runs of a calibration.
    MakeRuns {
        request: Box<CalibrateRequest>,
        wanted: Vec<WantedRun>,
    },
    /// The texture as a drawing.
    Draw(DrawingFormat),
}

impl Job {
    pub(crate) fn new(document: Document, kind: JobKind) -> Self {
        Self { document, kind }
    }
}
