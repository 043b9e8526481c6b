//! Correlated friction coefficients: means over blocks of a Gaussian random field that depends on the seed
//! and the position in the slider (Eq. 1).
//!
//! The nodes of a grid have standard normals z. The pitch of the grid is a fraction of the correlation length
//! xi, not of a block. The field
//!
//! ```text
//! g(x) = A sum_k z_k exp(-2 |x - x_k|^2/xi^2)     A^2 = 4 p_x p_y/(pi xi^2)
//! ```
//!
//! has the variance 1 and the correlation `exp(-(r/xi)^2)`. Its mean over a rectangle is a sum of products of
//! differences of error functions, one factor along x and one along y, so that the mean over a block is the
//! mean of the means over its parts.

use std::f64::consts::{FRAC_2_SQRT_PI, PI, SQRT_2};
use std::ops::{Range, RangeInclusive};

use super::coefficients::{Coefficients, Distribution, Stream, standard_normals};
use crate::lattice::{Edges, Lattice};
use crate::parallel::*;

/// Least number of nodes in a correlation length. With it the variance of the field varies by 1e-9 of itself
/// from place to place; with two nodes by 2e-4.
const NODES_PER_LENGTH: f64 = 3.0;

/// Reach of a node in pitches of `xi/3`: beyond it, from `sqrt(2) 13/3 = 6.1` on, the error function is 1 to
/// the last bit.
const REACH: f64 = 13.0;

/// Share by which a pitch may exceed a third of the correlation length, so that rounding of two lengths does
/// not change the number of nodes.
const ROUNDING: f64 = 1e-9;

/// A Gaussian random field in the plane of the slider, of mean 0, variance 1 and correlation `exp(-(r/xi)^2)`
/// over a distance r.
///
/// Its origin is the corner of the slider at x = 0, y = 0. Along a periodic axis it repeats, so that a
/// distance is any distance between copies of two places; the pitch of its nodes divides the length of the
/// axis there. Lengths are in blocks.
///
/// ```
/// use slipfront::Lattice;
/// use slipfront::surface::CorrelatedField;
/// // A field that hardly changes within the slider.
/// let field = CorrelatedField::new(&Lattice::free(10, 10), 1e4);
/// assert!(field.variance_of_slider() > 0.99999);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelatedField {
    blocks: [usize; 2],
    axes: [Axis; 2],
}

impl CorrelatedField {
    /// Correlation lengths that can be drawn, in blocks. Below the shortest length, means over neighbouring
    /// blocks are correlated by 8 % and less, and more than 144 numbers are drawn for a block; above the
    /// longest length, the differences of error functions are lost to rounding.
    pub const LENGTHS: RangeInclusive<f64> = 0.25..=1e5;

    /// The field of correlation length `length` under the blocks of a lattice.
    ///
    /// # Panics
    /// If the length is out of [`LENGTHS`](Self::LENGTHS).
    pub fn new(lattice: &Lattice, length: f64) -> Self {
        assert!(Self::LENGTHS.contains(&length), "correlated over {length} blocks");
        let blocks = [lattice.nx, lattice.ny];
        let axes = [0, 1].map(|axis| Axis::new(blocks[axis], lattice.edges[axis], length));
        Self { blocks, axes }
    }

    /// Correlation length xi, blocks.
    pub fn length(&self) -> f64 {
        self.axes[0].length
    }

    /// Variance of the mean of the field over a block: `I^2`, except for copies beyond periodic edges, with
    /// [`deviation_along`].
    pub fn variance_of_blocks(&self) -> f64 {
        self.axes
            .iter()
            .map(|axis| axis.means(0..1, 1).variance())
            .product()
    }

    /// Variance of the mean of the field over the rectangle of all blocks, from seed to seed.
    pub fn variance_of_slider(&self) -> f64 {
        let along = |(axis, &blocks): (&Axis, &usize)| axis.means(0..1, blocks).variance();
        self.axes.iter().zip(&self.blocks).map(along).product()
    }
}

/// Factor by which the standard deviation of a field correlated over `xi` falls when it is averaged along an
/// interval: `I^(1/2)`, with `a = xi/length`; over a square with this side the factor is `I`.
///
/// ```text
/// I = sqrt(pi) a erf(1/a) - a^2 (1 - exp(-1/a^2))
/// ```
///
/// ```
/// use slipfront::surface::deviation_along;
/// // Blocks as large as the correlation length: sqrt(pi) erf(1) - 1 + 1/e.
/// let i = 1.7724538509 * 0.8427007929 - 1.0 + 0.3678794412;
/// assert!((deviation_along(1.0).powi(2) - i).abs() < 1e-9);
/// ```
pub fn deviation_along(a: f64) -> f64 {
    (PI.sqrt() * a * libm::erf(1.0 / a) + a * a * libm::expm1(-1.0 / (a * a))).sqrt()
}

