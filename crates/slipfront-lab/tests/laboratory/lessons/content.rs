//! The files of the lessons, as they are parsed.

use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use slipfront_case::case::{Case, Ranks};
use slipfront_case::case_file::{CaseFile, Override};

/// Keys of a case and their values.
pub(crate) type Keys = Map<String, Value>;

/// A lesson of `lessons.json`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Lesson {
    pub(crate) id: String,
    pub(crate) steps: Vec<Step>,
}

/// A step: the page runs its case from rest next to its text.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Step {
    pub(crate) id: String,
    pub(crate) case: String,
    /// Measured record that the reader can load.
    pub(crate) record: Option<String>,
    pub(crate) view: View,
    pub(crate) set: Vec<Button>,
}

/// The view of a step: the field, the pace, and whether the page shows the twin and the kymograph.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct View {
    #[serde(rename = "field")]
    _field: Field,
    /// t* per second.
    pub(crate) pace: f64,
    #[serde(default, rename = "twin")]
    _twin: bool,
    #[serde(default, rename = "kymograph")]
    _kymograph: bool,
}

/// A button: it changes keys of the case, which then runs from rest, or changes the view.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Button {
    pub(crate) id: String,
    #[serde(default)]
    pub(crate) keys: Keys,
    #[serde(default)]
    pub(crate) view: ViewChange,
}

/// Changes of the view by a button.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ViewChange {
    pub(crate) field: Option<Field>,
    pub(crate) pace: Option<f64>,
}

/// The fields that the laboratory shows.
#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Field {
    ContactStress,
    Traction,
    Displacement,
    Speed,
    Sliding,
    FirstSlip,
}

/// The words of a lesson.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct LessonWords {
    pub(crate) title: String,
    pub(crate) minutes: u32,
    pub(crate) summary: String,
    pub(crate) steps: BTreeMap<String, StepWords>,
}

/// The words of a step.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StepWords {
    pub(crate) title: String,
    /// Paragraphs up to the question.
    pub(crate) text: Vec<String>,
    /// Paragraphs shown on request of the reader.
    pub(crate) answer: Vec<String>,
    /// Labels of the buttons of the step.
    pub(crate) set: BTreeMap<String, String>,
}

/// A number in a text.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Number {
    pub(crate) says: String,
    pub(crate) case: String,
    #[serde(default)]
    pub(crate) set: Keys,
    pub(crate) quantity: Quantity,
    /// The key that a number of the quantity `key` refers to.
    pub(crate) key: Option<String>,
    /// Keys that change in the reference case of a reduction; all others are the same.
    pub(crate) against: Option<Keys>,
    /// Seeds of the surfaces over which the mean is taken; without any, the seed of the case.
    #[serde(default)]
    pub(crate) seeds: Vec<u64>,
}

/// The quantity that a number in a text gives.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Quantity {
    /// The value of a key of the case.
    Key,
    /// Static friction mu_s*.
    StaticFrictionStar,
    /// Kinetic friction mu_k*.
    KineticFrictionStar,
    /// Onset time t_s*.
    OnsetTimeStar,
    /// t* of the first slip of a block in contact.
    FirstSlipTimeStar,
    /// mu* at the instant E, where it is lowest after the peak.
    FrictionAfterFall,
    /// Eq. 16: reduction of mu_s* relative to `against`, %.
    StaticReductionPercent,
    /// Percentage of the blocks in contact that have slipped by t_s*.
    SlippedPercentAtPeak,
    /// Meshed coverage, %.
    TexturePercent,
    /// Median speed of the front over the speed of long shear waves.
    FrontSpeedCS,
    /// Drive speed V*.
    VStar,
    /// V* N_x, the speed of loading for a slider of this size.
    VStarNX,
}

impl Quantity {
    /// The unit behind a number in a text; empty for none.
    pub(crate) fn unit(self, key: Option<&str>) -> &'static str {
        match self {
            Self::StaticReductionPercent | Self::SlippedPercentAtPeak | Self::TexturePercent => "%",
            Self::Key if key.is_some_and(|key| key.ends_with(".coverage")) => "%",
            Self::Key if key == Some("drive.direction") => "°",
            _ => "",
        }
    }
}

impl StepWords {
    /// All paragraphs of a step, with those of its answer at the end.
    pub(crate) fn paragraphs(&self) -> impl Iterator<Item = &String> {
        self.text.iter().chain(&self.answer)
    }
}

/// The folder of the page.
pub(crate) fn web() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("web")
}

fn read<T: DeserializeOwned>(name: &str) -> T {
    let text = fs::read_to_string(web().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn lessons() -> Vec<Lesson> {
    read("lessons.json")
}

pub(crate) fn words() -> BTreeMap<String, LessonWords> {
    read("lessons.en.json")
}

pub(crate) fn numbers() -> BTreeMap<String, Number> {
    read("lesson_numbers.json")
}

/// The case of a file of the page, with some keys changed.
pub(crate) fn case(name: &str, keys: &Keys) -> Case {
    let text = fs::read_to_string(web().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let value = |value| toml::Value::try_from(value).unwrap_or_else(|error| panic!("{name}: {error}"));
    let overrides: Vec<String> = keys
        .iter()
        .map(|(key, json)| Override::new(key, &value(json)).to_string())
        .collect();
    CaseFile::parse(&text, name, &overrides)
        .and_then(|file| Case::to_run(file, name, web().as_path(), &mut |_| true, Ranks::ALONE))
        .unwrap_or_else(|error| panic!("{error}"))
}
