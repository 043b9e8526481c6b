//! A quantity against a direction: curves around a centre, with confidence bands.

use serde::{Deserialize, Serialize};

use crate::axis::{DrawnAxis, drawable};
use crate::canvas::Canvas;
use crate::estimate::Estimate;
use crate::frame::{LOWER_ROOM, lower_side};
use crate::geometry::{Align, Area, CanvasPoint};
use crate::legend::{Legend, LegendSample};
use crate::note::Note;
use crate::picture::Picture;
use crate::picture_error::PictureError;
use crate::response::Response;
use crate::series::{cross, marker};
use crate::size::PictureSize;
use crate::style::{
    BLACK, BLANK, COLUMN_WIDTH, MARGIN, RADIUS_MARKER, Rgb, SIZE_TEXT, WIDTH_FRAME, WIDTH_LEADER, WIDTH_MARK,
    curve_style,
};
use crate::text::{Text, number};
use crate::ticks::{Direction, MAX_STEPS, round_values};

/// Room on either side of the largest circle.
const BESIDE: f64 = 122.0;
/// Distance between that circle and the numbers of the directions.
const GAP: f64 = 12.0;
/// Distance from the largest circle to the axis of the radius below it.
const BELOW: f64 = 64.0;
/// Angle in degrees between neighbouring lines of directions, and between numbered ones.
const SPOKES: usize = 30;
const NUMBERED: usize = 90;
/// Range of the values, over the largest value, up to which the centre is not zero: measured from zero, their
/// differences could not be seen.
const ALIKE: f64 = 0.4;
/// Least range of values, over the largest of them, that fills half of the radius.
const LEAST_RANGE: f64 = 0.1;
/// Difference in degrees below which two directions count as one.
const SAME: f64 = 1e-9;

/// Curves against a direction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Polar {
    /// Quantity of the radius.
    pub value_title: String,
    /// Quantity of the curves' labels, for the legend; may be empty.
    pub legend_title: String,
    /// Meaning of the intervals, below everything; may be empty.
    pub note: String,
    /// The curves; x is the direction, in degrees from the x axis towards the y axis.
    pub curves: Vec<Response>,
}

/// Draws means around a centre with their confidence bands, usually as wide as a journal's column (85 mm).
/// The centre is zero, unless all values are similar; then the note gives its value. A curve whose directions
/// go all the way round is closed, and has a gap where a value is missing or below zero.
///
/// # Errors
///
/// No curve, or a size that leaves no room for the curves.
pub fn polar(polar: &Polar, size: PictureSize) -> Result<Picture, PictureError> {
    if polar.curves.is_empty() {
        return Err(PictureError::Nothing("curve"));
    }
    let rounds: Vec<Round> = polar.curves.iter().map(Round::new).collect();
    let points = || rounds.iter().flat_map(|round| round.parts.iter().flatten());
    let highest = points()
        .map(|point| point.high.max(point.mean))
        .fold(0.0, f64::max);
    let largest = if highest > 0.0 { highest } else { 1.0 };
    let lows = points().map(|point| point.low.min(point.mean));
    let smallest = lows.fold(largest, f64::min);
    let start = centre_value(smallest, largest);

    let width = size.roomy_width(COLUMN_WIDTH)?;
    let centre_x = (0.5 * width).round();
    let widest = (0.5 * width - BESIDE).round();
    let [left, right] = [centre_x - widest, centre_x + widest];
    let named = polar.curves.iter().filter(|_| rounds.len() > 1);
    let names = named.map(|curve| (curve.label.as_str(), LegendSample::Marker));
    let legend = Legend::new(&polar.legend_title, names, left, right);
    let numbers = f64::from(SIZE_TEXT) + GAP + MARGIN;
    let note = Note::new(&with_centre(&polar.note, start), centre_x, width);
    let others = legend.height + numbers + BELOW + LOWER_ROOM + note.height;
    let room = size.panel(2.0 * widest, others, 1)?;
    let reach = widest.min(0.5 * room);
    let centre = (centre_x, legend.height + numbers + 0.5 * room);
    // The axis of the radius, from the centre to the right, below the circles.
    let side = Area::new(centre.0, centre.1 + reach + BELOW, reach, 0.0);
    let radius = DrawnAxis::linear(start, largest + 0.05 * (largest - start)).placed(0.0, reach);

    let mut canvas = Canvas::sized(width, others + room, size);
    let ring = Ring {
        centre,
        radius,
        reach,
    };
    ring.draw_grid(&mut canvas);
    legend.draw(&mut canvas);
    canvas.line((side.x, side.y), (side.right(), side.y), WIDTH_FRAME, BLACK);
    let ticks = radius.placed(side.x, side.right()).ticks(Direction::X, MAX_STEPS);
    let title = Text::fitted(&polar.value_title, 2.0 * (width - MARGIN - side.centre().0));
    lower_side(&mut canvas, side, &ticks, &title);
    for (index, round) in rounds.iter().enumerate() {
        ring.draw_band(&mut canvas, round, curve_style(index).colour);
    }
    for (index, round) in rounds.iter().enumerate() {
        ring.draw_curve(&mut canvas, round, index);
    }
    for curve in &polar.curves {
        ring.draw_crosses(&mut canvas, curve);
    }
    note.draw(&mut canvas);
    canvas.finish()
}