impl Coefficients {
    /// Draws `mu_si` and `mu_ki` for the blocks in some rows of the lattice from two independent fields of
    /// the same correlation length: `mu_si = mean + deviation g_i`, with the mean g_i of the field over block
    /// i.
    ///
    /// The fields depend only on `seed`, the correlation length, the position and, along a periodic axis, its
    /// length: other blocks and other rows give the same surface.
    pub fn draw_correlated(
        field: &CorrelatedField,
        rows: &Range<usize>,
        mu_static: Distribution,
        mu_kinetic: Distribution,
        seed: u64,
    ) -> Self {
        let nx = field.blocks[0];
        let [columns, rows] = [
            field.axes[0].means(0..nx, 1),
            field.axes[1].means(rows.clone(), 1),
        ];
        let rows_at_once = rows.count().div_ceil(current_num_threads()).max(1);
        let draw = |distribution: Distribution, stream: Stream| {
            let mut coefficients = vec![0.0; nx * rows.count()];
            let bands = coefficients.par_chunks_mut(nx * rows_at_once).enumerate();
            bands.for_each(|(band, coefficients)| {
                let normals = |row, first| standard_normals(seed, stream, row, first);
                add_means(&columns, &rows, band * rows_at_once, normals, coefficients);
                for coefficient in coefficients {
                    *coefficient = distribution.mean + distribution.deviation * *coefficient;
                }
            });
            coefficients
        };
        Self {
            mu_static: draw(mu_static, Stream::MuStatic),
            mu_kinetic: draw(mu_kinetic, Stream::MuKinetic),
        }
    }
}

/// Adds the means `sum_m w_jm sum_n w_in z_mn` over the blocks of some rows; `first_row` is the first of
/// these in `rows`. Both sums are in the order of the nodes, so that the bits of a block do not depend on the
/// other blocks of the call. `normals` returns the standard normals of a row of nodes from a number on.
fn add_means<N: Iterator<Item = f64>>(
    columns: &Means,
    rows: &Means,
    first_row: usize,
    normals: impl Fn(u64, usize) -> N,
    means: &mut [f64],
) {
    let nx = columns.count();
    let range = first_row..first_row + means.len() / nx;
    let along = columns.nodes(0..nx);
    let mut numbers = vec![0.0; (along.end - along.start) as usize];
    let mut filtered = vec![0.0; nx];
    for node in rows.nodes(range.clone()) {
        // Row 0 of the key is used for draws by block.
        let row = rows.number(node) as u64 + 1;
        columns.fill(along.start, |first| normals(row, first), &mut numbers);
        for (i, mean) in filtered.iter_mut().enumerate() {
            let from = (columns.first[i] - along.start) as usize;
            let pairs = columns.weights(i).iter().zip(&numbers[from..]);
            *mean = pairs.map(|(weight, z)| weight * z).sum();
        }
        let of_rows = &rows.first[range.clone()];
        let begin = of_rows.partition_point(|first| first + rows.width as i64 <= node);
        let end = of_rows.partition_point(|&first| first <= node);
        for j in begin..end {
            let weight = rows.weights(first_row + j)[(node - of_rows[j]) as usize];
            for (mean, along) in means[nx * j..][..nx].iter_mut().zip(&filtered) {
                *mean += weight * along;
            }
        }
    }
}

/// The nodes along an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Axis {
    /// Correlation length, blocks.
    length: f64,
    /// Distance between nodes, blocks: node k is at `k pitch`.
    pitch: f64,
    /// Number of nodes after which the nodes repeat, along a periodic axis.
    period: Option<usize>,
    /// Factor `A` along the axis, for which the field has the variance 1.
    amplitude: f64,
}

impl Axis {
    fn new(blocks: usize, edges: Edges, length: f64) -> Self {
        let blocks = blocks as f64;
        let period = (edges == Edges::Periodic)
            .then(|| (NODES_PER_LENGTH * blocks / length * (1.0 - ROUNDING)).ceil());
        let pitch = period.map_or(length / NODES_PER_LENGTH, |nodes| blocks / nodes);
        // A place is correlated with its own copies, which matters if the axis is not much longer than xi.
        let copies = period.map_or(1.0, |_| {
            let of_copy = |k: i32| libm::exp(-(f64::from(k) * blocks / length).powi(2));
            let terms = (1..).map(of_copy).take_while(|term| *term > 0.0);
            1.0 + 2.0 * terms.sum::<f64>()
        });
        Self {
            length,
            pitch,
            period: period.map(|nodes| nodes as usize),
            amplitude: (FRAC_2_SQRT_PI * pitch / (length * copies)).sqrt(),
        }
    }

