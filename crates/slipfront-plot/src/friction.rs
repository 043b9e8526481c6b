//! Friction and the share of sliding blocks against time.

use crate::canvas::Canvas;
use crate::friction_curve::{FrictionCurve, Kinetic};
use crate::friction_layout::{Panels, between};
use crate::geometry::{Align, Area, Point};
use crate::label_placement::{Candidate, Placer, around};
use crate::legend::Legend;
use crate::picture::{Picture, PictureError};
use crate::polyline::segments;
use crate::range::drawable;
use crate::style::{
    BLACK, COLUMN_WIDTH, CURVES, GREY, MARGIN, Rgb, SIZE_LABEL, WIDTH_CURVE, WIDTH_LEADER, WIDTH_MARK,
    curve_colour,
};
use crate::text::{Text, number};

const DOT: f64 = 7.0;
/// The kinetic window's shade.
const SHADE: Rgb = [0x9a, 0xa5, 0xb1];

/// Draws mu* and, below it, N* against t*, as wide as a journal's column (85 mm).
///
/// One curve is drawn with all it knows: first slip, peak, kinetic window, lettered instants. Several are
/// drawn over each other with their peaks, the lettered instants if only one has any, and a legend above. Curves
/// of more than 4000 points are thinned to the first, last, lowest and highest point of every pixel column, which
/// shows the same picture.
///
/// # Errors
///
/// No curve, or a curve whose columns differ in length.
pub fn friction(curves: &[FrictionCurve]) -> Result<Picture, PictureError> {
    if curves.is_empty() {
        return Err(PictureError::Nothing("curve"));
    }
    for curve in curves {
        let columns = [("mu*", curve.mu_star.len()), ("N*", curve.sliding_percent.len())];
        if let Some(&(column, values)) = columns
            .iter()
            .find(|(_, values)| *values != curve.time_star.len())
        {
            let (label, times) = (curve.label.clone(), curve.time_star.len());
            return Err(PictureError::Columns {
                label,
                times,
                column,
                values,
            });
        }
    }
    let mut panels = Panels::of(curves);
    let mut legend = Legend::default();
    if curves.len() > 1 {
        let labels: Vec<&str> = curves.iter().map(|curve| curve.label.as_str()).collect();
        legend = Legend::of(&labels, panels.time.start, panels.time.end);
        panels = panels.lowered(legend.height);
    }
    let mut canvas = Canvas::new(COLUMN_WIDTH, panels.bottom());
    panels.draw_axes(&mut canvas);
    legend.draw(&mut canvas);
    match curves {
        [curve] => draw_one(&mut canvas, &panels, curve),
        _ => draw_many(&mut canvas, &panels, curves),
    }
    canvas.finish()
}

/// One curve with its marks.
fn draw_one(canvas: &mut Canvas, panels: &Panels, curve: &FrictionCurve) {
    let Panels { time, mu, sliding } = panels;
    let mut placer = Placer::new(panels.friction());
    let window = curve
        .kinetic
        .filter(|window| drawable(window.mean) && window.from < window.to);
    if let Some(window) = &window {
        shade_window(canvas, panels, window);
    }
    let first_slip = curve.first_slip_time_star.filter(|&slip| time.contains(slip));
    if let Some(x) = first_slip.map(|slip| time.at(slip)) {
        for axis in [mu, sliding] {
            canvas.line((x, axis.start), (x, axis.end), WIDTH_LEADER, GREY);
        }
        placer.avoid(&[(x, mu.start), (x, mu.end)]);
    }
    draw_curve(canvas, panels, &mut placer, curve, CURVES[0]);
    if let Some(window) = &window {
        // Over the curve, which would hide it.
        let y = mu.clamped(window.mean);
        let ends = [(time.clamped(window.from), y), (time.clamped(window.to), y)];
        canvas.line(ends[0], ends[1], WIDTH_MARK, CURVES[1]);
        placer.avoid(&ends);
    }
    let marks = Marks::of(panels, curve, curve.peak);
    marks.keep_free(&mut placer);
    // Labels that can go in fewest places come first.
    if let Some(window) = &window {
        let text = Text::math(&format!("\u{3bc}_k* = {}", with_uncertainty(window)), SIZE_LABEL);
        write(
            canvas,
            &mut placer,
            &text,
            along_window(panels, &text, window),
            CURVES[1],
        );
    }
    marks.label_peak(canvas, &mut placer);
    if let Some(slip) = first_slip {
        let text = Text::plain("first slip", SIZE_LABEL);
        write(
            canvas,
            &mut placer,
            &text,
            beside_line(panels, &text, time.at(slip)),
            GREY,
        );
    }
    marks.label_instants(canvas, &mut placer);
    marks.draw_dots(canvas);
    panels.draw_frames(canvas);
}

