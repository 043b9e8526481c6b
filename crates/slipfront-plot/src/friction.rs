//! Friction and the share of sliding blocks against time or path.

use crate::axis::drawable;
use crate::canvas::Canvas;
use crate::friction_curve::{FrictionAxes, FrictionCurve, KineticLine};
use crate::friction_layout::Panels;
use crate::geometry::{Align, Area, CanvasPoint};
use crate::label_placement::{Placer, around};
use crate::legend::{Legend, LegendSample};
use crate::picture::Picture;
use crate::picture_error::{PictureError, check_columns};
use crate::series::segments;
use crate::short_names::without_common_folder;
use crate::size::PictureSize;
use crate::style::{
    BLACK, COLUMN_WIDTH, CURVES, CurveStyle, GREY, Rgb, SIZE_TEXT, WIDTH_LEADER, WIDTH_MARK, curve_style,
};
use crate::text::{Text, number};

const DOT: f64 = 7.0;
/// Radius of a point of a record.
const POINT: f64 = 3.0;
/// Height above the panels of one curve for the names written there.
const ABOVE: f64 = 42.0;
/// Distance between two names above the panels.
const APART: f64 = 24.0;
/// Colour of the kinetic window.
const SHADE: Rgb = [0x9a, 0xa5, 0xb1];

