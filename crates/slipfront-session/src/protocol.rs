//! Messages between the page and a session: requests as JSON, replies as JSON, pictures as bytes.
//!
//! The page is written with the types of `types/protocol.d.ts`. Samples of all messages ensure that they
//! agree with the types of this module.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
#[cfg(feature = "work")]
use slipfront_run::measured::{Measure, TableColumn};
use slipfront_study::Sample;

use crate::controls::{Control, ControlValue};
use crate::shapes::ShapeOutlines;
use crate::view::ViewChange;

/// Longest message of the page, in bytes: an image of the texture.
pub const MAX_MESSAGE: usize = 8 << 20;

/// Largest number of values of a request, including those in lists and tables: a value takes some 30 times
/// the memory of its text.
const MAX_VALUES: usize = 20_000;

/// A message of the page, which holds one request.
#[derive(Debug)]
pub struct Message(pub(crate) Request);

impl Message {
    /// Parses a message, which is JSON.
    ///
    /// # Errors
    /// A sentence, if it is not a request, or has too many values.
    pub fn parse(text: &str) -> Result<Self, String> {
        if most_values(text) > MAX_VALUES {
            return Err(format!("not a request: it has more than {MAX_VALUES} values"));
        }
        let request = serde_json::from_str(text);
        request
            .map(Self)
            .map_err(|error| format!("not a request: {error}"))
    }
}

/// Upper bound of the number of values in a JSON text: every value except the first follows a comma or an
/// opening bracket.
fn most_values(text: &str) -> usize {
    let (mut is_quoted, mut is_escaped, mut values) = (false, false, 1);
    for byte in text.bytes() {
        match byte {
            _ if is_escaped => is_escaped = false,
            b'\\' => is_escaped = is_quoted,
            b'"' => is_quoted = !is_quoted,
            b',' | b'[' | b'{' if !is_quoted => values += 1,
            _ => {}
        }
    }
    values
}

/// A request of the page.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub(crate) enum Request {
    /// Opens another case, from rest.
    Open { source: Source },
    /// Sets keys of the case to values as in TOML; null removes a key.
    Set { keys: Map<String, Value>, gesture: u64 },
    /// Makes blocks within a radius of a line through points texture, or contact. Lengths are in blocks.
    Paint {
        points: Vec<[f64; 2]>,
        radius: f64,
        textured: bool,
        gesture: u64,
    },
    /// Replaces the texture by the parts of a PNG image, in Base64, that are darker than a threshold.
    Image {
        png: String,
        threshold: f64,
        gesture: u64,
    },
    /// Returns to the case before the last gesture.
    Undo,
    /// Returns to the case before the last undo.
    Redo,
    /// Runs the present case again, from rest.
    Rest,
    /// Changes what is shown of the run, and its pace.
    View(ViewChange),
    /// Takes some steps of a paused run.
    Step { count: u64 },
    /// Computes static friction over several seeds; 0 stops the computation.
    Repeat { seeds: u64 },
    /// Searches for a texture with less static friction than that of the present case.
    Find { gesture: u64 },
    /// Ends the search for a texture; the best texture so far counts.
    FindStop,
    /// Runs the present case from rest, and saves the run in a folder of this name.
    Save { name: String },
    /// Stops saving the run of this name.
    SaveStop { name: String },
    /// Asks for the case as files.
    Export,
    /// Shows a recorded snapshot in place of the live field, or the live field again.
    FramesOf { index: Option<usize> },
    /// Reads a measured record.
    ReadRecord { record: RecordFile },
    /// Estimates unknown keys of the case from a record.
    Calibrate(Box<CalibrateRequest>),
    /// Ends the calibration under way.
    CalibrateStop,
    /// Asks for the change of static friction with the quantity of a slider.
    Sensitivity { control: String },
    /// Asks for the texture as a drawing.
    Drawing { format: DrawingFormat },
}

