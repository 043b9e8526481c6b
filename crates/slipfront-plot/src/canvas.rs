//! What a picture is drawn on, and how it becomes SVG and PNG.
//!
//! Lines and texts go through a `kuva` scene. Images (colour maps) are kept apart: the SVG holds each as one
//! pixelated image and the PNG as rectangles that end on whole pixels, because neighbouring rectangles in an
//! SVG leave hairline seams between them in most viewers.

use kuva::render::color::Color;
use kuva::render::render::{PathData, Primitive, TextAnchor};

use crate::export;
use crate::picture::{Picture, PictureError};
use crate::style::{BLACK, BLANK, Rgb, TICK_LENGTH, WHITE, WIDTH_FRAME, ramp};
use crate::text::{Run, Text};

/// Where a text lies relative to its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

impl Align {
    /// How far before the point a text of this width starts.
    fn before(self, width: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5 * width,
            Self::End => width,
        }
    }
}

/// A rectangle, in pixels, y downwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }
}

/// An image whose pixels are levels of the colour ramp.
pub(crate) struct Image {
    pub(crate) area: Area,
    pub(crate) columns: usize,
    /// Row by row, the uppermost first; see [`level`].
    pub(crate) levels: Vec<u8>,
}

/// The level of a blank pixel.
pub(crate) const LEVEL_BLANK: u8 = 255;

/// The level of a value from 0 to 1; NaN is blank.
pub(crate) fn level(value: f32) -> u8 {
    if value.is_nan() {
        LEVEL_BLANK
    } else {
        (value.clamp(0.0, 1.0) * f32::from(LEVEL_BLANK - 1)).round() as u8
    }
}

pub(crate) fn level_colour(level: u8) -> Rgb {
    if level == LEVEL_BLANK {
        BLANK
    } else {
        ramp(f64::from(level) / f64::from(LEVEL_BLANK - 1))
    }
}

/// A picture being drawn.
pub(crate) struct Canvas {
    width: f64,
    height: f64,
    images: Vec<Image>,
    elements: Vec<Primitive>,
}