    /// Contributions of the nodes to means over intervals of `size` blocks.
    fn means(self, intervals: Range<usize>, size: usize) -> Means {
        let reach = REACH / NODES_PER_LENGTH * self.length;
        let within = ((size as f64 + 2.0 * reach) / self.pitch).ceil() as usize + 1;
        let width = self.period.map_or(within, |period| within.min(period));
        let mut means = Means {
            axis: self,
            width,
            first: Vec::with_capacity(intervals.len()),
            weights: vec![0.0; width * intervals.len()],
        };
        let scale = SQRT_2 / self.length;
        let factor = self.amplitude / (FRAC_2_SQRT_PI * scale * size as f64);
        for (interval, weights) in intervals.zip(means.weights.chunks_exact_mut(width)) {
            let [from, to] = [interval, interval + 1].map(|edge| (edge * size) as f64);
            let first = ((from - reach) / self.pitch).ceil();
            for k in 0..within {
                let node = (first + k as f64) * self.pitch;
                let difference = libm::erf(scale * (to - node)) - libm::erf(scale * (from - node));
                weights[k % width] += factor * difference;
            }
            means.first.push(first as i64);
        }
        means
    }
}

/// Contributions of the nodes along an axis to means over intervals.
struct Means {
    axis: Axis,
    /// Number of nodes that contribute to an interval, one copy of each.
    width: usize,
    /// The first node of each interval.
    first: Vec<i64>,
    /// Weights of the nodes, interval after interval.
    weights: Vec<f64>,
}

impl Means {
    /// Number of intervals.
    fn count(&self) -> usize {
        self.first.len()
    }

    /// Weights of the nodes that contribute to an interval.
    fn weights(&self, interval: usize) -> &[f64] {
        &self.weights[self.width * interval..][..self.width]
    }

    /// The nodes that contribute to some intervals.
    fn nodes(&self, intervals: Range<usize>) -> Range<i64> {
        match &self.first[intervals] {
            [first, .., last] | [first @ last] => *first..last + self.width as i64,
            [] => 0..0,
        }
    }

    /// Number of a node, from 0; copies of a node have the same number.
    fn number(&self, node: i64) -> usize {
        match self.axis.period {
            Some(period) => node.rem_euclid(period as i64) as usize,
            None => (node + REACH as i64) as usize,
        }
    }

    /// Fills `numbers` for a row of nodes from node `from` on, with the `normals` from a number on.
    fn fill<N: Iterator<Item = f64>>(&self, from: i64, normals: impl Fn(usize) -> N, numbers: &mut [f64]) {
        let (start, count) = match self.axis.period {
            Some(period) => (0, period),
            None => (self.number(from), numbers.len()),
        };
        let drawn: Vec<f64> = normals(start).take(count).collect();
        for (number, node) in numbers.iter_mut().zip(from..) {
            *number = drawn[self.number(node) - start];
        }
    }

