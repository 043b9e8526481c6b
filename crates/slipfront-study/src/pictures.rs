//! Draws the pictures of a study.

use std::collections::HashMap;

use rayon::prelude::*;

use crate::anisotropy::FRICTION;
use crate::axis::{Axis, Spacing};
use crate::converge::on_meshes::{OnMeshes, is_over_meshes};
use crate::error::StudyError;
use crate::labels::{axis_symbol, axis_title, level_with_symbol, quantity_symbol, title, titled};
use crate::levels::{Levels, combinations};
use crate::meshed_coverage::MeshedCoverage;
use crate::picture_plan::{POLAR, PictureKind, PlannedPicture, measured_quantities, planned, polar};
use crate::plan::{PICTURES_AT_ONCE, Plan};
use crate::statistics::mean;
use crate::study_results::StudyResults;
use crate::summary_values::needs_transition;
use slipfront_base::number_format::four_digits;
use slipfront_plot::{
    Bar, BarChart, BarGroup, Estimate, HeatAxis, HeatMap, Picture, PictureError, PictureLook, PictureSize,
    Polar, Response, Responses,
};

/// Name of the curve of a study over meshes.
const MEANS_ON_MESHES: &str = "mean on each mesh";

/// The value on the finest mesh with its error. The axis begins at a block size of 0, to which the meshes
/// converge.
fn result_on_meshes(finest: f64, value: f64, error: f64) -> Response {
    Response {
        label: "finest mesh, with its error".to_owned(),
        points: vec![
            (0.0, Estimate::NONE),
            (finest, Estimate::between(value - error, value, value + error)),
        ],
        line: false,
    }
}

/// Note that coverages are meshed ones; a legend of several axes has no space to say so.
const AS_MESHED: &str = "A* as meshed";

/// Draws the requested pictures of a study, and passes each on with the name of its files. The budget limits
/// the number of pictures that are in memory at the same time.
pub(crate) fn draw(
    plan: &Plan,
    results: &StudyResults,
    look: &PictureLook,
    mut hand_on: impl FnMut(String, Picture) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    if let Some(Ok((over, combinations))) = polar(&plan.axes).filter(|_| look.draws(POLAR)) {
        let drawn = friction_polar(plan, results, over, &combinations, look.size);
        if let Some(picture) = drawn.transpose() {
            hand_on(POLAR.to_owned(), named(POLAR, picture)?)?;
        }
    }
    let on_meshes = is_over_meshes(&plan.axes)
        .then(|| OnMeshes::new(plan, results))
        .transpose()?;
    for quantity in measured_quantities(plan, results) {
        let mut measured = PlottedQuantity::new(plan, results, quantity);
        measured.on_finest_mesh = on_meshes.as_ref().and_then(|found| found.result_of(quantity));
        let mut asked = planned(&plan.axes, quantity);
        asked.retain(|picture| look.draws(&picture.name));
        for some in asked.chunks(PICTURES_AT_ONCE) {
            let drawn: Vec<_> = some
                .par_iter()
                .map(|picture| measured.draw(&picture.kind, look.size))
                .collect();
            for (PlannedPicture { name, .. }, drawn) in some.iter().zip(drawn) {
                hand_on(name.clone(), named(name, drawn)?)?;
            }
        }
    }
    Ok(())
}

/// A picture, or the error that names it.
fn named(name: &str, picture: Result<Picture, PictureError>) -> Result<Picture, StudyError> {
    picture.map_err(|source| StudyError::Picture {
        name: name.to_owned(),
        source,
    })
}

/// A quantity at every point of a study.
struct PlottedQuantity<'a> {
    axes: &'a [Axis],
    quantity: &'static str,
    /// Values by the levels of a point.
    values: HashMap<Vec<usize>, Estimate>,
    /// Meaning of the intervals.
    note: String,
    /// Number of values at each point that has one.
    counts: Vec<usize>,
    /// Number of runs without a transition.
    without_transition: usize,
    /// Meshed coverages of an axis, at which values are drawn.
    meshed: Option<MeshedCoverage>,
    /// Value on the finest of several meshes and its error, for a study over the size of the blocks.
    on_finest_mesh: Option<[f64; 2]>,
}

