//! Friction and the share of sliding blocks against time or path.

use crate::axis::drawable;
use crate::canvas::Canvas;
use crate::friction_curve::{FrictionAxes, FrictionCurve, Kinetic};
use crate::friction_layout::Panels;
use crate::geometry::{Align, Area, Point};
use crate::label_placement::{Candidate, Placer, around};
use crate::legend::{Legend, Sample};
use crate::picture::{Picture, PictureError, check_columns};
use crate::series::segments;
use crate::style::{
    BLACK, COLUMN_WIDTH, CURVES, GREY, MARGIN, Rgb, SIZE_LABEL, WIDTH_CURVE, WIDTH_LEADER, WIDTH_MARK,
    curve_colour,
};
use crate::text::{Text, number};

const DOT: f64 = 7.0;
/// The kinetic window's shade.
const SHADE: Rgb = [0x9a, 0xa5, 0xb1];

/// Draws friction and, below it, N* against time or path, as wide as a journal's column (85 mm).
///
/// One curve is drawn with all it knows: first slip, peak, kinetic window, lettered instants. Several are
/// drawn over each other with their peaks, the lettered instants if only one has any, and a legend above. Curves
/// of more than 4000 points are thinned to the first, last, lowest and highest point of every pixel column, which
/// shows the same picture.
///
/// # Errors
///
/// No curve, or a curve whose columns differ in length.
pub fn friction(curves: &[FrictionCurve], axes: &FrictionAxes) -> Result<Picture, PictureError> {
    if curves.is_empty() {
        return Err(PictureError::Nothing("curve"));
    }
    for curve in curves {
        let columns = [
            ("friction", curve.friction.len()),
            ("N*", curve.sliding_percent.len()),
        ];
        check_columns(&curve.label, ("abscissae", curve.x.len()), &columns)?;
    }
    let panels = Panels::of(curves);
    let named = curves.iter().filter(|_| curves.len() > 1);
    let names: Vec<_> = named.map(|curve| (curve.label.as_str(), Sample::Line)).collect();
    let legend = Legend::of("", &names, panels.x.start, panels.x.end);
    let panels = panels.lowered(legend.height);
    let mut drawing = Drawing {
        canvas: Canvas::new(COLUMN_WIDTH, panels.bottom()),
        panels,
        axes,
        placer: Placer::new(panels.area(&panels.mu)),
    };
    panels.draw_axes(&mut drawing.canvas, axes);
    legend.draw(&mut drawing.canvas);
    match curves {
        [curve] => drawing.draw_one(curve),
        _ => drawing.draw_many(curves),
    }
    panels.draw_frames(&mut drawing.canvas);
    drawing.canvas.finish()
}

struct Drawing<'a> {
    canvas: Canvas,
    panels: Panels,
    axes: &'a FrictionAxes,
    /// Places the labels in the panel of friction.
    placer: Placer,
}

