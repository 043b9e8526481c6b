//! Draws the pictures of a study.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use super::anisotropy::FRICTION;
use super::axis::{Axis, Spacing};
use super::error::StudyError;
use super::labels::{axis_symbol, axis_title, level_with_symbol, quantity_symbol, title};
use super::levels::{Levels, combinations};
use super::picture_plan::{POLAR, PictureKind, PlannedPicture, measured_quantities, planned, polar};
use super::plan::{PICTURES_AT_ONCE, Plan};
use super::study_results::StudyResults;
use super::summary_values::needs_transition;
use slipfront_case::number_format::four_digits;
use slipfront_plot::{
    Bar, BarChart, BarGroup, HeatAxis, HeatMap, Picture, PictureError, Polar, Response, Responses,
};

/// Draws the pictures of a study and hands each on with the name of its files. No more are in memory at once than there is
/// room for in the budget.
pub(super) fn draw(
    plan: &Plan,
    results: &StudyResults,
    mut hand_on: impl FnMut(String, Picture) -> Result<(), StudyError>,
) -> Result<(), StudyError> {
    if let Some(Ok((over, combinations))) = polar(&plan.axes) {
        let drawn = friction_polar(plan, results, over, &combinations);
        if let Some(picture) = drawn.transpose() {
            let name = POLAR.to_owned();
            hand_on(
                POLAR.to_owned(),
                picture.map_err(|source| StudyError::Picture { name, source })?,
            )?;
        }
    }
    for quantity in measured_quantities(plan, results) {
        let measured = Measured::of(plan, results, quantity);
        for some in planned(&plan.axes, quantity).chunks(PICTURES_AT_ONCE) {
            let drawn: Vec<_> = some
                .par_iter()
                .map(|picture| measured.draw(&picture.kind))
                .collect();
            for (PlannedPicture { name, .. }, drawn) in some.iter().zip(drawn) {
                let name = name.clone();
                match drawn {
                    Ok(picture) => hand_on(name, picture)?,
                    Err(source) => return Err(StudyError::Picture { name, source }),
                }
            }
        }
    }
    Ok(())
}

/// A quantity at every point of a study.
struct Measured<'a> {
    axes: &'a [Axis],
    quantity: &'static str,
    /// Mean and the ends of its interval, by the levels of a point; NaN where there is none.
    values: HashMap<Vec<usize>, [f64; 3]>,
    /// What the intervals are.
    note: String,
    /// How many values there are at each point that has one.
    counts: Vec<usize>,
    /// The levels of points of which runs are left out that had no transition: a cross marks them.
    crossed: HashSet<Vec<usize>>,
    /// How many such runs there are.
    without_transition: usize,
}

impl<'a> Measured<'a> {
    fn of(plan: &'a Plan, results: &StudyResults, quantity: &'static str) -> Self {
        let samples: Vec<_> = (0..plan.points.len())
            .map(|position| results.sample(plan, position, quantity))
            .collect();
        let value = |position: usize| {
            let sample = samples[position];
            let interval = sample.and_then(|sample| sample.interval());
            let [low, high] = interval.unwrap_or([f64::NAN; 2]);
            [sample.map_or(f64::NAN, |sample| sample.mean), low, high]
        };
        let points = plan.points.iter().enumerate();
        let values = points.map(|(position, point)| (plan.levels(point), value(position)));
        let counts: Vec<usize> = samples.iter().flatten().map(|sample| sample.n).collect();
        let without = |position: usize| match needs_transition(quantity) {
            true => results.runs_without_transition(position, quantity),
            false => 0,
        };
        let points = plan.points.iter().enumerate();
        let crossed = points.filter(|&(position, _)| without(position) > 0);
        let without_transition = (0..plan.points.len()).map(without).sum();
        Self {
            axes: &plan.axes,
            quantity,
            values: values.collect(),
            note: note_on_intervals(plan.settings.confidence(), &counts, without_transition),
            counts,
            crossed: crossed.map(|(_, point)| plan.levels(point)).collect(),
            without_transition,
        }
    }

    fn draw(&self, kind: &PictureKind) -> Result<Picture, PictureError> {
        match kind {
            PictureKind::Bars => self.bars(),
            PictureKind::Curves { x, fixed, varied } => self.curves(*x, fixed, varied),
            PictureKind::Map { x, y } => self.map(*x, *y),
        }
    }

    /// The values at the point with these levels; NaN if the point is part of another shard.
    fn at(&self, levels: &[usize]) -> [f64; 3] {
        self.values.get(levels).copied().unwrap_or([f64::NAN; 3])
    }

    /// The name of a level in legends and under bars.
    fn shown(&self, axis: usize, level: usize) -> String {
        self.axes[axis].levels[level].shown()
    }

    fn curves(&self, x: usize, fixed: &[(usize, usize)], varied: &[usize]) -> Result<Picture, PictureError> {
        let curves = combinations(self.axes, varied).into_iter();
        slipfront_plot::response(&Responses {
            x_title: axis_title(&self.axes[x]),
            log_x: self.axes[x].spacing == Spacing::Logarithmic,
            log_y: false,
            y_title: title(self.quantity),
            legend_title: match varied {
                [axis] => axis_symbol(&self.axes[*axis]),
                _ => String::new(),
            },
            note: self.note_at(fixed),
            curves: curves.map(|varied| self.curve(x, fixed, &varied)).collect(),
        })
    }

    /// What the intervals are, after the levels that all curves of a picture have in common.
    fn note_at(&self, fixed: &[(usize, usize)]) -> String {
        let levels = fixed
            .iter()
            .map(|&(axis, level)| level_with_symbol(&self.axes[axis], level));
        let parts: Vec<String> = levels.chain([self.note.clone()]).collect();
        parts.join("; ")
    }

