//! Draws the pictures of a study.

use std::collections::HashMap;

use rayon::prelude::*;

use super::axis::{Axis, Spacing};
use super::error::StudyError;
use super::labels::{symbol, title};
use super::picture_plan::{PictureKind, PlannedPicture, QUANTITIES, combinations, planned};
use super::plan::Plan;
use super::point_statistics::sample;
use super::study_results::StudyResults;
use slipfront_plot::{
    Bar, BarChart, BarGroup, HeatAxis, HeatMap, Picture, PictureError, Response, Responses,
};

/// Draws the pictures of a study, each with the name of its files.
///
/// # Errors
/// When one cannot be drawn.
pub(super) fn draw(plan: &Plan, results: &StudyResults) -> Result<Vec<(String, Picture)>, StudyError> {
    let axes = &plan.axes;
    let of_quantity = |quantity: &&str| -> Result<Vec<(String, Picture)>, StudyError> {
        let values = Values::of(plan, results, quantity);
        // Runs that stop at the onset have no kinetic friction, and a study without a reference has no reduction.
        if values.0.values().all(|[mean, ..]| mean.is_nan()) {
            return Ok(Vec::new());
        }
        let drawn = planned(axes, quantity)
            .into_iter()
            .map(|PlannedPicture { name, kind }| {
                let picture = match &kind {
                    PictureKind::Bars => bars(axes, quantity, &values),
                    PictureKind::Curves { x, fixed, varied } => {
                        curves(axes, *x, fixed, varied, quantity, &values)
                    }
                    PictureKind::Map { x, y } => map(axes, *x, *y, quantity, &values),
                };
                match picture {
                    Ok(picture) => Ok((name, picture)),
                    Err(source) => Err(StudyError::Picture { name, source }),
                }
            });
        drawn.collect()
    };
    let drawn: Vec<_> = QUANTITIES.par_iter().map(of_quantity).collect();
    let drawn: Result<Vec<_>, StudyError> = drawn.into_iter().collect();
    Ok(drawn?.into_iter().flatten().collect())
}

/// Mean of a quantity and the ends of its interval, by the levels of a point; NaN where there is none.
struct Values<'a>(HashMap<&'a [usize], [f64; 3]>);

impl<'a> Values<'a> {
    fn of(plan: &'a Plan, results: &StudyResults, quantity: &str) -> Self {
        let value = |position| match sample(plan, results, position, quantity) {
            Some(sample) => {
                let [low, high] = sample.interval().unwrap_or([f64::NAN; 2]);
                [sample.mean, low, high]
            }
            None => [f64::NAN; 3],
        };
        let points = plan.points.iter().enumerate();
        Self(
            points
                .map(|(position, point)| (point.levels.as_slice(), value(position)))
                .collect(),
        )
    }

    /// The values at the point with these levels; NaN if the point is part of another shard.
    fn at(&self, levels: &[usize]) -> [f64; 3] {
        self.0.get(levels).copied().unwrap_or([f64::NAN; 3])
    }
}

fn curves(
    axes: &[Axis],
    x: usize,
    fixed: &[(usize, usize)],
    varied: &[usize],
    quantity: &str,
    values: &Values,
) -> Result<Picture, PictureError> {
    let curves = combinations(axes, varied)
        .into_iter()
        .map(|at| curve(axes, x, &[fixed, &at].concat(), varied, values))
        .collect();
    slipfront_plot::response(&Responses {
        x_title: title(axes[x].title()),
        log_x: axes[x].spacing == Spacing::Logarithmic,
        log_y: false,
        y_title: title(quantity),
        legend_title: match varied {
            [axis] => symbol(axes[*axis].title()),
            _ => String::new(),
        },
        curves,
    })
}

fn curve(axes: &[Axis], x: usize, fixed: &[(usize, usize)], labelled: &[usize], values: &Values) -> Response {
    let label: Vec<String> = fixed
        .iter()
        .filter(|(axis, _)| labelled.contains(axis))
        .map(|&(axis, level)| axes[axis].levels[level].shown())
        .collect();
    let mut response = Response {
        label: label.join(", "),
        x: vec![],
        mean: vec![],
        low: vec![],
        high: vec![],
        line: false,
    };
    for (at, level) in by_number(&axes[x]) {
        let mut place = vec![0; axes.len()];
        place[x] = level;
        fixed.iter().for_each(|&(axis, level)| place[axis] = level);
        let [mean, low, high] = values.at(&place);
        response.x.push(at);
        response.mean.push(mean);
        response.low.push(low);
        response.high.push(high);
    }
    response
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

fn map(axes: &[Axis], x: usize, y: usize, quantity: &str, values: &Values) -> Result<Picture, PictureError> {
    let (columns, rows) = (by_number(&axes[x]), by_number(&axes[y]));
    let mut means = Vec::new();
    for &(_, row) in &rows {
        for &(_, column) in &columns {
            let mut place = vec![0; axes.len()];
            (place[x], place[y]) = (column, row);
            means.push(values.at(&place)[0]);
        }
    }
    let heat_axis = |axis: usize, levels: &[(f64, usize)]| HeatAxis {
        title: title(axes[axis].title()),
        values: levels.iter().map(|(at, _)| *at).collect(),
        log: axes[axis].spacing == Spacing::Logarithmic,
    };
    slipfront_plot::heat_map(&HeatMap {
        x: heat_axis(x, &columns),
        y: heat_axis(y, &rows),
        value_title: title(quantity),
        values: means,
    })
}

/// Bars for the names of one axis, or in groups for two.
fn bars(axes: &[Axis], quantity: &str, values: &Values) -> Result<Picture, PictureError> {
    let bar = |label: &str, levels: &[usize]| {
        let [mean, low, high] = values.at(levels);
        Bar {
            label: label.to_owned(),
            mean,
            low,
            high,
        }
    };
    let name = |axis: usize, level: usize| axes[axis].levels[level].shown();
    let levels = |axis: usize| 0..axes[axis].levels.len();
    let groups = if axes.len() == 1 {
        let bars = levels(0).map(|level| bar(&name(0, level), &[level])).collect();
        vec![BarGroup {
            label: String::new(),
            bars,
        }]
    } else {
        let group = |one: usize| BarGroup {
            label: name(0, one),
            bars: levels(1)
                .map(|other| bar(&name(1, other), &[one, other]))
                .collect(),
        };
        levels(0).map(group).collect()
    };
    let legend_title = axes.get(1).map_or(String::new(), |axis| symbol(axis.title()));
    slipfront_plot::bars(&BarChart {
        y_title: title(quantity),
        x_title: title(axes[0].title()),
        legend_title,
        groups,
    })
}
