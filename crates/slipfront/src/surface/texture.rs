//! Textures: which blocks lie over a cavity, a groove, a polygon or a mask (Eqs. 15, 17, 18).
//!
//! Positions and sizes are in blocks. A block is textured when its centre lies inside the outline of any texture. Outlines
//! wrap around periodic axes and are clipped at free edges.

use serde::{Deserialize, Serialize};

use std::f64::consts::{PI, TAU};

use crate::lattice::{Edges, Lattice};
use crate::vector_field::unit_vector;

/// A textured zone.
#[derive(Clone, Debug, PartialEq)]
pub enum Texture {
    /// The closed curve of Eq. 17, once or on a grid.
    Cavity(Cavity),
    /// A straight strip from edge to edge.
    Groove(Groove),
    /// Any polygon, by the even-odd rule.
    Polygon(Vec<[f64; 2]>),
    /// An image stretched over the slider.
    Image(MaskImage),
    /// Block by block, row by row from y = 0.
    Blocks(Vec<bool>),
}

/// The cavity of Eq. 17 (Fig. 13):
///
/// ```text
/// x = x_0 + lambda (cos phi + w cos(s phi)),   y = y_0 + lambda (sin phi - w sin(s phi))
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cavity {
    /// Centre (x_0, y_0) of the cavity, or of the grid of cavities.
    pub center: [f64; 2],
    /// Size `lambda`.
    pub lambda: f64,
    /// Vertices less one: 1 makes ellipses, s > 1 semi-polygons of s + 1 edges.
    pub s: u32,
    /// Elongation (s = 1) or sharpness of the vertices; |w| <= 1/s, and |w| < 1 for s = 1.
    pub w: f64,
    /// Swaps x and y: elongated across the x axis.
    pub across: bool,
    /// Turn in degrees from x towards y, after the swap.
    pub rotate: f64,
    /// Columns and rows of the grid on which the cavity is repeated, spread over the slider.
    pub array: [usize; 2],
}

/// Size `lambda` of each of `count` cavities that together cover `percent` of `n_blocks` blocks (Eq. 18, D5):
///
/// ```text
/// lambda = sqrt(N A*/(100 pi (1 - s w^2)))
/// ```
///
/// ```
/// let lambda = slipfront::surface::cavity_lambda(10.0, 2500, 1, 0.0, 1);
/// assert!((std::f64::consts::PI * lambda * lambda - 250.0).abs() < 1e-9);
/// ```
pub fn cavity_lambda(percent: f64, n_blocks: usize, s: u32, w: f64, count: usize) -> f64 {
    (n_blocks as f64 * percent / (100.0 * count as f64 * PI * (1.0 - f64::from(s) * w * w))).sqrt()
}

/// Share of `n_blocks` blocks, in %, that `count` cavities of size `lambda` enclose: the inverse of
/// [`cavity_lambda`].
pub fn cavity_percent(lambda: f64, n_blocks: usize, s: u32, w: f64, count: usize) -> f64 {
    100.0 * count as f64 * PI * lambda * lambda * (1.0 - f64::from(s) * w * w) / n_blocks as f64
}

/// Which way a groove runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Orientation {
    /// Across the x axis: the strip runs along y.
    Across,
    /// Along the x axis.
    Along,
}

/// A straight groove, half-open: the block whose centre lies on its lower edge is in, on its upper edge out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// Which way it runs.
    pub orientation: Orientation,
    /// Width.
    pub width: f64,
    /// Distance of its middle line from the middle of the slider.
    pub offset: f64,
}

/// A black and white image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MaskImage {
    /// Pixels along x.
    pub width: usize,
    /// Pixels along y.
    pub height: usize,
    /// Dark pixels (textured), row by row from the top, which is the largest y.
    pub dark: Vec<bool>,
}

impl MaskImage {
    /// Whether block (i, j) of the lattice lies on a dark pixel: the nearest one of the image stretched over the slider.
    fn covers(&self, lattice: &Lattice, i: usize, j: usize) -> bool {
        let column = (2 * i + 1) * self.width / (2 * lattice.nx);
        let row = (2 * (lattice.ny - 1 - j) + 1) * self.height / (2 * lattice.ny);
        self.dark[row * self.width + column]
    }
}

