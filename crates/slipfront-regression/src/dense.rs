//! Symmetric systems of some thousand equations: Cholesky's factor, solutions, and the diagonal of the inverse.
//!
//! Every sum runs in the order of its index, so that results have the same bits for any width of vectors.

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};

/// Number of columns that are computed together: two vectors of AVX2, one of AVX-512.
const PANEL: usize = 8;

/// Number of rows that are computed together.
const ROWS: usize = 4;

/// The lower factor `L` of a symmetric positive matrix `A = L L^T`.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    n: usize,
    /// Rows of the factor one after the other; numbers above the diagonal have no meaning.
    rows: Vec<f64>,
}

/// Sums over k of `a[row][k] b[k][column]` of a tile of the product of two matrices.
#[inline(always)]
fn tile<S: Simd>(simd: S, a: [&[f64]; ROWS], b: &[[f64; PANEL]]) -> [[f64; PANEL]; ROWS] {
    let mut sums = [f64x8::splat(simd, 0.0); ROWS];
    let [a0, a1, a2, a3] = a.map(|row| &row[..b.len()]);
    for ((((b, a0), a1), a2), a3) in b.iter().zip(a0).zip(a1).zip(a2).zip(a3) {
        let b = f64x8::load_array_ref(simd, b);
        sums[0] += f64x8::splat(simd, *a0) * b;
        sums[1] += f64x8::splat(simd, *a1) * b;
        sums[2] += f64x8::splat(simd, *a2) * b;
        sums[3] += f64x8::splat(simd, *a3) * b;
    }
    sums.map(Into::into)
}

/// Rows of a matrix from `first` on, from column `from` on; behind the last row this row is repeated.
#[inline(always)]
fn rows_from(matrix: &[f64], n: usize, first: usize, from: usize) -> [&[f64]; ROWS] {
    std::array::from_fn(|k| {
        let row = (first + k).min(n - 1) * n;
        &matrix[row + from..row + n]
    })
}

impl Factor {
    /// Factorizes the symmetric matrix of `n` rows, of which the lower half is read; none if the matrix is not positive.
    ///
    /// ```text
    /// L_ij = (A_ij - sum_k<j L_ik L_jk)/L_jj,   L_jj = sqrt(A_jj - sum_k<j L_jk^2)
    /// ```
    pub(crate) fn of(matrix: Vec<f64>, n: usize) -> Option<Self> {
        assert_eq!(matrix.len(), n * n);
        let mut factor = Self { n, rows: matrix };
        let is_positive = dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || factor.factorize(simd)
        ));
        is_positive.then_some(factor)
    }

    #[inline(always)]
    fn factorize<S: Simd>(&mut self, simd: S) -> bool {
        let n = self.n;
        let mut panel = Vec::with_capacity(n);
        for first in (0..n).step_by(PANEL) {
            let width = PANEL.min(n - first);
            panel.clear();
            panel.extend((0..first).map(|k| {
                std::array::from_fn(|column| {
                    if column < width {
                        self.rows[(first + column) * n + k]
                    } else {
                        0.0
                    }
                })
            }));
            // The factor of the panel's own rows, column after column.
            let mut own = [[0.0; PANEL]; PANEL];
            for group in (first..n).step_by(ROWS) {
                let sums = tile(simd, rows_from(&self.rows, n, group, 0), &panel);
                for (row, sums) in (group..n).zip(sums) {
                    let place = row * n + first;
                    let values = &mut self.rows[place..place + width];
                    let last = (row - first).min(width - 1);
                    for column in 0..=last {
                        let is_diagonal = row == first + column;
                        let mut rest = values[column] - sums[column];
                        for k in 0..column {
                            let other = if is_diagonal { values[k] } else { own[column][k] };
                            rest -= values[k] * other;
                        }
                        values[column] = if !is_diagonal {
                            rest / own[column][column]
                        } else if rest > 0.0 {
                            rest.sqrt()
                        } else {
                            return false;
                        };
                    }
                    if row < first + width {
                        own[row - first][..=last].copy_from_slice(&values[..=last]);
                    }
                }
            }
        }
        true
    }

    /// Replaces the right side `y` of `A x = y` by the solution `x`.
    pub(crate) fn solve(&self, y: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.rows[i * n..i * n + i];
            let sum: f64 = row.iter().zip(&*y).map(|(l, y)| l * y).sum();
            y[i] = (y[i] - sum) / self.rows[i * n + i];
        }
        for i in (0..n).rev() {
            y[i] /= self.rows[i * n + i];
            let (before, value) = (&self.rows[i * n..i * n + i], y[i]);
            for (y, l) in y.iter_mut().zip(before) {
                *y -= l * value;
            }
        }
    }

    /// The diagonal of the inverse: the sums of squares of the columns of `L^-1`.
    pub(crate) fn inverse_diagonal(&self) -> Vec<f64> {
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || self.squares_of_columns(simd)
        ))
    }

    #[inline(always)]
    fn squares_of_columns<S: Simd>(&self, simd: S) -> Vec<f64> {
        let n = self.n;
        let mut diagonal = Vec::with_capacity(n);
        let mut columns: Vec<[f64; PANEL]> = Vec::with_capacity(n);
        for first in (0..n).step_by(PANEL) {
            columns.clear();
            let mut squares = [0.0; PANEL];
            for group in (first..n).step_by(ROWS) {
                let sums = tile(simd, rows_from(&self.rows, n, group, first), &columns);
                for (row, mut sums) in (group..n).zip(sums) {
                    let line = &self.rows[row * n..row * n + row + 1];
                    for k in group..row {
                        for (sum, value) in sums.iter_mut().zip(columns[k - first]) {
                            *sum += line[k] * value;
                        }
                    }
                    let solved: [f64; PANEL] = std::array::from_fn(|column| {
                        let right = if row == first + column { 1.0 } else { 0.0 };
                        (right - sums[column]) / line[row]
                    });
                    for (square, value) in squares.iter_mut().zip(solved) {
                        *square += value * value;
                    }
                    columns.push(solved);
                }
            }
            diagonal.extend(squares.iter().take(PANEL.min(n - first)));
        }
        diagonal
    }
}