impl<'a> PlottedQuantity<'a> {
    fn new(plan: &'a Plan, results: &StudyResults, quantity: &'static str) -> Self {
        let samples: Vec<_> = (0..plan.points.len())
            .map(|position| results.sample(plan, position, quantity))
            .collect();
        let counts: Vec<usize> = samples.iter().flatten().map(|sample| sample.n).collect();
        let without = |position: usize| {
            if needs_transition(quantity) {
                results.runs_without_transition(position, quantity)
            } else {
                0
            }
        };
        let value = |position: usize| {
            let sample = samples[position];
            let interval = sample.and_then(|sample| sample.interval());
            let [low, high] = interval.unwrap_or([f64::NAN; 2]);
            Estimate {
                mean: sample.map_or(f64::NAN, |sample| sample.mean),
                low,
                high,
                crossed: without(position) > 0,
            }
        };
        let points = plan.points.iter().enumerate();
        let values = points.map(|(position, point)| (plan.levels(point), value(position)));
        let without_transition = (0..plan.points.len()).map(without).sum();
        Self {
            axes: &plan.axes,
            quantity,
            values: values.collect(),
            note: note_on_intervals(plan.settings.confidence(), &counts, without_transition),
            counts,
            without_transition,
            meshed: MeshedCoverage::from_plan(plan),
            on_finest_mesh: None,
        }
    }

    fn draw(&self, kind: &PictureKind, size: PictureSize) -> Result<Picture, PictureError> {
        match kind {
            PictureKind::Bars => slipfront_plot::bars(&self.bars(), size),
            PictureKind::Curves { x, fixed, varied } => {
                slipfront_plot::response(&self.curves(*x, fixed, varied), size)
            }
            PictureKind::Map { x, y } => slipfront_plot::heat_map(&self.map(*x, *y), size),
        }
    }

    /// The value at the point with these levels; none if the point is part of another shard.
    fn at(&self, levels: &[usize]) -> Estimate {
        self.values.get(levels).copied().unwrap_or(Estimate::NONE)
    }

    /// The meshed coverages, if this axis is the one of coverages.
    fn meshed(&self, axis: usize) -> Option<&MeshedCoverage> {
        self.meshed.as_ref().filter(|meshed| meshed.axis == axis)
    }

    fn axis_title(&self, axis: usize) -> String {
        titled(axis_title(&self.axes[axis]), self.meshed(axis).is_some())
    }

    fn axis_symbol(&self, axis: usize) -> String {
        titled(axis_symbol(&self.axes[axis]), self.meshed(axis).is_some())
    }

    /// The name of a level in legends and notes, at these levels of other axes.
    fn shown(&self, axis: usize, level: usize, held: &[(usize, usize)]) -> String {
        let asked = self.axes[axis].levels[level].shown();
        let Some(meshed) = self.meshed(axis) else {
            return asked;
        };
        let is_held = |axis: usize| held.iter().any(|(other, _)| *other == axis);
        let free: Vec<usize> = (0..self.axes.len())
            .filter(|&other| other != axis && !is_held(other))
            .collect();
        let free = combinations(self.axes, &free);
        let shown_at = |level: usize| {
            let coverages = free.iter().filter_map(|free| {
                let mut levels = vec![0; self.axes.len()];
                for &(other, level) in held.iter().chain(free).chain(&[(axis, level)]) {
                    levels[other] = level;
                }
                meshed.at(&levels)
            });
            range(&coverages.collect::<Vec<_>>())
        };
        let shown = shown_at(level);
        let mut others = (0..self.axes[axis].levels.len()).filter(|&other| other != level);
        if others.any(|other| shown_at(other) == shown) {
            // Another level has the same meshed coverage.
            format!("{shown} ({asked} asked)")
        } else {
            shown
        }
    }

    /// Label of a level where several axes are named, with the axes of `held` fixed at their levels.
    fn level_with_symbol(&self, axis: usize, level: usize, held: &[(usize, usize)]) -> String {
        level_with_symbol(&self.axes[axis], self.shown(axis, level, held))
    }

    fn curves(&self, x: usize, fixed: &[(usize, usize)], varied: &[usize]) -> Responses {
        let curves = combinations(self.axes, varied).into_iter();
        let mut curves: Vec<Response> = curves.map(|varied| self.curve(x, fixed, &varied)).collect();
        // A coverage of 0 cannot be drawn on a logarithmic scale.
        let has_place = curves
            .iter()
            .flat_map(|curve| &curve.points)
            .all(|(x, _)| *x > 0.0);
        if let (Some([value, error]), [curve]) = (self.on_finest_mesh, &mut curves[..]) {
            MEANS_ON_MESHES.clone_into(&mut curve.label);
            let finest = curve.points.iter().map(|(x, _)| *x).fold(f64::INFINITY, f64::min);
            curves.push(result_on_meshes(finest, value, error));
        }
        Responses {
            x_title: self.axis_title(x),
            log_x: self.axes[x].spacing == Spacing::Logarithmic && has_place,
            log_y: false,
            y_title: title(self.quantity),
            legend_title: match varied {
                [axis] => self.axis_symbol(*axis),
                _ => String::new(),
            },
            note: self.note_at(fixed, varied),
            curves,
        }
    }

