//! Response curves of a parametric study, with confidence bands.

use serde::{Deserialize, Serialize};

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::estimate::Estimate;
use crate::frame::{LOWER_ROOM, left_room, numbered_sides, right_end};
use crate::geometry::{Area, CanvasPoint};
use crate::legend::{Legend, LegendSample};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::series::{cross, error_bar, marker, segments};
use crate::size::PictureSize;
use crate::style::{COLUMN_WIDTH, GREY, MARGIN, RADIUS_MARKER, WIDTH_LEADER, curve_style};
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
    /// Abscissae and values of the points, in any order. A point without a mean leaves a gap, and has its
    /// cross on the lower side.
    pub points: Vec<(f64, Estimate)>,
    /// Whether the curve is a formula or a level rather than a result: it is drawn as a line through its
    /// points, without markers.
    pub line: bool,
}

/// Draws means with their confidence bands, usually as wide as a journal's column (85 mm).
///
/// The y axis starts where the values do, not at zero. A point without neighbours has an error bar in place
/// of a band. Several curves have a legend above, and markers of different shapes.
///
/// # Errors
///
/// No curve, or a size that leaves no room for the curves.
pub fn response(responses: &Responses, size: PictureSize) -> Result<Picture, PictureError> {
    if responses.curves.is_empty() {
        return Err(PictureError::Nothing("curve"));
    }
    let curves: Vec<Response> = responses.curves.iter().map(sorted).collect();
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let xs: Vec<f64> = points().map(|(x, _)| *x).collect();
    let x = DrawnAxis::around(&xs, responses.log_x, 0.04);
    let ys = points().flat_map(|(_, value)| [value.mean, value.low, value.high]);
    let ys: Vec<f64> = ys.collect();
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
    let names = named.map(|curve| (curve.label.as_str(), sample(curve)));
    let legend = Legend::new(&responses.legend_title, names, left, right);
    let note = Note::new(&responses.note, 0.5 * (left + right), width);
    let top = MARGIN + legend.height;
    let height = size.panel(HEIGHT, top + LOWER_ROOM + note.height, 1)?;
    let area = Area::new(left, top, right - left, height);
    let (x, y) = (x.placed(left, right), y.placed(area.bottom(), area.y));

    let mut canvas = Canvas::sized(width, area.bottom() + LOWER_ROOM + note.height, size);
    numbered_sides(
        &mut canvas,
        area,
        [&x, &y],
        [&responses.x_title, &responses.y_title],
    );
    if !y.is_log && y.lo < 0.0 && y.hi > 0.0 {
        canvas.line((area.x, y.at(0.0)), (area.right(), y.at(0.0)), WIDTH_LEADER, GREY);
    }
    note.draw(&mut canvas);
    legend.draw(&mut canvas);
    draw_curves(&mut canvas, &x, &y, &curves);
    draw_crosses(&mut canvas, area, &x, &y, &curves);
    canvas.frame(area);
    canvas.finish()
}

/// The curve with its points sorted by x, and with intervals that are complete or NaN.
fn sorted(curve: &Response) -> Response {
    let mut sorted = curve.clone();
    sorted.points.retain(|(x, _)| drawable(*x));
    sorted.points.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, value) in &mut sorted.points {
        [value.low, value.high] = value.interval().unwrap_or([f64::NAN; 2]);
    }
    sorted
}

impl Response {
    /// The curve through `values` at the abscissae `x`, without intervals.
    pub fn of_values(label: &str, x: &[f64], values: &[f64]) -> Self {
        let values = values.iter().map(|&mean| Estimate::exact(mean));
        Self {
            label: label.to_owned(),
            points: x.iter().copied().zip(values).collect(),
            line: false,
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

    /// Parts without a gap of the line through the means or the ends of the intervals.
    fn segments(&self, of: fn(&Estimate) -> f64, x: &DrawnAxis, y: &DrawnAxis) -> Vec<Vec<CanvasPoint>> {
        segments(self.points.iter().map(|(at, value)| (*at, of(value))), x, y)
    }
}

/// Draws all bands, then all curves, then all points, so that nothing hides a point.
fn draw_curves(canvas: &mut Canvas, x: &DrawnAxis, y: &DrawnAxis, curves: &[Response]) {
    let opacity = if curves.len() > 4 { 0.13 } else { 0.2 };
    let colour = |index: usize| curve_style(index).colour;
    for (index, curve) in curves.iter().enumerate() {
        let lows = curve.segments(|value| value.low, x, y);
        let highs = curve.segments(|value| value.high, x, y);
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
        for segment in curve.segments(|value| value.mean, x, y) {
            if segment.len() > 1 {
                canvas.curve(segment, curve_style(index));
            }
        }
    }
    for (index, curve) in curves.iter().enumerate().filter(|(_, curve)| !curve.line) {
        for point in curve.segments(|value| value.mean, x, y).concat() {
            marker(canvas, index, point, RADIUS_MARKER, colour(index));
        }
    }
}

/// Draws the crosses of marked points.
fn draw_crosses(canvas: &mut Canvas, area: Area, x: &DrawnAxis, y: &DrawnAxis, curves: &[Response]) {
    /// Height above the lower side of the cross of a point without a mean.
    const LIFT: f64 = 14.0;
    let points = curves.iter().flat_map(|curve| &curve.points);
    for (at, value) in points.filter(|(_, value)| value.crossed) {
        let height = if drawable(value.mean) {
            y.clamped(value.mean)
        } else {
            area.bottom() - LIFT
        };
        cross(canvas, (x.at(*at), height));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A curve with intervals of 0.1 to both sides.
    fn curve(label: &str, points: &[(f64, f64)]) -> Response {
        let points = points.iter();
        Response {
            label: label.to_string(),
            points: points
                .map(|&(x, mean)| (x, Estimate::between(mean - 0.1, mean, mean + 0.1)))
                .collect(),
            line: false,
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
        curve.points[3].1.mean = f64::NAN;
        assert_eq!(bands(&svg(std::slice::from_ref(&curve))), 2);
        // The last point alone has an error bar.
        curve.points[5].1.low = f64::NAN;
        assert_eq!(bands(&svg(std::slice::from_ref(&curve))), 1);
        for (_, value) in &mut curve.points {
            value.high = f64::NAN;
        }
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
        plain.points[1].1.mean = f64::NAN;
        let mut crossed = plain.clone();
        for (_, value) in &mut crossed.points[..2] {
            value.crossed = true;
        }
        let lines = |curve: &Response| svg(std::slice::from_ref(curve)).matches("fill=\"none\"").count();
        assert_eq!(lines(&crossed), lines(&plain) + 4);
    }

    #[test]
    fn an_interval_is_held_whole() {
        let mut wide = curve("", &[(1.0, 0.5)]);
        (wide.points[0].1.low, wide.points[0].1.high) = (-3.0, 7.0);
        let drawn = svg(&[wide]);
        assert!(drawn.contains(">6</text>") && drawn.contains(">\u{2212}2</text>"));
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
    fn a_picture_has_a_curve() {
        let error = response(&responses(&[], false), PictureSize::default())
            .unwrap_err()
            .to_string();
        assert_eq!(error, "there is no curve to draw");
    }
}