/// Value at the centre: 0, or, if the values are similar, a round value about as far below the smallest as
/// the largest is above the smallest.
fn centre_value(smallest: f64, largest: f64) -> f64 {
    let range = (largest - smallest).max(LEAST_RANGE * largest);
    let start = smallest - range;
    if largest - smallest > ALIKE * largest || start <= 0.0 {
        return 0.0;
    }
    let (step, _) = round_values(start, largest, MAX_STEPS);
    (step * (start / step).floor()).max(0.0)
}

/// A note, with the value of the centre if that is not zero.
fn with_centre(note: &str, start: f64) -> String {
    let decimals = (1.0 - libm::log10(start).floor()).clamp(0.0, 6.0) as usize;
    let mut text = number(start, decimals);
    if text.contains('.') {
        text.truncate(text.trim_end_matches('0').trim_end_matches('.').len());
    }
    let centre = format!("the centre is {text}");
    match (start == 0.0, note.is_empty()) {
        (true, _) => note.to_owned(),
        (false, true) => centre,
        (false, false) => format!("{note}; {centre}"),
    }
}

/// The points of a curve, by rising direction.
struct Round {
    /// Parts of the curve: neighbours without a gap between them.
    parts: Vec<Vec<RoundPoint>>,
    /// Whether the curve is one part that goes all the way round.
    is_closed: bool,
}

#[derive(Clone, Copy)]
struct RoundPoint {
    degrees: f64,
    mean: f64,
    low: f64,
    high: f64,
}

impl Round {
    fn new(curve: &Response) -> Self {
        let point = |(degrees, value): &(f64, Estimate)| {
            let (degrees, mean) = (degrees.rem_euclid(360.0), value.mean);
            let [low, high] = value.interval().unwrap_or([mean, mean]);
            let there = (drawable(mean) && mean >= 0.0).then(|| RoundPoint {
                degrees,
                mean,
                low: low.max(0.0),
                high,
            });
            (degrees, there)
        };
        let points = curve.points.iter().filter(|(degrees, _)| drawable(*degrees));
        let mut all: Vec<(f64, Option<RoundPoint>)> = points.map(point).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // 0 and 360 degrees are one direction.
        all.dedup_by(|later, first| {
            let is_same = later.0 - first.0 < SAME;
            if is_same {
                first.1 = first.1.or(later.1);
            }
            is_same
        });
        let gaps = all.windows(2).map(|pair| pair[1].0 - pair[0].0);
        let widest = gaps.fold(0.0, f64::max);
        let last = match (all.first(), all.last()) {
            (Some(first), Some(last)) => first.0 + 360.0 - last.0,
            _ => f64::INFINITY,
        };
        let is_round = all.len() > 2 && last <= widest + SAME;
        let missing = all.iter().position(|(_, there)| there.is_none());
        // A curve that goes all the way round is made to start after a gap.
        if let (true, Some(missing)) = (is_round, missing) {
            all.rotate_left(missing);
        }
        let parts = all.split(|(_, there)| there.is_none());
        let parts = parts.map(|part| part.iter().filter_map(|(_, there)| *there).collect());
        Self {
            is_closed: is_round && missing.is_none(),
            parts: parts.filter(|part: &Vec<RoundPoint>| !part.is_empty()).collect(),
        }
    }

    /// The points of a part at these values, back to the first if the curve is closed.
    fn path(&self, part: &[RoundPoint], ring: &Ring, value: impl Fn(&RoundPoint) -> f64) -> Vec<CanvasPoint> {
        let first = part.first().filter(|_| self.is_closed);
        let points = part.iter().chain(first);
        points.map(|point| ring.at(point.degrees, value(point))).collect()
    }
}

/// Positions of directions and values.
struct Ring {
    centre: CanvasPoint,
    radius: DrawnAxis,
    /// Radius of the largest circle.
    reach: f64,
}

impl Ring {
    fn at(&self, degrees: f64, value: f64) -> CanvasPoint {
        self.around(degrees, self.radius.clamped(value))
    }

