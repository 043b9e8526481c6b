//! Points (x, y) and rectangles of a picture, in pixels, y downwards.

pub(crate) type CanvasPoint = (f64, f64);

/// A length in hundredths of a pixel, which is less than a micrometre on paper.
pub(crate) fn length(pixels: f64) -> f64 {
    // Adding zero makes a negative zero positive.
    (pixels * 100.0).round() / 100.0 + 0.0
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Area {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Area {
    pub(crate) const fn new(x: f64, y: f64, width: f64, height: f64) -> Self {
        Self { x, y, width, height }
    }

    /// Numbers x, y, width and height of the area.
    pub(crate) fn sides(&self) -> [f64; 4] {
        [self.x, self.y, self.width, self.height]
    }

    /// The area between two values of x and two of y.
    pub(crate) fn between(from: f64, to: f64, start: f64, end: f64) -> Self {
        Self::new(from, start.min(end), to - from, (end - start).abs())
    }

    pub(crate) fn right(&self) -> f64 {
        self.x + self.width
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.y + self.height
    }

    pub(crate) fn centre(&self) -> CanvasPoint {
        (self.x + 0.5 * self.width, self.y + 0.5 * self.height)
    }
}

/// Position of a text relative to its point.
#[derive(Clone, Copy)]
pub(crate) enum Align {
    Start,
    Middle,
    End,
}

impl Align {
    /// Distance by which a text of this width starts before the point.
    pub(crate) fn offset(self, width: f64) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5 * width,
            Self::End => width,
        }
    }
}