/// Shades the window of kinetic friction in both panels, and the uncertainty of its mean.
fn shade_window(canvas: &mut Canvas, Panels { time, mu, sliding }: &Panels, window: &Kinetic) {
    let (from, to) = (time.clamped(window.from), time.clamped(window.to));
    for axis in [mu, sliding] {
        canvas.fill(between(from, to, axis.start, axis.end), SHADE, 0.25);
    }
    if let Some(uncertainty) = window.uncertainty.filter(|&u| drawable(u)) {
        let [lo, hi] = [window.mean - uncertainty, window.mean + uncertainty].map(|value| mu.clamped(value));
        canvas.fill(between(from, to, lo, hi), CURVES[1], 0.25);
    }
}

/// Draws mu* and N*; labels keep off the former.
fn draw_curve(canvas: &mut Canvas, panels: &Panels, placer: &mut Placer, curve: &FrictionCurve, colour: Rgb) {
    let Panels { time, mu, sliding } = panels;
    for segment in segments(&curve.time_star, &curve.mu_star, time, mu) {
        placer.avoid(&segment);
        stroke(canvas, segment, colour);
    }
    for segment in segments(&curve.time_star, &curve.sliding_percent, time, sliding) {
        stroke(canvas, segment, colour);
    }
}

/// Several curves, with their peaks.
fn draw_many(canvas: &mut Canvas, panels: &Panels, curves: &[FrictionCurve]) {
    let Panels { time, mu, .. } = panels;
    let mut placer = Placer::new(panels.friction());
    for (index, curve) in curves.iter().enumerate() {
        let colour = curve_colour(index, curves.len());
        draw_curve(canvas, panels, &mut placer, curve, colour);
    }
    // Peaks last: no curve may hide one.
    for (index, curve) in curves.iter().enumerate() {
        if let Some((t, value)) = curve
            .peak
            .filter(|&(t, value)| time.contains(t) && mu.contains(value))
        {
            canvas.dot((time.at(t), mu.at(value)), DOT, curve_colour(index, curves.len()));
        }
    }
    // Letters of two curves could not be told apart.
    let mut lettered = curves.iter().filter(|curve| !curve.instants.is_empty());
    if let (Some(curve), None) = (lettered.next(), lettered.next()) {
        let marks = Marks::of(panels, curve, None);
        marks.keep_free(&mut placer);
        marks.label_instants(canvas, &mut placer);
        marks.draw_dots(canvas);
    }
    panels.draw_frames(canvas);
}

/// The points of a curve that are marked by dots.
struct Marks {
    /// The peak and its value.
    peak: Option<(Point, f64)>,
    /// Instants and their letters; those at the peak share its label, because several labels of one point would take its
    /// neighbours' places.
    instants: Vec<(Point, char)>,
    at_peak: Vec<char>,
    /// All of these points.
    dots: Vec<Point>,
}

impl Marks {
    /// The instants of a curve that lie in the panel, and its peak if one is given.
    fn of(Panels { time, mu, .. }: &Panels, curve: &FrictionCurve, peak: Option<(f64, f64)>) -> Self {
        let point =
            |t: f64, value: f64| (time.contains(t) && mu.contains(value)).then(|| (time.at(t), mu.at(value)));
        let peak = peak.and_then(|(t, value)| Some((point(t, value)?, value)));
        let instants = curve
            .instants
            .iter()
            .filter_map(|instant| Some((point(instant.time_star, instant.mu_star)?, instant.letter)));
        let instants: Vec<(Point, char)> = instants.collect();
        let mut dots: Vec<Point> = instants.iter().map(|(at, _)| *at).collect();
        dots.extend(peak.map(|(at, _)| at));
        let is_at_peak = |&(at, letter): &(Point, char)| {
            let near = |(peak, _): (Point, f64)| libm::hypot(at.0 - peak.0, at.1 - peak.1) < 2.0;
            peak.is_some_and(near) && letter.is_alphanumeric()
        };
        let (at_peak, instants): (Vec<_>, Vec<_>) = instants.into_iter().partition(is_at_peak);
        Self {
            peak,
            instants,
            at_peak: at_peak.into_iter().map(|(_, letter)| letter).collect(),
            dots,
        }
    }

    /// Keeps labels off the dots.
    fn keep_free(&self, placer: &mut Placer) {
        for (x, y) in &self.dots {
            placer.take(Area {
                x: x - DOT,
                y: y - DOT,
                width: 2.0 * DOT,
                height: 2.0 * DOT,
            });
        }
    }

    fn label_peak(&self, canvas: &mut Canvas, placer: &mut Placer) {
        let Some((peak, value)) = self.peak else { return };
        let letters: Vec<String> = self.at_peak.iter().map(char::to_string).collect();
        let letters = match letters[..] {
            [] => String::new(),
            _ => letters.join(", ") + ": ",
        };
        let text = Text::math(&format!("{letters}\u{3bc}_s* = {}", number(value, 3)), SIZE_LABEL);
        let places = around(peak, box_of(&text), &self.dots);
        write(canvas, placer, &text, places, BLACK);
    }

