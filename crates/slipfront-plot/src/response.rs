//! Response curves of a parametric study, with confidence bands.

use serde::{Deserialize, Serialize};

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::frame::{LOWER_ROOM, left_room, left_side, lower_side, right_end, short_ticks, upright_room};
use crate::geometry::Area;
use crate::legend::{Legend, LegendSample};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::{PictureError, check_columns};
use crate::series::{cross, error_bar, interval, marker, segments};
use crate::size::PictureSize;
use crate::style::{COLUMN_WIDTH, GREY, MARGIN, RADIUS_MARKER, WIDTH_LEADER, curve_style};
use crate::text::Text;
use crate::ticks::{Direction, MAX_STEPS};

const HEIGHT: f64 = 560.0;
/// Room right of the panel for the last number below it, half of which may extend beyond the panel.
const RIGHT: f64 = 34.0;

/// Response curves over one axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Responses {
    /// Quantity of x; see [`title`](crate::QuantityLabel::title).
    pub x_title: String,
    /// Whether x is logarithmic; without effect if an x is not positive.
    pub log_x: bool,
    /// Whether y is logarithmic; without effect if a y is not positive.
    pub log_y: bool,
    /// Quantity that the curves show.
    pub y_title: String,
    /// Quantity of the curves' labels, for the legend; see [`legend`](crate::QuantityLabel::legend).
    pub legend_title: String,
    /// Meaning of the intervals, below the panel; may be empty.
    pub note: String,
    /// The curves.
    pub curves: Vec<Response>,
}

/// One response curve, a point for every value of an axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Response {
    /// Name of the curve in the legend; shown only if there are other curves.
    pub label: String,
    /// Abscissae of the points, in any order.
    pub x: Vec<f64>,
    /// The mean at every point; NaN leaves a gap.
    pub mean: Vec<f64>,
    /// The lower end of every mean's confidence interval; NaN where there is none.
    pub low: Vec<f64>,
    /// The upper end of every mean's confidence interval; NaN where there is none.
    pub high: Vec<f64>,
    /// Marks of points that get a cross, on their marker or, without a mean, on the lower side; may be empty.
    #[serde(default)]
    pub crossed: Vec<bool>,
    /// Whether the curve is a formula or a level rather than a result: it is drawn as a line through its
    /// points, without markers.
    pub line: bool,
}

/// Refuses an empty list of curves, and a curve whose columns differ in length; `counted` names its
/// abscissae.
pub(crate) fn check_curves(curves: &[Response], counted: &'static str) -> Result<(), PictureError> {
    if curves.is_empty() {
        return Err(PictureError::Nothing("curve"));
    }
    curves.iter().try_for_each(|curve| {
        let columns = [
            ("its mean", curve.mean.len()),
            ("its low", curve.low.len()),
            ("its high", curve.high.len()),
        ];
        check_columns(&curve.label, (counted, curve.x.len()), &columns)
    })
}

/// Draws means with their confidence bands, usually as wide as a journal's column (85 mm).
///
/// The y axis starts where the values do, not at zero. A point without neighbours has an error bar in place
/// of a band. Several curves have a legend above, and markers of different shapes.
///
/// # Errors
///
/// No curve, a curve whose columns differ in length, or a size that leaves no room for the curves.
pub fn response(responses: &Responses, size: PictureSize) -> Result<Picture, PictureError> {
    check_curves(&responses.curves, "points")?;
    let curves: Vec<Response> = responses.curves.iter().map(sorted).collect();
    let xs: Vec<f64> = curves.iter().flat_map(|curve| curve.x.clone()).collect();
    let x = DrawnAxis::around(&xs, responses.log_x, 0.04);
    let ys: Vec<f64> = curves.iter().flat_map(values).collect();
    let y = DrawnAxis::around(&ys, responses.log_y, 0.06);

    let width = size.roomy_width(COLUMN_WIDTH)?;
    let left = left_room(&y.placed(HEIGHT, 0.0).ticks(Direction::Y, MAX_STEPS));
    let right = (width - RIGHT).round();
    let x_ticks = x.placed(left, right).ticks(Direction::X, MAX_STEPS);
    let right = right_end(&x_ticks, left, right, width);
    let sample = |curve: &Response| {
        if curve.line {
            LegendSample::Line
        } else {
            LegendSample::Marker
        }
    };
    let named = curves.iter().filter(|_| curves.len() > 1);
    let names: Vec<_> = named.map(|curve| (curve.label.as_str(), sample(curve))).collect();
    let legend = Legend::of(&responses.legend_title, &names, left, right);
    let note = Note::of(&responses.note, 0.5 * (left + right), width);
    let top = MARGIN + legend.height;
    let height = size.panel(HEIGHT, top + LOWER_ROOM + note.height, 1)?;
    let area = Area::new(left, top, right - left, height);
    let (x, y) = (x.placed(left, right), y.placed(area.bottom(), area.y));

    let mut canvas = Canvas::sized(width, area.bottom() + LOWER_ROOM + note.height, size);
    draw_sides(&mut canvas, area, &x, &y, responses);
    note.draw(&mut canvas);
    legend.draw(&mut canvas);
    draw_curves(&mut canvas, &x, &y, &curves);
    draw_crosses(&mut canvas, area, &x, &y, &curves);
    canvas.frame(area);
    canvas.finish()
}

