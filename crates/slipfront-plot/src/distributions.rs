//! Distributions of several quantities: for each, the number of values at or above x.

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::frame::{LOWER_ROOM, left_room, numbered_sides, right_end};
use crate::geometry::Area;
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::series::segments;
use crate::size::PictureSize;
use crate::style::{COLUMN_WIDTH, MARGIN, RADIUS_MARKER, curve_style};
use crate::ticks::{Direction, MAX_STEPS};

/// Usual height of a panel.
const HEIGHT: f64 = 400.0;
/// Distance between the numbers of a panel and the panel below.
const GAP: f64 = 18.0;
/// Room right of a panel for the last number below it, half of which may extend beyond the panel.
const RIGHT: f64 = 34.0;

/// Values of a quantity, and the words for them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Distribution {
    /// Quantity of the values.
    pub x_title: String,
    /// Words for the number of values that are as large or larger.
    pub y_title: String,
    /// The values, in any order; values that are not positive are not drawn.
    pub values: Vec<f64>,
}

/// Draws a panel for each quantity, one below the other: the number of values at or above x against x, on
/// logarithmic axes, on which a power law is a straight line. The picture is usually as wide as a journal's
/// column (85 mm).
///
/// # Errors
///
/// No distribution, or a size that leaves no room for the panels.
pub fn distributions(
    distributions: &[Distribution],
    note: &str,
    size: PictureSize,
) -> Result<Picture, PictureError> {
    if distributions.is_empty() {
        return Err(PictureError::Nothing("distribution"));
    }
    let curves: Vec<Steps> = distributions.iter().map(Steps::new).collect();
    let width = size.roomy_width(COLUMN_WIDTH)?;
    let left = curves
        .iter()
        .map(|curve| left_room(&curve.y.placed(HEIGHT, 0.0).ticks(Direction::Y, MAX_STEPS)));
    let left = left.fold(0.0, f64::max);
    let right = curves.iter().fold((width - RIGHT).round(), |right, curve| {
        let ticks = curve.x.placed(left, right).ticks(Direction::X, MAX_STEPS);
        right_end(&ticks, left, right, width)
    });
    let note = Note::new(note, 0.5 * (left + right), width);
    let count = curves.len() as f64;
    let beside = MARGIN + count * LOWER_ROOM + (count - 1.0) * GAP + note.height;
    let height = size.panel(HEIGHT, beside, curves.len())?;
    let mut canvas = Canvas::sized(width, beside + count * height, size);
    let mut top = MARGIN;
    for (curve, distribution) in curves.iter().zip(distributions) {
        let area = Area::new(left, top, right - left, height);
        curve.draw(&mut canvas, area, distribution);
        top = area.bottom() + LOWER_ROOM + GAP;
    }
    note.draw(&mut canvas);
    canvas.finish()
}

/// The number of values as a function of x, which falls in steps.
struct Steps {
    x: DrawnAxis,
    y: DrawnAxis,
    /// The values in rising order.
    values: Vec<f64>,
}

impl Steps {
    fn new(distribution: &Distribution) -> Self {
        let values = distribution.values.iter().copied();
        let mut values: Vec<f64> = values.filter(|value| drawable(*value) && *value > 0.0).collect();
        values.sort_unstable_by(f64::total_cmp);
        // At least one decade, so that the numbers of the axis are whole.
        let most = values.len().max(10) as f64;
        Self {
            x: DrawnAxis::around(&values, true, 0.04),
            y: DrawnAxis::around(&[1.0, most], true, 0.06),
            values,
        }
    }

    /// The corners of the steps: values and numbers.
    fn corners(&self) -> Vec<(f64, f64)> {
        let n = self.values.len();
        let corner = |k: usize| {
            let (value, number) = (self.values[k], (n - k) as f64);
            // Horizontal from the previous value at this number, then down.
            let before = self.values[k.saturating_sub(1)];
            [(before, number), (value, number)]
        };
        (0..n).flat_map(corner).collect()
    }

    fn draw(&self, canvas: &mut Canvas, area: Area, distribution: &Distribution) {
        let (x, y) = (
            self.x.placed(area.x, area.right()),
            self.y.placed(area.bottom(), area.y),
        );
        let titles = [&*distribution.x_title, &*distribution.y_title];
        numbered_sides(canvas, area, [&x, &y], titles);
        let corners = self.corners();
        for segment in segments(corners.iter().copied(), &x, &y) {
            if let (Some(&first), true) = (segment.first(), corners.len() == 2) {
                canvas.dot(first, RADIUS_MARKER, curve_style(0).colour);
            }
            canvas.curve(segment, curve_style(0));
        }
        canvas.frame(area);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn distribution(values: &[f64]) -> Distribution {
        Distribution {
            x_title: "moment".to_owned(),
            y_title: "events".to_owned(),
            values: values.to_vec(),
        }
    }

    #[test]
    fn numbers_fall_by_one_at_every_value() {
        let steps = Steps::new(&distribution(&[4.0, f64::NAN, 1.0, -3.0, 4.0, 0.0]));
        let (x, number): (Vec<f64>, Vec<f64>) = steps.corners().into_iter().unzip();
        assert_eq!(x, [1.0, 1.0, 1.0, 4.0, 4.0, 4.0]);
        assert_eq!(number, [3.0, 3.0, 2.0, 2.0, 1.0, 1.0]);
    }

    #[test]
    fn poor_values_are_drawn_all_the_same() {
        for values in [
            &[][..],
            &[1.0],
            &[2.0, 2.0],
            &[f64::MAX, 1e-320],
            &[-1.0, f64::NAN],
        ] {
            let drawn = distributions(
                &[distribution(values), distribution(&[1.0, 2.0])],
                "",
                PictureSize::default(),
            );
            let svg = drawn.unwrap().svg;
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{values:?}");
        }
        let none = distributions(&[], "", PictureSize::default()).unwrap_err();
        assert_eq!(none.to_string(), "there is no distribution to draw");
    }
}