    fn label_instants(&self, canvas: &mut Canvas, placer: &mut Placer) {
        for &(at, letter) in &self.instants {
            let text = Text::plain(&letter.to_string(), SIZE_LABEL);
            let places = around(at, box_of(&text), &self.dots);
            write(canvas, placer, &text, places, BLACK);
        }
    }

    fn draw_dots(&self, canvas: &mut Canvas) {
        for &dot in &self.dots {
            canvas.dot(dot, DOT, BLACK);
        }
    }
}

/// Writes a text at the best of the places, with its leader.
fn write(canvas: &mut Canvas, placer: &mut Placer, text: &Text, candidates: Vec<Candidate>, colour: Rgb) {
    let Some(Candidate { area, leader, .. }) = placer.place(candidates) else {
        return;
    };
    if let Some([from, to]) = leader {
        canvas.line(from, to, WIDTH_LEADER, GREY);
    }
    canvas.text(text, (area.x, area.bottom() - text.depth()), Align::Start, colour);
}

/// Draws a segment of a curve; one of a single point is a dot.
fn stroke(canvas: &mut Canvas, segment: Vec<Point>, colour: Rgb) {
    match segment[..] {
        [point] => canvas.dot(point, 0.6 * DOT, colour),
        _ => canvas.polyline(segment, WIDTH_CURVE, colour),
    }
}

/// The width and the full height of a text.
fn box_of(text: &Text) -> (f64, f64) {
    (text.width(), text.height() + text.depth())
}

/// Places for a label of the window: within it if it is wide enough, rather above the mean than below.
fn along_window(panels: &Panels, text: &Text, window: &Kinetic) -> Vec<Candidate> {
    let panel = panels.friction();
    let (from, to) = (panels.time.clamped(window.from), panels.time.clamped(window.to));
    let mean = panels.mu.clamped(window.mean);
    let (width, height) = box_of(text);
    let room = (panel.x + MARGIN, panel.right() - MARGIN - width);
    let x = (0.5 * (from + to - width)).min(room.1).max(room.0);
    let steps = (panel.height / 8.0) as usize;
    (0..steps)
        .map(|step| {
            let area = Area {
                x,
                y: panel.y + MARGIN + 8.0 * step as f64,
                width,
                height,
            };
            let distance = mean - area.bottom();
            Candidate {
                area,
                penalty: if distance > 0.0 { distance } else { 80.0 - distance },
                leader: None,
            }
        })
        .collect()
}

/// Places for a label of a vertical line: beside its upper end, or further down.
fn beside_line(panels: &Panels, text: &Text, x: f64) -> Vec<Candidate> {
    let panel = panels.friction();
    let (width, height) = box_of(text);
    let steps = (panel.height / 10.0) as usize;
    let sides = [x - MARGIN - width, x + MARGIN];
    (0..steps)
        .flat_map(|step| {
            let down = 10.0 * step as f64;
            let y = panel.y + MARGIN + down;
            sides.map(|x| Candidate {
                area: Area { x, y, width, height },
                penalty: down,
                leader: None,
            })
        })
        .collect()
}