/// A texture on a lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct Meshed {
    /// Textured blocks.
    pub textured: Vec<bool>,
    /// Indices of the textures that extend beyond a free edge and are clipped there.
    pub clipped: Vec<usize>,
}

/// Marks the blocks covered by any of the textures.
pub fn mesh(lattice: &Lattice, textures: &[Texture]) -> Meshed {
    let mut meshed = Meshed {
        textured: vec![false; lattice.n_blocks()],
        clipped: Vec::new(),
    };
    for (index, texture) in textures.iter().enumerate() {
        let mut clipped = false;
        let mut cover = |outline: Outline| {
            clipped |= extends_beyond(&outline, lattice);
            fill(&outline, lattice, &mut meshed.textured);
        };
        match texture {
            // One outline at a time: a million cavities with thousands of vertices each would not fit in memory.
            Texture::Cavity(cavity) => cavity
                .centers(lattice)
                .for_each(|center| cover(cavity.outline(center))),
            Texture::Groove(groove) => cover(groove.outline(lattice)),
            Texture::Polygon(points) => cover(Outline::Polygon(points.clone())),
            Texture::Image(image) => {
                for (b, textured) in meshed.textured.iter_mut().enumerate() {
                    let (i, j) = lattice.column_row(b);
                    *textured |= image.covers(lattice, i, j);
                }
            }
            Texture::Blocks(blocks) => {
                let pairs = meshed.textured.iter_mut().zip(blocks);
                pairs.for_each(|(textured, block)| *textured |= block);
            }
        }
        meshed.clipped.extend(clipped.then_some(index));
    }
    meshed
}

/// A closed outline that can be intersected with a horizontal line.
enum Outline {
    Ellipse {
        center: [f64; 2],
        semi_axes: [f64; 2],
        axis: [f64; 2],
    },
    Polygon(Vec<[f64; 2]>),
    /// Smallest and largest (x, y), infinite along the strip.
    Strip([[f64; 2]; 2]),
}

impl Groove {
    fn outline(&self, lattice: &Lattice) -> Outline {
        let along_x = self.orientation == Orientation::Along;
        let size = if along_x { lattice.ny } else { lattice.nx } as f64;
        let middle = 0.5 * size + self.offset;
        let (from, to) = (middle - 0.5 * self.width, middle + 0.5 * self.width);
        Outline::Strip(if along_x {
            [[f64::NEG_INFINITY, from], [f64::INFINITY, to]]
        } else {
            [[from, f64::NEG_INFINITY], [to, f64::INFINITY]]
        })
    }
}

/// Number of vertices of a semi-polygon's outline. They lie on the curve, and the chords between them differ from it by less
/// than `lambda (1 + s) (2 pi/4096)^2/8`, a ten-thousandth of a block at `lambda` = 100.
const OUTLINE_VERTICES: usize = 4096;

impl Cavity {
    fn centers(&self, lattice: &Lattice) -> impl Iterator<Item = [f64; 2]> + use<> {
        let [columns, rows] = self.array;
        let spacing = [
            lattice.nx as f64 / columns as f64,
            lattice.ny as f64 / rows as f64,
        ];
        let center = self.center;
        let position = |k: usize, count: usize| k as f64 - 0.5 * (count as f64 - 1.0);
        (0..rows).flat_map(move |b| {
            (0..columns).map(move |a| {
                [
                    center[0] + spacing[0] * position(a, columns),
                    center[1] + spacing[1] * position(b, rows),
                ]
            })
        })
    }

    fn outline(&self, center: [f64; 2]) -> Outline {
        let axis = unit_vector(self.rotate);
        let swap = |p: [f64; 2]| if self.across { [p[1], p[0]] } else { p };
        if self.s == 1 || self.w == 0.0 {
            let w = if self.s == 1 { self.w } else { 0.0 };
            let semi_axes = swap([self.lambda * (1.0 + w), self.lambda * (1.0 - w)]);
            return Outline::Ellipse {
                center,
                semi_axes,
                axis,
            };
        }
        let s = f64::from(self.s);
        let vertex = |k: usize| {
            let phi = TAU * k as f64 / OUTLINE_VERTICES as f64;
            let p = swap([
                self.lambda * (libm::cos(phi) + self.w * libm::cos(s * phi)),
                self.lambda * (libm::sin(phi) - self.w * libm::sin(s * phi)),
            ]);
            [
                center[0] + axis[0] * p[0] - axis[1] * p[1],
                center[1] + axis[1] * p[0] + axis[0] * p[1],
            ]
        };
        Outline::Polygon((0..OUTLINE_VERTICES).map(vertex).collect())
    }
}

