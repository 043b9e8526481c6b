//! A run of a figure, and measurements on it.

use std::sync::Arc;

use slipfront::Stop;
use slipfront::observe::{CurvePoint, Frame};

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::statistics::{deviation, largest};
use slipfront::observe::Field;
use slipfront_case::case::{Case, Snapshots};
use slipfront_plot::{FieldMap, FrictionCurve};
use slipfront_run::pictures::friction::marked_curve;
use slipfront_run::running::RunData;

/// A case that ends at the last of these times, and records its fields only at these times.
pub(super) fn recorded_at(mut case: Case, times_star: &[f64]) -> Case {
    let step = |time: &f64| (time / case.time_plan.dt_star).round() as u64;
    let mut steps: Vec<u64> = times_star.iter().map(step).collect();
    steps.dedup();
    case.time_plan.stop = Stop::at_step(steps.last().copied().unwrap_or(case.time_plan.last_step));
    case.output.snapshots = Snapshots::At(steps);
    case
}

/// A map of the lattice of a case without values.
pub(super) fn blank_map(case: &Case, label: &str) -> FieldMap {
    let lattice = &case.model.lattice;
    FieldMap {
        label: label.to_owned(),
        nx: lattice.nx,
        ny: lattice.ny,
        textured: case.model.surface.textured.clone(),
        ..FieldMap::default()
    }
}

/// Maps of contact stress at the peaks of several runs.
pub(super) fn peak_maps(runs: &[FigureRun], labels: &[String]) -> Result<Vec<FieldMap>, PaperError> {
    let labelled = runs.iter().zip(labels);
    labelled
        .map(|(run, label)| run.stress_map(run.instant('C')?, label))
        .collect()
}

/// Friction and sliding blocks of several runs.
pub(super) fn curves(runs: &[FigureRun], label: impl Fn(usize) -> String) -> Drawing {
    let curves = runs.iter().enumerate();
    Drawing::Curves(curves.map(|(index, run)| run.curve(&label(index))).collect())
}

/// Results of a measurement on each of several runs.
pub(super) fn on_each<T>(
    runs: &[FigureRun],
    measure: impl Fn(&FigureRun) -> Result<T, PaperError>,
) -> Result<Vec<T>, PaperError> {
    runs.iter().map(measure).collect()
}

/// A case and the record of its run.
pub(super) struct FigureRun {
    pub(super) case: Arc<Case>,
    pub(super) record: RunData,
    /// Seconds that the run took.
    pub(super) wall_time_s: f64,
}

impl FigureRun {
    /// The frame of one of the instants A-F.
    pub(super) fn instant(&self, letter: char) -> Result<&Frame, PaperError> {
        let mut frames = self.record.frames.iter();
        let found = frames.find(|(letters, _)| letters.contains(letter));
        let frame = found.map(|(_, frame)| frame);
        frame.ok_or_else(|| self.missing(&format!("instant {letter}")))
    }