    /// A curve over axis `x` at these levels of the others; those of the `varied` axes name it, a single one of which is told by the title
    /// of the legend.
    fn curve(&self, x: usize, fixed: &[(usize, usize)], varied: &[(usize, usize)]) -> Response {
        let label = varied.iter().map(|&(axis, level)| match varied.len() {
            1 => self.shown(axis, level),
            _ => level_with_symbol(&self.axes[axis], level),
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
            let [mean, low, high] = self.at(&levels);
            response.x.push(number);
            response.mean.push(mean);
            response.low.push(low);
            response.high.push(high);
            response.crossed.push(self.crossed.contains(&levels));
        }
        response
    }

    fn map(&self, x: usize, y: usize) -> Result<Picture, PictureError> {
        let (columns, rows) = (by_number(&self.axes[x]), by_number(&self.axes[y]));
        let (mut means, mut half_widths, mut crossed) = (Vec::new(), Vec::new(), Vec::new());
        // A map is drawn for two axes alone.
        let mut levels = [0; 2];
        for &(_, row) in &rows {
            for &(_, column) in &columns {
                (levels[x], levels[y]) = (column, row);
                let [mean, low, high] = self.at(&levels);
                means.push(mean);
                half_widths.push(0.5 * (high - low));
                crossed.push(self.crossed.contains(&levels[..]));
            }
        }
        let heat_axis = |axis: usize, numbers: &[(f64, usize)]| HeatAxis {
            title: axis_title(&self.axes[axis]),
            values: numbers.iter().map(|(number, _)| *number).collect(),
            log: self.axes[axis].spacing == Spacing::Logarithmic,
        };
        slipfront_plot::heat_map(&HeatMap {
            x: heat_axis(x, &columns),
            y: heat_axis(y, &rows),
            value_title: title(self.quantity),
            values: means,
            half_widths,
            crossed,
            note: self.note.clone(),
        })
    }

    /// Bars for the names of one axis, or in groups for two.
    fn bars(&self) -> Result<Picture, PictureError> {
        let bar = |axis: usize, levels: &[usize]| {
            let [mean, low, high] = self.at(levels);
            Bar {
                label: self.shown(axis, levels[axis]),
                mean,
                low,
                high,
                crossed: self.crossed.contains(levels),
            }
        };
        let levels = |axis: usize| 0..self.axes[axis].levels.len();
        let groups = if self.axes.len() == 1 {
            let bars = levels(0).map(|level| bar(0, &[level])).collect();
            let label = String::new();
            vec![BarGroup { label, bars }]
        } else {
            let group = |one: usize| BarGroup {
                label: self.shown(0, one),
                bars: levels(1).map(|other| bar(1, &[one, other])).collect(),
            };
            levels(0).map(group).collect()
        };
        let legend = self.axes.get(1).map(axis_symbol);
        slipfront_plot::bars(&BarChart {
            y_title: title(self.quantity),
            x_title: axis_title(&self.axes[0]),
            legend_title: legend.unwrap_or_default(),
            note: self.note.clone(),
            groups,
        })
    }
}

/// Static and kinetic friction around the directions of the drive, a curve for each combination of levels of the other axes; none if no
/// run has either.
fn friction_polar(
    plan: &Plan,
    results: &StudyResults,
    over: usize,
    combinations: &[Levels],
) -> Result<Option<Picture>, PictureError> {
    let measured = measured_quantities(plan, results);
    let measured: Vec<Measured> = FRICTION
        .iter()
        .filter(|(quantity, _)| measured.contains(quantity))
        .map(|(quantity, _)| Measured::of(plan, results, quantity))
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
        let curve = |measured: &Measured| {
            let mut response = measured.curve(over, &[], varied);
            let parts = [response.label.as_str(), quantity_symbol(measured.quantity)];
            let parts = parts.into_iter().filter(|part| !part.is_empty());
            response.label = parts.collect::<Vec<_>>().join(", ");
            response
        };
        measured.iter().map(curve).collect::<Vec<_>>()
    });
    let picture = slipfront_plot::polar(&Polar {
        value_title: "friction \u{3bc}*".to_owned(),
        legend_title: match plan.axes.iter().enumerate().find(|(axis, _)| *axis != over) {
            Some((_, other)) if plan.axes.len() == 2 => axis_symbol(other),
            _ => String::new(),
        },
        note: note_on_intervals(plan.settings.confidence(), &counts, without_transition),
        curves: curves.collect(),
    });
    picture.map(Some)
}

/// What the intervals around means of so many values are, and how many runs are left out of them.
fn note_on_intervals(confidence: f64, counts: &[usize], without_transition: usize) -> String {
    let intervals = intervals(confidence, counts);
    match without_transition {
        0 => intervals,
        1 => format!("{intervals}; \u{d7}: without 1 run that had no transition"),
        runs => format!("{intervals}; \u{d7}: without {runs} runs that had no transition"),
    }
}

fn intervals(confidence: f64, counts: &[usize]) -> String {
    let [least, most] = [counts.iter().min(), counts.iter().max()].map(|count| count.copied().unwrap_or(0));
    if most < 2 {
        return "no intervals: one run at each point".to_owned();
    }
    let count = match least == most {
        true => most.to_string(),
        false => format!("{least} to {most}"),
    };
    format!(
        "{} % interval of the mean, n = {count}",
        four_digits(100.0 * confidence)
    )
}

/// Numbers of an axis in rising order, each with its level.
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
            "no intervals: one run at each point"
        );
        assert_eq!(
            note_on_intervals(0.95, &[4, 5], 6),
            "95 % interval of the mean, n = 4 to 5; \u{d7}: without 6 runs that had no transition"
        );
    }
}