impl Outline {
    /// Smallest and largest (x, y); infinite where a strip runs from edge to edge.
    fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Outline::Ellipse {
                center,
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                let half = [
                    ((a * c).powi(2) + (b * s).powi(2)).sqrt(),
                    ((a * s).powi(2) + (b * c).powi(2)).sqrt(),
                ];
                [
                    [center[0] - half[0], center[1] - half[1]],
                    [center[0] + half[0], center[1] + half[1]],
                ]
            }
            Outline::Polygon(points) => {
                points
                    .iter()
                    .fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |b, p| {
                        [
                            [b[0][0].min(p[0]), b[0][1].min(p[1])],
                            [b[1][0].max(p[0]), b[1][1].max(p[1])],
                        ]
                    })
            }
            Outline::Strip(bounds) => *bounds,
        }
    }

    /// Whether a point between two crossings is inside. An ellipse excludes its outline and is tested by a formula that
    /// rounds symmetrically, so that its mesh is as symmetric as the ellipse; other outlines are half-open.
    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        match self {
            Outline::Ellipse {
                center,
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                let (dx, dy) = (x - center[0], y - center[1]);
                ((dx * c + dy * s) / a).powi(2) + ((dy * c - dx * s) / b).powi(2) < 1.0
            }
            Outline::Polygon(_) | Outline::Strip(_) => true,
        }
    }

    /// Intersections with the horizontal line at `y`: pairs of x, inside in [enter, leave).
    fn intersect(&self, y: f64, crossings: &mut Vec<f64>) {
        crossings.clear();
        match self {
            Outline::Ellipse {
                center,
                semi_axes: [a, b],
                axis: [c, s],
            } => {
                // |(x, y) turned back, over the semi-axes| < 1 is a quadratic in x.
                let dy = y - center[1];
                let (p, q, r) = (c / a, s / b, dy * s / a);
                let t = dy * c / b;
                let square = p * p + q * q;
                let half = p * r - q * t;
                let root = half * half - square * (r * r + t * t - 1.0);
                if root > 0.0 {
                    let root = root.sqrt();
                    let (enter, leave) = ((-half - root) / square, (-half + root) / square);
                    // Slightly wider: `contains` decides about a centre that lies on the outline.
                    let margin = 1e-9 * a.abs().max(b.abs());
                    crossings.extend([center[0] + enter - margin, center[0] + leave + margin]);
                }
            }
            Outline::Polygon(points) => {
                let previous = points.iter().cycle().skip(points.len() - 1);
                for (p, q) in previous.zip(points) {
                    if (p[1] <= y) != (q[1] <= y) {
                        crossings.push(p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]));
                    }
                }
                crossings.sort_by(f64::total_cmp);
            }
            Outline::Strip([[left, bottom], [right, top]]) => {
                if (*bottom..*top).contains(&y) {
                    crossings.extend([*left, *right]);
                }
            }
        }
    }
}

fn extends_beyond(outline: &Outline, lattice: &Lattice) -> bool {
    let [low, high] = outline.bounds();
    [lattice.nx, lattice.ny].iter().enumerate().any(|(axis, &size)| {
        let over = |at: f64| at.is_finite() && !(0.0..=size as f64).contains(&at);
        lattice.edges[axis] == Edges::Free && (over(low[axis]) || over(high[axis]))
    })
}