impl Request {
    /// The name of the request in messages.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Self::Open { .. } => "open",
            Self::Set { .. } => "set",
            Self::Paint { .. } => "paint",
            Self::Image { .. } => "image",
            Self::Undo => "undo",
            Self::Redo => "redo",
            Self::Rest => "rest",
            Self::View(_) => "view",
            Self::Step { .. } => "step",
            Self::Repeat { .. } => "repeat",
            Self::Find { .. } => "find",
            Self::FindStop => "find_stop",
            Self::Save { .. } => "save",
            Self::SaveStop { .. } => "save_stop",
            Self::Export => "export",
            Self::FramesOf { .. } => "frames_of",
            Self::ReadRecord { .. } => "read_record",
            Self::Calibrate(_) => "calibrate",
            Self::CalibrateStop => "calibrate_stop",
            Self::Sensitivity { .. } => "sensitivity",
            Self::Drawing { .. } => "drawing",
        }
    }
}

/// The file of a measured record, and the columns of its table.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct RecordFile {
    pub(crate) name: String,
    /// The file, in Base64.
    pub(crate) bytes: String,
    /// Names of the columns, or their numbers from 1; chosen by their units where they are missing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) x: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) y: Option<String>,
    /// Units of the columns, where the table has none or other ones are meant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) x_unit: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) y_unit: Option<String>,
}

/// A calibration that the page asks for.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CalibrateRequest {
    pub(crate) record: RecordFile,
    /// Added to times or displacements, s or m.
    pub(crate) shift: f64,
    /// The part that is compared, after the shift, s or m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) from: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) to: Option<f64>,
    /// Standard deviation of the noise, as a share of the mean friction.
    pub(crate) noise: f64,
    /// Number of training runs.
    pub(crate) runs: u32,
    /// Ranges of the unknown keys, as calibration files have them.
    pub(crate) unknowns: Map<String, Value>,
}

/// Format of a drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum DrawingFormat {
    Dxf,
    Svg,
}

/// Where a case is taken from: if nothing is given, the case with which the laboratory was started.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Source {
    pub(crate) preset: Option<String>,
    pub(crate) folder: Option<String>,
    /// A case as text, and its name.
    pub(crate) toml: Option<String>,
    pub(crate) name: Option<String>,
    /// Files that the TOML names, in Base64.
    #[serde(default)]
    pub(crate) files: BTreeMap<String, String>,
    /// Files of the folder of a recorded run, in Base64.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) run: Option<BTreeMap<String, String>>,
}

/// A reply or report of a session to the page.
#[derive(Debug, Serialize)]
#[serde(tag = "is", rename_all = "snake_case")]
pub(crate) enum Reply<'a> {
    Hello {
        version: &'static str,
        presets: &'a [PresetEntry<'a>],
        folders: &'a [String],
        results: Option<&'a str>,
        max_blocks: usize,
        controls: &'static [Control],
    },
    Case(Box<CaseReply<'a>>),
    Curve(CurveReply<'a>),
    Numbers(Box<NumbersReply>),
    Probe(ProbeReply),
    Repeated(RepeatedReply),
    Finding(FindingReply),
    Found(FoundReply),
    /// All runs that are being saved, from whichever page.
    Saving {
        under_way: Vec<SavingEntry<'a>>,
    },
    Saved {
        name: &'a str,
        folder: &'a str,
        folders: &'a [String],
    },
    Exported {
        toml: &'a str,
        files: BTreeMap<&'a str, String>,
        zip: String,
    },
    /// Snapshots of the run folder that is shown.
    Recorded {
        times_star: Vec<f64>,
    },
    Calibrating(CalibratingReply),
    Calibrated(CalibratedReply),
    #[cfg(feature = "work")]
    Record(RecordReply),
    #[cfg(feature = "work")]
    Sensitivity(SensitivityReply),
    #[cfg(feature = "work")]
    Drawing(DrawingReply),
    /// A request was refused; nothing changed.
    Refused {
        of: &'static str,
        sentence: String,
    },
    /// The run has failed.
    Failed {
        sentence: String,
    },
}

impl Reply<'_> {
    /// The reply as JSON.
    pub(crate) fn json(&self) -> String {
        // Replies contain only texts and numbers; infinite numbers become null. Serialisation cannot fail.
        serde_json::to_string(self).expect("replies are JSON")
    }
}