impl Drawing<'_> {
    /// One curve with its marks.
    fn draw_one(&mut self, curve: &FrictionCurve) {
        let Panels {
            x: across,
            mu,
            sliding,
        } = self.panels;
        let is_window = |window: &Kinetic| drawable(window.mean) && window.from < window.to;
        let window = curve.kinetic.filter(is_window);
        if let Some(window) = &window {
            self.shade_window(window);
        }
        let first_slip = curve.first_slip.filter(|&slip| across.contains(slip));
        let first_slip = first_slip.map(|slip| across.at(slip));
        if let Some(x) = first_slip {
            for axis in [mu, sliding] {
                self.canvas
                    .line((x, axis.start), (x, axis.end), WIDTH_LEADER, GREY);
            }
            self.placer.avoid(&[(x, mu.start), (x, mu.end)]);
        }
        self.draw_curve(curve, CURVES[0]);
        if let Some(window) = &window {
            // Over the curve, which would hide it.
            let ends = [window.from, window.to].map(|t| (across.clamped(t), mu.clamped(window.mean)));
            self.canvas.line(ends[0], ends[1], WIDTH_MARK, CURVES[1]);
            self.placer.avoid(&ends);
        }
        let marks = Marks::of(&self.panels, self.axes, curve, curve.peak);
        self.keep_free(&marks.dots);
        // Labels that can go in fewest places come first.
        if let Some(window) = &window {
            let FrictionAxes { kinetic, unit, .. } = self.axes;
            let label = format!("{kinetic} = {}{unit}", with_uncertainty(window));
            let text = Text::math(&label, SIZE_LABEL);
            self.write(&text, along_window(&self.panels, &text, window), CURVES[1]);
        }
        self.label_points(&marks.peak, &marks.dots);
        if let Some(x) = first_slip {
            let text = Text::plain("first slip", SIZE_LABEL);
            self.write(&text, beside_line(&self.panels, &text, x), GREY);
        }
        self.label_points(&marks.instants, &marks.dots);
        self.draw_dots(&marks.dots);
    }

    /// Several curves, with their peaks.
    fn draw_many(&mut self, curves: &[FrictionCurve]) {
        let colour = |index| curve_colour(index, curves.len());
        for (index, curve) in curves.iter().enumerate() {
            self.draw_curve(curve, colour(index));
        }
        // Peaks last: no curve may hide one.
        for (index, curve) in curves.iter().enumerate() {
            if let Some(peak) = curve.peak.and_then(|peak| self.panels.point(peak)) {
                self.canvas.dot(peak, DOT, colour(index));
            }
        }
        // Letters of two curves could not be told apart.
        let mut lettered = curves.iter().filter(|curve| !curve.instants.is_empty());
        if let (Some(curve), None) = (lettered.next(), lettered.next()) {
            let marks = Marks::of(&self.panels, self.axes, curve, None);
            self.keep_free(&marks.dots);
            self.label_points(&marks.instants, &marks.dots);
            self.draw_dots(&marks.dots);
        }
    }

    /// Shades the window of kinetic friction in both panels, and the uncertainty of its mean.
    fn shade_window(&mut self, window: &Kinetic) {
        let Panels {
            x: across,
            mu,
            sliding,
        } = self.panels;
        let (from, to) = (across.clamped(window.from), across.clamped(window.to));
        for axis in [mu, sliding] {
            self.canvas
                .fill(Area::between(from, to, axis.start, axis.end), SHADE, 0.25);
        }
        if let Some(uncertainty) = window.uncertainty.filter(|&u| drawable(u)) {
            let [lo, hi] =
                [window.mean - uncertainty, window.mean + uncertainty].map(|value| mu.clamped(value));
            self.canvas.fill(Area::between(from, to, lo, hi), CURVES[1], 0.25);
        }
    }

    /// Draws friction and N*; labels keep off the former.
    fn draw_curve(&mut self, curve: &FrictionCurve, colour: Rgb) {
        let Panels {
            x: across,
            mu,
            sliding,
        } = &self.panels;
        let friction = segments(&curve.x, &curve.friction, across, mu);
        friction.iter().for_each(|segment| self.placer.avoid(segment));
        let sliding = segments(&curve.x, &curve.sliding_percent, across, sliding);
        for segment in friction.into_iter().chain(sliding) {
            match segment[..] {
                [point] => self.canvas.dot(point, 0.6 * DOT, colour),
                _ => self.canvas.polyline(segment, WIDTH_CURVE, colour),
            }
        }
    }

    /// Keeps labels off the dots.
    fn keep_free(&mut self, dots: &[Point]) {
        for (x, y) in dots {
            self.placer
                .take(Area::new(x - DOT, y - DOT, 2.0 * DOT, 2.0 * DOT));
        }
    }

    fn draw_dots(&mut self, dots: &[Point]) {
        for &dot in dots {
            self.canvas.dot(dot, DOT, BLACK);
        }
    }

    /// Writes the label of each of these points, which are among the `dots`.
    fn label_points(&mut self, points: &[(Point, Text)], dots: &[Point]) {
        for (at, text) in points {
            self.write(text, around(*at, box_of(text), dots), BLACK);
        }
    }

    /// Writes a text at the best of the places, with its leader.
    fn write(&mut self, text: &Text, candidates: Vec<Candidate>, colour: Rgb) {
        let Some(Candidate { area, leader, .. }) = self.placer.place(candidates) else {
            return;
        };
        if let Some([from, to]) = leader {
            self.canvas.line(from, to, WIDTH_LEADER, GREY);
        }
        let at = (area.x, area.bottom() - text.depth());
        self.canvas.text(text, at, Align::Start, colour);
    }
}

/// The points of a curve that are marked by dots, and their labels.
struct Marks {
    dots: Vec<Point>,
    /// The peak, if it is marked, with its value and the letters of the instants there: several labels of one point would
    /// take its neighbours' places.
    peak: Vec<(Point, Text)>,
    /// The other instants with their letters.
    instants: Vec<(Point, Text)>,
}

impl Marks {
    /// The instants of a curve that lie in the panel, and its peak if one is given.
    fn of(panels: &Panels, axes: &FrictionAxes, curve: &FrictionCurve, peak: Option<Point>) -> Self {
        let peak = peak.and_then(|(x, value)| Some((panels.point((x, value))?, value)));
        let (mut dots, mut instants, mut at_peak) = (Vec::new(), Vec::new(), Vec::new());
        for instant in &curve.instants {
            let Some(at) = panels.point((instant.x, instant.friction)) else {
                continue;
            };
            dots.push(at);
            let letter = instant.letter.to_string();
            let is_near = peak.is_some_and(|(peak, _)| libm::hypot(at.0 - peak.0, at.1 - peak.1) < 2.0);
            if is_near && instant.letter.is_alphanumeric() {
                at_peak.push(letter);
            } else {
                instants.push((at, Text::plain(&letter, SIZE_LABEL)));
            }
        }
        dots.extend(peak.map(|(at, _)| at));
        let colon = if at_peak.is_empty() { "" } else { ": " };
        let label = |(at, value): (Point, f64)| {
            let (letters, FrictionAxes { peak, unit, .. }) = (at_peak.join(", "), axes);
            let label = format!("{letters}{colon}{peak} = {}{unit}", number(value, 3));
            (at, Text::math(&label, SIZE_LABEL))
        };
        Self {
            dots,
            peak: peak.map(label).into_iter().collect(),
            instants,
        }
    }
}

