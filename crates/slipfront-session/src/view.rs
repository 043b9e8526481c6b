//! The view of a run and its pace. Changes of the view never change the case.

use serde::Deserialize;

use crate::picture::DisplayedField;

/// Changes of the view that the page asks for; parts that are not given stay as they are.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct ViewChange {
    field: Option<DisplayedField>,
    visible: Option<bool>,
    paused: Option<bool>,
    pace: Option<f64>,
    loading_pace: Option<f64>,
    twin: Option<bool>,
    kymograph: Option<bool>,
    frames_per_second: Option<f64>,
    after_change: Option<AfterChange>,
    /// The block that is probed; null for none.
    #[serde(deserialize_with = "deserialize_nullable")]
    probe: Option<Option<[usize; 2]>>,
}

/// Parses a key that may be null; null differs from a missing key.
fn deserialize_nullable<'de, D: serde::Deserializer<'de>>(
    from: D,
) -> Result<Option<Option<[usize; 2]>>, D::Error> {
    Deserialize::deserialize(from).map(Some)
}

/// How the run goes on after the case was changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum AfterChange {
    /// The run begins again, from rest.
    #[default]
    Rest,
    /// The run goes on from its present state.
    GoOn,
}

/// The view of a run: the field, the pace, and what runs or is drawn next to it.
#[derive(Debug)]
pub(crate) struct View {
    pub(crate) field: DisplayedField,
    /// Whether the page is visible.
    pub(crate) visible: bool,
    pub(crate) paused: bool,
    /// t* per second; 0 for as fast as possible.
    pub(crate) pace: f64,
    /// t* per second until a block in contact slips, if that is faster than the pace.
    pub(crate) loading_pace: f64,
    /// Whether the slider without texture runs next to the run.
    pub(crate) twin: bool,
    pub(crate) kymograph: bool,
    pub(crate) frames_per_second: f64,
    pub(crate) after_change: AfterChange,
    pub(crate) probe: Option<[usize; 2]>,
}

impl Default for View {
    fn default() -> Self {
        Self {
            field: DisplayedField::Front,
            visible: true,
            paused: false,
            pace: 25.0,
            loading_pace: 0.0,
            twin: true,
            kymograph: false,
            frames_per_second: 60.0,
            after_change: AfterChange::Rest,
            probe: None,
        }
    }
}

impl View {
    /// Pace of a run, t* per second, by whether a block in contact has slipped; 0 for as fast as possible.
    pub(crate) fn pace_when(&self, has_slipped: bool) -> f64 {
        if has_slipped || self.pace == 0.0 {
            self.pace
        } else {
            self.pace.max(self.loading_pace)
        }
    }

    /// Changes the parts of the view that are given.
    ///
    /// # Errors
    /// A sentence with the bound that a number exceeds; in that case nothing changes.
    pub(crate) fn change(&mut self, change: &ViewChange) -> Result<(), String> {
        let pace = change.pace.unwrap_or(self.pace);
        let loading_pace = change.loading_pace.unwrap_or(self.loading_pace);
        for pace in [pace, loading_pace] {
            if !(0.0..=1e6).contains(&pace) {
                return Err(format!(
                    "the pace is {pace} t* per second, where it may be from 0, as fast as possible, to 1e6"
                ));
            }
        }
        let rate = change.frames_per_second.unwrap_or(self.frames_per_second);
        if !(1.0..=60.0).contains(&rate) {
            return Err(format!(
                "{rate} pictures per second were asked for, where there may be 1 to 60"
            ));
        }
        (self.pace, self.loading_pace, self.frames_per_second) = (pace, loading_pace, rate);
        self.field = change.field.unwrap_or(self.field);
        self.visible = change.visible.unwrap_or(self.visible);
        self.paused = change.paused.unwrap_or(self.paused);
        self.twin = change.twin.unwrap_or(self.twin);
        self.kymograph = change.kymograph.unwrap_or(self.kymograph);
        self.after_change = change.after_change.unwrap_or(self.after_change);
        self.probe = change.probe.unwrap_or(self.probe);
        Ok(())
    }
}
