//! Textured blocks: blocks with centres inside the outline of any texture. Outlines wrap around periodic axes
//! and are clipped at free edges. A rank meshes only its own rows.

use std::convert::Infallible;
use std::ops::Range;

use super::outline::{Crossing, Outlines, Sweep};
use super::pattern::{Crossings, grids, n_rows};
use super::texture::{Groove, Shape, Texture, Tile};
use crate::lattice::{Edges, Lattice};

/// A texture on a lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct Meshed {
    /// Textured blocks of the rows that were meshed.
    pub textured: Vec<bool>,
    /// Indices of the textures that extend beyond a free edge and are clipped there.
    pub clipped: Vec<usize>,
    /// Indices of the textures that cover no block of these rows.
    pub empty: Vec<usize>,
}

/// Marks the blocks covered by any of the textures.
pub fn mesh(lattice: &Lattice, textures: &[Texture]) -> Meshed {
    let Ok(meshed) = mesh_watched::<Infallible>(lattice, &(0..lattice.ny), textures, &mut |_| Ok(()));
    meshed
}

/// Meshes some rows as [`mesh`] does, with textures that may take long. `watch` receives the share that is
/// done, row of blocks by row of blocks; an error of `watch` ends the meshing.
pub fn mesh_watched<E>(
    lattice: &Lattice,
    rows: &Range<usize>,
    textures: &[Texture],
    watch: &mut dyn FnMut(f64) -> Result<(), E>,
) -> Result<Meshed, E> {
    let total: f64 = textures
        .iter()
        .map(|texture| n_rows(&grids(&texture.arrays)) as f64)
        .sum();
    let mut done = 0.0;
    let (mut clipped, mut empty) = (Vec::new(), Vec::new());
    let mut mask = Mask::new(lattice, rows);
    for (index, texture) in textures.iter().enumerate() {
        let grids = grids(&texture.arrays);
        let mut watch_texture = |rows: f64| watch((done + rows) / total);
        let is_clipped = if texture.inverted {
            let mut inside = Mask::new(lattice, rows);
            let is_clipped = inside.cover_copies(&texture.shape, &grids, &mut watch_texture)?;
            mask.cover_all_but(&inside);
            is_clipped
        } else {
            mask.cover_copies(&texture.shape, &grids, &mut watch_texture)?
        };
        done += n_rows(&grids) as f64;
        clipped.extend(is_clipped.then_some(index));
        empty.extend((!mask.covers).then_some(index));
    }
    Ok(Meshed {
        textured: mask.textured,
        clipped,
        empty,
    })
}

/// Whether copies of a texture's shape have blocks in common, anywhere on the lattice.
pub fn copies_overlap(lattice: &Lattice, texture: &Texture) -> bool {
    let rows = 0..lattice.ny;
    let mut mask = Mask::new(lattice, &rows);
    let Ok(_) = mask.cover_copies::<Infallible>(&texture.shape, &grids(&texture.arrays), &mut |_| Ok(()));
    mask.overlaps
}

/// Least distance of crossings for which they have the same order around every centre: coordinates of up to
/// 10^7 blocks have rounding errors of 10^-9.
const DISTINCT: f64 = 1e-6;

/// Least distance by which a clipped outline extends beyond an edge, for the same rounding errors.
const TOUCHING: f64 = 1e-8;

/// The largest distance between neighbouring lines of a grid.
fn largest_gap(lines: &[f64]) -> f64 {
    let gaps = lines.windows(2).map(|pair| pair[1] - pair[0]);
    gaps.fold(0.0, f64::max)
}

/// The blocks marked as textured so far.
struct Mask<'a> {
    lattice: &'a Lattice,
    /// The rows that are meshed.
    rows: &'a Range<usize>,
    textured: Vec<bool>,
    /// Rows that one outline, or overlapping outlines, cover from edge to edge.
    full: Vec<bool>,
    /// Whether the present texture covers any block of these rows.
    covers: bool,
    /// Whether some block was marked twice.
    overlaps: bool,
}

impl<'a> Mask<'a> {
    fn new(lattice: &'a Lattice, rows: &'a Range<usize>) -> Self {
        Self {
            lattice,
            rows,
            textured: vec![false; lattice.blocks_of(rows).len()],
            full: vec![false; rows.len()],
            covers: false,
            overlaps: false,
        }
    }

