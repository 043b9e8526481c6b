//! Values of the unknowns in the runs of a training.

use sobol_burley::{NUM_DIMENSIONS, sample};

/// Shares of the ranges of `count` unknowns in training run `run`, of at most 65536: points that fill the
/// ranges evenly, for any number of runs.
///
/// The points are a Sobol sequence with the direction numbers of Joe and Kuo (SIAM Journal on Scientific
/// Computing 30 (2008) 2635) and Owen's scrambling: each unknown alone, and each pair of unknowns, has values
/// as even as those of a grid. Multiples of powers of one number do not have this property, since such a
/// power may be close to a ratio of small integers.
pub fn design_point(run: usize, count: usize) -> Vec<f64> {
    // Beyond the last dimension the sequence starts again with another scrambling.
    let share = |j: u32| sample(run as u32, j % NUM_DIMENSIONS, j / NUM_DIMENSIONS);
    (0..count as u32).map(|j| f64::from(share(j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The largest distance of the share of values below a number from that number.
    fn unevenness(mut values: Vec<f64>) -> f64 {
        values.sort_by(f64::total_cmp);
        let n = values.len() as f64;
        let distances = values.iter().enumerate();
        distances.fold(0.0, |largest: f64, (i, value)| {
            largest
                .max((value - i as f64 / n).abs())
                .max((value - (i as f64 + 1.0) / n).abs())
        })
    }

    /// The share of n values below any number differs from that number by less than log2(n)/n, also if n is
    /// not a power of two.
    #[test]
    fn design_points_fill_the_range_of_every_unknown() {
        for (runs, count) in [(100, 3), (300, 8), (400, 4), (2500, 6), (2500, 12), (100, 300)] {
            let points: Vec<Vec<f64>> = (0..runs).map(|run| design_point(run, count)).collect();
            for j in 0..count {
                let found = unevenness(points.iter().map(|point| point[j]).collect());
                let n = runs as f64;
                assert!(found < n.log2() / n, "{runs} {count} {j}: {found}");
            }
        }
    }

    /// Every square of a grid of 16 x 16 holds at least one of 1024 values of two unknowns: random ones would
    /// leave some five squares empty.
    #[test]
    fn design_points_fill_the_ranges_of_two_unknowns() {
        let points: Vec<Vec<f64>> = (0..1024).map(|run| design_point(run, 8)).collect();
        for first in 0..8 {
            for second in 0..first {
                let mut counts = [0; 256];
                for point in &points {
                    let [row, column] = [first, second].map(|j| (16.0 * point[j]) as usize);
                    counts[16 * row + column] += 1;
                }
                assert!(counts.iter().all(|&count| count > 0), "{first} {second}");
            }
        }
    }
}
