//! Lines and curves drawn as polylines.

use std::f64::consts::FRAC_PI_8;

pub(super) type Point = [f64; 2];

/// Largest distance of a chord from its curve, in blocks.
const CHORD_ERROR: f64 = 1e-4;
/// Points that are closer than this, in blocks, are one: drawings are often rounded to a nanometre.
pub(super) const CLOSE: f64 = 0.01;

/// Number of corners, elements and copies that a drawing may still have.
pub(super) struct Budget(usize);

impl Budget {
    pub(super) const WHOLE: usize = 1 << 20;

    pub(super) fn new() -> Self {
        Self(Self::WHOLE)
    }

    /// Takes this many, which may be no number.
    pub(super) fn take(&mut self, count: f64) -> Result<usize, String> {
        if count <= self.0 as f64 {
            self.0 -= count as usize;
            return Ok(count as usize);
        }
        Err(format!(
            "has more than {} corners, elements and copies, its curves drawn as chords: draw one copy and repeat it by `array`, \
             or export a picture for a mask",
            Self::WHOLE
        ))
    }
}

/// A linear map and a shift: (x, y) becomes (a x + c y + e, b x + d y + f).
#[derive(Clone, Copy)]
pub(super) struct Map(pub(super) [f64; 6]);

impl Map {
    pub(super) fn shift([x, y]: Point) -> Self {
        Self([1.0, 0.0, 0.0, 1.0, x, y])
    }

    pub(super) fn scale([x, y]: Point) -> Self {
        Self([x, 0.0, 0.0, y, 0.0, 0.0])
    }

    pub(super) fn rotation(degrees: f64) -> Self {
        let [c, s] = direction(degrees.to_radians());
        Self([c, s, -s, c, 0.0, 0.0])
    }

    /// The map after another.
    pub(super) fn after(self, first: Self) -> Self {
        let [a, b, c, d, _, _] = first.0;
        let [[a, b], [c, d]] = [self.turned([a, b]), self.turned([c, d])];
        let [e, f] = self.at([first.0[4], first.0[5]]);
        Self([a, b, c, d, e, f])
    }

    fn turned(&self, [x, y]: Point) -> Point {
        let [a, b, c, d, ..] = self.0;
        [a * x + c * y, b * x + d * y]
    }

    pub(super) fn at(&self, point: Point) -> Point {
        let [x, y] = self.turned(point);
        [x + self.0[4], y + self.0[5]]
    }

    /// At least the largest ratio of a length to that before.
    fn stretch(&self) -> f64 {
        let [a, b, c, d, ..] = self.0;
        length([length([a, b]), length([c, d])])
    }
}

/// The direction at an angle, radians from x to y.
pub(super) fn direction(angle: f64) -> Point {
    [libm::cos(angle), libm::sin(angle)]
}

pub(super) fn length([x, y]: Point) -> f64 {
    libm::hypot(x, y)
}

pub(super) fn difference(to: Point, from: Point) -> Point {
    [to[0] - from[0], to[1] - from[1]]
}

/// A polyline in the making, in blocks, drawn in the lengths of the file.
pub(super) struct Pen<'b> {
    map: Map,
    budget: &'b mut Budget,
    pub(super) here: Point,
    line: Vec<Point>,
}

impl<'b> Pen<'b> {
    pub(super) fn new(map: Map, budget: &'b mut Budget) -> Self {
        Self {
            map,
            budget,
            here: [0.0; 2],
            line: Vec::new(),
        }
    }

    /// Draws a straight line, or begins here.
    pub(super) fn to(&mut self, point: Point) -> Result<(), String> {
        self.budget.take(1.0)?;
        let mapped = self.map.at(point);
        if !mapped.iter().all(|length| length.is_finite()) {
            return Err("has a length that is not finite; write the file again".to_owned());
        }
        self.here = point;
        if self.line.last() != Some(&mapped) {
            self.line.push(mapped);
        }
        Ok(())
    }

    /// Draws a curve through `at` of 0 to 1 that ends at `end`, as chords; its second derivative is at most
    /// `bend`.
    pub(super) fn curve(&mut self, bend: f64, end: Point, at: impl Fn(f64) -> Point) -> Result<(), String> {
        let chords = (self.map.stretch() * bend / (8.0 * CHORD_ERROR)).sqrt().ceil();
        // Corners are taken one by one, but no number of chords is.
        if chords.is_nan() || chords > Budget::WHOLE as f64 {
            self.budget.take(f64::INFINITY)?;
        }
        let chords = chords as usize;
        for chord in 1..chords {
            self.to(at(chord as f64 / chords as f64))?;
        }
        self.to(end)
    }

    /// Draws a Bezier curve of two or three further points.
    pub(super) fn bezier(&mut self, points: &[Point]) -> Result<(), String> {
        let all = [&[self.here], points].concat();
        let n = points.len() as f64;
        let second = |p: &[Point]| {
            length([
                p[0][0] - 2.0 * p[1][0] + p[2][0],
                p[0][1] - 2.0 * p[1][1] + p[2][1],
            ])
        };
        let bend = n * (n - 1.0) * all.windows(3).map(second).fold(0.0, f64::max);
        self.curve(bend, all[points.len()], |t| {
            let mut rest = all.clone();
            while rest.len() > 1 {
                let between =
                    |pair: &[Point]| [0, 1].map(|axis| pair[0][axis] + t * (pair[1][axis] - pair[0][axis]));
                rest = rest.windows(2).map(between).collect();
            }
            rest[0]
        })
    }

    /// Draws the arc `center + cos(t) u + sin(t) v` to `end`; `t` goes through the angles.
    pub(super) fn arc(
        &mut self,
        center: Point,
        [u, v]: [Point; 2],
        [from, to]: [f64; 2],
        end: Point,
    ) -> Result<(), String> {
        let turn = to - from;
        let radius = length([length(u), length(v)]);
        // At least 16 chords to a circle, whatever its size.
        let bend =
            (turn * turn * radius).max((turn / FRAC_PI_8).powi(2) * 8.0 * CHORD_ERROR / self.map.stretch());
        self.curve(bend, end, |share| {
            let [c, s] = direction(from + share * turn);
            [0, 1].map(|axis| center[axis] + c * u[axis] + s * v[axis])
        })
    }

    /// Draws a whole ellipse.
    pub(super) fn ellipse(&mut self, center: Point, axes: [Point; 2]) -> Result<(), String> {
        let start = [0, 1].map(|axis| center[axis] + axes[0][axis]);
        self.to(start)?;
        self.arc(center, axes, [0.0, std::f64::consts::TAU], start)
    }

    /// The line drawn so far, and whether it returns to its beginning.
    pub(super) fn take(&mut self) -> (Vec<Point>, bool) {
        let mut line = std::mem::take(&mut self.line);
        let ends = line.first().zip(line.last());
        let is_closed =
            line.len() > 2 && ends.is_some_and(|(from, to)| length(difference(*to, *from)) < CLOSE);
        if is_closed {
            line.pop();
        }
        (line, is_closed)
    }
}