/// The mean and, if known, its uncertainty, with as many digits as that deserves.
fn with_uncertainty(window: &Kinetic) -> String {
    match window.uncertainty.filter(|&u| u > 0.0 && drawable(u)) {
        Some(uncertainty) => {
            let decimals = (-libm::log10(uncertainty).floor()).clamp(1.0, 5.0) as usize;
            format!(
                "{} \u{b1} {}",
                number(window.mean, decimals),
                number(uncertainty, decimals)
            )
        }
        None => number(window.mean, 3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction_curve::Instant;

    /// A curve like a real run's: a ramp, a peak, a fall, sliding.
    fn run() -> FrictionCurve {
        let time_star: Vec<f64> = (0..=534).map(|step| 0.5 * f64::from(step)).collect();
        let mu = |t: f64| match t {
            ..78.0 => 0.883 * t / 78.0,
            ..84.0 => 0.883 - 0.08 * (t - 78.0),
            _ => 0.53 - 0.1 * (-(t - 84.0) / 20.0).exp() + 0.05 * (t / 4.0).sin(),
        };
        let letters = [
            ('A', 16.7),
            ('B', 71.0),
            ('C', 78.0),
            ('D', 80.0),
            ('E', 84.0),
            ('F', 214.0),
        ];
        FrictionCurve {
            label: "a < b & $c$".to_string(),
            mu_star: time_star.iter().map(|&t| mu(t)).collect(),
            sliding_percent: time_star
                .iter()
                .map(|&t| if t < 71.0 { 0.0 } else { 40.0 })
                .collect(),
            time_star,
            first_slip_time_star: Some(71.0),
            peak: Some((78.0, 0.883)),
            kinetic: Some(Kinetic {
                from: 161.0,
                to: 267.0,
                mean: 0.53,
                uncertainty: Some(0.004),
            }),
            instants: letters
                .map(|(letter, t)| Instant {
                    letter,
                    time_star: t,
                    mu_star: mu(t),
                })
                .to_vec(),
        }
    }

    fn curve(points: &[(f64, f64)]) -> FrictionCurve {
        let (time_star, mu_star) = points.iter().copied().unzip();
        FrictionCurve {
            time_star,
            mu_star,
            sliding_percent: vec![0.0; points.len()],
            ..FrictionCurve::default()
        }
    }

    /// The point at which the SVG writes `text`.
    fn written_at(svg: &str, text: &str) -> Option<(f64, f64)> {
        let line = svg
            .lines()
            .find(|line| line.ends_with(&format!(">{text}</text>")))?;
        let value = |name: &str| {
            line.split_once(&format!(" {name}=\""))?
                .1
                .split_once('"')?
                .0
                .parse()
                .ok()
        };
        Some((value("x")?, value("y")?))
    }

    #[test]
    fn the_same_curve_gives_the_same_bytes() {
        assert_eq!(friction(&[run()]).unwrap(), friction(&[run()]).unwrap());
    }

    #[test]
    fn every_mark_is_written_once_and_apart_from_the_others() {
        let svg = friction(&[run()]).unwrap().svg;
        // C is the peak and shares its label.
        let letters = ["A", "B", "C: \u{3bc}", "D", "E", "F"].map(|letter| written_at(&svg, letter).unwrap());
        for (index, a) in letters.iter().enumerate() {
            for b in &letters[..index] {
                assert!(
                    (a.0 - b.0).abs() > 20.0 || (a.1 - b.1).abs() > 25.0,
                    "{letters:?}"
                );
            }
        }
        for text in ["first slip", "* = 0.883", "* = 0.530 \u{b1} 0.004"] {
            assert_eq!(svg.matches(text).count(), 1, "{text}");
        }
    }

    #[test]
    fn instants_at_the_peak_share_its_label() {
        let mut uniform = run();
        uniform.instants[1] = Instant {
            letter: 'B',
            ..uniform.instants[2]
        };
        let svg = friction(&[uniform]).unwrap().svg;
        assert!(written_at(&svg, "B, C: \u{3bc}").is_some() && written_at(&svg, "B").is_none());
    }

    #[test]
    fn several_curves_have_a_legend_and_the_letters_of_at_most_one() {
        let svg = |other: FrictionCurve| friction(&[run(), other]).unwrap().svg;
        let (one, two) = (svg(curve(&[(0.0, 0.0), (300.0, 1.0)])), svg(run()));
        assert!(one.contains(">a &lt; b &amp; $c$</text>"));
        assert!(written_at(&one, "A").is_some() && written_at(&two, "A").is_none());
        assert!(!one.contains("first slip") && !two.contains("first slip"));
    }

    #[test]
    fn poor_curves_are_drawn_all_the_same() {
        let odd = [
            curve(&[]),
            curve(&[(0.0, 0.3)]),
            curve(&[(0.0, 0.3), (1.0, 0.3)]),
            curve(&[(0.0, -0.3), (1.0, -0.1)]),
            curve(&[(0.0, f64::NAN), (f64::NAN, 1.0)]),
            curve(&[(0.0, f64::MAX), (f64::INFINITY, f64::MIN), (2.0, 1.0)]),
            FrictionCurve {
                peak: Some((9.0, f64::NAN)),
                first_slip_time_star: Some(f64::NAN),
                kinetic: Some(Kinetic {
                    from: f64::NAN,
                    to: 1.0,
                    mean: 1.0,
                    uncertainty: Some(f64::INFINITY),
                }),
                instants: vec![Instant {
                    letter: '\u{0}',
                    time_star: f64::INFINITY,
                    mu_star: 0.0,
                }],
                ..curve(&[(0.0, 0.0), (1.0, 1.0)])
            },
        ];
        for curve in &odd {
            let svg = friction(std::slice::from_ref(curve)).unwrap().svg;
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{curve:?}");
        }
        friction(&odd).unwrap();
    }

    #[test]
    fn columns_of_different_length_are_refused() {
        let mut bad = curve(&[(0.0, 0.0), (1.0, 1.0)]);
        bad.sliding_percent.pop();
        let error = friction(&[bad]).unwrap_err().to_string();
        assert_eq!(error, "curve `` has 2 times but 1 values of N*");
        assert_eq!(
            friction(&[]).unwrap_err().to_string(),
            "there is no curve to draw"
        );
    }
}