/// A run that is being saved, and the share of it that is done.
#[derive(Debug, Serialize)]
pub(crate) struct SavingEntry<'a> {
    pub(crate) name: &'a str,
    pub(crate) share: f64,
}

/// A case to choose.
#[derive(Debug, Serialize)]
pub(crate) struct PresetEntry<'a> {
    pub(crate) name: &'a str,
    pub(crate) group: &'a str,
    pub(crate) picture: &'a str,
    /// Whether the case is the base of a study of many runs.
    pub(crate) is_study: bool,
    pub(crate) title: &'a str,
}

/// The case that is shown.
#[derive(Debug, Serialize)]
pub(crate) struct CaseReply<'a> {
    pub(crate) name: &'a str,
    pub(crate) toml: String,
    pub(crate) files: Vec<&'a str>,
    pub(crate) link_files_bytes: usize,
    pub(crate) blocks: [usize; 2],
    pub(crate) block_size_m: f64,
    pub(crate) n_blocks: usize,
    pub(crate) texture_percent: f64,
    pub(crate) texture: Value,
    pub(crate) shapes: Vec<ShapeOutlines>,
    pub(crate) values: BTreeMap<&'static str, ControlValue>,
    pub(crate) units: Units,
    pub(crate) dt_star: f64,
    pub(crate) duration_star: f64,
    pub(crate) kinetic_from_star: f64,
    /// Time t* of the blocks at which the onset is expected first, or that of the end of the run, if that
    /// comes before.
    pub(crate) onset_star: f64,
    /// Direction of the drive, degrees from x towards y; none if it turns the slider.
    pub(crate) drive_degrees: Option<f64>,
    /// Rise of mu* in one t* of the drive as long as no block slides; none of a drive that turns the slider.
    pub(crate) loading_rate: Option<f64>,
    pub(crate) steady_level: f64,
    pub(crate) can_undo: bool,
    pub(crate) can_redo: bool,
    pub(crate) leg: usize,
    pub(crate) why: &'static str,
    pub(crate) time_before_s: f64,
    pub(crate) twin: bool,
    pub(crate) has_memory: bool,
    /// Which length decides how much of an answer is the mesh.
    pub(crate) mesh: String,
    pub(crate) warnings: Vec<String>,
    /// The one of the warnings that blocks are too coarse for the outlines of the texture.
    pub(crate) too_coarse: Option<String>,
    /// Note on what other seeds change, if it is less than static friction.
    pub(crate) seeds: Option<&'static str>,
    pub(crate) search: SearchLimits,
}

/// Bounds of the textures that a search for a better one may try.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct SearchLimits {
    /// Smallest width of a feature and of a gap, in blocks.
    pub(crate) width_blocks: usize,
    /// Largest coverage: textured share of the slider, %.
    pub(crate) most_percent: f64,
}

/// Units of the dimensionless quantities.
#[derive(Debug, Serialize)]
pub(crate) struct Units {
    pub(crate) time_s: f64,
    pub(crate) displacement_m: f64,
    pub(crate) speed_m_s: f64,
    pub(crate) stress_pa: f64,
    /// Friction force where mu* is 1, N; none if the drive turns the slider.
    pub(crate) friction_n: Option<f64>,
    /// Friction coefficient mu where mu* is 1.
    pub(crate) friction_coefficient: f64,
}

/// New points of the curves.
#[derive(Debug, Default, Serialize)]
pub(crate) struct CurveReply<'a> {
    pub(crate) leg: usize,
    pub(crate) from_rest: bool,
    pub(crate) t: Vec<f64>,
    pub(crate) mu: Vec<f64>,
    pub(crate) sliding: Vec<f64>,
    pub(crate) twin_reset: bool,
    pub(crate) twin_t: Vec<f64>,
    pub(crate) twin_mu: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) recorded_t: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) recorded_mu: Option<&'a [f64]>,
}

