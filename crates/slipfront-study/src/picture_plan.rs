//! The pictures of a study, determined by its axes alone: curves over numeric axes, maps over two of them,
//! bars for names.

use std::collections::HashSet;

use crate::axis::{Axis, Spacing};
use crate::levels::{Levels, combinations, direction_axis};
use crate::plan::Plan;
use crate::study_results::StudyResults;
use crate::summary_values::REDUCTION;

/// Quantities that are drawn, if the study has values for them.
pub(crate) const QUANTITIES: [&str; 3] = ["static_friction_star", "kinetic_friction_star", REDUCTION];

/// Largest number of curves in one picture.
const MOST_CURVES: usize = 9;

/// Largest number of pictures with curves of a quantity; for a larger study, the tables are more useful.
const MOST_PICTURES: usize = 1000;

/// Largest number of characters for the levels in the name of a picture: the length of file names is limited.
const MOST_OF_LEVELS: usize = 100;

/// Name of the picture of friction over the directions of the drive.
pub(crate) const POLAR: &str = "friction_polar";

/// The axis of directions and the combinations of levels of the other axes; none if there is no such axis.
/// Each combination is a curve of every quantity in the polar picture. A sentence if they are too many for
/// one picture.
pub(crate) fn polar(axes: &[Axis]) -> Option<Result<(usize, Vec<Levels>), String>> {
    let over = direction_axis(axes)?;
    let others = others_than(axes, over);
    let count: usize = others.iter().map(|&axis| axes[axis].levels.len()).product();
    Some(if 2 * count <= MOST_CURVES {
        Ok((over, combinations(axes, &others)))
    } else {
        Err(format!(
            "there is no polar picture: it would have {} curves, two for each combination of the levels of the other axes, but \
             at most {MOST_CURVES} are possible; anisotropy.csv contains the values",
            2 * count
        ))
    })
}

/// A picture to be drawn.
pub(crate) struct PlannedPicture {
    /// Name of the picture's files.
    pub(crate) name: String,
    pub(crate) kind: PictureKind,
}

/// Kind of a picture; axes and levels are given by their positions.
pub(crate) enum PictureKind {
    /// A bar for each name of one axis, or groups of bars for two.
    Bars,
    /// Curves over axis `x`, one for each combination of levels of the `varied` axes, at these levels of the
    /// others.
    Curves {
        x: usize,
        fixed: Levels,
        varied: Vec<usize>,
    },
    /// A map over two axes.
    Map { x: usize, y: usize },
}

/// The quantities for which the study has a value at some point: runs that stop at the onset have no kinetic
/// friction, and a study without a reference has no reduction.
pub(crate) fn measured_quantities(plan: &Plan, results: &StudyResults) -> Vec<&'static str> {
    let has = |quantity: &&str| {
        let mut points = 0..plan.points.len();
        points.any(|position| results.sample(plan, position, quantity).is_some())
    };
    QUANTITIES.into_iter().filter(has).collect()
}

/// A sentence for each quantity that a study of this kind draws, if this study has no value of it.
pub fn quantities_without_pictures(plan: &Plan, results: &StudyResults) -> Vec<String> {
    let measured = measured_quantities(plan, results);
    let expected = |quantity: &&str| plan.has_reference() || *quantity != REDUCTION;
    let missing = QUANTITIES.into_iter().filter(expected);
    let missing = missing.filter(|quantity| !measured.contains(quantity));
    missing
        .map(|quantity| format!("there is no picture of {quantity}: no run has a value"))
        .collect()
}

/// Sentences on why a study with these axes has no curves or bars, and no polar picture of its directions;
/// none for pictures that it has.
pub fn why_no_pictures(axes: &[Axis]) -> Vec<String> {
    let polar = polar(axes).and_then(Result::err);
    why_no_curves(axes).into_iter().chain(polar).collect()
}

fn why_no_curves(axes: &[Axis]) -> Option<String> {
    let why = planned_charts(axes, QUANTITIES[0]).err()?;
    let values = match map_of(axes) {
        Some(_) => "the map shows the values",
        None => "points.csv has the values",
    };
    Some(format!("there are no pictures of curves: {why}; {values}"))
}