impl Canvas {
    /// An empty canvas, `width` by `height` pixels.
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self {
            width: width.round(),
            height: height.round(),
            images: Vec::new(),
            elements: Vec::new(),
        }
    }

    /// Adds an image; images lie below everything else.
    pub(crate) fn image(&mut self, image: Image) {
        self.images.push(image);
    }

    /// Adds a straight line.
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), width: f64, colour: Rgb) {
        self.elements.push(Primitive::Line {
            x1: from.0,
            y1: from.1,
            x2: to.0,
            y2: to.1,
            stroke: color(colour),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    /// Adds a line through points.
    pub(crate) fn polyline(&mut self, points: Vec<(f64, f64)>, width: f64, colour: Rgb) {
        self.elements.push(Primitive::PolyLine {
            points,
            stroke: color(colour),
            stroke_width: width,
            stroke_dasharray: None,
        });
    }

    /// Fills a rectangle.
    pub(crate) fn fill(&mut self, area: Area, colour: Rgb, opacity: f64) {
        self.elements.push(Primitive::Rect {
            x: area.x,
            y: area.y,
            width: area.width,
            height: area.height,
            fill: color(colour),
            stroke: None,
            stroke_width: None,
            opacity: Some(opacity),
        });
    }

    /// Fills a polygon.
    pub(crate) fn polygon(&mut self, points: &[(f64, f64)], colour: Rgb, opacity: f64) {
        let corners: Vec<String> = points.iter().map(|(x, y)| format!("{x:.2} {y:.2}")).collect();
        self.elements.push(Primitive::Path(Box::new(PathData {
            d: format!("M {} Z", corners.join(" L ")),
            fill: Some(color(colour)),
            stroke: Color::None,
            stroke_width: 0.0,
            opacity: Some(opacity),
            stroke_dasharray: None,
        })));
    }

    /// Draws the edge of a rectangle.
    pub(crate) fn frame(&mut self, area: Area) {
        let (left, right, top, bottom) = (area.x, area.right(), area.y, area.bottom());
        self.elements.push(Primitive::Path(Box::new(PathData {
            d: format!("M {left} {top} L {right} {top} L {right} {bottom} L {left} {bottom} Z"),
            fill: None,
            stroke: color(BLACK),
            stroke_width: WIDTH_FRAME,
            opacity: None,
            stroke_dasharray: None,
        })));
    }

    /// Adds a disc with a thin white rim, which parts it from the curve below.
    pub(crate) fn dot(&mut self, centre: (f64, f64), radius: f64, fill: Rgb) {
        for (r, colour) in [(radius + 1.5, WHITE), (radius, fill)] {
            self.elements.push(Primitive::Circle {
                cx: centre.0,
                cy: centre.1,
                r,
                fill: color(colour),
                fill_opacity: None,
                stroke: None,
                stroke_width: None,
            });
        }
    }

    /// Adds a text on the baseline through `at`.
    pub(crate) fn text(&mut self, text: &Text, at: (f64, f64), align: Align, colour: Rgb) {
        let mut x = at.0 - align.before(text.width());
        for run in &text.runs {
            self.run(run, x, |x| (x, at.1 + run.drop), None, colour);
            x += run.width();
        }
    }

    /// Adds a text that reads upwards, its baseline the vertical through `at`.
    pub(crate) fn text_upwards(&mut self, text: &Text, at: (f64, f64), align: Align, colour: Rgb) {
        let mut along = -align.before(text.width());
        for run in &text.runs {
            self.run(
                run,
                along,
                |along| (at.0 + run.drop, at.1 - along),
                Some(-90.0),
                colour,
            );
            along += run.width();
        }
    }

    fn run(
        &mut self,
        run: &Run,
        along: f64,
        point: impl Fn(f64) -> (f64, f64),
        rotate: Option<f64>,
        colour: Rgb,
    ) {
        // SVG drops the spaces that a text starts with, so they are stepped over.
        let trimmed = run.text.trim_start();
        let spaces = Run {
            text: " ".repeat(run.text.len() - trimmed.len()),
            ..run.clone()
        };
        let (x, y) = point(along + spaces.width());
        self.elements.push(Primitive::Text {
            x,
            y,
            // kuva reads dollars as the edges of a formula.
            content: trimmed.replace('$', "\\$"),
            size: run.size,
            anchor: TextAnchor::Start,
            rotate,
            bold: false,
            color: Some(color(colour)),
        });
    }

    /// Adds a tick below `at` and its number.
    pub(crate) fn tick_below(&mut self, at: (f64, f64), number: &Text) {
        self.line(at, (at.0, at.1 + TICK_LENGTH), WIDTH_FRAME, BLACK);
        let baseline = at.1 + TICK_LENGTH + 7.0 + number.height();
        self.text(number, (at.0, baseline), Align::Middle, BLACK);
    }

    /// Adds a tick left of `at` and its number.
    pub(crate) fn tick_left(&mut self, at: (f64, f64), number: &Text) {
        self.line((at.0 - TICK_LENGTH, at.1), at, WIDTH_FRAME, BLACK);
        let place = (at.0 - TICK_LENGTH - 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::End, BLACK);
    }

    /// Adds a tick right of `at` and its number.
    pub(crate) fn tick_right(&mut self, at: (f64, f64), number: &Text) {
        self.line(at, (at.0 + TICK_LENGTH, at.1), WIDTH_FRAME, BLACK);
        let place = (at.0 + TICK_LENGTH + 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::Start, BLACK);
    }

    /// Makes both files.
    pub(crate) fn finish(self) -> Result<Picture, PictureError> {
        export::write(self.width, self.height, self.elements, &self.images)
    }
}

pub(crate) fn color(colour: Rgb) -> Color {
    Color::Rgb(colour[0], colour[1], colour[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_span_the_ramp_and_leave_one_for_blank() {
        assert_eq!(
            [0.0, 1.0, 2.0, -1.0, f32::NAN, f32::INFINITY].map(level),
            [0, 254, 254, 0, 255, 254]
        );
    }
}
