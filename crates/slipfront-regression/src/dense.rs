//! Symmetric systems of some thousand equations: Cholesky factor, solutions, and the diagonal of the inverse.
//!
//! Every sum is computed in the order of its index, so that results have the same bits for any vector width.

use fearless_simd::{Level, Simd, SimdBase, dispatch, f64x8};

/// Number of columns that are computed together: two vectors with AVX2, one with AVX-512.
const PANEL: usize = 8;

// The 32 sums of a tile stay in registers: every loaded number is used in four or eight of them.
/// Number of rows that are computed together.
const ROWS: usize = 4;

/// The lower factor `L` of a symmetric positive matrix `A = L L^T`.
#[derive(Clone, Debug)]
pub(crate) struct Factor {
    n: usize,
    /// Rows of the factor, one after the other; numbers above the diagonal are undefined.
    rows: Vec<f64>,
}

/// Coefficients of the combination of columns that is closest to `y`, each damped by a share `damping` of the
/// square of its column; none if a column is zero, or linearly dependent on the others.
///
/// ```text
/// (A^T A + damping diag(A^T A)) x = A^T y
/// ```
pub fn least_squares(columns: &[Vec<f64>], y: &[f64], damping: f64) -> Option<Vec<f64>> {
    let product = |one: &[f64], other: &[f64]| one.iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
    let matrix = columns
        .iter()
        .flat_map(|one| columns.iter().map(|other| product(one, other)));
    let added = columns.iter().map(|column| damping * product(column, column));
    let factor = Factor::new(matrix.collect(), added)?;
    let mut x: Vec<f64> = columns.iter().map(|column| product(column, y)).collect();
    factor.solve(&mut x);
    Some(x)
}

/// Sums over k of `a[row][k] b[k][column]`, for a tile of a matrix product.
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

/// Rows of a matrix with `d` columns, starting with row `first` and column `from`. Beyond the last row, this
/// row is repeated.
#[inline(always)]
fn rows_from(matrix: &[f64], d: usize, first: usize, from: usize) -> [&[f64]; ROWS] {
    std::array::from_fn(|k| {
        let row = (first + k).min(matrix.len() / d - 1) * d;
        &matrix[row + from..row + d]
    })
}

/// The transposed inverse of the first `width` rows and columns of a lower triangular matrix.
fn inverse_of_triangle(triangle: &[[f64; PANEL]; PANEL], width: usize) -> [[f64; PANEL]; PANEL] {
    let mut inverse = [[0.0; PANEL]; PANEL];
    for (column, solved) in inverse.iter_mut().enumerate().take(width) {
        for row in column..width {
            let right = if row == column { 1.0 } else { 0.0 };
            let sum: f64 = (column..row).map(|k| triangle[row][k] * solved[k]).sum();
            solved[row] = (right - sum) / triangle[row][row];
        }
    }
    inverse
}

impl Factor {
    /// Factorizes a symmetric matrix, given by its lower half, with numbers added to its diagonal; none if
    /// the sum is not positive definite.
    ///
    /// ```text
    /// L_ij = (A_ij - sum_k<j L_ik L_jk)/L_jj,   L_jj = sqrt(A_jj + added_j - sum_k<j L_jk^2)
    /// ```
    pub(crate) fn new(mut matrix: Vec<f64>, added: impl ExactSizeIterator<Item = f64>) -> Option<Self> {
        let n = added.len();
        assert_eq!(matrix.len(), n * n);
        for (i, added) in added.enumerate() {
            matrix[i * n + i] += added;
        }
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
        // Each panel is reduced by the product of all columns before it: this product, in `tile`, takes
        // nearly all of the time.
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
            // The factor of the panel's own rows, column by column.
            let mut own = [[0.0; PANEL]; PANEL];
            let below = first + width;
            for group in (first..below).step_by(ROWS) {
                let sums = tile(simd, rows_from(&self.rows, n, group, 0), &panel);
                for (row, sums) in (group..below).zip(sums) {
                    let place = row * n + first;
                    let values = &mut self.rows[place..=place + row - first];
                    for column in 0..values.len() {
                        let is_diagonal = column == row - first;
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
                    own[row - first][..values.len()].copy_from_slice(values);
                }
            }
            // Rows below are multiplied by the inverse of the panel's triangle. Solving for each row would
            // need a division per number.
            let inverse = inverse_of_triangle(&own, width).map(|row| f64x8::load_array(simd, row));
            for group in (below..n).step_by(ROWS) {
                let sums = tile(simd, rows_from(&self.rows, n, group, 0), &panel);
                for (row, sums) in (group..n).zip(sums) {
                    let values = &mut self.rows[row * n + first..row * n + first + PANEL];
                    let mut solved = f64x8::splat(simd, 0.0);
                    for ((value, sum), line) in values.iter().zip(sums).zip(inverse) {
                        solved += f64x8::splat(simd, value - sum) * line;
                    }
                    solved.store_slice(values);
                }
            }
        }
        true
    }