/// The pictures of a quantity apart from a map; a sentence if there are none.
fn planned_charts(axes: &[Axis], quantity: &str) -> Result<Vec<PlannedPicture>, String> {
    let mut over = numeric(axes).into_iter().map(|x| (x, split(axes, x)));
    match (over.next(), axes.len()) {
        (None, 0) => Err("the study has no axis".to_owned()),
        (None, 1 | 2) => Ok(vec![PlannedPicture {
            name: quantity.to_owned(),
            kind: PictureKind::Bars,
        }]),
        (None, count) => Err(format!(
            "none of its {count} axes is numeric, and bars need one or two axes"
        )),
        (Some((x, Ok(split))), _) => Ok(planned_curves(axes, x, split, quantity)),
        // Another axis may need fewer curves or pictures.
        (Some((_, Err(why))), _) => over
            .find_map(|(x, split)| Some(planned_curves(axes, x, split.ok()?, quantity)))
            .ok_or(why),
    }
}

/// The numeric axes.
fn numeric(axes: &[Axis]) -> Vec<usize> {
    let axes = axes.iter().enumerate();
    axes.filter(|(_, axis)| axis.spacing != Spacing::Named)
        .map(|(position, _)| position)
        .collect()
}

/// The axes of a study that has exactly two, if both are numeric.
fn map_of(axes: &[Axis]) -> Option<[usize; 2]> {
    let numeric: [usize; 2] = numeric(axes).try_into().ok()?;
    (axes.len() == 2).then_some(numeric)
}

/// The pictures of a quantity, determined by the axes alone.
pub(crate) fn planned(axes: &[Axis], quantity: &str) -> Vec<PlannedPicture> {
    let mut pictures = planned_charts(axes, quantity).unwrap_or_default();
    if let Some([x, y]) = map_of(axes) {
        pictures.push(PlannedPicture {
            name: format!("{quantity}_map"),
            kind: PictureKind::Map { x, y },
        });
    }
    pictures
}

/// All axes but one.
fn others_than(axes: &[Axis], x: usize) -> Vec<usize> {
    (0..axes.len()).filter(|&axis| axis != x).collect()
}

/// Number of leading axes, not counting `x`, with a separate picture for each level, so that each picture has
/// few enough curves; a sentence if there would still be too many curves, or too many pictures.
fn split(axes: &[Axis], x: usize) -> Result<usize, String> {
    let others = others_than(axes, x);
    let count: usize = others.iter().map(|&axis| axes[axis].levels.len()).product();
    let mut held = count;
    let mut split = 0;
    while held > MOST_CURVES && split + 1 < others.len() {
        held /= axes[others[split]].levels.len();
        split += 1;
    }
    if held > MOST_CURVES {
        return Err(format!(
            "a picture would have {held} curves, one for each level of `{}`, but at most {MOST_CURVES} are possible",
            axes[others[split]].columns.join(" ")
        ));
    }
    match count / held {
        pictures if pictures > MOST_PICTURES => Err(format!(
            "they would need {pictures} pictures, more than {MOST_PICTURES}"
        )),
        _ => Ok(split),
    }
}

