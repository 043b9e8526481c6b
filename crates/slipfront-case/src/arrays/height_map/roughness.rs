//! Parameters of ISO 25178-2 of unfiltered heights, and their least-squares plane. Points with NaN were not
//! measured, and are ignored.

use super::grid::Line;

/// Lowest and highest of some heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightRange {
    pub(super) lowest: f64,
    pub(super) highest: f64,
}

/// Mean height and range of points, added one by one.
#[derive(Default)]
pub(super) struct Mean {
    /// The first height, and the range of all heights. Other heights are summed relative to the first, so
    /// that a map far above its zero loses no digits.
    first: Option<(f64, HeightRange)>,
    sum: f64,
    count: usize,
}

impl Mean {
    pub(super) fn add(&mut self, heights: &[f64]) {
        let Some(&start) = heights.iter().find(|height| !height.is_nan()) else {
            return;
        };
        let (first, range) = self.first.get_or_insert((
            start,
            HeightRange {
                lowest: start,
                highest: start,
            },
        ));
        let (mut sum, mut count) = (0.0, 0);
        for &height in heights.iter().filter(|height| !height.is_nan()) {
            range.lowest = range.lowest.min(height);
            range.highest = range.highest.max(height);
            sum += height - *first;
            count += 1;
        }
        self.sum += sum;
        self.count += count;
    }

    /// Number of points.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// Mean and range, if there is a height.
    pub(super) fn of_all(&self) -> Option<(f64, HeightRange)> {
        self.first
            .map(|(first, range)| (first + self.sum / self.count as f64, range))
    }
}

/// Height parameters of a surface (ISO 25178-2), from the deviations z from the mean height:
///
/// ```text
/// Sa = mean |z|,   Sq = sqrt(mean z^2),   Ssk = mean z^3/Sq^3,   Sku = mean z^4/Sq^4
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Roughness {
    /// Arithmetical mean height Sa, m.
    pub sa: f64,
    /// Root mean square height Sq, m.
    pub sq: f64,
    /// Skewness Ssk; none for a plane.
    pub ssk: Option<f64>,
    /// Kurtosis Sku; none for a plane.
    pub sku: Option<f64>,
}

/// A plane through zero in the middle of a map, with its slopes per column and per row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Plane {
    middle: [f64; 2],
    slopes: [f64; 2],
    /// The share of the variance of the heights that the plane explains.
    pub(super) share: f64,
}

impl Plane {
    /// Heights of a line minus the plane, which passes through zero in the middle of the map.
    pub(super) fn subtract(&self, line: &Line, heights: &mut Vec<f64>) {
        heights.clear();
        let across = self.slopes[1] * (line.row as f64 - self.middle[1]);
        let of_plane = |column: usize| self.slopes[0] * (column as f64 - self.middle[0]) + across;
        let levelled = (line.column..).zip(line.heights);
        heights.extend(levelled.map(|(column, height)| height - of_plane(column)));
    }
}

/// Sums over the points of a map, and of products of their column x and row y, both from the middle, and
/// their height z.
pub(super) struct PlaneSums {
    middle: [f64; 2],
    count: f64,
    /// Sums of x, y and z.
    sums: [f64; 3],
    /// Sums of xx, xy, yy, xz, yz and zz.
    products: [f64; 6],
}

impl PlaneSums {
    /// The sums for a map with this number of points.
    pub(super) fn new(points: [usize; 2]) -> Self {
        Self {
            middle: points.map(|count| (count as f64 - 1.0) / 2.0),
            count: 0.0,
            sums: [0.0; 3],
            products: [0.0; 6],
        }
    }

    /// Adds the points of a line, with their heights above `mean`.
    pub(super) fn add(&mut self, line: &Line, mean: f64) {
        let y = line.row as f64 - self.middle[1];
        for (column, height) in (line.column..).zip(line.heights) {
            let (x, z) = (column as f64 - self.middle[0], height - mean);
            if z.is_nan() {
                continue;
            }
            self.count += 1.0;
            for (sum, value) in self.sums.iter_mut().zip([x, y, z]) {
                *sum += value;
            }
            for (sum, product) in self
                .products
                .iter_mut()
                .zip([x * x, x * y, y * y, x * z, y * z, z * z])
            {
                *sum += product;
            }
        }
    }

    /// The least-squares plane. With S the sums of products of deviations from the means:
    ///
    /// ```text
    /// Sxx a + Sxy b = Sxz,   Sxy a + Syy b = Syz,   share = (a Sxz + b Syz)/Szz
    /// ```
    pub(super) fn plane(&self) -> Plane {
        let [x, y, z] = self.sums;
        let about = |product: usize, a: f64, b: f64| self.products[product] - a * b / self.count.max(1.0);
        let [xx, xy, yy] = [about(0, x, x), about(1, x, y), about(2, y, y)];
        let [xz, yz, zz] = [about(3, x, z), about(4, y, z), about(5, z, z)];
        let ratio = |sum: f64, total: f64| if total > 0.0 { sum / total } else { 0.0 };
        let determinant = xx * yy - xy * xy;
        // Points on one line define no plane, but may have a slope along it.
        let slopes = match determinant > 1e-12 * xx * yy {
            true => [
                (xz * yy - yz * xy) / determinant,
                (yz * xx - xz * xy) / determinant,
            ],
            false if xx > yy => [ratio(xz, xx), 0.0],
            false => [0.0, ratio(yz, yy)],
        };
        Plane {
            middle: self.middle,
            slopes,
            share: ratio(slopes[0] * xz + slopes[1] * yz, zz),
        }
    }
}

/// Sums over the deviations from the mean: of their absolute values, and of their second, third and fourth
/// powers.
#[derive(Default)]
pub(super) struct Moments {
    sums: [f64; 4],
    count: f64,
}

impl Moments {
    /// Adds heights, as deviations from their mean.
    pub(super) fn add(&mut self, heights: &[f64], mean: f64) {
        let (mut sums, mut count) = ([0.0; 4], 0.0);
        for height in heights.iter().filter(|height| !height.is_nan()) {
            let z = height - mean;
            let square = z * z;
            count += 1.0;
            for (sum, term) in sums
                .iter_mut()
                .zip([z.abs(), square, square * z, square * square])
            {
                *sum += term;
            }
        }
        self.count += count;
        for (sum, of_line) in self.sums.iter_mut().zip(sums) {
            *sum += of_line;
        }
    }

    /// The parameters, where a deviation of 1 is `unit` metres.
    pub(super) fn roughness(&self, unit: f64) -> Roughness {
        let [sa, square, cube, fourth] = self.sums.map(|sum| sum / self.count);
        let sq = square.sqrt();
        let over = |moment: f64, power: i32| (sq > 0.0).then(|| moment / sq.powi(power));
        Roughness {
            sa: sa * unit,
            sq: sq * unit,
            ssk: over(cube, 3),
            sku: over(fourth, 4),
        }
    }
}