/// Marks the blocks whose centre lies inside.
fn fill(outline: &Outline, lattice: &Lattice, textured: &mut [bool]) {
    let [low, high] = outline.bounds();
    let mut crossings = Vec::new();
    for row in blocks_between(low[1], high[1], lattice.ny, lattice.edges[1]) {
        outline.intersect(row as f64 + 0.5, &mut crossings);
        let j = row.rem_euclid(lattice.ny as isize) as usize;
        for inside in crossings.chunks_exact(2) {
            let columns = blocks_between(inside[0], inside[1], lattice.nx, lattice.edges[0]);
            // One turn around a periodic axis covers all columns of the row.
            for column in columns.take(lattice.nx + 1) {
                if !outline.contains([column as f64 + 0.5, row as f64 + 0.5]) {
                    continue;
                }
                textured[lattice.block(column.rem_euclid(lattice.nx as isize) as usize, j)] = true;
            }
        }
    }
}

/// Blocks along one axis whose centre k + 1/2 lies in [from, to); outside the lattice only along a periodic axis.
fn blocks_between(from: f64, to: f64, count: usize, edges: Edges) -> std::ops::Range<isize> {
    let (mut first, mut end) = ((from - 0.5).ceil(), (to - 0.5).ceil());
    if from.is_infinite() || to.is_infinite() || edges == Edges::Free {
        first = first.max(0.0);
        end = end.min(count as f64);
    }
    first as isize..end.max(first) as isize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(lattice: &Lattice, texture: Texture) -> usize {
        mesh(lattice, &[texture]).textured.iter().filter(|&&t| t).count()
    }

    fn cavity(s: u32, w: f64, percent: f64) -> Cavity {
        let lambda = cavity_lambda(percent, 2500, s, w, 1);
        Cavity {
            center: [25.0, 25.0],
            lambda,
            s,
            w,
            across: false,
            rotate: 0.0,
            array: [1, 1],
        }
    }

    #[test]
    fn a_groove_of_ten_percent_is_rows_22_to_26() {
        let lattice = Lattice::free(50, 50);
        let groove = Groove {
            orientation: Orientation::Across,
            width: 5.0,
            offset: 0.0,
        };
        let meshed = mesh(&lattice, &[Texture::Groove(groove)]);
        for b in 0..2500 {
            assert_eq!(meshed.textured[b], (22..=26).contains(&(b % 50)), "block {b}");
        }
        assert!(meshed.clipped.is_empty());
    }

    /// At these radii centres lie on the outline: 19, 21 and 35 are given exactly, and 35^2 = 28^2 + 21^2.
    #[test]
    fn the_mesh_of_a_circle_is_as_symmetric_as_the_circle() {
        for (n, lambda) in [
            (51, 19.0),
            (51, 21.0),
            (101, 35.0),
            (101, 41.0),
            (101, 49.0),
            (50, 12.5),
        ] {
            let lattice = Lattice::free(n, n);
            let circle = Cavity {
                center: [0.5 * n as f64; 2],
                lambda,
                ..cavity(1, 0.0, 1.0)
            };
            let t = mesh(&lattice, &[Texture::Cavity(circle)]).textured;
            for j in 0..n {
                for i in 0..n {
                    let here = t[lattice.block(i, j)];
                    let mirrored = [(n - 1 - i, j), (i, n - 1 - j), (j, i)];
                    let all = mirrored.iter().all(|&(i, j)| t[lattice.block(i, j)] == here);
                    assert!(all, "lambda = {lambda}: block ({i}, {j})");
                }
            }
        }
    }

    #[test]
    fn every_shape_covers_what_eq_18_says() {
        let lattice = Lattice::free(50, 50);
        let shapes = [
            (1, 0.0),
            (1, 0.6),
            (2, 0.5),
            (2, 0.1),
            (3, 1.0 / 3.0),
            (4, 0.25),
            (4, 0.05),
            (1, -0.6),
        ];
        for (s, w) in shapes {
            let blocks = count(&lattice, Texture::Cavity(cavity(s, w, 10.0)));
            // The meshed area of a smooth outline of perimeter ~60 differs from 250 by a few blocks.
            assert!(blocks.abs_diff(250) <= 8, "s = {s}, w = {w}: {blocks}");
        }
    }

    #[test]
    fn a_polygon_of_many_vertices_agrees_with_the_ellipse() {
        let lattice = Lattice::free(50, 50);
        let turned = Cavity {
            rotate: 33.0,
            center: [24.3, 26.1],
            ..cavity(1, 0.4, 12.0)
        };
        let axis = unit_vector(33.0);
        let points = (0..20_000)
            .map(|k| {
                let phi = TAU * f64::from(k) / 20_000.0;
                let p = [turned.lambda * 1.4 * phi.cos(), turned.lambda * 0.6 * phi.sin()];
                [
                    24.3 + axis[0] * p[0] - axis[1] * p[1],
                    26.1 + axis[1] * p[0] + axis[0] * p[1],
                ]
            })
            .collect();
        let ellipse = mesh(&lattice, &[Texture::Cavity(turned)]);
        assert_eq!(ellipse, mesh(&lattice, &[Texture::Polygon(points)]));
    }

    #[test]
    fn elongation_lies_along_x_and_across_turns_it() {
        let lattice = Lattice::free(50, 50);
        let along = mesh(&lattice, &[Texture::Cavity(cavity(1, 0.5, 10.0))]).textured;
        let across = mesh(
            &lattice,
            &[Texture::Cavity(Cavity {
                across: true,
                ..cavity(1, 0.5, 10.0)
            })],
        )
        .textured;
        let width = |t: &[bool]| (0..50).filter(|&i| t[25 * 50 + i]).count();
        assert!(width(&along) > 2 * width(&across));
        assert!((0..2500).all(|b| along[b] == across[(b % 50) * 50 + b / 50]));
    }

    #[test]
    fn free_edges_clip_and_periodic_ones_wrap() {
        let corner = Cavity {
            center: [0.0, 0.0],
            ..cavity(1, 0.0, 4.0)
        };
        let free = mesh(&Lattice::free(50, 50), &[Texture::Cavity(corner)]);
        let wrapped = mesh(
            &Lattice::with_edges(50, 50, [Edges::Periodic; 2]),
            &[Texture::Cavity(corner)],
        );
        let blocks = |m: &Meshed| m.textured.iter().filter(|&&t| t).count();
        assert_eq!(free.clipped, [0]);
        assert!(wrapped.clipped.is_empty());
        assert_eq!(4 * blocks(&free), blocks(&wrapped));
    }

    #[test]
    fn an_outline_larger_than_a_periodic_slider_covers_all_of_it() {
        let lattice = Lattice::with_edges(25, 25, [Edges::Periodic; 2]);
        for s in [1, 3] {
            let large = Cavity {
                center: [12.5, 12.5],
                ..cavity(s, 0.2, 100.0)
            };
            assert_eq!(count(&lattice, Texture::Cavity(large)), 625, "s = {s}");
        }
    }

    #[test]
    fn an_array_covers_as_much_as_one() {
        let lattice = Lattice::free(60, 60);
        let lambda = cavity_lambda(20.0, 3600, 1, 0.0, 6);
        let array = Cavity {
            center: [30.0, 30.0],
            lambda,
            s: 1,
            w: 0.0,
            across: false,
            rotate: 0.0,
            array: [3, 2],
        };
        let meshed = mesh(&lattice, &[Texture::Cavity(array)]);
        assert!(meshed.textured.iter().filter(|&&t| t).count().abs_diff(720) < 25);
        assert!(meshed.textured[lattice.block(10, 15)] && meshed.textured[lattice.block(50, 45)]);
    }

    #[test]
    fn a_picture_stands_upright() {
        let lattice = Lattice::free(4, 4);
        let image = MaskImage {
            width: 2,
            height: 2,
            dark: vec![true, false, false, false],
        };
        let meshed = mesh(&lattice, &[Texture::Image(image)]);
        let blocks: Vec<usize> = (0..16).filter(|&b| meshed.textured[b]).collect();
        assert_eq!(blocks, [8, 9, 12, 13]);
    }

    #[test]
    fn a_star_is_hollow_by_the_even_odd_rule() {
        let lattice = Lattice::free(40, 40);
        let star: Vec<[f64; 2]> = (0..5)
            .map(|k| {
                let phi = TAU * f64::from(2 * k) / 5.0;
                [20.0 + 19.0 * phi.cos(), 20.0 + 19.0 * phi.sin()]
            })
            .collect();
        let meshed = mesh(&lattice, &[Texture::Polygon(star)]);
        assert!(!meshed.textured[lattice.block(20, 20)]);
        assert!(meshed.textured[lattice.block(33, 20)]);
    }
}
