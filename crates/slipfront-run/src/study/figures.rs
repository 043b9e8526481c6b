//! Which pictures a study gets: curves over numbers, maps over two of them, bars for names.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;

use super::axis::{Axis, Spacing};
use super::error::StudyError;
use super::plan::Plan;
use super::scheduler::StudyResults;
use super::summary_values::REDUCTION;
use super::tables::sample;
use slipfront_plot::{
    Bar, BarChart, BarGroup, HeatAxis, HeatMap, Picture, PictureError, Response, Responses, symbol, title,
};

/// What is drawn, where the study has it.
pub(super) const QUANTITIES: [&str; 3] = ["static_friction_star", "kinetic_friction_star", REDUCTION];

/// Most curves in one picture.
const MOST_CURVES: usize = 9;

/// Most pictures of curves of a quantity: who has more looks at the tables.
const MOST_PICTURES: usize = 1000;

/// Most characters of the levels in the name of a picture: names of files are bounded.
const MOST_OF_LEVELS: usize = 100;

/// Names of all pictures that a study of these axes may get.
pub(super) fn names(axes: &[Axis]) -> impl Iterator<Item = String> {
    QUANTITIES
        .into_iter()
        .flat_map(|quantity| sketches(axes, quantity))
        .map(|sketch| sketch.name)
}