/// Squared distances between points of `d` numbers each, row after row of `points` and column after column of `others`.
pub fn squared_distances(points: &[f64], others: &[f64], d: usize) -> Vec<f64> {
    dispatch!(Level::new(), simd => simd.vectorize(
        #[inline(always)]
        || distances(simd, points, others, d)
    ))
}

#[inline(always)]
fn distances<S: Simd>(simd: S, points: &[f64], others: &[f64], d: usize) -> Vec<f64> {
    let (n, m) = (points.len() / d, others.len() / d);
    let square = |point: &[f64]| point.iter().map(|x| x * x).sum::<f64>();
    let squares: Vec<f64> = others.chunks_exact(d).map(square).collect();
    let mut distances = vec![0.0; n * m];
    for first in (0..m).step_by(PANEL) {
        let width = PANEL.min(m - first);
        let panel: Vec<[f64; PANEL]> = (0..d)
            .map(|k| std::array::from_fn(|column| others[(first + column.min(width - 1)) * d + k]))
            .collect();
        for group in (0..n).step_by(ROWS) {
            let rows = std::array::from_fn(|k| {
                let row = (group + k).min(n - 1) * d;
                &points[row..row + d]
            });
            let products = tile(simd, rows, &panel);
            for (k, row) in (group..n.min(group + ROWS)).enumerate() {
                let own = square(&points[row * d..row * d + d]);
                for column in 0..width {
                    let distance = own + squares[first + column] - 2.0 * products[k][column];
                    distances[row * m + first + column] = distance.max(0.0);
                }
            }
        }
    }
    distances
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A^-1 of the second difference matrix of n rows has the diagonal i (n + 1 - i)/(n + 1), i from 1.
    #[test]
    fn second_differences_have_their_inverse() {
        for n in [1, 7, 8, 9, 21, 40] {
            let mut matrix = vec![0.0; n * n];
            for i in 0..n {
                matrix[i * n + i] = 2.0;
                if i > 0 {
                    matrix[i * n + i - 1] = -1.0;
                }
            }
            let factor = Factor::of(matrix, n).unwrap();
            let size = n as f64 + 1.0;
            for (i, found) in factor.inverse_diagonal().into_iter().enumerate() {
                let place = i as f64 + 1.0;
                // Errors of rounding grow with the condition number, 4 (n + 1)^2/pi^2.
                let bound = 4.0 * size * size * f64::EPSILON;
                assert!(
                    (found / (place * (size - place) / size) - 1.0).abs() < bound,
                    "{n} {i}"
                );
            }
            // A x = y for x = i has y = 0 but for the last row.
            let mut y = vec![0.0; n];
            y[n - 1] = size;
            factor.solve(&mut y);
            for (i, x) in y.into_iter().enumerate() {
                assert!(
                    (x - (i as f64 + 1.0)).abs() < 4.0 * size * size * size * f64::EPSILON,
                    "{n} {i}"
                );
            }
        }
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_factor() {
        assert!(Factor::of(vec![1.0, 0.0, 2.0, 1.0], 2).is_none());
        assert!(Factor::of(vec![f64::NAN], 1).is_none());
    }

    #[test]
    fn distances_of_points_of_a_grid() {
        let points: Vec<f64> = (0..22).map(f64::from).collect();
        let found = squared_distances(&points, &points[..10], 2);
        for (k, distance) in found.into_iter().enumerate() {
            // Neighbours differ by 2 in both numbers, and all of it are integers.
            let apart = (k / 5) as f64 - (k % 5) as f64;
            assert_eq!(distance, 8.0 * apart * apart);
        }
    }
}