    /// The note below a picture: the levels that all its curves have in common, and the meaning of the
    /// intervals.
    fn note_at(&self, fixed: &[(usize, usize)], varied: &[usize]) -> String {
        let levels = fixed
            .iter()
            .map(|&(axis, level)| self.level_with_symbol(axis, level, fixed));
        // Otherwise, the title of a legend or an axis says so.
        let several = varied.iter().filter(|_| varied.len() > 1);
        let mut beside_others = fixed.iter().map(|(axis, _)| axis).chain(several);
        let is_meshed = beside_others.any(|&axis| self.meshed(axis).is_some());
        let meshed = is_meshed.then(|| AS_MESHED.to_owned());
        let parts: Vec<String> = levels.chain(meshed).chain([self.note.clone()]).collect();
        parts.join("; ")
    }

    /// A curve over axis `x` at these levels of the others. Its label has the levels of the `varied` axes,
    /// without a symbol if there is a single one, which the title of the legend names.
    fn curve(&self, x: usize, fixed: &[(usize, usize)], varied: &[(usize, usize)]) -> Response {
        let held = [fixed, varied].concat();
        let label = varied.iter().map(|&(axis, level)| match varied.len() {
            1 => self.shown(axis, level, &held),
            _ => self.level_with_symbol(axis, level, &held),
        });
        let mut response = Response {
            label: label.collect::<Vec<_>>().join(", "),
            ..Response::default()
        };
        let mut levels = vec![0; self.axes.len()];
        for &(axis, level) in fixed.iter().chain(varied) {
            levels[axis] = level;
        }
        for (number, level) in by_number(&self.axes[x]) {
            levels[x] = level;
            let meshed = self.meshed(x).and_then(|meshed| meshed.at(&levels));
            let at = meshed.unwrap_or(number);
            response.points.push((at, self.at(&levels)));
        }
        response
    }

    fn map(&self, x: usize, y: usize) -> HeatMap {
        let (columns, rows) = (by_number(&self.axes[x]), by_number(&self.axes[y]));
        // A map is drawn only for two axes.
        let mut levels = [0; 2];
        let mut values = Vec::with_capacity(rows.len() * columns.len());
        for &(_, row) in &rows {
            for &(_, column) in &columns {
                (levels[x], levels[y]) = (column, row);
                values.push(self.at(&levels));
            }
        }
        let numbers = |asked: &[(f64, usize)]| asked.iter().map(|(number, _)| *number).collect();
        let heat_axis = |axis: usize, asked: &[(f64, usize)]| {
            let log = self.axes[axis].spacing == Spacing::Logarithmic;
            let title = axis_title(&self.axes[axis]);
            let (title, values) = match (self.meshed(axis), self.meshed_lines(axis, asked, log)) {
                (_, Some(meshed)) => (self.axis_title(axis), meshed),
                (Some(_), None) => (format!("asked {title}"), numbers(asked)),
                (None, None) => (title, numbers(asked)),
            };
            HeatAxis { title, values, log }
        };
        HeatMap {
            x: heat_axis(x, &columns),
            y: heat_axis(y, &rows),
            value_title: title(self.quantity),
            values,
            note: self.note.clone(),
        }
    }

    /// The mean meshed coverages of the lines of a map over two axes; none if this is not an axis of
    /// coverages, or if the lines would change their order.
    fn meshed_lines(&self, axis: usize, asked: &[(f64, usize)], log: bool) -> Option<Vec<f64>> {
        let meshed = self.meshed(axis)?;
        let across = 0..self.axes[1 - axis].levels.len();
        let line = |&(_, level): &(f64, usize)| {
            let at = |other: usize| {
                let mut levels = [other; 2];
                levels[axis] = level;
                meshed.at(&levels)
            };
            let found: Vec<f64> = across.clone().filter_map(at).collect();
            (!found.is_empty()).then(|| mean(&found))
        };
        let lines: Vec<f64> = asked.iter().map(line).collect::<Option<_>>()?;
        let is_rising = lines.windows(2).all(|pair| pair[0] < pair[1]);
        (is_rising && (!log || lines[0] > 0.0)).then_some(lines)
    }

    /// Bars for the names of one axis, or in groups for two.
    fn bars(&self) -> BarChart {
        let bar = |axis: usize, levels: &[usize]| Bar {
            label: self.axes[axis].levels[levels[axis]].shown(),
            value: self.at(levels),
        };
        let levels = |axis: usize| 0..self.axes[axis].levels.len();
        let groups = if self.axes.len() == 1 {
            let bars = levels(0).map(|level| bar(0, &[level])).collect();
            let label = String::new();
            vec![BarGroup { label, bars }]
        } else {
            let group = |one: usize| BarGroup {
                label: self.axes[0].levels[one].shown(),
                bars: levels(1).map(|other| bar(1, &[one, other])).collect(),
            };
            levels(0).map(group).collect()
        };
        let legend = self.axes.get(1).map(axis_symbol);
        BarChart {
            y_title: title(self.quantity),
            x_title: axis_title(&self.axes[0]),
            legend_title: legend.unwrap_or_default(),
            note: self.note.clone(),
            groups,
        }
    }
}

