//! Parameters of ISO 25178-2 of the heights as they stand in the file, neither levelled nor filtered.

/// The lowest and the highest of some heights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HeightRange {
    pub(super) lowest: f64,
    pub(super) highest: f64,
}

/// The mean height and the range of points that come one after the other.
#[derive(Default)]
pub(super) struct Mean {
    /// The first height, from which the others are counted so that a map far above its zero loses no digits,
    /// and the range of all heights.
    first: Option<(f64, HeightRange)>,
    sum: f64,
    count: f64,
}

impl Mean {
    pub(super) fn add(&mut self, heights: &[f64]) {
        let Some(&start) = heights.first() else { return };
        let (first, range) = self.first.get_or_insert((
            start,
            HeightRange {
                lowest: start,
                highest: start,
            },
        ));
        for &height in heights {
            range.lowest = range.lowest.min(height);
            range.highest = range.highest.max(height);
        }
        self.sum += heights.iter().map(|height| height - *first).sum::<f64>();
        self.count += heights.len() as f64;
    }

    /// Mean and range, if there is a height.
    pub(super) fn of_all(&self) -> Option<(f64, HeightRange)> {
        self.first
            .map(|(first, range)| (first + self.sum / self.count, range))
    }
}

/// Height parameters of a surface (ISO 25178-2), of the deviations z from the mean height:
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

/// The sums that a plane through the deviations z from the mean takes: of z times the column and the row.
#[derive(Default)]
pub(super) struct PlaneSums {
    along: [f64; 2],
    square: f64,
}

impl PlaneSums {
    /// Adds points of a row of a map, the first of them in the column `column`.
    pub(super) fn add(&mut self, row: usize, column: usize, deviations: &[f64]) {
        let (mut sum, mut weighted) = (0.0, 0.0);
        for (at, z) in (column..).zip(deviations) {
            sum += z;
            weighted += at as f64 * z;
            self.square += z * z;
        }
        self.along[0] += weighted;
        self.along[1] += row as f64 * sum;
    }

    /// The share of the variance that the plane of least squares takes from a map of so many points: over a
    /// whole grid columns and rows are orthogonal, and
    ///
    /// ```text
    /// share = [(sum z x)^2/sum x^2 + (sum z y)^2/sum y^2]/sum z^2,   x and y from the middle
    /// ```
    pub(super) fn share(&self, points: [usize; 2]) -> f64 {
        let [nx, ny] = points.map(|count| count as f64);
        // The sum of (i - (n - 1)/2)^2 over i = 0 ... n - 1, for every line across.
        let squares = [nx * (nx * nx - 1.0) / 12.0 * ny, ny * (ny * ny - 1.0) / 12.0 * nx];
        let taken = self.along.iter().zip(squares).filter(|(_, square)| *square > 0.0);
        let taken: f64 = taken.map(|(sum, square)| sum * sum / square).sum();
        if self.square > 0.0 {
            taken / self.square
        } else {
            0.0
        }
    }
}

/// Sums over the deviations from the mean: of their size, and of their second, third and fourth power.
#[derive(Default)]
pub(super) struct Moments {
    sums: [f64; 4],
    count: f64,
}

impl Moments {
    pub(super) fn add(&mut self, deviations: &[f64]) {
        let mut sums = [0.0; 4];
        for z in deviations {
            let square = z * z;
            for (sum, term) in sums
                .iter_mut()
                .zip([z.abs(), square, square * z, square * square])
            {
                *sum += term;
            }
        }
        self.count += deviations.len() as f64;
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
