//! The canvas of a picture: a list of lines, shapes, texts and images, in drawing order.

use crate::color_image::Image;
use crate::geometry::{Align, Area, CanvasPoint};
use crate::size::PictureSize;
use crate::style::{BLACK, CurveStyle, MM, Rgb, TICK_LENGTH, WHITE, WIDTH_CURVE, WIDTH_FRAME, WIDTH_MARK};
use crate::text::{Text, width};

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Canvas {
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// Factor by which the picture is larger than its canvas.
    pub(crate) scale: f64,
    /// Images, which lie below everything else.
    pub(crate) images: Vec<Image>,
    pub(crate) elements: Vec<Element>,
}

/// Something drawn in one colour.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Element {
    pub(crate) primitive: Primitive,
    pub(crate) colour: Rgb,
    /// Opacity from 0 to 1.
    pub(crate) opacity: f64,
}

/// Elements that can be drawn; areas are filled. SVG, PNG and PDF are made of these alone.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Primitive {
    Line(Line),
    Polygon(Vec<CanvasPoint>),
    Rectangle(Area),
    Disc { centre: CanvasPoint, radius: f64 },
    Letters(Letters),
}

/// A line through points.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Line {
    pub(crate) points: Vec<CanvasPoint>,
    pub(crate) width: f64,
    /// Whether the line goes back to the first point.
    pub(crate) closed: bool,
    /// Lengths of dashes and of the gaps after them; empty for a line without gaps.
    pub(crate) dashes: &'static [f64],
}

/// Letters on a baseline.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Letters {
    pub(crate) text: String,
    pub(crate) size: u32,
    /// Where the baseline starts.
    pub(crate) at: CanvasPoint,
    /// Whether the letters read upwards.
    pub(crate) upwards: bool,
}

impl Letters {
    /// Directions along the line of text and from it towards the tops of the letters, y downwards.
    pub(crate) fn directions(&self) -> [[f32; 2]; 2] {
        if self.upwards {
            [[0.0, -1.0], [-1.0, 0.0]]
        } else {
            [[1.0, 0.0], [0.0, -1.0]]
        }
    }
}

impl Primitive {
    /// Moves the primitive to the right.
    fn shift(&mut self, by: f64) {
        match self {
            Self::Line(Line { points, .. }) | Self::Polygon(points) => {
                points.iter_mut().for_each(|point| point.0 += by);
            }
            Self::Rectangle(area) => area.x += by,
            Self::Disc { centre: at, .. } | Self::Letters(Letters { at, .. }) => at.0 += by,
        }
    }
}

impl Canvas {
    pub(crate) fn new(width: f64, height: f64) -> Self {
        Self {
            width,
            height,
            scale: 1.0,
            images: Vec::new(),
            elements: Vec::new(),
        }
    }

    /// A canvas with letters, lines and marks of the requested size.
    pub(crate) fn sized(width: f64, height: f64, size: PictureSize) -> Self {
        Self {
            scale: size.scale(),
            ..Self::new(width, height)
        }
    }

    /// Width and height on paper, mm.
    pub(crate) fn millimetres(&self) -> [f64; 2] {
        [self.width, self.height].map(|side| self.scale * side / MM)
    }

    /// Width and height in pixels of the PNG.
    pub(crate) fn pixels(&self) -> [u32; 2] {
        [self.width, self.height].map(|side| (self.scale * side).round() as u32)
    }

    /// Changes the width of the canvas to the requested one and centres its content. Without a requested
    /// width, the canvas keeps its width.
    pub(crate) fn widened(mut self, size: PictureSize) -> Self {
        let width = match size.width_mm {
            None => self.width,
            Some(_) => size.width(self.width),
        };
        let right = 0.5 * (width - self.width);
        for image in &mut self.images {
            image.area.x += right;
        }
        for element in &mut self.elements {
            element.primitive.shift(right);
        }
        self.width = width;
        self
    }

    fn add(&mut self, primitive: Primitive, colour: Rgb, opacity: f64) {
        self.elements.push(Element {
            primitive,
            colour,
            opacity,
        });
    }

    pub(crate) fn line(&mut self, from: CanvasPoint, to: CanvasPoint, width: f64, colour: Rgb) {
        self.polyline(vec![from, to], width, colour);
    }

    /// Adds a line through points, closed if it ends where it starts.
    pub(crate) fn polyline(&mut self, mut points: Vec<CanvasPoint>, width: f64, colour: Rgb) {
        let closed = points.len() > 3 && points.first() == points.last();
        if closed {
            points.pop();
        }
        let line = Line {
            points,
            width,
            closed,
            ..Line::default()
        };
        self.add(Primitive::Line(line), colour, 1.0);
    }

