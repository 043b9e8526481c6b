//! Named patterns, such as a designer would draw without a search. A search begins with them.

use std::f64::consts::FRAC_PI_2;

use crate::limits::Limits;
use crate::patch::{Form, Patch, PatchDraft};
use crate::slider_blocks::{SliderBlocks, count};

/// A pattern and its name.
#[derive(Clone, Debug)]
pub(crate) struct Named {
    /// Name of the pattern.
    pub(crate) name: String,
    /// Draft of the pattern.
    pub(crate) draft: PatchDraft,
}

impl Named {
    /// A mask as a pattern.
    pub(crate) fn drawn(grid: &SliderBlocks, name: &str, textured: &[bool]) -> Self {
        Self {
            name: name.to_owned(),
            draft: PatchDraft::drawn(grid, textured),
        }
    }
}

/// Name of the pattern that serves as a reference.
pub(crate) const GROOVE: &str = "groove across";

/// Legal named patterns, each with a texture that covers as much as the limits allow; fewer once `ends`
/// returns true.
pub(crate) fn named(
    grid: &SliderBlocks,
    limits: &Limits,
    ends: &dyn Fn() -> bool,
) -> Vec<(Named, Vec<bool>)> {
    let percent = limits.coverage[1];
    // A strip has an odd number of blocks across if it is centred on a block, and an even number if it is
    // centred on an edge.
    let [edges, middles] = [0.0, 0.5].map(|shift| shifted(grid, percent, shift));
    let textured = |named: Named| Some((limits.texture(grid, &named.draft).ok()?, named));
    let larger = |(one, other): (Named, Named)| {
        let both = [textured(one), textured(other)].into_iter().flatten();
        both.max_by_key(|(texture, _)| count(texture))
            .map(|(texture, named)| (named, texture))
    };
    let pairs = edges.into_iter().zip(middles).take_while(|_| !ends());
    pairs.filter_map(larger).collect()
}

/// Named patterns with their strips and cavities shifted by `shift` blocks: one, two or three grooves across
/// and along the sliding direction (x unless the drive is rotated), a tilted groove, a frame, a cross, and
/// one or several round or square cavities.
fn shifted(grid: &SliderBlocks, percent: f64, shift: f64) -> Vec<Named> {
    let size = grid.size().map(|n| n as f64);
    let strip = |axis: usize, place: f64, angle: f64| {
        let mut center = size.map(|n| 0.5 * n);
        center[axis] = place * size[axis] + shift;
        Patch {
            center,
            half: [size[0] + size[1], 0.0],
            angle,
            form: Form::Rectangle,
        }
    };
    let across = |place: f64| strip(0, place, FRAC_PI_2);
    let along = |place: f64| strip(1, place, 0.0);
    let cavities = |columns: usize, rows: usize, form: Form| -> Vec<Patch> {
        let place = |k: usize, n: usize, axis: usize| (k as f64 + 0.5) / n as f64 * size[axis];
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        let cavity = |[column, row]: [usize; 2]| Patch {
            center: [place(column, columns, 0) + shift, place(row, rows, 1) + shift],
            half: [0.5, 0.5],
            angle: 0.0,
            form,
        };
        cells.map(cavity).collect()
    };
    let frame = || vec![across(0.0), across(1.0), along(0.0), along(1.0)];
    let [third, quarter] = [1.0 / 3.0, 0.25];
    let patterns: Vec<(&str, Vec<Patch>)> = vec![
        (GROOVE, vec![across(0.5)]),
        ("groove along", vec![along(0.5)]),
        (
            "two grooves across at 1/4 and 3/4",
            vec![across(quarter), across(1.0 - quarter)],
        ),
        (
            "two grooves across at 1/3 and 2/3",
            vec![across(third), across(1.0 - third)],
        ),
        (
            "two grooves along at 1/4 and 3/4",
            vec![along(quarter), along(1.0 - quarter)],
        ),
        (
            "three grooves across",
            [1.0, 3.0, 5.0].map(|place| across(place / 6.0)).to_vec(),
        ),
        ("grooves at the edges across", vec![across(0.0), across(1.0)]),
        ("grooves at the edges along", vec![along(0.0), along(1.0)]),
        (
            "groove tilted by 30 degrees",
            vec![strip(0, 0.5, third * FRAC_PI_2)],
        ),
        (
            "groove tilted by 60 degrees",
            vec![strip(0, 0.5, 2.0 * third * FRAC_PI_2)],
        ),
        ("frame", frame()),
        ("cross", vec![across(0.5), along(0.5)]),
        ("round cavity", cavities(1, 1, Form::Ellipse)),
        ("square cavity", cavities(1, 1, Form::Rectangle)),
        ("2 x 2 round cavities", cavities(2, 2, Form::Ellipse)),
        ("2 x 2 square cavities", cavities(2, 2, Form::Rectangle)),
        ("3 x 3 round cavities", cavities(3, 3, Form::Ellipse)),
        ("3 x 3 square cavities", cavities(3, 3, Form::Rectangle)),
        ("5 x 5 square cavities", cavities(5, 5, Form::Rectangle)),
    ];
    let pattern = |(name, patches): (&str, Vec<Patch>)| Named {
        name: name.to_owned(),
        draft: PatchDraft {
            patches,
            drawn: None,
            percent,
        },
    };
    patterns.into_iter().map(pattern).collect()
}