/// The run at this instant.
#[derive(Debug, Serialize)]
pub(crate) struct NumbersReply {
    pub(crate) step: u64,
    pub(crate) t_star: f64,
    pub(crate) time_s: f64,
    pub(crate) mu_star: f64,
    pub(crate) sliding_percent: f64,
    pub(crate) peak: Option<PeakReply>,
    pub(crate) twin_peak: Option<PeakReply>,
    pub(crate) change_percent: Option<f64>,
    pub(crate) kinetic: Option<f64>,
    pub(crate) instants: BTreeMap<char, f64>,
    /// Whether every block in contact has slipped since rest.
    pub(crate) crossed: bool,
    pub(crate) steps_per_second: f64,
    pub(crate) ended: bool,
    pub(crate) summary: Option<Value>,
}

/// The first peak of mu*, which is certain once the fall after it has been seen.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct PeakReply {
    pub(crate) t_star: f64,
    pub(crate) mu_star: f64,
    pub(crate) certain: bool,
}

/// The block under the pointer.
#[derive(Debug, Default, Serialize)]
pub(crate) struct ProbeReply {
    pub(crate) block: [usize; 2],
    pub(crate) exists: bool,
    pub(crate) textured: bool,
    pub(crate) sliding: bool,
    pub(crate) mu_static: f64,
    pub(crate) mu_kinetic: f64,
    pub(crate) contact_stress_pa: f64,
    pub(crate) traction_pa: f64,
    pub(crate) displacement_m: f64,
    pub(crate) speed_m_s: f64,
    pub(crate) first_slip_star: Option<f64>,
}

/// Static friction over several seeds.
#[derive(Debug, PartialEq, Serialize)]
pub(crate) struct RepeatedReply {
    pub(crate) done: usize,
    pub(crate) of: u64,
    pub(crate) finished: bool,
    pub(crate) change_percent: Option<Estimate>,
    pub(crate) with: Option<Estimate>,
    pub(crate) without: Option<Estimate>,
    /// How many of the runs had no transition.
    pub(crate) without_transition: usize,
}

/// How far the search for a better texture is.
#[derive(Debug, Serialize)]
pub(crate) struct FindingReply {
    pub(crate) seconds: f64,
    pub(crate) of_seconds: f64,
    /// Textures that were tried.
    pub(crate) textures: usize,
    /// Whether the best texture is being compared with the painted one, on surfaces that the search has not
    /// seen.
    pub(crate) compares: bool,
    /// Change of static friction by the best texture so far against no texture, %, on the surfaces of the
    /// search.
    pub(crate) best_percent: Option<f64>,
    /// Strips of textured blocks of the best texture so far: the row, the first column and the column after
    /// the last.
    pub(crate) best_texture: Vec<[usize; 3]>,
}

/// The result of a search for a better texture.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct FoundReply {
    pub(crate) outcome: FoundOutcome,
    /// Textures that were tried.
    pub(crate) textures: usize,
    /// Number of surfaces, unseen by the search, on which the best texture and the painted one were compared.
    pub(crate) surfaces: usize,
    /// Change of static friction by the best texture of the search against no texture, %.
    pub(crate) best: Option<Estimate>,
    /// Change of static friction by the painted texture against no texture, %.
    pub(crate) painted: Option<Estimate>,
}

/// Fate of the painted texture after a search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum FoundOutcome {
    /// The best texture of the search has replaced the painted one.
    Replaced,
    /// The painted texture stays, since the search found no better one.
    Kept,
    /// The case was changed before the search had ended, so that the search was given up.
    GivenUp,
    /// The painted texture stays, since the search has failed; a refusal sent before says why.
    Failed,
}