    /// Variance of the mean over the first interval.
    fn variance(&self) -> f64 {
        self.weights(0).iter().map(|weight| weight * weight).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Lattice;

    const UNIT: Distribution = Distribution {
        mean: 0.0,
        deviation: 1.0,
    };

    fn draw(field: &CorrelatedField, seed: u64) -> Vec<f64> {
        Coefficients::draw_correlated(field, &(0..field.blocks[1]), UNIT, UNIT, seed).mu_static
    }

    /// `F(n + 1) - 2 F(n) + F(n - 1)`, with `F'' = exp(-(s/a)^2)`: covariance of the means over two intervals
    /// of length 1, with beginnings n apart, of a field correlated over a.
    fn covariance(a: f64, n: f64) -> f64 {
        let twice = |s: f64| 0.5 * a * (PI.sqrt() * s * libm::erf(s / a) + a * libm::exp(-(s / a).powi(2)));
        twice(n + 1.0) - 2.0 * twice(n) + twice(n - 1.0)
    }

    /// Covariance of the means over two intervals, from the weights of the nodes.
    fn of_weights(means: &Means, one: usize, other: usize) -> f64 {
        let mut weights = vec![
            0.0;
            1 + means
                .nodes(0..means.count())
                .map(|k| means.number(k))
                .max()
                .unwrap()
        ];
        for (node, weight) in (means.first[one]..).zip(means.weights(one)) {
            weights[means.number(node)] = *weight;
        }
        let pairs = (means.first[other]..).zip(means.weights(other));
        pairs
            .map(|(node, weight)| weight * weights[means.number(node)])
            .sum()
    }

    /// Means over blocks have the correlations of a field with the correlation `exp(-(r/xi)^2)`, at every
    /// distance.
    #[test]
    fn means_are_correlated_as_the_field_says() {
        for a in [0.25, 0.3, 1.0, 4.0, 7.3, 30.0] {
            let means = Axis::new(40, Edges::Free, a).means(0..40, 1);
            for n in 0..20 {
                let found = of_weights(&means, 11, 11 + n);
                // The variance varies by 2 exp(-pi^2 9/4) = 4.5e-10 along an axis.
                assert!((found - covariance(a, n as f64)).abs() < 1e-9, "{a} {n}: {found}");
            }
        }
    }

    /// Beyond the edges of a periodic axis are copies, also for a field correlated over more than the axis.
    #[test]
    fn a_periodic_field_is_correlated_with_its_copies() {
        for (blocks, a) in [(40, 4.0), (40, 7.3), (20, 15.0), (3, 0.25), (5, 2.0)] {
            let means = Axis::new(blocks, Edges::Periodic, a).means(0..blocks, 1);
            let over_copies = |f: &dyn Fn(f64) -> f64| -> f64 {
                (-20..=20).map(|copy| f(f64::from(copy) * blocks as f64)).sum()
            };
            let at_a_point = over_copies(&|s| libm::exp(-(s / a).powi(2)));
            for n in 0..blocks {
                let exact = over_copies(&|s| covariance(a, n as f64 + s)) / at_a_point;
                let found = of_weights(&means, 1, (1 + n) % blocks);
                // As above, relative to a sum over copies.
                assert!((found - exact).abs() < 1e-9, "{blocks} {a} {n}: {found} {exact}");
            }
        }
        // A field correlated over ten thousand times the axis is the same everywhere, but differs from seed
        // to seed.
        let field = CorrelatedField::new(&Lattice::with_edges(5, 4, [Edges::Periodic; 2]), 5e4);
        assert!((field.variance_of_slider() - 1.0).abs() < 1e-9);
    }

    #[test]
    fn three_nodes_in_a_length_keep_the_variance_and_two_do_not() {
        let swing = |nodes: f64| {
            // At a node and between two nodes: sums of squares of the kernel.
            let sum = |place: f64| -> f64 {
                let kernel = |k: i32| libm::exp(-4.0 * ((f64::from(k) + place) / nodes).powi(2));
                (-40..=40).map(kernel).sum()
            };
            (sum(0.0) / sum(0.5)).powi(2) - 1.0
        };
        assert!(swing(NODES_PER_LENGTH) < 2e-9, "{}", swing(NODES_PER_LENGTH));
        assert!(swing(2.0) > 1e-4 && swing(1.0) > 0.3);
    }

    #[test]
    fn variances_are_told_as_the_formula_says() {
        let lattice = Lattice::free(30, 12);
        for length in [0.25, 1.0, 5.0, 90.0, 1e5] {
            let field = CorrelatedField::new(&lattice, length);
            // The variance varies by 1e-9; the differences of error functions, of the size 1/length, have
            // rounding errors of 1e-16.
            let tolerance = 2e-9 + 1e-15 * length;
            let of_blocks = deviation_along(length).powi(4);
            assert!(
                (field.variance_of_blocks() - of_blocks).abs() < tolerance,
                "{length}"
            );
            let of_slider = (deviation_along(length / 30.0) * deviation_along(length / 12.0)).powi(2);
            assert!(
                (field.variance_of_slider() - of_slider).abs() < tolerance,
                "{length}"
            );
        }
    }

    /// The mean of four children equals their parent, on free and periodic axes; and so does that of nine,
    /// with other rounding errors.
    #[test]
    fn children_average_to_their_parent() {
        for edges in [Edges::Free, Edges::Periodic] {
            for (nx, ny, length, parts) in [
                (25, 25, 5.0, 2),
                (7, 11, 0.25, 2),
                (12, 1, 3.3, 4),
                (9, 10, 2.1, 3),
                (8, 6, 70.0, 2),
            ] {
                let ends = if ny == 1 { [edges, Edges::Free] } else { [edges; 2] };
                let coarse = CorrelatedField::new(&Lattice::with_edges(nx, ny, ends), length);
                let fine = Lattice::with_edges(parts * nx, parts * ny, ends);
                let fine = draw(&CorrelatedField::new(&fine, parts as f64 * length), 3);
                for (b, parent) in draw(&coarse, 3).into_iter().enumerate() {
                    let [i, j] = [parts * (b % nx), parts * (b / nx)];
                    let rows = (j..j + parts).map(|j| &fine[parts * nx * j + i..][..parts]);
                    let mean = rows.flatten().sum::<f64>() / (parts * parts) as f64;
                    // Differences of error functions are of the size 1/length, have rounding errors of 1e-16,
                    // and some 700 of them are added.
                    let tolerance = 1e-14 * (1.0 + length);
                    assert!(
                        (mean - parent).abs() < tolerance,
                        "{edges:?} {nx} {length} {b}: {mean} {parent}"
                    );
                }
            }
        }
    }

    /// A rank, a band and a larger slider give the same numbers to the last bit.
    #[test]
    fn parts_draw_what_the_whole_does() {
        let wide = Distribution {
            mean: 0.1,
            deviation: 0.3,
        };
        for edges in [Edges::Free, Edges::Periodic] {
            for length in [0.3, 4.0, 40.0] {
                let field = CorrelatedField::new(&Lattice::with_edges(20, 31, [edges; 2]), length);
                let whole = Coefficients::draw_correlated(&field, &(0..31), wide, UNIT, 5);
                let mut joined = Coefficients::given(Vec::new(), Vec::new());
                for cut in [0, 1, 2, 17, 17, 31].windows(2) {
                    let part = Coefficients::draw_correlated(&field, &(cut[0]..cut[1]), wide, UNIT, 5);
                    joined.mu_static.extend(part.mu_static);
                    joined.mu_kinetic.extend(part.mu_kinetic);
                }
                assert_eq!(joined, whole);
                for threads in [1, 3, 40] {
                    let pool = rayon::ThreadPoolBuilder::new()
                        .num_threads(threads)
                        .build()
                        .unwrap();
                    let drawn =
                        pool.install(|| Coefficients::draw_correlated(&field, &(0..31), wide, UNIT, 5));
                    assert_eq!(drawn, whole);
                }
            }
        }
        let [small, large] =
            [[20, 31], [50, 40]].map(|[nx, ny]| draw(&CorrelatedField::new(&Lattice::free(nx, ny), 4.0), 5));
        for (small, large) in small.chunks(20).zip(large.chunks(50)) {
            assert_eq!(small, &large[..20]);
        }
    }

    /// Over the seeds 0 to 9999, chosen before the measurement: five standard errors at each of 20 lags.
    #[test]
    fn ten_thousand_draws_have_the_correlation() {
        const DRAWS: u64 = 10_000;
        let (nx, length) = (12, 4.0);
        let field = CorrelatedField::new(&Lattice::free(nx, 8), length);
        let along = |n: usize| covariance(length, n as f64);
        let mut sums = vec![0.0; nx + 8];
        let mut apart = 0.0;
        for seed in 0..DRAWS {
            let drawn = Coefficients::draw_correlated(&field, &(0..8), UNIT, UNIT, seed);
            let g = drawn.mu_static;
            for (n, sum) in sums[..nx].iter_mut().enumerate() {
                *sum += g[0] * g[n];
            }
            for (n, sum) in sums[nx..].iter_mut().enumerate() {
                *sum += g[nx * n + 2] * g[2 + n];
            }
            apart += g[0] * drawn.mu_kinetic[0];
        }
        let variance = along(0).powi(2);
        let check = |sum: f64, exact: f64, at: &str| {
            // The product of two normals has the variance v^2 + c^2, and the interval from -5 to 5 contains
            // all but 6e-7.
            let error = ((variance * variance + exact * exact) / DRAWS as f64).sqrt();
            let found = sum / DRAWS as f64;
            assert!(
                (found - exact).abs() < 5.0 * error,
                "{at}: {found} for {exact}, error {error}"
            );
        };
        let (along_x, across) = sums.split_at(nx);
        for (n, &sum) in along_x.iter().enumerate() {
            check(sum, along(0) * along(n), &format!("along x at {n}"));
        }
        for (n, &sum) in across.iter().enumerate() {
            // Blocks at (2, n) and (2 + n, 0).
            check(sum, along(n).powi(2), &format!("across at {n}"));
        }
        check(apart, 0.0, "static and kinetic");
    }

    /// The numbers are fixed: changing them would change every surface ever published with a seed and a
    /// correlation length.
    #[test]
    fn the_first_means_of_seed_one_never_change() {
        let field = CorrelatedField::new(&Lattice::free(3, 1), 2.0);
        assert_eq!(draw(&field, 1), PINNED);
    }
    const PINNED: [f64; 3] = [1.666338318323235, 2.566363215491553, 3.03238898061342];
}