    /// Replaces the right-hand side `y` of `A x = y` by the solution `x`.
    pub(crate) fn solve(&self, y: &mut [f64]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.rows[i * n..i * n + i];
            let sum: f64 = row.iter().zip(&*y).map(|(l, y)| l * y).sum();
            y[i] = (y[i] - sum) / self.rows[i * n + i];
        }
        // L^T is also read by rows of L: reading its columns would access distant memory.
        for i in (0..n).rev() {
            y[i] /= self.rows[i * n + i];
            let (before, value) = (&self.rows[i * n..i * n + i], y[i]);
            for (y, l) in y.iter_mut().zip(before) {
                *y -= l * value;
            }
        }
    }

    /// The logarithm of the determinant.
    pub(crate) fn log_determinant(&self) -> f64 {
        let diagonal = self.rows.iter().step_by(self.n + 1);
        2.0 * diagonal.map(|l| libm::log(*l)).sum::<f64>()
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
        let mut columns = Vec::with_capacity(n);
        for first in (0..n).step_by(PANEL) {
            self.inverse_columns(simd, first, &mut columns);
            let mut squares = [0.0; PANEL];
            for row in &columns {
                for (square, value) in squares.iter_mut().zip(row) {
                    *square += value * value;
                }
            }
            diagonal.extend(squares.iter().take(PANEL.min(n - first)));
        }
        diagonal
    }

    /// The inverse `L^-T L^-1`.
    pub(crate) fn inverse(&self) -> Vec<f64> {
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || self.products_of_columns(simd)
        ))
    }

    #[inline(always)]
    fn products_of_columns<S: Simd>(&self, simd: S) -> Vec<f64> {
        let n = self.n;
        let mut inverse = vec![0.0; n * n];
        // The columns of L^-1 computed so far, each stored as a row.
        let mut all = vec![0.0; n * n];
        let mut columns = Vec::with_capacity(n);
        for first in (0..n).step_by(PANEL) {
            let width = PANEL.min(n - first);
            self.inverse_columns(simd, first, &mut columns);
            for (k, row) in (first..n).zip(&columns) {
                for (column, value) in (first..first + width).zip(row) {
                    all[column * n + k] = *value;
                }
            }
            // Columns of L^-1 are zero above `first`, so that sums begin there. The other half follows by
            // symmetry.
            let last = first + width;
            for group in (0..last).step_by(ROWS) {
                let sums = tile(simd, rows_from(&all, n, group, first), &columns);
                for (row, sums) in (group..last).zip(sums) {
                    for (column, sum) in (first..last).zip(sums) {
                        inverse[row * n + column] = sum;
                        inverse[column * n + row] = sum;
                    }
                }
            }
        }
        inverse
    }

    /// Replaces `columns` by the columns of `L^-1` from `first` up, as many as a panel has, starting at row
    /// `first`.
    #[inline(always)]
    fn inverse_columns<S: Simd>(&self, simd: S, first: usize, columns: &mut Vec<[f64; PANEL]>) {
        let n = self.n;
        columns.clear();
        for group in (first..n).step_by(ROWS) {
            let sums = tile(simd, rows_from(&self.rows, n, group, first), columns);
            for (row, mut sums) in (group..n).zip(sums) {
                let line = &self.rows[row * n..row * n + row + 1];
                for k in group..row {
                    for (sum, value) in sums.iter_mut().zip(columns[k - first]) {
                        *sum += line[k] * value;
                    }
                }
                columns.push(std::array::from_fn(|column| {
                    let right = if row == first + column { 1.0 } else { 0.0 };
                    (right - sums[column]) / line[row]
                }));
            }
        }
    }
}

/// Sums `sum_j m_ij (x_j - x_i)` over points of `d` numbers each, with a square matrix of as many rows as
/// points.
pub(crate) fn differences(matrix: &[f64], points: &[f64], d: usize) -> Vec<f64> {
    let n = points.len() / d;
    // The sum is a matrix product minus the row sums times a point, which avoids a difference for every pair.
    let mut sums = product(matrix, n, d, |j, column| points[j * d + column]);
    let rows = matrix.chunks_exact(n).zip(points.chunks_exact(d));
    for (sums, (row, point)) in sums.chunks_exact_mut(d).zip(rows) {
        let sum_of_row: f64 = row.iter().sum();
        for (sum, x) in sums.iter_mut().zip(point) {
            *sum -= sum_of_row * x;
        }
    }
    sums
}

/// Squared distances between points of `d` numbers each, with a row per point of `points` and a column per
/// point of `others`.
pub fn squared_distances(points: &[f64], others: &[f64], d: usize) -> Vec<f64> {
    let m = others.len() / d;
    let square = |point: &[f64]| point.iter().map(|x| x * x).sum::<f64>();
    let squares: Vec<f64> = others.chunks_exact(d).map(square).collect();
    let mut distances = product(points, d, m, |k, column| others[column * d + k]);
    for (distances, point) in distances.chunks_exact_mut(m).zip(points.chunks_exact(d)) {
        let own = square(point);
        for (distance, other) in distances.iter_mut().zip(&squares) {
            *distance = (own + other - 2.0 * *distance).max(0.0);
        }
    }
    distances
}