/// Curves over axis `x`, one for each combination of levels of the other axes; the levels of the first
/// `split` of them have separate pictures.
fn planned_curves(axes: &[Axis], x: usize, split: usize, quantity: &str) -> Vec<PlannedPicture> {
    let others = others_than(axes, x);
    let (front, back) = others.split_at(split);
    let picture = |fixed: Levels| {
        let labels = fixed
            .iter()
            .flat_map(|&(axis, level)| &axes[axis].levels[level].labels);
        let letters = labels.flat_map(|label| ['-'].into_iter().chain(label.chars()));
        // Some file systems do not allow other characters in names.
        let is_allowed = |letter: char| letter.is_ascii_alphanumeric() || "._-".contains(letter);
        let letters = letters.map(|letter| if is_allowed(letter) { letter } else { '_' });
        let suffix: String = letters.take(MOST_OF_LEVELS).collect();
        PlannedPicture {
            name: format!("{quantity}{suffix}"),
            kind: PictureKind::Curves {
                x,
                fixed,
                varied: back.to_vec(),
            },
        }
    };
    let mut pictures: Vec<PlannedPicture> = combinations(axes, front).into_iter().map(picture).collect();
    // After characters are replaced or the end is cut off, names can be equal: then each gets a number.
    let names: HashSet<&String> = pictures.iter().map(|picture| &picture.name).collect();
    if names.len() < pictures.len() {
        for (k, picture) in pictures.iter_mut().enumerate() {
            picture.name += &format!("_{}", k + 1);
        }
    }
    pictures
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study_file::StudyFile;

    fn axes_of(axes: &str) -> Vec<Axis> {
        let text = format!("base.slider.blocks = [2, 2]\n{axes}");
        StudyFile::parse(&text, "study.toml", "study", Path::new(""))
            .unwrap()
            .axes
    }

    fn names_of(axes: &str) -> Vec<String> {
        let planned = planned(&axes_of(axes), "static_friction_star").into_iter();
        planned.map(|picture| picture.name).collect()
    }

    /// Every picture has a distinct name, whatever the names of the levels, and no name is too long.
    #[test]
    fn every_picture_has_a_name_of_its_own() {
        let long = "x".repeat(300);
        let rest = "[[axes]]\nkey = 'load.pressure'\nlist = ['1 MPa', '2 MPa']\n\
                    [[axes]]\nkey = 'drive.v_star'\nlist = [0.1, 0.2, 0.3, 0.4, 0.5]";
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

    /// The number of pictures is limited, although a line of a file can ask for a million.
    #[test]
    fn more_pictures_than_anyone_looks_at_are_not_drawn() {
        let surfaces: String = (0..1001)
            .map(|k| format!("s{k} = {{ friction.seed = {k} }}, "))
            .collect();
        let many = &format!(
            "[[axes]]\nname = 'surface'\nvariants = {{ {surfaces} }}\n[[axes]]\nkey = 'drive.v_star'\nlinspace = [0.1, 0.2, 100]\n\
             [[axes]]\nkey = 'load.pressure'\nlist = ['1 MPa', '2 MPa']"
        );
        assert!(names_of(many).is_empty());
        let why = why_no_curves(&axes_of(many)).unwrap();
        let expected = "there are no pictures of curves: they would need 1001 pictures, more than 1000; points.csv has the values";
        assert_eq!(why, expected);
    }

    /// The axis over which curves are drawn, or the reason why there are none.
    #[test]
    fn curves_that_are_left_out_have_a_reason() {
        let axis =
            |key: &str, count: usize| format!("[[axes]]\nkey = '{key}'\nlinspace = [0.1, 0.5, {count}]\n");
        let two = |counts: [usize; 2]| {
            let [one, other] = counts;
            axes_of(&(axis("drive.v_star", one) + &axis("friction.r_star", other)))
        };
        let over = |axes: &[Axis]| match planned_charts(axes, "quantity").ok()?[0].kind {
            PictureKind::Curves { x, .. } => Some(x),
            _ => None,
        };
        for (counts, x) in [
            ([20, 9], Some(0)),
            ([9, 20], Some(1)),
            ([9, 9], Some(0)),
            ([10, 10], None),
        ] {
            let axes = two(counts);
            assert_eq!(over(&axes), x, "{counts:?}");
            assert_eq!(why_no_curves(&axes).is_some(), x.is_none(), "{counts:?}");
        }
        let expected = "there are no pictures of curves: a picture would have 10 curves, one for each level of \
                        `friction.r_star`, but at most 9 are possible; the map shows the values";
        assert_eq!(why_no_curves(&two([10, 10])).unwrap(), expected);
        let names = "[[axes]]\nkey = 'slider.edges'\nlist = ['free', 'periodic']\n[[axes]]\nkey = 'friction.redraw'\nlist = [true, false]\n\
                     [[axes]]\nkey = 'load.redistribute'\nlist = [true, false]";
        let why = why_no_curves(&axes_of(names)).unwrap();
        assert!(why.contains("none of its 3 axes is numeric"), "{why}");
        assert!(why_no_curves(&[]).unwrap().contains("no axis"));
        assert!(why_no_curves(&axes_of("[[axes]]\nkey = 'slider.edges'\nlist = ['free']")).is_none());
    }
}