/// A measured record.
#[cfg(feature = "work")]
#[derive(Debug, Serialize)]
pub(crate) struct RecordReply {
    pub(crate) name: String,
    pub(crate) columns: Vec<TableColumn>,
    /// The record; none if the table could not be read with these columns.
    pub(crate) curve: Option<RecordCurve>,
    /// Why there is no curve, which other columns or units may mend.
    pub(crate) problem: Option<String>,
    /// How the table was read, and what is doubtful about it.
    pub(crate) notes: Vec<String>,
}

/// Two columns of a table, in SI units.
#[cfg(feature = "work")]
#[derive(Debug, Serialize)]
pub(crate) struct RecordCurve {
    /// Places of the columns in the table, from 0.
    pub(crate) columns: [usize; 2],
    /// Quantity of the abscissae: time or displacement.
    pub(crate) along: Measure,
    /// Quantity of the ordinates: force or friction coefficient.
    pub(crate) of: Measure,
    /// Number of values of the record; longer ones are thinned out below.
    pub(crate) values: usize,
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    /// Noise by the scatter of values about their neighbours, % of the mean friction.
    pub(crate) noise_percent: f64,
}

/// How far a calibration is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct CalibratingReply {
    pub(crate) stage: CalibrationStage,
    pub(crate) runs: usize,
    pub(crate) of: usize,
}

/// Purpose of the runs of a calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CalibrationStage {
    Training,
    Closest,
    Prediction,
    OtherStep,
}

/// The end of a calibration.
#[derive(Debug, Serialize)]
pub(crate) struct CalibratedReply {
    pub(crate) outcome: CalibrationOutcome,
    /// Reason of a failure.
    pub(crate) sentence: Option<String>,
    /// [`CalibrationResults`], if it is done.
    pub(crate) results: Option<Value>,
}

/// How a calibration has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum CalibrationOutcome {
    Done,
    Stopped,
    /// The case was changed before the end.
    GivenUp,
    Failed,
}

/// Results of a calibration.
#[cfg(feature = "work")]
#[derive(Debug, Serialize)]
pub(crate) struct CalibrationResults {
    pub(crate) unknowns: Vec<UnknownReply>,
    /// Whether the model cannot have made the record.
    pub(crate) is_refused: bool,
    /// The report, as `slipfront calibrate` prints it.
    pub(crate) report: String,
    /// The calibration file, with which `slipfront calibrate` finds the same.
    pub(crate) toml: String,
    /// The median of every unknown, as keys of the case.
    pub(crate) set: Map<String, Value>,
}

/// An unknown key, as it was estimated.
#[cfg(feature = "work")]
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct UnknownReply {
    pub(crate) key: String,
    pub(crate) unit: Option<String>,
    pub(crate) median: f64,
    /// The interval that holds the unknown with 90 %.
    pub(crate) interval: [f64; 2],
    pub(crate) range: [f64; 2],
    /// Whether the record determines the unknown.
    pub(crate) is_determined: bool,
}

/// Static friction at two values of the quantity of a slider.
#[cfg(feature = "work")]
#[derive(Debug, Serialize)]
pub(crate) struct SensitivityReply {
    pub(crate) control: String,
    /// The two values, as the slider has them.
    pub(crate) values: [f64; 2],
    /// Change of static friction mu_s* from the first value to the second, %; none without a transition.
    pub(crate) percent: Option<f64>,
}

/// The texture as a drawing.
#[cfg(feature = "work")]
#[derive(Debug, Serialize)]
pub(crate) struct DrawingReply {
    pub(crate) format: DrawingFormat,
    pub(crate) text: String,
    pub(crate) notes: Vec<String>,
}

/// Confidence level of the intervals.
const CONFIDENCE: f64 = 0.95;

/// A mean and the half width of its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Estimate {
    pub(crate) mean: f64,
    pub(crate) half_width: Option<f64>,
}

impl Estimate {
    /// The mean of values, with half the width of its 95 % confidence interval; none without values.
    pub(crate) fn from_values(values: &[f64]) -> Option<Self> {
        let sample = Sample::from_values(values, CONFIDENCE)?;
        Some(Self {
            mean: sample.mean,
            half_width: sample.half_width,
        })
    }
}