/// The width and the full height of a text.
fn box_of(text: &Text) -> (f64, f64) {
    (text.width(), text.height() + text.depth())
}

/// Places for a label of the window: within it if it is wide enough, rather above the mean than below.
fn along_window(panels: &Panels, text: &Text, window: &Kinetic) -> Vec<Candidate> {
    let panel = panels.area(&panels.mu);
    let (from, to) = (panels.x.clamped(window.from), panels.x.clamped(window.to));
    let mean = panels.mu.clamped(window.mean);
    let (width, height) = box_of(text);
    let room = (panel.x + MARGIN, panel.right() - MARGIN - width);
    let x = (0.5 * (from + to - width)).min(room.1).max(room.0);
    let candidate = |step: usize| {
        let area = Area::new(x, panel.y + MARGIN + 8.0 * step as f64, width, height);
        let above = mean - area.bottom();
        Candidate {
            area,
            penalty: if above > 0.0 { above } else { 80.0 - above },
            leader: None,
        }
    };
    (0..(panel.height / 8.0) as usize).map(candidate).collect()
}

/// Places for a label of a vertical line: beside its upper end, or further down.
fn beside_line(panels: &Panels, text: &Text, x: f64) -> Vec<Candidate> {
    let panel = panels.area(&panels.mu);
    let (width, height) = box_of(text);
    let candidates = |step: usize| {
        let down = 10.0 * step as f64;
        [x - MARGIN - width, x + MARGIN].map(|x| Candidate {
            area: Area::new(x, panel.y + MARGIN + down, width, height),
            penalty: down,
            leader: None,
        })
    };
    (0..(panel.height / 10.0) as usize).flat_map(candidates).collect()
}

/// The mean and, if known, its uncertainty, with as many digits as that deserves.
fn with_uncertainty(window: &Kinetic) -> String {
    let Some(uncertainty) = window.uncertainty.filter(|&u| u > 0.0 && drawable(u)) else {
        return number(window.mean, 3);
    };
    let decimals = (-libm::log10(uncertainty).floor()).clamp(1.0, 5.0) as usize;
    [window.mean, uncertainty]
        .map(|value| number(value, decimals))
        .join(" \u{b1} ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction_curve::Instant;

    fn drawn(curves: &[FrictionCurve]) -> Result<Picture, PictureError> {
        friction(curves, &FrictionAxes::default())
    }

    /// A curve like a real run's: a ramp, a peak, a fall, sliding.
    fn run() -> FrictionCurve {
        let x: Vec<f64> = (0..=534).map(|step| 0.5 * f64::from(step)).collect();
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
            friction: x.iter().map(|&t| mu(t)).collect(),
            sliding_percent: x.iter().map(|&t| if t < 71.0 { 0.0 } else { 40.0 }).collect(),
            x,
            first_slip: Some(71.0),
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
                    x: t,
                    friction: mu(t),
                })
                .to_vec(),
        }
    }

    fn curve(points: &[(f64, f64)]) -> FrictionCurve {
        let (x, friction) = points.iter().copied().unzip();
        FrictionCurve {
            x,
            friction,
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
        assert_eq!(drawn(&[run()]).unwrap(), drawn(&[run()]).unwrap());
    }

    #[test]
    fn every_mark_is_written_once_and_apart_from_the_others() {
        let svg = drawn(&[run()]).unwrap().svg;
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
        let svg = drawn(&[uniform]).unwrap().svg;
        assert!(written_at(&svg, "B, C: \u{3bc}").is_some() && written_at(&svg, "B").is_none());
    }

    #[test]
    fn several_curves_have_a_legend_and_the_letters_of_at_most_one() {
        let svg = |other: FrictionCurve| drawn(&[run(), other]).unwrap().svg;
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
                first_slip: Some(f64::NAN),
                kinetic: Some(Kinetic {
                    from: f64::NAN,
                    to: 1.0,
                    mean: 1.0,
                    uncertainty: Some(f64::INFINITY),
                }),
                instants: vec![Instant {
                    letter: '\u{0}',
                    x: f64::INFINITY,
                    friction: 0.0,
                }],
                ..curve(&[(0.0, 0.0), (1.0, 1.0)])
            },
        ];
        for curve in &odd {
            let svg = drawn(std::slice::from_ref(curve)).unwrap().svg;
            assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{curve:?}");
        }
        drawn(&odd).unwrap();
    }

    #[test]
    fn columns_of_different_length_are_refused() {
        let mut bad = curve(&[(0.0, 0.0), (1.0, 1.0)]);
        bad.sliding_percent.pop();
        let error = drawn(&[bad]).unwrap_err().to_string();
        assert_eq!(error, "curve `` has 2 abscissae but 1 values of N*");
        assert_eq!(drawn(&[]).unwrap_err().to_string(), "there is no curve to draw");
    }
}