    /// The point of this direction and radius in pixels.
    fn around(&self, degrees: f64, radius: f64) -> CanvasPoint {
        let (sine, cosine) = libm::sincos(degrees.to_radians());
        (self.centre.0 + radius * cosine, self.centre.1 - radius * sine)
    }

    /// Draws circles at round values and lines of directions; the first two that are numbered are the axes x
    /// and y.
    fn draw_grid(&self, canvas: &mut Canvas) {
        let circle = |radius: f64| {
            (0..=180)
                .map(|k| self.around(f64::from(k % 180) * 2.0, radius))
                .collect()
        };
        for (radius, _) in self.radius.ticks(Direction::X, MAX_STEPS) {
            if radius > 1.0 && radius < self.reach - 1.0 {
                canvas.polyline(circle(radius), WIDTH_LEADER, BLANK);
            }
        }
        for degrees in (0..360).step_by(SPOKES) {
            let angle = degrees as f64;
            canvas.line(self.centre, self.around(angle, self.reach), WIDTH_LEADER, BLANK);
            if degrees % NUMBERED != 0 {
                continue;
            }
            let axis = match degrees {
                0 => "x ",
                90 => "y ",
                _ => "",
            };
            let text = Text::plain(&format!("{axis}{degrees}\u{b0}"), SIZE_TEXT);
            let (x, y) = self.around(angle, self.reach + GAP);
            let (sine, cosine) = libm::sincos(angle.to_radians());
            // The text is aligned by its side nearest to the circle.
            let align = match cosine {
                c if c > 0.1 => Align::Start,
                c if c < -0.1 => Align::End,
                _ => Align::Middle,
            };
            let baseline = y + 0.5 * text.height() * (1.0 - sine);
            canvas.text(&text, (x, baseline), align, BLACK);
        }
        canvas.polyline(circle(self.reach), WIDTH_FRAME, BLACK);
    }

    fn draw_band(&self, canvas: &mut Canvas, round: &Round, colour: Rgb) {
        for part in &round.parts {
            if let [point] = part[..] {
                let ends = [point.low, point.high].map(|value| self.at(point.degrees, value));
                canvas.line(ends[0], ends[1], WIDTH_MARK, colour);
                continue;
            }
            let mut edge = round.path(part, self, |point| point.high);
            edge.extend(round.path(part, self, |point| point.low).into_iter().rev());
            canvas.polygon(edge, colour, 0.2);
        }
    }

    fn draw_curve(&self, canvas: &mut Canvas, round: &Round, index: usize) {
        let style = curve_style(index);
        for part in &round.parts {
            let path = round.path(part, self, |point| point.mean);
            if path.len() > 1 {
                canvas.curve(path, style);
            }
            for point in part {
                let at = self.at(point.degrees, point.mean);
                marker(canvas, index, at, RADIUS_MARKER, style.colour);
            }
        }
    }