    /// Marks the blocks inside any of the copies of a shape; returns whether a copy extends beyond a free
    /// edge.
    fn cover_copies<E>(
        &mut self,
        shape: &Shape,
        grids: &[Crossings],
        watch: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<bool, E> {
        self.covers = false;
        match shape {
            Shape::Cavity(cavity) => self.cover(&cavity.outlines(grids), watch),
            Shape::Polygon(points) => self.cover(&Outlines::polygon(points, grids), watch),
            Shape::Drawing(parts) => self.cover(&Outlines::drawing(parts, grids), watch),
            Shape::Groove(groove) => Ok(self.cover_strips(groove, grids)),
            Shape::Tile(tile) => self.cover_tiles(tile, grids, watch),
        }
    }

    /// Marks the blocks that another mask does not mark.
    fn cover_all_but(&mut self, inside: &Mask) {
        self.covers = inside.textured.contains(&false);
        let pairs = self.textured.iter_mut().zip(&inside.textured);
        pairs.for_each(|(textured, inside)| *textured |= !inside);
    }

    /// Marks the blocks inside any of the outlines; returns whether an outline extends beyond a free edge.
    fn cover<E>(
        &mut self,
        outlines: &Outlines,
        watch: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<bool, E> {
        let mut crossings = Vec::new();
        let mut done = 0.0;
        for [columns, heights] in &outlines.centers {
            let gap = largest_gap(columns);
            for &center in heights {
                let [low, high] = outlines.heights(center);
                let rows = blocks_between(low, high, self.lattice.ny, self.lattice.edges[1]);
                let [bottom, top] = outlines.bounds(1, center);
                let mut sweep = outlines.at_height(center);
                for row in rows.clone() {
                    let Some(meshed_row) = self.meshed_row(row) else {
                        continue;
                    };
                    watch(done + (row - rows.start) as f64 / rows.len() as f64)?;
                    if self.covers && self.full[meshed_row] {
                        self.overlaps |= (bottom..top).contains(&(row as f64 + 0.5));
                        continue;
                    }
                    sweep.intersect(row as f64 + 0.5, &mut crossings);
                    self.cover_row(row, &sweep, &mut crossings, columns, gap);
                }
                done += 1.0;
            }
        }
        let is_clipped = |axis: usize| {
            let mut outermost = outlines.outermost(axis);
            outermost.any(|center| self.is_beyond(axis, &outlines.bounds(axis, center)))
        };
        Ok(is_clipped(0) || is_clipped(1))
    }

    /// Marks the blocks of a row inside any of the outlines around `centers`, which are at most `gap` apart.
    ///
    /// If all neighbours overlap, their union is one interval from the first to the last, and the work does
    /// not grow with their number.
    fn cover_row(
        &mut self,
        row: isize,
        sweep: &Sweep,
        crossings: &mut [Crossing],
        centers: &[f64],
        gap: f64,
    ) {
        let [first, .., last] = *centers else {
            return self.cover_pairs(row, sweep, crossings, centers);
        };
        crossings.sort_by(|a, b| a.x(first).total_cmp(&b.x(first)));
        let width = |pair: &[Crossing]| pair[1].x(first) - pair[0].x(first);
        if !crossings.windows(2).all(|pair| width(pair) > DISTINCT) {
            return self.cover_pairs(row, sweep, crossings, centers);
        }
        for pair in crossings.chunks_exact(2) {
            // A margin of a whole block, far more than rounding errors.
            if width(pair) > gap + 1.0 {
                self.overlaps = true;
                self.cover_interval(row, sweep, [(first, pair[0].x(first)), (last, pair[1].x(last))]);
            } else {
                self.cover_pairs(row, sweep, pair, centers);
            }
        }
    }

    /// Marks the blocks of a row between the crossings, one centre after the other.
    fn cover_pairs(&mut self, row: isize, sweep: &Sweep, crossings: &[Crossing], centers: &[f64]) {
        let mut ends = Vec::with_capacity(crossings.len());
        for &center in centers {
            ends.clear();
            ends.extend(crossings.iter().map(|crossing| crossing.x(center)));
            ends.sort_by(f64::total_cmp);
            for pair in ends.chunks_exact(2) {
                self.cover_interval(row, sweep, [(center, pair[0]), (center, pair[1])]);
            }
        }
    }

    /// Marks the blocks of a row from the entry into one outline to the exit from the same or another
    /// outline; each is given by x of the centre and x of the crossing.
    fn cover_interval(&mut self, row: isize, sweep: &Sweep, [enter, leave]: [(f64, f64); 2]) {
        let Lattice { nx, edges, .. } = *self.lattice;
        // Clipped afterwards: a block at a free edge may lie far inside an outline.
        let Range { mut start, mut end } = blocks_between(enter.1, leave.1, nx, Edges::Periodic);
        let is_inside =
            |column: isize, center: f64| sweep.contains(center, [column as f64 + 0.5, row as f64 + 0.5]);
        while start < end && !is_inside(start, enter.0) {
            start += 1;
        }
        while start < end && !is_inside(end - 1, leave.0) {
            end -= 1;
        }
        if edges[0] == Edges::Free {
            start = start.max(0);
            end = end.min(nx as isize);
        }
        self.fill(row, start..end);
    }

    /// Marks the blocks of the copies of a groove; returns whether a copy extends beyond a free edge.
    fn cover_strips(&mut self, groove: &Groove, grids: &[Crossings]) -> bool {
        let Lattice { nx, ny, edges } = *self.lattice;
        let mut is_clipped = false;
        for shift in groove.shifts(grids) {
            let [[left, bottom], [right, top]] = groove.bounds(self.lattice, shift);
            for row in blocks_between(bottom, top, ny, edges[1]) {
                self.fill(row, blocks_between(left, right, nx, edges[0]));
            }
            is_clipped |= self.is_beyond(0, &[left, right]) || self.is_beyond(1, &[bottom, top]);
        }
        is_clipped
    }

    /// Marks the blocks of the copies of a mask; returns whether a copy extends beyond a free edge.
    fn cover_tiles<E>(
        &mut self,
        tile: &Tile,
        grids: &[Crossings],
        watch: &mut dyn FnMut(f64) -> Result<(), E>,
    ) -> Result<bool, E> {
        let Lattice { nx, ny, edges } = *self.lattice;
        let within = |at: isize, axis: usize| {
            let size = [nx, ny][axis] as isize;
            if edges[axis] == Edges::Free {
                at.clamp(0, size)
            } else {
                at
            }
        };
        let mut is_clipped = false;
        let mut done = 0.0;
        for [columns, heights] in grids {
            for &y in heights {
                watch(done)?;
                for &x in columns {
                    let start = Tile::start(self.lattice, tile.size, [x, y]);
                    let end = [0, 1].map(|axis| start[axis] + tile.size[axis] as isize);
                    is_clipped |= [0, 1].iter().any(|&axis| {
                        within(start[axis], axis) != start[axis] || within(end[axis], axis) != end[axis]
                    });
                    for (row, blocks) in tile.rows.clone().zip(tile.blocks.chunks(tile.size[0])) {
                        let row = start[1] + row as isize;
                        if within(row, 1) != row || row == ny as isize && edges[1] == Edges::Free {
                            continue;
                        }
                        let mut column = start[0];
                        for run in blocks.chunk_by(|one, other| one == other) {
                            let next = column + run.len() as isize;
                            if run[0] {
                                self.fill(row, within(column, 0)..within(next, 0));
                            }
                            column = next;
                        }
                    }
                }
                done += 1.0;
            }
        }
        Ok(is_clipped)
    }

    /// Whether any of these coordinates lies beyond a free edge.
    fn is_beyond(&self, axis: usize, coordinates: &[f64]) -> bool {
        let size = [self.lattice.nx, self.lattice.ny][axis] as f64;
        // An outline that touches the edge is cut by rounding errors alone.
        let is_beyond = |at: &f64| at.is_finite() && !(-TOUCHING..=size + TOUCHING).contains(at);
        self.lattice.edges[axis] == Edges::Free && coordinates.iter().any(is_beyond)
    }

    /// Index of a row, counted on beyond periodic edges, among the meshed rows.
    fn meshed_row(&self, row: isize) -> Option<usize> {
        let row = row.rem_euclid(self.lattice.ny as isize) as usize;
        self.rows.contains(&row).then(|| row - self.rows.start)
    }

    /// Marks the blocks of a row; row and columns are counted on beyond periodic edges.
    fn fill(&mut self, row: isize, columns: Range<isize>) {
        let Some(row) = self.meshed_row(row) else { return };
        let nx = self.lattice.nx;
        self.covers |= !columns.is_empty();
        // One turn around a periodic axis covers all columns of the row.
        let count = columns.len().min(nx);
        let from = columns.start.rem_euclid(nx as isize) as usize;
        self.full[row] |= count == nx;
        let row = &mut self.textured[row * nx..][..nx];
        self.overlaps |= columns.len() > nx;
        for part in [from..nx.min(from + count), 0..(from + count).saturating_sub(nx)] {
            self.overlaps |= row[part.clone()].contains(&true);
            row[part].fill(true);
        }
    }
}

/// Blocks along one axis with their centre k + 1/2 in [from, to); outside the lattice only along a periodic
/// axis.
fn blocks_between(from: f64, to: f64, count: usize, edges: Edges) -> Range<isize> {
    let (mut first, mut end) = (first_from(from), first_from(to));
    if from.is_infinite() || to.is_infinite() || edges == Edges::Free {
        first = first.max(0.0);
        end = end.min(count as f64);
    }
    first as isize..end.max(first) as isize
}

/// The first block with its centre k + 1/2 at or above `from`.
fn first_from(from: f64) -> f64 {
    let first = from.floor();
    // A centre is exact, while `from - 0.5` might be rounded to a whole number.
    if first + 0.5 >= from { first } else { first + 1.0 }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::drawing::{FillRule, Part};
    use super::super::pattern::Array;
    use super::super::texture::{Cavity, Orientation, cavity_lambda};
    use super::*;
    use crate::vector_field::unit_vector;

    fn count(lattice: &Lattice, shape: Shape) -> usize {
        mesh(lattice, &[shape.into()])
            .textured
            .iter()
            .filter(|&&t| t)
            .count()
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
        }
    }

    /// A circle that passes through the centres of twelve blocks, which belong outside: 16 blocks whichever
    /// way it is turned, on every lattice that it is moved over.
    #[test]
    fn a_turned_circle_covers_the_same_blocks() {
        let lattice = Lattice::free(12, 12);
        for rotate in [0.0, 37.2, 163.52934363286016, 200.13624746953943, 359.0] {
            for (s, across) in [(1, false), (1, true), (4, false)] {
                let circle = Cavity {
                    center: [5.5, 6.0],
                    lambda: 2.5,
                    s,
                    w: 0.0,
                    across,
                    rotate,
                };
                assert_eq!(count(&lattice, Shape::Cavity(circle)), 16, "{circle:?}");
            }
        }
    }

    /// Every block is inside an ellipse if its centre is, by the formula alone: rows and columns are only
    /// where to look. The ellipses touch the centres of blocks at their ends, in any direction.
    #[test]
    fn an_ellipse_covers_what_its_formula_says() {
        let lattice = Lattice::free(40, 40);
        for k in 0..720 {
            let ellipse = Cavity {
                center: [20.0 + 0.5 * f64::from(k % 2), 20.5],
                lambda: f64::from(2 + k % 7),
                w: [0.5, 0.25, -0.5, 0.0][k as usize % 4],
                rotate: 0.5 * f64::from(k),
                ..cavity(1, 0.0, 1.0)
            };
            let outlines = ellipse.outlines(&grids(&[]));
            let meshed = mesh(&lattice, &[Shape::Cavity(ellipse).into()]);
            for (b, &textured) in meshed.textured.iter().enumerate() {
                let (i, j) = lattice.column_row(b);
                let place = [i as f64 + 0.5, j as f64 + 0.5];
                let sweep = outlines.at_height(ellipse.center[1]);
                assert_eq!(
                    textured,
                    sweep.contains(ellipse.center[0], place),
                    "{ellipse:?} at {place:?}"
                );
            }
        }
    }

    /// Strips along both axes have their bounds by one rule, which is exact one last digit from a centre.
    #[test]
    fn strips_begin_at_the_same_centres_along_both_axes() {
        for edge in [-0.5, 0.5, 3.5, 4.5] {
            for edge in [f64::next_down(edge), edge, f64::next_up(edge)] {
                let first = (-2..6).map(f64::from).find(|k| k + 0.5 >= edge);
                assert_eq!(Some(first_from(edge)), first, "{edge:e}");
            }
        }
    }

    /// A circle that touches free edges is not clipped, however its bounds are rounded.
    #[test]
    fn an_outline_that_touches_an_edge_is_whole() {
        let lattice = Lattice::free(50, 50);
        for rotate in 0..90 {
            let ellipse = Cavity {
                lambda: 20.0,
                w: 0.25,
                rotate: f64::from(rotate),
                ..cavity(1, 0.0, 1.0)
            };
            let outlines = ellipse.outlines(&grids(&[]));
            let reach = [0, 1].map(|axis| outlines.bounds(axis, 0.0)[1]);
            let touching = |by: f64| Cavity {
                center: reach.map(|reach| reach - by),
                ..ellipse
            };
            let clipped = |by| mesh(&lattice, &[Shape::Cavity(touching(by)).into()]).clipped;
            assert_eq!((clipped(1e-9), clipped(1e-6)), (vec![], vec![0]), "{rotate}");
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
        let meshed = mesh(&lattice, &[Shape::Groove(groove).into()]);
        for b in 0..2500 {
            assert_eq!(meshed.textured[b], (22..=26).contains(&(b % 50)), "block {b}");
        }
        assert!(meshed.clipped.is_empty());
    }

    /// Radii for which block centres lie on the outline: 19, 21 and 35 are represented exactly, and
    /// 35^2 = 28^2 + 21^2.
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
            let t = mesh(&lattice, &[Shape::Cavity(circle).into()]).textured;
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
            let blocks = count(&lattice, Shape::Cavity(cavity(s, w, 10.0)));
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
        let ellipse = mesh(&lattice, &[Shape::Cavity(turned).into()]);
        assert_eq!(ellipse, mesh(&lattice, &[Shape::Polygon(points).into()]));
    }

    #[test]
    fn elongation_lies_along_x_and_across_turns_it() {
        let lattice = Lattice::free(50, 50);
        let along = mesh(&lattice, &[Shape::Cavity(cavity(1, 0.5, 10.0)).into()]).textured;
        let across = mesh(
            &lattice,
            &[Shape::Cavity(Cavity {
                across: true,
                ..cavity(1, 0.5, 10.0)
            })
            .into()],
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
        let free = mesh(&Lattice::free(50, 50), &[Shape::Cavity(corner).into()]);
        let wrapped = mesh(
            &Lattice::with_edges(50, 50, [Edges::Periodic; 2]),
            &[Shape::Cavity(corner).into()],
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
            assert_eq!(count(&lattice, Shape::Cavity(large)), 625, "s = {s}");
        }
    }

    #[test]
    fn an_array_covers_as_much_as_one() {
        let lattice = Lattice::free(60, 60);
        let lambda = cavity_lambda(20.0, 3600, 1, 0.0, 6);
        let cavity = Cavity {
            center: [30.0, 30.0],
            lambda,
            s: 1,
            w: 0.0,
            across: false,
            rotate: 0.0,
        };
        let array = Texture {
            arrays: vec![Array::spread(&lattice, [3, 2])],
            ..Shape::Cavity(cavity).into()
        };
        let meshed = mesh(&lattice, &[array]);
        assert!(meshed.textured.iter().filter(|&&t| t).count().abs_diff(720) < 25);
        assert!(meshed.textured[lattice.block(10, 15)] && meshed.textured[lattice.block(50, 45)]);
    }

    /// A staggered pattern of whole and half blocks repeats after a row and half a column, and covers as many
    /// blocks as one separate cavity for each of its positions.
    #[test]
    fn a_staggered_pattern_repeats_itself_exactly() {
        let lattice = Lattice::with_edges(48, 40, [Edges::Periodic; 2]);
        let shape = Shape::Cavity(Cavity {
            center: [24.0, 20.0],
            lambda: 3.2,
            ..cavity(1, 0.3, 1.0)
        });
        let pattern = |staggered| Texture {
            arrays: vec![Array {
                staggered,
                ..Array::spread(&lattice, [4, 4])
            }],
            ..shape.clone().into()
        };
        let one = count(&lattice, shape.clone());
        for (texture, step) in [(pattern(true), [6, 10]), (pattern(false), [12, 10])] {
            let t = mesh(&lattice, &[texture]).textured;
            assert_eq!(t.iter().filter(|&&t| t).count(), 16 * one);
            for b in 0..t.len() {
                let (i, j) = lattice.column_row(b);
                assert_eq!(t[b], t[lattice.block((i + step[0]) % 48, (j + step[1]) % 40)]);
            }
        }
    }

    /// Clusters of four by three cavities in a pattern of three by two.
    #[test]
    fn a_pattern_of_patterns_has_a_pattern_at_every_place() {
        let lattice = Lattice::with_edges(60, 40, [Edges::Periodic; 2]);
        let inner = Array {
            count: [4, 3],
            spacing: [3.0, 4.0],
            staggered: true,
        };
        let dot = Cavity {
            center: [30.5, 20.5],
            lambda: 0.9,
            ..cavity(1, 0.0, 1.0)
        };
        let nested = Texture {
            arrays: vec![Array::spread(&lattice, [3, 2]), inner],
            ..Shape::Cavity(dot).into()
        };
        let t = mesh(&lattice, &[nested]).textured;
        let clusters: Vec<Texture> = (0..6)
            .map(|k| Texture {
                arrays: vec![inner],
                ..Shape::Cavity(Cavity {
                    center: [10.5 + f64::from(k % 3) * 20.0, 10.5 + f64::from(k / 3) * 20.0],
                    ..dot
                })
                .into()
            })
            .collect();
        assert_eq!(t, mesh(&lattice, &clusters).textured);
        assert!(t.iter().filter(|&&t| t).count() >= 72);
    }

    #[test]
    fn copies_of_a_groove_are_beside_each_other() {
        let lattice = Lattice::free(60, 40);
        let groove = |orientation| Groove {
            orientation,
            width: 3.0,
            offset: 0.0,
        };
        for (orientation, staggered, strips, size) in [
            (Orientation::Across, false, 5, 40),
            (Orientation::Across, true, 10, 40),
            (Orientation::Along, false, 4, 60),
            (Orientation::Along, true, 4, 60),
        ] {
            let shape = Shape::Groove(groove(orientation));
            let arrays = vec![Array {
                staggered,
                ..Array::spread(&lattice, [5, 4])
            }];
            assert_eq!(shape.n_copies(&arrays), strips);
            let texture = Texture {
                arrays,
                ..shape.into()
            };
            let blocks = mesh(&lattice, &[texture]).textured.iter().filter(|&&t| t).count();
            assert_eq!(blocks, strips * 3 * size, "{orientation:?} {staggered}");
        }
    }

    /// A mask of one column, in rows that are shifted by half a cell.
    #[test]
    fn tiles_are_laid_beside_each_other() {
        let lattice = Lattice::with_edges(24, 12, [Edges::Periodic; 2]);
        let size = [6, 3];
        let blocks: Vec<bool> = (0..18).map(|b| b % 6 == 2).collect();
        for staggered in [false, true] {
            let tile = Tile {
                size,
                rows: 0..3,
                blocks: blocks.clone().into(),
            };
            let texture = Texture {
                arrays: vec![Array {
                    staggered,
                    ..Array::spread(&lattice, [4, 4])
                }],
                ..Shape::Tile(tile).into()
            };
            let meshed = mesh(&lattice, &[texture]);
            assert!(meshed.clipped.is_empty());
            for (b, textured) in meshed.textured.iter().enumerate() {
                let (i, j) = lattice.column_row(b);
                // A quarter of a cell is one and a half blocks: even rows of cells move to the left by one
                // block, odd rows to the right by two.
                let shift = match (staggered, j / 3 % 2) {
                    (false, _) => 0,
                    (true, 0) => 23,
                    (true, _) => 2,
                };
                assert_eq!(*textured, (i + 24 - shift) % 6 == 2, "block ({i}, {j})");
            }
        }
    }

    #[test]
    fn pillars_leave_what_is_between_them() {
        let lattice = Lattice::free(50, 50);
        let circle = Cavity {
            lambda: 12.0,
            ..cavity(1, 0.0, 1.0)
        };
        let inverted = Texture {
            inverted: true,
            ..Shape::Cavity(circle).into()
        };
        let inside = count(&lattice, Shape::Cavity(circle));
        let outside = mesh(&lattice, std::slice::from_ref(&inverted));
        let found = outside.textured.iter().filter(|&&t| t).count();
        assert_eq!(found, 2500 - inside);
        assert!(!outside.textured[lattice.block(25, 25)] && outside.textured[0]);
        // Pillars everywhere leave no textured block.
        let all = Texture {
            inverted: true,
            ..Shape::Polygon(vec![[0.0, 0.0], [50.0, 0.0], [50.0, 50.0], [0.0, 50.0]]).into()
        };
        assert_eq!(mesh(&lattice, &[inverted, all]).empty, [1]);
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
        let meshed = mesh(&lattice, &[Shape::Polygon(star).into()]);
        assert!(!meshed.textured[lattice.block(20, 20)]);
        assert!(meshed.textured[lattice.block(33, 20)]);
    }

    /// Two squares that overlap, one in the other, and a square with a hole: the corners of both rules.
    #[test]
    fn parts_of_a_drawing_are_united_and_each_is_filled_by_its_rule() {
        let lattice = Lattice::free(20, 10);
        let square =
            |x: f64, y: f64, side: f64| vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]];
        let reversed = |x: f64, y: f64, side: f64| square(x, y, side).into_iter().rev().collect();
        let part = |rule, rings: &[Vec<[f64; 2]>]| Part {
            rings: rings.to_vec(),
            rule,
        };
        let count = |parts: &[Part]| count(&lattice, Shape::Drawing(parts.to_vec().into()));
        let [even_odd, non_zero] = [FillRule::EvenOdd, FillRule::NonZero];
        let nested = [square(0.0, 0.0, 6.0), square(2.0, 2.0, 2.0)];
        assert_eq!(count(&[part(even_odd, &nested)]), 32);
        assert_eq!(count(&[part(non_zero, &nested)]), 36);
        let turned = [square(0.0, 0.0, 6.0), reversed(2.0, 2.0, 2.0)];
        assert_eq!(count(&[part(non_zero, &turned)]), 32);
        let overlapping = [square(0.0, 0.0, 6.0), reversed(3.0, 3.0, 6.0)];
        assert_eq!(count(&[part(even_odd, &overlapping)]), 72 - 18);
        let parts = overlapping.map(|ring| part(even_odd, &[ring]));
        assert_eq!(count(&parts), 72 - 9);
        // A second part fills the hole of the first.
        assert_eq!(
            count(&[part(even_odd, &nested), part(non_zero, &nested[1..])]),
            36
        );
        // Copies in a row, and the union beyond an edge.
        let copies = Texture {
            arrays: vec![Array {
                count: [3, 1],
                spacing: [7.0, 1.0],
                staggered: false,
            }],
            ..Shape::Drawing(vec![part(even_odd, &nested), part(non_zero, &nested[1..])].into()).into()
        };
        let meshed = mesh(&lattice, &[copies]);
        assert_eq!(meshed.textured.iter().filter(|&&t| t).count(), 6 * (6 + 6));
        assert_eq!(meshed.clipped, [0]);
    }

    #[test]
    fn who_watches_sees_the_share_rise_and_can_end_it() {
        let lattice = Lattice::free(50, 50);
        let array = Texture {
            arrays: vec![Array::spread(&lattice, [2, 3])],
            ..Shape::Cavity(cavity(3, 0.2, 2.0)).into()
        };
        let textures = [array.clone(), array];
        let mut shares = Vec::new();
        let watched = mesh_watched::<Infallible>(&lattice, &(0..50), &textures, &mut |share| {
            shares.push(share);
            Ok(())
        });
        assert_eq!(watched, Ok(mesh(&lattice, &textures)));
        assert!(shares.is_sorted() && shares[0] == 0.0 && *shares.last().unwrap() > 0.9);
        let mut asked = 0;
        let stopped = mesh_watched(&lattice, &(0..50), &textures, &mut |_| {
            asked += 1;
            if asked < 10 { Ok(()) } else { Err("enough") }
        });
        assert_eq!((stopped, asked), (Err("enough"), 10));
    }
}