/// Polar picture of static and kinetic friction over the directions of the drive, with a curve for each
/// combination of levels of the other axes; none if no run has either quantity.
fn friction_polar(
    plan: &Plan,
    results: &StudyResults,
    over: usize,
    combinations: &[Levels],
    size: PictureSize,
) -> Result<Option<Picture>, PictureError> {
    let measured = measured_quantities(plan, results);
    let measured: Vec<PlottedQuantity> = FRICTION
        .iter()
        .filter(|(quantity, _)| measured.contains(quantity))
        .map(|(quantity, _)| PlottedQuantity::new(plan, results, quantity))
        .collect();
    if measured.is_empty() {
        return Ok(None);
    }
    let counts: Vec<usize> = measured
        .iter()
        .flat_map(|measured| &measured.counts)
        .copied()
        .collect();
    let without_transition = measured.iter().map(|measured| measured.without_transition).sum();
    let curves = combinations.iter().flat_map(|varied| {
        let curve = |measured: &PlottedQuantity| {
            let mut response = measured.curve(over, &[], varied);
            let parts = [response.label.as_str(), quantity_symbol(measured.quantity)];
            let parts = parts.into_iter().filter(|part| !part.is_empty());
            response.label = parts.collect::<Vec<_>>().join(", ");
            response
        };
        measured.iter().map(curve).collect::<Vec<_>>()
    });
    let note = note_on_intervals(plan.settings.confidence(), &counts, without_transition);
    let polar = Polar {
        value_title: "friction \u{3bc}*".to_owned(),
        legend_title: match plan.axes.iter().enumerate().find(|(axis, _)| *axis != over) {
            Some((other, _)) if plan.axes.len() == 2 => measured[0].axis_symbol(other),
            _ => String::new(),
        },
        note: if measured[0].meshed.is_some() && plan.axes.len() > 2 {
            format!("{AS_MESHED}; {note}")
        } else {
            note
        },
        curves: curves.collect(),
    };
    slipfront_plot::polar(&polar, size).map(Some)
}

/// Note on the intervals of means of `counts` values, and on the number of runs that are left out.
fn note_on_intervals(confidence: f64, counts: &[usize], without_transition: usize) -> String {
    let intervals = intervals(confidence, counts);
    match without_transition {
        0 => intervals,
        runs => format!("{intervals}; \u{d7}: {runs} without transition"),
    }
}

fn intervals(confidence: f64, counts: &[usize]) -> String {
    let [least, most] = [counts.iter().min(), counts.iter().max()].map(|count| count.copied().unwrap_or(0));
    if most < 2 {
        return "no intervals: one run per point".to_owned();
    }
    let count = if least == most {
        most.to_string()
    } else {
        format!("{least} to {most}")
    };
    format!(
        "{} % interval of the mean, n = {count}",
        four_digits(100.0 * confidence)
    )
}

/// Range of the coverages to which a level is meshed.
fn range(coverages: &[f64]) -> String {
    let ends = [f64::min, f64::max].map(|of| coverages.iter().copied().reduce(of));
    let [least, most] = ends.map(|end| four_digits(end.unwrap_or(f64::NAN)));
    if least == most {
        least
    } else {
        format!("{least} to {most}")
    }
}

/// Numbers of an axis in ascending order, each with its level.
fn by_number(axis: &Axis) -> Vec<(f64, usize)> {
    let levels = axis.levels.iter().enumerate();
    let mut numbers: Vec<(f64, usize)> = levels
        .filter_map(|(level, at)| Some((at.number?, level)))
        .collect();
    numbers.sort_by(|a, b| a.0.total_cmp(&b.0));
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_say_what_their_intervals_are() {
        assert_eq!(
            note_on_intervals(0.95, &[5, 5], 0),
            "95 % interval of the mean, n = 5"
        );
        assert_eq!(
            note_on_intervals(0.999, &[8, 3], 0),
            "99.9 % interval of the mean, n = 3 to 8"
        );
        assert_eq!(
            note_on_intervals(0.95, &[1, 1], 0),
            "no intervals: one run per point"
        );
        assert_eq!(
            note_on_intervals(0.95, &[4, 5], 6),
            "95 % interval of the mean, n = 4 to 5; \u{d7}: 6 without transition"
        );
    }
}
