//! Which pictures a study gets: curves over numbers, maps over two of them, bars for names.

use std::collections::HashMap;

use rayon::prelude::*;

use super::axis::{Axis, Spacing};
use super::error::StudyError;
use super::execute::Findings;
use super::plan::Plan;
use super::quantities::REDUCTION;
use super::tables::sample;
use crate::pictures::{
    self, Bar, BarChart, BarGroup, HeatAxis, HeatMap, Picture, PictureError, Response, Responses, symbol,
    title,
};

/// What is drawn, where the study has it.
pub(super) const QUANTITIES: [&str; 3] = ["static_friction_star", "kinetic_friction_star", REDUCTION];

/// Most curves in one picture.
const MOST_CURVES: usize = 9;

/// Draws the pictures of a study, each with the name of its files.
///
/// # Errors
/// When one cannot be drawn.
pub(super) fn draw(plan: &Plan, findings: &Findings) -> Result<Vec<(String, Picture)>, StudyError> {
    let of_quantity = |quantity: &&str| {
        let values = Values::of(plan, findings, quantity);
        // A study that stops at the onset knows no kinetic friction, one without reference no reduction.
        if values.0.values().all(|[mean, ..]| mean.is_nan()) {
            return Vec::new();
        }
        draw_quantity(plan, quantity, &values)
    };
    let drawn: Vec<Vec<Drawn>> = QUANTITIES.par_iter().map(of_quantity).collect();
    drawn
        .into_iter()
        .flatten()
        .map(|(name, picture)| match picture {
            Ok(picture) => Ok((name, picture)),
            Err(source) => Err(StudyError::Picture { name, source }),
        })
        .collect()
}

/// Mean and interval of a quantity by the levels of a point; not a number where it has none.
struct Values<'a>(HashMap<&'a [usize], [f64; 3]>);

impl<'a> Values<'a> {
    fn of(plan: &'a Plan, findings: &Findings, quantity: &str) -> Self {
        let value = |position| match sample(plan, findings, position, quantity) {
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

    /// At the point with these levels; a shard lacks most of them.
    fn at(&self, levels: &[usize]) -> [f64; 3] {
        self.0.get(levels).copied().unwrap_or([f64::NAN; 3])
    }
}

type Drawn = (String, Result<Picture, PictureError>);

fn draw_quantity(plan: &Plan, quantity: &str, values: &Values) -> Vec<Drawn> {
    let axes = &plan.axes;
    let numeric: Vec<usize> = (0..axes.len())
        .filter(|&axis| axes[axis].spacing != Spacing::Named)
        .collect();
    match (numeric.first(), axes.len()) {
        (_, 0) => Vec::new(),
        (None, 1 | 2) => vec![(quantity.to_owned(), bars(axes, quantity, values))],
        // Names alone on three axes or more: the tables serve better.
        (None, _) => Vec::new(),
        (Some(&x), _) => {
            let mut drawn = curves(axes, x, quantity, values);
            if let ([x, y], 2) = (numeric.as_slice(), axes.len()) {
                drawn.push((format!("{quantity}_map"), map(axes, *x, *y, quantity, values)));
            }
            drawn
        }
    }
}

/// Curves over axis `x`, one for each combination of levels of the others; more pictures where these are many.
fn curves(axes: &[Axis], x: usize, quantity: &str, values: &Values) -> Vec<Drawn> {
    let others: Vec<usize> = (0..axes.len()).filter(|&axis| axis != x).collect();
    let count: usize = others.iter().map(|&axis| axes[axis].levels.len()).product();
    // The axes in front are split off into pictures of their own until one picture can hold the rest.
    let mut held = count;
    let mut split = 0;
    while held > MOST_CURVES && split + 1 < others.len() {
        held /= axes[others[split]].levels.len();
        split += 1;
    }
    if held > MOST_CURVES {
        return Vec::new();
    }
    let (front, back) = others.split_at(split);
    combinations(axes, front)
        .into_iter()
        .map(|fixed| {
            let curves = combinations(axes, back)
                .into_iter()
                .map(|varied| curve(axes, x, &[fixed.clone(), varied].concat(), back, values))
                .collect();
            let responses = Responses {
                x_title: title(axes[x].title()),
                log_x: axes[x].spacing == Spacing::Logarithmic,
                log_y: false,
                y_title: title(quantity),
                legend_title: match back {
                    [axis] => symbol(axes[*axis].title()),
                    _ => String::new(),
                },
                curves,
            };
            let suffix: String = fixed
                .iter()
                .map(|&(axis, level)| format!("-{}", file_word(&axes[axis].levels[level].labels.join("-"))))
                .collect();
            (format!("{quantity}{suffix}"), pictures::response(&responses))
        })
        .collect()
}

/// Levels of some axes: pairs of axis and level.
type Levels = Vec<(usize, usize)>;

/// Every combination of levels of these axes, the last fastest.
fn combinations(axes: &[Axis], of: &[usize]) -> Vec<Levels> {
    of.iter().fold(vec![Vec::new()], |combinations, &axis| {
        let with = |level| {
            combinations
                .iter()
                .map(move |levels| [levels.as_slice(), &[(axis, level)]].concat())
        };
        let mut all: Vec<Levels> = (0..axes[axis].levels.len()).flat_map(with).collect();
        all.sort();
        all
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
    pictures::heat_map(&HeatMap {
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
    pictures::bars(&BarChart {
        y_title: title(quantity),
        x_title: title(axes[0].title()),
        legend_title,
        groups,
    })
}

/// A word that every file system takes.
fn file_word(label: &str) -> String {
    label
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || "._-".contains(c) {
                c
            } else {
                '_'
            }
        })
        .collect()
}