/// The curve with its points sorted by x, and with intervals that are complete or NaN.
fn sorted(curve: &Response) -> Response {
    let mut order: Vec<usize> = (0..curve.x.len()).collect();
    order.retain(|&index| drawable(curve.x[index]));
    order.sort_by(|&a, &b| curve.x[a].total_cmp(&curve.x[b]));
    let ends = |&index: &usize| {
        interval(curve.mean[index], curve.low[index], curve.high[index]).unwrap_or((f64::NAN, f64::NAN))
    };
    let (low, high) = order.iter().map(ends).unzip();
    Response {
        label: curve.label.clone(),
        x: order.iter().map(|&index| curve.x[index]).collect(),
        mean: order.iter().map(|&index| curve.mean[index]).collect(),
        low,
        high,
        crossed: order.iter().map(|&index| curve.is_crossed(index)).collect(),
        line: curve.line,
    }
}

impl Response {
    /// The curve through `values` at the abscissae `x`, without intervals.
    pub fn of_values(label: &str, x: &[f64], values: &[f64]) -> Self {
        Self {
            label: label.to_owned(),
            x: x.to_vec(),
            mean: values.to_vec(),
            low: vec![f64::NAN; x.len()],
            high: vec![f64::NAN; x.len()],
            ..Self::default()
        }
    }

    /// The line of the function `value`, drawn through its values at the abscissae `x`.
    pub fn of_formula(label: &str, x: &[f64], value: impl Fn(f64) -> f64) -> Self {
        let values: Vec<f64> = x.iter().map(|&x| value(x)).collect();
        Self {
            line: true,
            ..Self::of_values(label, x, &values)
        }
    }

    /// Whether a point is marked by a cross.
    pub(crate) fn is_crossed(&self, point: usize) -> bool {
        self.crossed.get(point).copied().unwrap_or(false)
    }
}

/// All values that the y axis must hold.
fn values(curve: &Response) -> impl Iterator<Item = f64> {
    [&curve.mean, &curve.low, &curve.high]
        .into_iter()
        .flatten()
        .copied()
}

/// Draws ticks, numbers and titles, and a line at zero.
fn draw_sides(canvas: &mut Canvas, area: Area, x: &DrawnAxis, y: &DrawnAxis, responses: &Responses) {
    let title = Text::fitted(&responses.y_title, upright_room(area, canvas.height));
    left_side(canvas, area, 0.0, &y.ticks(Direction::Y, MAX_STEPS), &title);
    short_ticks(canvas, area, Direction::Y, &y.short_ticks());
    short_ticks(canvas, area, Direction::X, &x.short_ticks());
    let title = Text::fitted(&responses.x_title, area.width);
    lower_side(canvas, area, &x.ticks(Direction::X, MAX_STEPS), &title);
    if !y.is_log && y.lo < 0.0 && y.hi > 0.0 {
        canvas.line((area.x, y.at(0.0)), (area.right(), y.at(0.0)), WIDTH_LEADER, GREY);
    }
}