/// The product `sum_k a_ik b(k, j)` of a matrix with rows of `d` numbers and a function with `m` columns.
fn product(a: &[f64], d: usize, m: usize, b: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    dispatch!(Level::new(), simd => simd.vectorize(
        #[inline(always)]
        || product_of_tiles(simd, a, d, m, &b)
    ))
}

#[inline(always)]
fn product_of_tiles<S: Simd>(
    simd: S,
    a: &[f64],
    d: usize,
    m: usize,
    b: &impl Fn(usize, usize) -> f64,
) -> Vec<f64> {
    let n = a.len() / d;
    let mut product = vec![0.0; n * m];
    for first in (0..m).step_by(PANEL) {
        let width = PANEL.min(m - first);
        let panel: Vec<[f64; PANEL]> = (0..d)
            .map(|k| std::array::from_fn(|column| b(k, first + column.min(width - 1))))
            .collect();
        for group in (0..n).step_by(ROWS) {
            let sums = tile(simd, rows_from(a, d, group, 0), &panel);
            for (row, sums) in (group..n).zip(sums) {
                product[row * m + first..][..width].copy_from_slice(&sums[..width]);
            }
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line through 1, 3 and 5 at 0, 1 and 2. Damping by its full square halves its slope.
    #[test]
    fn least_squares_find_a_line() {
        let line = [vec![1.0; 3], vec![0.0, 1.0, 2.0]];
        let found = least_squares(&line, &[1.0, 3.0, 5.0], 0.0).unwrap();
        assert!(
            (found[0] - 1.0).abs() < 1e-12 && (found[1] - 2.0).abs() < 1e-12,
            "{found:?}"
        );
        let held = least_squares(&line[1..], &[0.0, 2.0, 4.0], 1.0).unwrap();
        assert!((held[0] - 1.0).abs() < 1e-12, "{held:?}");
        assert_eq!(least_squares(&[vec![0.0; 3]], &[1.0; 3], 0.1), None);
    }

    /// A^-1 of the second difference matrix of n rows has the diagonal i (n + 1 - i)/(n + 1), i from 1.
    #[test]
    fn second_differences_have_their_inverse() {
        for n in [1, 7, 8, 9, 21, 40] {
            let mut matrix = vec![0.0; n * n];
            for i in 0..n {
                matrix[i * n + i] = 0.5;
                if i > 0 {
                    matrix[i * n + i - 1] = -1.0;
                }
            }
            let factor = Factor::new(matrix, vec![1.5; n].into_iter()).unwrap();
            let size = n as f64 + 1.0;
            for (i, found) in factor.inverse_diagonal().into_iter().enumerate() {
                let place = i as f64 + 1.0;
                // Rounding errors grow with the condition number, 4 (n + 1)^2/pi^2.
                let bound = 4.0 * size * size * f64::EPSILON;
                assert!(
                    (found / (place * (size - place) / size) - 1.0).abs() < bound,
                    "{n} {i}"
                );
            }
            // A_ij^-1 = i (n + 1 - j)/(n + 1) for i <= j, and det A = n + 1.
            let inverse = factor.inverse();
            for (place, found) in inverse.into_iter().enumerate() {
                let (i, j) = (place / n + 1, place % n + 1);
                let exact = i.min(j) as f64 * (size - i.max(j) as f64) / size;
                assert!(
                    (found / exact - 1.0).abs() < 4.0 * size * size * f64::EPSILON,
                    "{n} {i} {j}"
                );
            }
            assert!((factor.log_determinant() - size.ln()).abs() < 4.0 * size * size * f64::EPSILON);
            // For x = i, y = A x is 0 except in the last row.
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
        assert!(Factor::new(vec![1.0, 0.0, 2.0, 1.0], [0.0; 2].into_iter()).is_none());
        assert!(Factor::new(vec![f64::NAN], [0.0].into_iter()).is_none());
    }

    #[test]
    fn distances_of_points_of_a_grid() {
        let points: Vec<f64> = (0..22).map(f64::from).collect();
        let found = squared_distances(&points, &points[..10], 2);
        for (k, distance) in found.into_iter().enumerate() {
            // Neighbours differ by 2 in both numbers, and all values are integers.
            let apart = (k / 5) as f64 - (k % 5) as f64;
            assert_eq!(distance, 8.0 * apart * apart);
        }
    }

    #[test]
    fn differences_of_points_of_a_grid() {
        // Eleven points with the components i, i^2 and so on; the matrix has the elements i + 2 j.
        let (n, d) = (11, 9);
        let power = |i: usize, f: usize| (i as f64).powi(f as i32 % 3 + 1);
        let points: Vec<f64> = (0..n).flat_map(|i| (0..d).map(move |f| power(i, f))).collect();
        let matrix: Vec<f64> = (0..n * n).map(|k| (k / n + 2 * (k % n)) as f64).collect();
        for (k, found) in differences(&matrix, &points, d).into_iter().enumerate() {
            let (i, f) = (k / d, k % d);
            // All values are integers.
            let exact: f64 = (0..n)
                .map(|j| (i + 2 * j) as f64 * (power(j, f) - power(i, f)))
                .sum();
            assert_eq!(found, exact, "{i} {f}");
        }
    }
}