    /// Draws the crosses of marked points; a point without a mean has its cross on the largest circle.
    fn draw_crosses(&self, canvas: &mut Canvas, curve: &Response) {
        let points = curve.points.iter();
        for (degrees, Estimate { mean, .. }) in points.filter(|(x, value)| value.crossed && drawable(*x)) {
            let is_drawn = drawable(*mean) && *mean >= 0.0;
            let radius = if is_drawn {
                self.radius.clamped(*mean)
            } else {
                self.reach
            };
            cross(canvas, self.around(*degrees, radius));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(label: &str, directions: &[f64], mean: f64) -> Response {
        let value = Estimate::between(mean - 0.1, mean, mean + 0.1);
        Response {
            label: label.to_string(),
            points: directions.iter().map(|degrees| (*degrees, value)).collect(),
            line: false,
        }
    }

    fn svg(curves: &[Response]) -> String {
        let picture = polar(
            &Polar {
                value_title: "friction".to_string(),
                curves: curves.to_vec(),
                ..Polar::default()
            },
            PictureSize::default(),
        );
        let svg = picture.unwrap().svg;
        assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{curves:?}");
        svg
    }

    #[test]
    fn directions_that_go_all_the_way_round_are_closed() {
        let is_closed = |directions: &[f64]| Round::new(&curve("", directions, 0.5)).is_closed;
        assert!(is_closed(&[0.0, 90.0, 180.0, 270.0]));
        assert!(is_closed(&[-180.0, -60.0, 60.0, 180.0]));
        assert!(is_closed(&[0.0, 120.0, 240.0, 360.0]));
        assert!(!is_closed(&[0.0, 30.0, 60.0, 90.0]));
        assert!(!is_closed(&[0.0, 180.0]));
        let mut gap = curve("", &[0.0, 90.0, 180.0, 270.0], 0.5);
        gap.points[2].1.mean = f64::NAN;
        // The gap is where the value is missing: the part goes on through 0 degrees.
        let round = Round::new(&gap);
        assert!(!round.is_closed);
        let degrees = |round: &Round| -> Vec<Vec<f64>> {
            let parts = round.parts.iter();
            parts
                .map(|part| part.iter().map(|point| point.degrees).collect())
                .collect()
        };
        assert_eq!(degrees(&round), [[270.0, 0.0, 90.0]]);
        gap.points[0].1.mean = -1.0;
        assert_eq!(degrees(&Round::new(&gap)), [[90.0], [270.0]]);
        // 0 degrees has its value at 360.
        let mut twice = curve("", &[0.0, 120.0, 240.0, 360.0], 0.5);
        twice.points[0].1.mean = f64::NAN;
        assert!(Round::new(&twice).is_closed);
    }

    /// Directions and values have their places: 0 degrees is to the right, 90 upwards, and the radius is in
    /// proportion to the value.
    #[test]
    fn directions_and_values_have_their_places() {
        let ring = Ring {
            centre: (100.0, 100.0),
            radius: DrawnAxis::linear(0.0, 2.0).placed(0.0, 50.0),
            reach: 50.0,
        };
        for (degrees, value, (x, y)) in [
            (0.0, 1.0, (125.0, 100.0)),
            (90.0, 2.0, (100.0, 50.0)),
            (180.0, 1.0, (75.0, 100.0)),
            (270.0, 0.0, (100.0, 100.0)),
        ] {
            let at = ring.at(degrees, value);
            // The sine of pi in double precision, times the radius.
            assert!(
                (at.0 - x).abs() < 1e-12 && (at.1 - y).abs() < 1e-12,
                "{degrees}: {at:?}"
            );
        }
    }

    #[test]
    fn curves_have_a_legend_and_the_axis_its_title() {
        let all = [0.0, 90.0, 180.0, 270.0];
        let two = svg(&[curve("static", &all, 0.8), curve("kinetic", &all, 0.5)]);
        for text in [
            "static",
            "kinetic",
            "friction",
            "x 0\u{b0}",
            "y 90\u{b0}",
            "180\u{b0}",
            "270\u{b0}",
        ] {
            assert!(two.contains(&format!(">{text}</text>")), "{text}");
        }
        assert!(!svg(&[curve("static", &all, 0.8)]).contains(">static</text>"));
    }

    /// Similar values are drawn from a round value below them, which the note gives; others from zero.
    #[test]
    fn the_centre_is_zero_unless_that_hides_the_effect() {
        assert_eq!(centre_value(0.3, 0.9), 0.0);
        assert_eq!(centre_value(0.0, 0.0), 0.0);
        let start = centre_value(0.8, 0.9);
        // 0.8 - 0.1, in steps of 0.05, which are rounded.
        assert!((0.6..0.7 + 1e-9).contains(&start), "{start}");
        // Equal values are not magnified down to their last digit.
        let start = centre_value(0.9, 0.9);
        assert!((0.7..=0.81).contains(&start), "{start}");
        let all = [0.0, 90.0, 180.0, 270.0];
        let narrow = |mean: f64| {
            let mut curve = curve("", &all, mean);
            for (_, value) in &mut curve.points {
                *value = Estimate::between(mean - 0.01, mean, mean + 0.01);
            }
            curve
        };
        assert!(svg(&[narrow(0.8)]).contains("the centre is 0."));
        assert!(!svg(&[narrow(0.8), narrow(0.1)]).contains("the centre is"));
        assert_eq!(with_centre("bands: 95 %", 0.5), "bands: 95 %; the centre is 0.5");
    }

    #[test]
    fn points_that_are_not_whole_are_crossed() {
        let plain = curve("", &[0.0, 90.0, 180.0, 270.0], 0.5);
        let mut crossed = plain.clone();
        for index in [0, 2] {
            crossed.points[index].1.crossed = true;
        }
        let lines = |curve: &Response| svg(std::slice::from_ref(curve)).matches("fill=\"none\"").count();
        assert_eq!(lines(&crossed), lines(&plain) + 4);
    }

    #[test]
    fn poor_curves_are_drawn_all_the_same() {
        for curve in [
            curve("", &[], 1.0),
            curve("", &[45.0], 1.0),
            curve("", &[0.0, 90.0], f64::NAN),
            curve("", &[0.0, 90.0], -1.0),
            curve("", &[0.0, f64::INFINITY], 0.0),
            curve("", &[0.0, 90.0], 1e99),
        ] {
            svg(&[curve]);
        }
        assert!(polar(&Polar::default(), PictureSize::default()).is_err());
    }
}