/// Draws all bands, then all curves, then all points, so that nothing hides a point.
fn draw_curves(canvas: &mut Canvas, x: &DrawnAxis, y: &DrawnAxis, curves: &[Response]) {
    let opacity = if curves.len() > 4 { 0.13 } else { 0.2 };
    let colour = |index: usize| curve_style(index).colour;
    for (index, curve) in curves.iter().enumerate() {
        let lows = segments(&curve.x, &curve.low, x, y);
        let highs = segments(&curve.x, &curve.high, x, y);
        for (low, high) in lows.into_iter().zip(highs) {
            if let ([low], [high]) = (&low[..], &high[..]) {
                error_bar(canvas, low.0, low.1, high.1, colour(index));
            } else {
                let edge = low.into_iter().chain(high.into_iter().rev()).collect();
                canvas.polygon(edge, colour(index), opacity);
            }
        }
    }
    for (index, curve) in curves.iter().enumerate() {
        for segment in segments(&curve.x, &curve.mean, x, y) {
            if segment.len() > 1 {
                canvas.curve(segment, curve_style(index));
            }
        }
    }
    for (index, curve) in curves.iter().enumerate().filter(|(_, curve)| !curve.line) {
        for point in segments(&curve.x, &curve.mean, x, y).concat() {
            marker(canvas, index, point, RADIUS_MARKER, colour(index));
        }
    }
}