/// Draws friction and, below it, N* against time or path, as wide as a journal's column (85 mm).
///
/// One curve is drawn with all its marks: first slip, peak, kinetic window, lettered instants. The names of
/// lines and windows are above the panels, clear of the curve. Several curves are overlaid, with their peaks
/// and a legend above; lettered instants are drawn if only one curve has any. Curves of more than 4000 points
/// are thinned to the first, last, lowest and highest point of every pixel column, which shows the same
/// picture.
///
/// # Errors
///
/// No curve, a curve whose columns differ in length, or a size that leaves no room for the curves.
pub fn friction(
    curves: &[FrictionCurve],
    axes: &FrictionAxes,
    size: PictureSize,
) -> Result<Picture, PictureError> {
    let width = size.roomy_width(COLUMN_WIDTH)?;
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
    let panels = Panels::new(curves, width, None);
    let named: Vec<&FrictionCurve> = curves.iter().filter(|_| curves.len() > 1).collect();
    let labels: Vec<&str> = named.iter().map(|curve| curve.label.as_str()).collect();
    let (folder, own) = without_common_folder(&labels);
    let samples = named.iter().map(|curve| {
        if curve.is_record {
            LegendSample::Points
        } else {
            LegendSample::Line
        }
    });
    let names = own.into_iter().zip(samples);
    let legend = Legend::new(folder, names, panels.x.start, panels.x.end);
    let above = if curves.len() > 1 { legend.height } else { ABOVE };
    size.check_height(above)?;
    let panels = match size.height() {
        Some(height) => Panels::new(curves, width, Some(height - above)),
        None => panels,
    };
    let panels = panels.lowered(above);
    let canvas = Canvas::sized(width, panels.bottom(), size);
    let mut drawing = FrictionDrawing {
        canvas,
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

struct FrictionDrawing<'a> {
    canvas: Canvas,
    panels: Panels,
    axes: &'a FrictionAxes,
    /// Places the labels in the panel of friction.
    placer: Placer,
}

impl FrictionDrawing<'_> {
    /// Draws one curve with its marks.
    fn draw_one(&mut self, curve: &FrictionCurve) {
        let Panels { x, mu, sliding } = self.panels;
        let is_window = |window: &KineticLine| drawable(window.mean) && window.from < window.to;
        let window = curve.kinetic.filter(is_window);
        if let Some(window) = &window {
            self.shade_window(window);
        }
        let first_slip = curve.first_slip.filter(|&slip| x.contains(slip));
        let first_slip = first_slip.map(|slip| x.at(slip));
        if let Some(at) = first_slip {
            for axis in [mu, sliding] {
                let ends = [axis.start, axis.end].map(|end| (at, end));
                self.canvas.line(ends[0], ends[1], WIDTH_LEADER, GREY);
            }
            self.placer.avoid(&[(at, mu.start), (at, mu.end)]);
        }
        self.draw_curve(curve, curve_style(0));
        if let Some(window) = &window {
            // Drawn after the curve, which would otherwise hide it.
            let ends = [window.from, window.to].map(|t| (x.clamped(t), mu.clamped(window.mean)));
            self.canvas.line(ends[0], ends[1], WIDTH_MARK, CURVES[1]);
            self.placer.avoid(&ends);
        }
        self.write_above(first_slip, window.as_ref());
        self.draw_marks(&marks(&self.panels, curve, curve.peak));
    }

    /// Names the line of the first slip and the window of kinetic friction.
    fn write_above(&mut self, first_slip: Option<f64>, window: Option<&KineticLine>) {
        let panel = self.panels.area(&self.panels.mu);
        let baseline = panel.y - 14.0;
        // Centred on the line or window that it names, within two ends.
        let placed = |middle: f64, text: &Text, [from, to]: [f64; 2]| {
            (middle - 0.5 * text.width()).min(to - text.width()).max(from)
        };
        let slip = first_slip.map(|x| (x, Text::plain("first slip", SIZE_TEXT)));
        let mut from = panel.x;
        let mut to = panel.right();
        if let Some(window) = window {
            let FrictionAxes { kinetic, unit, .. } = self.axes;
            let label = format!("{kinetic} = {}{unit}", with_uncertainty(window));
            let text = Text::math(&label, SIZE_TEXT);
            if let Some((_, slip)) = &slip {
                from += slip.width() + APART;
            }
            let [start, end] = [window.from, window.to].map(|t| self.panels.x.clamped(t));
            let x = placed(0.5 * (start + end), &text, [from, to]);
            self.canvas.text(&text, (x, baseline), Align::Start, CURVES[1]);
            to = x - APART;
        }
        if let Some((middle, text)) = slip {
            let x = placed(middle, &text, [panel.x, to]);
            self.canvas.text(&text, (x, baseline), Align::Start, GREY);
        }
    }

    /// Draws several curves, with their peaks.
    fn draw_many(&mut self, curves: &[FrictionCurve]) {
        // Points of records first, so that they hide no curve.
        for (index, curve) in curves.iter().enumerate().filter(|(_, curve)| curve.is_record) {
            self.draw_points(curve, curve_style(index).colour);
        }
        for (index, curve) in curves.iter().enumerate().filter(|(_, curve)| !curve.is_record) {
            self.draw_curve(curve, curve_style(index));
        }
        // Peaks last, so that no curve hides one.
        for (index, curve) in curves.iter().enumerate() {
            if let Some(peak) = curve.peak.and_then(|peak| self.panels.point(peak)) {
                self.canvas.dot(peak, DOT, curve_style(index).colour);
            }
        }
        // Letters of two curves could not be distinguished.
        let mut lettered = curves.iter().filter(|curve| !curve.instants.is_empty());
        if let (Some(curve), None) = (lettered.next(), lettered.next()) {
            self.draw_marks(&marks(&self.panels, curve, None));
        }
    }

    /// Shades the window of kinetic friction in both panels, and the uncertainty of its mean.
    fn shade_window(&mut self, window: &KineticLine) {
        let Panels { x, mu, sliding } = self.panels;
        let (from, to) = (x.clamped(window.from), x.clamped(window.to));
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

    /// Draws friction and N*; labels avoid the friction curve.
    fn draw_curve(&mut self, curve: &FrictionCurve, style: CurveStyle) {
        let Panels { x, mu, sliding } = &self.panels;
        let friction = segments(curve.friction_points(), x, mu);
        friction.iter().for_each(|segment| self.placer.avoid(segment));
        let sliding = segments(curve.sliding_points(), x, sliding);
        for segment in friction.into_iter().chain(sliding) {
            match segment[..] {
                [point] => self.canvas.dot(point, 0.6 * DOT, style.colour),
                _ => self.canvas.curve(segment, style),
            }
        }
    }

    /// Draws the points of a record.
    fn draw_points(&mut self, curve: &FrictionCurve, colour: Rgb) {
        let Panels { x, mu, .. } = &self.panels;
        for point in segments(curve.friction_points(), x, mu).concat() {
            self.canvas.disc(point, POINT, colour);
        }
    }

    /// Draws the dots of these marks, each with its label; the label of the peak comes first because it is
    /// the longest.
    fn draw_marks(&mut self, marks: &[Mark]) {
        let dots: Vec<CanvasPoint> = marks.iter().map(|mark| mark.at).collect();
        for (x, y) in &dots {
            self.placer
                .take(Area::new(x - DOT, y - DOT, 2.0 * DOT, 2.0 * DOT));
        }
        for mark in marks {
            let text = mark.label(self.axes);
            let size = (text.width(), text.height() + text.depth());
            let Some(placed) = self.placer.place(around(mark.at, size, &dots)) else {
                continue;
            };
            if let Some([from, to]) = placed.leader {
                self.canvas.line(from, to, WIDTH_LEADER, GREY);
            }
            let at = (placed.area.x, placed.area.bottom() - text.depth());
            self.canvas.text(&text, at, Align::Start, BLACK);
        }
        for dot in dots {
            self.canvas.dot(dot, DOT, BLACK);
        }
    }
}

/// A point of a curve that is marked by a dot.
struct Mark {
    at: CanvasPoint,
    /// Letters of the instants at the point.
    letters: Vec<String>,
    /// Friction at the point, if it is the peak.
    peak: Option<f64>,
}

impl Mark {
    fn label(&self, axes: &FrictionAxes) -> Text {
        let mut label = self.letters.join(", ");
        if let Some(value) = self.peak {
            let colon = if label.is_empty() { "" } else { ": " };
            let FrictionAxes { peak, unit, .. } = axes;
            label += &format!("{colon}{peak} = {}{unit}", number(value, 3));
        }
        Text::math(&label, SIZE_TEXT)
    }
}

/// The peak of a curve, if given, and its instants, if they lie in the panel. Instants with overlapping dots
/// are merged into one mark, because their letters could not be distinguished.
fn marks(panels: &Panels, curve: &FrictionCurve, peak: Option<CanvasPoint>) -> Vec<Mark> {
    let mark = |at, letters, peak| Mark { at, letters, peak };
    let peak = peak.and_then(|(x, value)| Some(mark(panels.point((x, value))?, Vec::new(), Some(value))));
    let mut marks: Vec<Mark> = peak.into_iter().collect();
    for instant in &curve.instants {
        let Some((x, y)) = panels.point((instant.x, instant.friction)) else {
            continue;
        };
        let letter = instant.letter.to_string();
        let covers = |mark: &&mut Mark| libm::hypot(x - mark.at.0, y - mark.at.1) < DOT;
        match marks.iter_mut().find(covers) {
            Some(mark) => mark.letters.push(letter),
            None => marks.push(mark((x, y), vec![letter], None)),
        }
    }
    marks
}

/// The mean and, if known, its uncertainty, with the significant digits.
fn with_uncertainty(window: &KineticLine) -> String {
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
        friction(curves, &FrictionAxes::default(), PictureSize::default())
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
            kinetic: Some(KineticLine {
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
            ..FrictionCurve::default()
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
                kinetic: Some(KineticLine {
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
