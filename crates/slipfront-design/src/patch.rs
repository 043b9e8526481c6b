//! Drafts of textures: patches that grow together until they have the wanted coverage.

use std::sync::Arc;

use crate::slider_blocks::SliderBlocks;

/// Form of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// A strip, or a rectangle.
    Rectangle,
    /// An ellipse, or a disc.
    Ellipse,
}

/// A part of a texture. Lengths are in blocks; the block in column 0 and row 0 has its centre at (1/2, 1/2).
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Patch {
    /// Centre of the patch.
    pub(crate) center: [f64; 2],
    /// Half length and half width of the patch, before it grows.
    pub(crate) half: [f64; 2],
    /// Angle between x and the length of the patch, radians.
    pub(crate) angle: f64,
    /// Form of the patch.
    pub(crate) form: Form,
}

impl Patch {
    /// Growth at which the patch contains a point, in blocks on every side; negative inside the patch. With
    /// (u, v) the position of the point along length and width, a the half length and b the half width:
    ///
    /// ```text
    /// rectangle  max(|u| - a, |v| - b);   ellipse  (sqrt((u/a)^2 + (v/b)^2) - 1) min(a, b)
    /// ```
    fn growth(&self, [x, y]: [f64; 2], [cos, sin]: [f64; 2]) -> f64 {
        let [u, v] = [cos * x + sin * y, cos * y - sin * x].map(f64::abs);
        let [a, b] = self.half;
        match self.form {
            Form::Rectangle => (u - a).max(v - b),
            Form::Ellipse => {
                let [a, b] = [a.max(0.5), b.max(0.5)];
                (((u / a) * (u / a) + (v / b) * (v / b)).sqrt() - 1.0) * a.min(b)
            }
        }
    }

    /// Reduces the growth of every block to that of this patch where it is smaller.
    fn lower(&self, grid: &SliderBlocks, growth: &mut [f64]) {
        let direction = [libm::cos(self.angle), libm::sin(self.angle)];
        let [nx, ny] = grid.size();
        let along = |axis: usize, n: usize| -> Vec<f64> {
            let places = (0..n).map(|place| place as f64 + 0.5 - self.center[axis]);
            let wrapped = |distance: f64| {
                if grid.is_periodic(axis) {
                    distance - (distance / n as f64).round() * n as f64
                } else {
                    distance
                }
            };
            places.map(wrapped).collect()
        };
        let [columns, rows] = [along(0, nx), along(1, ny)];
        for (line, y) in growth.chunks_exact_mut(nx).zip(rows) {
            for (growth, &x) in line.iter_mut().zip(&columns) {
                *growth = growth.min(rounded(self.growth([x, y], direction)));
            }
        }
    }
}

/// Rounds a growth to a millionth of a block, so that blocks along a strip parallel to an axis are at equal
/// distances from it, despite the rounding of the cosine of its angle.
fn rounded(growth: f64) -> f64 {
    (growth * 1e6).round() * 1e-6
}

/// A draft of a texture that consists of patches.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PatchDraft {
    /// Patches of the draft.
    pub(crate) patches: Vec<Patch>,
    /// Growth at which a texture that was drawn block by block contains each block, in blocks, if the draft
    /// begins with such a texture.
    pub(crate) drawn: Option<Arc<Vec<f64>>>,
    /// Largest share of the slider that the draft covers, %.
    pub(crate) percent: f64,
}

impl PatchDraft {
    /// A texture that was drawn block by block.
    pub(crate) fn drawn(grid: &SliderBlocks, textured: &[bool]) -> Self {
        Self {
            patches: Vec::new(),
            drawn: Some(growth_of(grid, textured).into()),
            percent: grid.percent(textured),
        }
    }

    /// Growth at which the draft contains each block.
    pub(crate) fn growth(&self, grid: &SliderBlocks) -> Vec<f64> {
        let n = grid.exists.len();
        let mut growth = match &self.drawn {
            Some(drawn) => drawn.to_vec(),
            None => vec![f64::INFINITY; n],
        };
        for patch in &self.patches {
            patch.lower(grid, &mut growth);
        }
        growth
    }
}

/// Growth in blocks at which a set contains each block: the number of straight or diagonal steps to the set;
/// for a block in the set, 1 minus the number of steps out of it.
fn growth_of(grid: &SliderBlocks, set: &[bool]) -> Vec<f64> {
    let outwards = steps_to(grid, set);
    let inwards = steps_to(grid, &set.iter().map(|is_in| !is_in).collect::<Vec<_>>());
    let pairs = outwards.iter().zip(&inwards);
    pairs
        .map(|(out, into)| if *out > 0.0 { *out } else { 1.0 - into })
        .collect()
}

/// Number of steps, straight or diagonal, from every block to a set; as many as the slider has blocks if the
/// set is empty.
fn steps_to(grid: &SliderBlocks, set: &[bool]) -> Vec<f64> {
    let most = set.len() as f64;
    let mut steps: Vec<f64> = set.iter().map(|&is_in| if is_in { 0.0 } else { most }).collect();
    let mut reached: Vec<usize> = (0..set.len()).filter(|&block| set[block]).collect();
    let mut distance = 0.0;
    while !reached.is_empty() {
        distance += 1.0;
        let mut next = Vec::new();
        for block in reached {
            for offset in [-1, 0, 1]
                .into_iter()
                .flat_map(|dy| [-1, 0, 1].map(|dx| [dx, dy]))
            {
                if let Some(neighbour) = grid.neighbour(block, offset)
                    && steps[neighbour] > distance
                {
                    steps[neighbour] = distance;
                    next.push(neighbour);
                }
            }
        }
        reached = next;
    }
    steps
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slider_blocks::tests::whole;

    fn growth_of_patch(patch: Patch, grid: &SliderBlocks) -> Vec<f64> {
        let draft = PatchDraft {
            patches: vec![patch],
            drawn: None,
            percent: 100.0,
        };
        draft.growth(grid)
    }

    #[test]
    fn a_strip_grows_on_every_side() {
        let strip = Patch {
            center: [2.5, 2.5],
            half: [100.0, 0.5],
            angle: 0.5 * std::f64::consts::PI,
            form: Form::Rectangle,
        };
        let growth = growth_of_patch(strip, &whole([5, 4], [false; 2]));
        for (block, growth) in growth.iter().enumerate() {
            let distance = (block % 5).abs_diff(2) as f64;
            assert_eq!(*growth, distance - 0.5);
        }
    }

    #[test]
    fn an_ellipse_reaches_around_a_periodic_axis() {
        let disc = Patch {
            center: [0.5, 0.5],
            half: [2.0, 2.0],
            angle: 0.3,
            form: Form::Ellipse,
        };
        let growth = growth_of_patch(disc, &whole([8, 8], [true, false]));
        let expected = |x: f64, y: f64| (x * x + y * y).sqrt() - 2.0;
        assert_eq!(growth[7], rounded(expected(1.0, 0.0)));
        assert_eq!(growth[8 * 7], rounded(expected(0.0, 7.0)));
    }

    /// The blocks with a growth of at most 0 are the drawn set.
    #[test]
    fn a_drawn_set_comes_back() {
        let grid = whole([6, 3], [false; 2]);
        let set: Vec<bool> = (0..18).map(|block| (1..4).contains(&(block % 6))).collect();
        let growth = growth_of(&grid, &set);
        assert_eq!(growth[..6], [1.0, 0.0, -1.0, 0.0, 1.0, 2.0]);
        let back: Vec<bool> = growth.iter().map(|&growth| growth <= 0.0).collect();
        assert_eq!(back, set);
    }
}
