//! Which pictures a study has, by its axes alone: curves over numbers, maps over two of them, bars for names.

use std::collections::HashSet;

use super::axis::{Axis, Spacing};
use super::summary_values::REDUCTION;

/// Quantities that are drawn, if the study has values of them.
pub(super) const QUANTITIES: [&str; 3] = ["static_friction_star", "kinetic_friction_star", REDUCTION];

/// Most curves in one picture.
const MOST_CURVES: usize = 9;

/// Most pictures of curves of a quantity; for a larger study the tables serve better.
const MOST_PICTURES: usize = 1000;

/// Most characters of the levels in the name of a picture: the length of file names is limited.
const MOST_OF_LEVELS: usize = 100;

/// Names of all pictures that a study of these axes may get.
pub(super) fn names(axes: &[Axis]) -> impl Iterator<Item = String> {
    let pictures = QUANTITIES
        .into_iter()
        .flat_map(|quantity| planned(axes, quantity));
    pictures.map(|picture| picture.name)
}

/// A picture to be drawn.
pub(super) struct PlannedPicture {
    /// Name of its files.
    pub(super) name: String,
    #[cfg_attr(not(feature = "plot"), allow(dead_code))]
    pub(super) kind: PictureKind,
}

/// What a picture shows; axes and levels are given by their positions.
#[cfg_attr(not(feature = "plot"), allow(dead_code))]
pub(super) enum PictureKind {
    /// A bar for each name of one axis, or groups of bars for two.
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
pub(super) fn planned(axes: &[Axis], quantity: &str) -> Vec<PlannedPicture> {
    let numeric: Vec<usize> = (0..axes.len())
        .filter(|&axis| axes[axis].spacing != Spacing::Named)
        .collect();
    match (numeric.first(), axes.len()) {
        (None, 1 | 2) => vec![PlannedPicture {
            name: quantity.to_owned(),
            kind: PictureKind::Bars,
        }],
        // There is nothing to draw, or there are names on three axes or more: the tables serve better.
        (None, _) => Vec::new(),
        (Some(&x), _) => {
            let mut pictures = planned_curves(axes, x, quantity);
            if let (&[x, y], 2) = (numeric.as_slice(), axes.len()) {
                pictures.push(PlannedPicture {
                    name: format!("{quantity}_map"),
                    kind: PictureKind::Map { x, y },
                });
            }
            pictures
        }
    }
}

/// Curves over axis `x`, one for each combination of levels of the other axes, on as many pictures as they need.
fn planned_curves(axes: &[Axis], x: usize, quantity: &str) -> Vec<PlannedPicture> {
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
    let picture = |fixed: Levels| {
        let labels = fixed
            .iter()
            .flat_map(|&(axis, level)| &axes[axis].levels[level].labels);
        let letters = labels.flat_map(|label| ['-'].into_iter().chain(label.chars()));
        // Some file systems allow no other letters in names.
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
    // Names can be equal once characters are replaced or the end is cut off: then each gets a number.
    let names: HashSet<&String> = pictures.iter().map(|picture| &picture.name).collect();
    if names.len() < pictures.len() {
        for (k, picture) in pictures.iter_mut().enumerate() {
            picture.name += &format!("_{}", k + 1);
        }
    }
    pictures
}

/// Levels of some axes: pairs of axis and level.
pub(super) type Levels = Vec<(usize, usize)>;

/// Every combination of levels of these axes, the last fastest.
pub(super) fn combinations(axes: &[Axis], of: &[usize]) -> Vec<Levels> {
    let mut all = vec![Levels::new()];
    for &axis in of {
        let levels = 0..axes[axis].levels.len();
        let with_each = |earlier: Levels| {
            let with = move |level| [earlier.as_slice(), &[(axis, level)]].concat();
            levels.clone().map(with)
        };
        all = all.into_iter().flat_map(with_each).collect();
    }
    all
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::study::study_file::StudyFile;

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