/// Draws the crosses of marked points.
fn draw_crosses(canvas: &mut Canvas, area: Area, x: &DrawnAxis, y: &DrawnAxis, curves: &[Response]) {
    /// Height above the lower side of the cross of a point without a mean.
    const LIFT: f64 = 14.0;
    for curve in curves {
        for point in (0..curve.x.len()).filter(|&point| curve.is_crossed(point)) {
            let height = if drawable(curve.mean[point]) {
                y.clamped(curve.mean[point])
            } else {
                area.bottom() - LIFT
            };
            cross(canvas, (x.at(curve.x[point]), height));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve with intervals of 0.1 to both sides.
    fn curve(label: &str, points: &[(f64, f64)]) -> Response {
        let (x, mean): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        Response {
            label: label.to_string(),
            x,
            low: mean.iter().map(|mean| mean - 0.1).collect(),
            high: mean.iter().map(|mean| mean + 0.1).collect(),
            mean,
            ..Response::default()
        }
    }

    fn responses(curves: &[Response], log_x: bool) -> Responses {
        Responses {
            x_title: "x".to_string(),
            y_title: "y".to_string(),
            legend_title: "size".to_string(),
            log_x,
            curves: curves.to_vec(),
            ..Responses::default()
        }
    }

    fn svg(curves: &[Response]) -> String {
        let svg = response(&responses(curves, false), PictureSize::default())
            .unwrap()
            .svg;
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{curves:?}");
        svg
    }

    /// Number of bands: no other polygons have this opacity.
    fn bands(svg: &str) -> usize {
        svg.matches("fill-opacity=\"0.2\"").count()
    }

    #[test]
    fn the_same_curves_give_the_same_bytes_in_any_order_of_points() {
        let there = responses(&[curve("a", &[(1.0, 0.3), (2.0, 0.5), (4.0, 0.1)])], true);
        let back = responses(&[curve("a", &[(4.0, 0.1), (2.0, 0.5), (1.0, 0.3)])], true);
        assert_eq!(
            response(&there, PictureSize::default()).unwrap(),
            response(&back, PictureSize::default()).unwrap()
        );
    }

    #[test]
    fn only_several_curves_have_a_legend() {
        let one = curve("first", &[(1.0, 0.3), (2.0, 0.5)]);
        let two = curve("second", &[(1.0, 0.4), (2.0, 0.6)]);
        assert!(!svg(std::slice::from_ref(&one)).contains(">first</text>"));
        let both = svg(&[one, two]);
        for text in ["size", "first", "second"] {
            assert!(both.contains(&format!(">{text}</text>")), "{text}");
        }
    }

    /// A note is added below everything, and the rest stays where it is.
    #[test]
    fn a_note_stands_below_everything() {
        let plain = responses(&[curve("", &[(1.0, 0.3), (2.0, 0.5)])], false);
        let noted = Responses {
            note: "95 % interval of the mean, n = 5".to_string(),
            ..plain.clone()
        };
        let [plain, noted] =
            [plain, noted].map(|responses| response(&responses, PictureSize::default()).unwrap().svg);
        assert!(noted.contains(">95 % interval of the mean, n = 5</text>"));
        let texts = |svg: &str| svg.lines().filter(|line| line.contains("<text")).count();
        assert_eq!(texts(&noted), texts(&plain) + 1);
        let line = |svg: &str| {
            svg.lines()
                .find(|line| line.contains(">x</text>"))
                .map(str::to_string)
        };
        assert_eq!(line(&noted), line(&plain));
    }

    #[test]
    fn a_band_ends_where_an_interval_or_a_mean_is_missing() {
        let points: Vec<(f64, f64)> = (0..7).map(|i| (f64::from(i), 0.1 * f64::from(i))).collect();
        let mut curve = curve("", &points);
        assert_eq!(bands(&svg(std::slice::from_ref(&curve))), 1);
        curve.mean[3] = f64::NAN;
        assert_eq!(bands(&svg(std::slice::from_ref(&curve))), 2);
        // The last point alone has an error bar.
        curve.low[5] = f64::NAN;
        assert_eq!(bands(&svg(std::slice::from_ref(&curve))), 1);
        curve.high.fill(f64::NAN);
        assert_eq!(bands(&svg(&[curve])), 0);
    }

    #[test]
    fn a_formula_is_a_line_without_markers_on_either_kind_of_axis() {
        let mut formula = curve("5/2 over V*", &[(0.01, 250.0), (0.1, 25.0)]);
        let measured = svg(std::slice::from_ref(&formula));
        formula.line = true;
        let drawn = svg(std::slice::from_ref(&formula));
        assert_eq!(
            (
                measured.matches("<circle").count(),
                drawn.matches("<circle").count()
            ),
            (4, 0)
        );
        let mut both = responses(&[formula], true);
        both.log_y = true;
        let logarithmic = response(&both, PictureSize::default()).unwrap().svg;
        assert!(logarithmic.contains(">100</text>") && !logarithmic.contains("NaN"));
    }

    /// A cross adds two lines, on the marker or on the lower side.
    #[test]
    fn points_that_are_not_whole_are_crossed() {
        let mut plain = curve("", &[(1.0, 0.3), (2.0, 0.5), (3.0, 0.4)]);
        plain.mean[1] = f64::NAN;
        let crossed = Response {
            crossed: vec![true, true, false],
            ..plain.clone()
        };
        let lines = |curve: &Response| svg(std::slice::from_ref(curve)).matches("fill=\"none\"").count();
        assert_eq!(lines(&crossed), lines(&plain) + 4);
    }

    #[test]
    fn an_interval_is_held_whole() {
        let mut wide = curve("", &[(1.0, 0.5)]);
        (wide.low[0], wide.high[0]) = (-3.0, 7.0);
        let curve = sorted(&wide);
        assert!(values(&curve).any(|v| v == -3.0) && values(&curve).any(|v| v == 7.0));
    }

    #[test]
    fn poor_curves_are_drawn_all_the_same() {
        let odd = [
            curve("", &[]),
            curve("", &[(0.03, 0.88)]),
            curve("", &[(1.0, f64::NAN), (f64::NAN, 1.0)]),
            curve("", &[(-1.0, 0.3), (0.0, 0.3)]),
            curve("", &[(f64::INFINITY, 0.3), (1.0, f64::MAX), (2.0, f64::MIN)]),
            curve("", &[(1e-9, 1e-9), (2e-9, 3e-9)]),
            curve("", &[(5e-324, 5e-324), (1e-310, 2e-310)]),
            curve("", &[(1.0, -9e99), (9e99, 9e99)]),
            curve("", &[(1.0, 12345.0), (1.0 + 1e-12, 12345.0)]),
        ];
        for curve in &odd {
            svg(std::slice::from_ref(curve));
            response(
                &responses(std::slice::from_ref(curve), true),
                PictureSize::default(),
            )
            .unwrap();
        }
        svg(&odd);
    }

    #[test]
    fn columns_of_different_length_are_refused() {
        let mut bad = curve("a", &[(0.0, 0.0), (1.0, 1.0)]);
        bad.high.pop();
        let error = response(&responses(&[bad], false), PictureSize::default())
            .unwrap_err()
            .to_string();
        assert_eq!(error, "curve `a` has 2 points but 1 values of its high");
        let error = response(&responses(&[], false), PictureSize::default())
            .unwrap_err()
            .to_string();
        assert_eq!(error, "there is no curve to draw");
    }
}