/// Draws the pictures of a study, each with the name of its files.
///
/// # Errors
/// When one cannot be drawn.
pub(super) fn draw(plan: &Plan, results: &StudyResults) -> Result<Vec<(String, Picture)>, StudyError> {
    let axes = &plan.axes;
    let of_quantity = |quantity: &&str| -> Result<Vec<(String, Picture)>, StudyError> {
        let values = Values::of(plan, results, quantity);
        // A study that stops at the onset knows no kinetic friction, one without reference no reduction.
        if values.0.values().all(|[mean, ..]| mean.is_nan()) {
            return Ok(Vec::new());
        }
        let drawn = sketches(axes, quantity).into_iter().map(|Sketch { name, kind }| {
            let picture = match &kind {
                Kind::Bars => bars(axes, quantity, &values),
                Kind::Curves { x, fixed, varied } => curves(axes, *x, fixed, varied, quantity, &values),
                Kind::Map { x, y } => map(axes, *x, *y, quantity, &values),
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

/// Mean and interval of a quantity by the levels of a point; not a number where it has none.
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

    /// At the point with these levels; a shard lacks most of them.
    fn at(&self, levels: &[usize]) -> [f64; 3] {
        self.0.get(levels).copied().unwrap_or([f64::NAN; 3])
    }
}

/// A picture before it is drawn.
struct Sketch {
    name: String,
    kind: Kind,
}

enum Kind {
    /// Bars for names.
    Bars,
    /// Curves over axis `x`, one for each combination of levels of the `varied` axes, at these levels of the others.
    Curves {
        x: usize,
        fixed: Levels,
        varied: Vec<usize>,
    },
    /// A map over two axes.
    Map { x: usize, y: usize },
}

/// The pictures of a quantity, by the axes alone.
fn sketches(axes: &[Axis], quantity: &str) -> Vec<Sketch> {
    let numeric: Vec<usize> = (0..axes.len())
        .filter(|&axis| axes[axis].spacing != Spacing::Named)
        .collect();
    match (numeric.first(), axes.len()) {
        (_, 0) => Vec::new(),
        (None, 1 | 2) => vec![Sketch {
            name: quantity.to_owned(),
            kind: Kind::Bars,
        }],
        // Names alone on three axes or more: the tables serve better.
        (None, _) => Vec::new(),
        (Some(&x), _) => {
            let mut sketches = sketches_of_curves(axes, x, quantity);
            if let (&[x, y], 2) = (numeric.as_slice(), axes.len()) {
                sketches.push(Sketch {
                    name: format!("{quantity}_map"),
                    kind: Kind::Map { x, y },
                });
            }
            sketches
        }
    }
}

/// Curves over axis `x`, one for each combination of levels of the others; more pictures where these are many.
fn sketches_of_curves(axes: &[Axis], x: usize, quantity: &str) -> Vec<Sketch> {
    let others: Vec<usize> = (0..axes.len()).filter(|&axis| axis != x).collect();
    let count: usize = others.iter().map(|&axis| axes[axis].levels.len()).product();
    // The axes in front are split off into pictures of their own until one picture can hold the rest.
    let mut held = count;
    let mut split = 0;
    while held > MOST_CURVES && split + 1 < others.len() {
        held /= axes[others[split]].levels.len();
        split += 1;
    }
    if held > MOST_CURVES || count / held > MOST_PICTURES {
        return Vec::new();
    }
    let (front, back) = others.split_at(split);
    let sketch = |fixed: Levels| {
        let labels = fixed
            .iter()
            .flat_map(|&(axis, level)| &axes[axis].levels[level].labels);
        let letters = labels.flat_map(|label| ['-'].into_iter().chain(label.chars()));
        let suffix: String = letters.map(for_file).take(MOST_OF_LEVELS).collect();
        Sketch {
            name: format!("{quantity}{suffix}"),
            kind: Kind::Curves {
                x,
                fixed,
                varied: back.to_vec(),
            },
        }
    };
    let mut sketches: Vec<Sketch> = combinations(axes, front).into_iter().map(sketch).collect();
    // Names that differ only in what a file name does not take, or late, are told apart by their number.
    let names: HashSet<&String> = sketches.iter().map(|sketch| &sketch.name).collect();
    if names.len() < sketches.len() {
        for (k, sketch) in sketches.iter_mut().enumerate() {
            sketch.name += &format!("_{}", k + 1);
        }
    }
    sketches
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

/// A letter as every file system takes it.
fn for_file(letter: char) -> char {
    if letter.is_ascii_alphanumeric() || "._-".contains(letter) {
        letter
    } else {
        '_'
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::StudyFile;

    fn names_of(axes: &str) -> Vec<String> {
        let text = format!("base.slider.blocks = [2, 2]\n{axes}");
        let file = StudyFile::parse(&text, "study.toml", "study", Path::new("")).unwrap();
        names(&file.axes)
            .filter(|name| name.starts_with("static_friction_star"))
            .collect()
    }

    /// Whatever the levels are called: no picture takes the place of another, and no name is longer than one can be.
    #[test]
    fn every_picture_has_a_name_of_its_own() {
        let long = "x".repeat(300);
        let rest = "[[axes]]\nkey = 'load.pressure'\nlist = ['1 MPa', '2 MPa', '3 MPa', '4 MPa', '5 MPa']\n\
                    [[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]";
        for [one, other] in [
            ["rau \u{b5}", "rau \u{3c3}"],
            ["a b", "a_b"],
            [&long, &format!("{long}y")],
        ] {
            let variants = format!(
                "[[axes]]\nname = 'surface'\nvariants = {{ '{one}' = {{ drive.direction = 0 }}, '{other}' = {{ drive.direction = 1 }} }}\n"
            );
            let names = names_of(&format!("{variants}{rest}"));
            let distinct: HashSet<&String> = names.iter().collect();
            assert_eq!((names.len(), distinct.len()), (2, 2), "{names:?}");
            assert!(names.iter().all(|name| name.len() < 200), "{names:?}");
        }
        assert_eq!(
            names_of("[[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2]"),
            ["static_friction_star"]
        );
    }

    /// A line of a file can ask for a million.
    #[test]
    fn more_pictures_than_anyone_looks_at_are_not_drawn() {
        let many = "[[axes]]\nkey = 'drive.v_star'\nlinspace = [0.1, 0.2, 100]\n\
                    [[axes]]\nkey = 'drive.direction'\nlinspace = [0, 1, 2000]\n\
                    [[axes]]\nkey = 'load.pressure'\nlist = ['1 MPa', '2 MPa']";
        assert!(names_of(many).is_empty());
    }
}