    /// Adds a curve, or a part of one.
    pub(crate) fn curve(&mut self, points: Vec<CanvasPoint>, CurveStyle { colour, dashes }: CurveStyle) {
        let line = Line {
            points,
            width: WIDTH_CURVE,
            closed: false,
            dashes,
        };
        self.add(Primitive::Line(line), colour, 1.0);
    }

    pub(crate) fn fill(&mut self, area: Area, colour: Rgb, opacity: f64) {
        self.add(Primitive::Rectangle(area), colour, opacity);
    }

    pub(crate) fn polygon(&mut self, points: Vec<CanvasPoint>, colour: Rgb, opacity: f64) {
        self.add(Primitive::Polygon(points), colour, opacity);
    }

    /// Adds an area with its edge.
    pub(crate) fn edged_area(&mut self, mut points: Vec<CanvasPoint>, colour: Rgb, opacity: f64, edge: Rgb) {
        self.polygon(points.clone(), colour, opacity);
        points.extend(points.first().copied());
        self.polyline(points, WIDTH_MARK, edge);
    }

    /// Draws the edge of a rectangle.
    pub(crate) fn frame(&mut self, area: Area) {
        let (left, right, top, bottom) = (area.x, area.right(), area.y, area.bottom());
        let corners = [
            (left, top),
            (right, top),
            (right, bottom),
            (left, bottom),
            (left, top),
        ];
        self.polyline(corners.to_vec(), WIDTH_FRAME, BLACK);
    }

    /// Adds a disc.
    pub(crate) fn disc(&mut self, centre: CanvasPoint, radius: f64, colour: Rgb) {
        self.add(Primitive::Disc { centre, radius }, colour, 1.0);
    }

    /// Adds a disc with a thin white rim, which separates it from the curve below.
    pub(crate) fn dot(&mut self, centre: CanvasPoint, radius: f64, colour: Rgb) {
        for (radius, colour) in [(radius + 1.5, WHITE), (radius, colour)] {
            self.disc(centre, radius, colour);
        }
    }

    /// Adds a text on the baseline through `at`.
    pub(crate) fn text(&mut self, text: &Text, at: CanvasPoint, align: Align, colour: Rgb) {
        self.runs(text, at, align, colour, false);
    }

    /// Adds a text that reads upwards, with its baseline on the vertical line through `at`.
    pub(crate) fn text_upwards(&mut self, text: &Text, at: CanvasPoint, align: Align, colour: Rgb) {
        self.runs(text, at, align, colour, true);
    }

    fn runs(&mut self, text: &Text, (x, y): CanvasPoint, align: Align, colour: Rgb, upwards: bool) {
        let mut along = -align.offset(text.width());
        for run in &text.runs {
            // SVG drops leading spaces, so the text starts after them.
            let text = run.text.trim_start();
            let (spaces, _) = run.text.split_at(run.text.len() - text.len());
            let start = along + width(spaces, run.size);
            let letters = Letters {
                text: text.to_string(),
                size: run.size,
                at: if upwards {
                    (x + run.drop, y - start)
                } else {
                    (x + start, y + run.drop)
                },
                upwards,
            };
            if !text.is_empty() {
                self.add(Primitive::Letters(letters), colour, 1.0);
            }
            along += width(&run.text, run.size);
        }
    }

    /// Adds a tick below `at` and its number.
    pub(crate) fn tick_below(&mut self, at: CanvasPoint, number: &Text) {
        self.line(at, (at.0, at.1 + TICK_LENGTH), WIDTH_FRAME, BLACK);
        let baseline = at.1 + TICK_LENGTH + 7.0 + number.height();
        self.text(number, (at.0, baseline), Align::Middle, BLACK);
    }

    /// Adds a tick left of `at` and its number.
    pub(crate) fn tick_left(&mut self, at: CanvasPoint, number: &Text) {
        self.line((at.0 - TICK_LENGTH, at.1), at, WIDTH_FRAME, BLACK);
        let place = (at.0 - TICK_LENGTH - 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::End, BLACK);
    }

    /// Adds a tick right of `at` and its number.
    pub(crate) fn tick_right(&mut self, at: CanvasPoint, number: &Text) {
        self.line(at, (at.0 + TICK_LENGTH, at.1), WIDTH_FRAME, BLACK);
        let place = (at.0 + TICK_LENGTH + 7.0, at.1 + 0.5 * number.height());
        self.text(number, place, Align::Start, BLACK);
    }
}
