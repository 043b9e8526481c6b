//! Detection of values that mark points that were not measured, among heights or readings of a meter.

use std::cmp::Ordering;

/// The outermost value on one side of all values.
#[derive(Clone, Copy)]
struct Extreme {
    value: f64,
    /// Number of points with exactly this value.
    count: usize,
    /// The nearest other value; the outermost itself while there is none.
    next: f64,
}

impl Extreme {
    /// Adds a value; `side` says how a value beyond the outermost one compares with it.
    fn add(&mut self, value: f64, side: Ordering) {
        match value.total_cmp(&self.value) {
            Ordering::Equal => self.count += 1,
            order if order == side => {
                *self = Self {
                    value,
                    count: 1,
                    next: self.value,
                };
            }
            _ if self.next == self.value || value.total_cmp(&self.next) == side => self.next = value,
            _ => {}
        }
    }
}

/// The lowest and the highest of some values, each with its number of points and the nearest other value.
#[derive(Default)]
pub struct Extremes {
    /// The lowest and the highest.
    ends: Option<[Extreme; 2]>,
    count: usize,
}

impl Extremes {
    /// Adds values; NaN is none.
    pub fn add(&mut self, values: &[f64]) {
        for &value in values.iter().filter(|value| !value.is_nan()) {
            self.count += 1;
            let Some([lowest, highest]) = &mut self.ends else {
                let alone = Extreme {
                    value,
                    count: 1,
                    next: value,
                };
                self.ends = Some([alone; 2]);
                continue;
            };
            lowest.add(value, Ordering::Less);
            highest.add(value, Ordering::Greater);
        }
    }

    /// Whether a mark is more than twice as far from zero as all values that are none.
    pub fn exceeds_all(&self, mark: f64) -> bool {
        let marks = self.marks();
        let is_mark = |value: f64| marks.iter().any(|(of, _)| *of == value);
        self.ends.iter().flatten().all(|end| {
            let nearest = if is_mark(end.value) { end.next } else { end.value };
            mark.abs() > FAR * nearest.abs()
        })
    }

    /// The outermost values that may mark points that were not measured, with their numbers of points: values
    /// of a minority of the points, and farther from the nearest value than all other values are from each
    /// other.
    pub fn marks(&self) -> Vec<(f64, usize)> {
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

/// Distance of a mark from all values, over their range, and from zero. The heights of a surface have no such
/// gap.
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
