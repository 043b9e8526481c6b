//! Detection of values that mark points that were not measured, among heights.

use std::cmp::Ordering;

/// The outermost value on one side of all heights.
#[derive(Clone, Copy)]
struct Extreme {
    value: f64,
    /// Number of points with exactly this value.
    count: usize,
    /// The nearest other value; the outermost itself while there is none.
    next: f64,
}

impl Extreme {
    /// Adds a height; `side` says how a height beyond the outermost one compares with it.
    fn add(&mut self, height: f64, side: Ordering) {
        match height.total_cmp(&self.value) {
            Ordering::Equal => self.count += 1,
            order if order == side => {
                *self = Self {
                    value: height,
                    count: 1,
                    next: self.value,
                };
            }
            _ if self.next == self.value || height.total_cmp(&self.next) == side => self.next = height,
            _ => {}
        }
    }
}

/// The lowest and the highest of some heights, each with its number of points and the nearest other height.
#[derive(Default)]
pub(super) struct Extremes {
    /// The lowest and the highest.
    ends: Option<[Extreme; 2]>,
    count: usize,
}

impl Extremes {
    /// Adds heights; points with NaN are none.
    pub(super) fn add(&mut self, heights: &[f64]) {
        for &height in heights.iter().filter(|height| !height.is_nan()) {
            self.count += 1;
            let Some([lowest, highest]) = &mut self.ends else {
                let alone = Extreme {
                    value: height,
                    count: 1,
                    next: height,
                };
                self.ends = Some([alone; 2]);
                continue;
            };
            lowest.add(height, Ordering::Less);
            highest.add(height, Ordering::Greater);
        }
    }

    /// The outermost values that may mark points that were not measured, with their numbers of points: values
    /// of a minority of the points, and farther from the nearest height than all other heights are from each
    /// other.
    pub(super) fn marks(&self) -> Vec<(f64, usize)> {
        let Some([lowest, highest]) = self.ends else {
            return Vec::new();
        };
        let others = highest.next - lowest.next;
        let marks = [
            (lowest, lowest.next - lowest.value),
            (highest, highest.value - highest.next),
        ];
        let marks = marks
            .into_iter()
            .filter(|(extreme, gap)| others > 0.0 && *gap > FAR * others && 2 * extreme.count < self.count);
        marks.map(|(extreme, _)| (extreme.value, extreme.count)).collect()
    }
}

/// Distance of a mark from all heights, over their range. The heights of a surface have no such gap.
const FAR: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;

    /// A rough surface of 10 000 points between -1 and 1, of which every `spacing`-th is a mark.
    fn marks(spacing: usize, mark: &[f64]) -> Vec<(f64, usize)> {
        let mut extremes = Extremes::default();
        for k in 0..10_000 {
            let height = (k as f64 * 0.7).sin();
            let at = (k % spacing).checked_sub(spacing - mark.len());
            extremes.add(&[at.map_or(height, |at| mark[at])]);
        }
        extremes.marks()
    }

    #[test]
    fn marks_are_found_whatever_their_number() {
        for spacing in [4, 100, 2500, 10_000] {
            assert_eq!(marks(spacing, &[-9999.0]), [(-9999.0, 10_000 / spacing)]);
        }
        let both = marks(100, &[1e38, -10.0]);
        assert_eq!(both, [(-10.0, 100), (1e38, 100)]);
    }

    #[test]
    fn surfaces_have_no_marks() {
        assert_eq!(marks(4, &[f64::NAN]), []);
        // A spike of the height of the surface, and cavities with rough floors.
        assert_eq!(marks(100, &[3.0]), []);
        let mut extremes = Extremes::default();
        extremes.add(&[]);
        assert_eq!(extremes.marks(), []);
        for k in 0..1000 {
            let rough = (f64::from(k) * 0.7).sin();
            extremes.add(&[if k % 10 == 0 { rough - 500.0 } else { rough }]);
        }
        assert_eq!(extremes.marks(), []);
        // Two and three levels.
        for levels in [2, 3] {
            let mut extremes = Extremes::default();
            (0..30).for_each(|k| extremes.add(&[f64::from(k % levels * k % levels)]));
            assert_eq!(extremes.marks(), []);
        }
    }
}