    pub(super) fn field<'f>(&self, frame: &'f Frame, field: Field) -> Result<&'f [f32], PaperError> {
        let index = self.case.output.fields.iter().position(|&name| name == field);
        let values = index.and_then(|index| frame.values.get(index));
        values
            .map(Vec::as_slice)
            .ok_or_else(|| self.missing("such field"))
    }

    /// A map of tau_c*, NaN where the slider is textured.
    pub(super) fn stress_map(&self, frame: &Frame, label: &str) -> Result<FieldMap, PaperError> {
        let largest = self.record.contact_stress_max as f32;
        let values = self.field(frame, Field::ContactStress)?;
        let textured = &self.case.model.surface.textured;
        let scaled = values.iter().zip(textured);
        let scaled = scaled.map(|(value, &textured)| if textured { f32::NAN } else { value / largest });
        let (time, mu) = (frame.time_star, frame.point.mu_star);
        Ok(FieldMap {
            note: format!("t* = {time:.1}, \u{3bc}* = {mu:.3}"),
            values: scaled.collect(),
            ..blank_map(&self.case, label)
        })
    }

    /// The curve with its peak, its kinetic window and the letters of its instants.
    pub(super) fn lettered_curve(&self, label: &str) -> FrictionCurve {
        let rows = &self.record.rows;
        FrictionCurve {
            x: rows.iter().map(|row| row.time_star).collect(),
            friction: rows.iter().map(|row| row.point.mu_star).collect(),
            sliding_percent: rows.iter().map(|row| row.point.sliding_percent).collect(),
            ..marked_curve(label.to_owned(), &self.record.summary)
        }
    }

    /// The curve with its peak and its kinetic window.
    pub(super) fn curve(&self, label: &str) -> FrictionCurve {
        FrictionCurve {
            instants: Vec::new(),
            ..self.lettered_curve(label)
        }
    }

    /// A quantity of the curve at a time, interpolated linearly between two rows.
    pub(super) fn at(&self, time_star: f64, value: fn(&CurvePoint) -> f64) -> f64 {
        let rows = &self.record.rows;
        let after = rows
            .partition_point(|row| row.time_star < time_star)
            .min(rows.len() - 1);
        let (a, b) = (&rows[after.saturating_sub(1)], &rows[after]);
        let span = b.time_star - a.time_star;
        let share = if span > 0.0 {
            (time_star - a.time_star) / span
        } else {
            0.0
        };
        value(&a.point) + share.clamp(0.0, 1.0) * (value(&b.point) - value(&a.point))
    }

    /// The largest difference of a quantity between this and another run, over the rows of this run in a
    /// window of time.
    pub(super) fn largest_difference(
        &self,
        other: &FigureRun,
        [from, until]: [f64; 2],
        value: fn(&CurvePoint) -> f64,
    ) -> f64 {
        let rows = self.record.rows.iter();
        rows.filter(|row| (from..=until).contains(&row.time_star))
            .map(|row| (value(&row.point) - other.at(row.time_star, value)).abs())
            .fold(0.0, f64::max)
    }

    /// The largest difference of a quantity between this and any of several runs in a window of time.
    pub(super) fn largest_difference_of(
        &self,
        runs: &[FigureRun],
        window: [f64; 2],
        value: fn(&CurvePoint) -> f64,
    ) -> f64 {
        largest(runs.iter().map(|run| self.largest_difference(run, window, value)))
    }

    /// mu* in each row of a window of time.
    pub(super) fn friction_between(&self, from: f64, until: f64) -> Vec<f64> {
        let rows = self.record.rows.iter();
        rows.filter(|row| (from..=until).contains(&row.time_star))
            .map(|row| row.point.mu_star)
            .collect()
    }

    pub(super) fn kinetic_window(&self) -> Result<[f64; 2], PaperError> {
        let window = self.record.summary.kinetic_window_star;
        window.ok_or_else(|| self.missing("kinetic window"))
    }

    /// Standard deviation of mu* in the window of kinetic friction.
    pub(super) fn kinetic_fluctuation(&self) -> Result<f64, PaperError> {
        let [from, until] = self.kinetic_window()?;
        Ok(deviation(&self.friction_between(from, until)))
    }

    /// t* of the first slip of any block.
    pub(super) fn first_slip(&self) -> Result<f64, PaperError> {
        let time = self.record.summary.first_slip_time_star;
        time.ok_or_else(|| self.missing("slip"))
    }

    /// Times of the first slip of the blocks in contact, in ascending order.
    pub(super) fn slip_times(&self) -> Vec<f64> {
        let times = self.record.first_slip_time_star.iter().copied();
        let mut times: Vec<f64> = times.filter(|time| !time.is_nan()).collect();
        times.sort_by(f64::total_cmp);
        times
    }

    /// t* at which this share of the blocks in contact has slipped.
    pub(super) fn time_of_share(&self, share: f64) -> Result<f64, PaperError> {
        let contact = self.case.model.surface.n_contact() as f64;
        let index = ((share * contact).ceil() as usize).saturating_sub(1);
        let time = self.slip_times().get(index).copied();
        time.ok_or_else(|| self.missing(&format!("slip of {share} of all blocks")))
    }

    /// The block that slips first.
    pub(super) fn first_block(&self) -> Result<usize, PaperError> {
        let earliest = self.first_slip()?;
        let times = &self.record.first_slip_time_star;
        let first = times.iter().position(|&time| time == earliest);
        first.ok_or_else(|| self.missing("slip"))
    }

    fn missing(&self, what: &str) -> PaperError {
        PaperError::Lacks {
            file: self.case.name.clone(),
            what: what.to_owned(),
        }
    }
}

pub(super) fn mu_star(point: &CurvePoint) -> f64 {
    point.mu_star
}

pub(super) fn sliding_percent(point: &CurvePoint) -> f64 {
    point.sliding_percent
}
