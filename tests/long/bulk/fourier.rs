//! The discrete Fourier transform of a square of complex numbers.

use std::f64::consts::TAU;
use std::ops::{Add, Mul, Sub};

/// A complex number, also for the components of a vector in the plane.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Complex {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Complex {
    pub(crate) fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    pub(crate) fn conjugate(self) -> Self {
        Self::new(self.x, -self.y)
    }

    pub(crate) fn length(self) -> f64 {
        (self.x * self.x + self.y * self.y).sqrt()
    }

    pub(crate) fn times(self, factor: f64) -> Self {
        Self::new(self.x * factor, self.y * factor)
    }
}

impl Add for Complex {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.x + other.x, self.y + other.y)
    }
}

impl Sub for Complex {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::new(self.x - other.x, self.y - other.y)
    }
}

impl Mul for Complex {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.x * other.x - self.y * other.y,
            self.x * other.y + self.y * other.x,
        )
    }
}

/// Transforms of squares of one size.
pub(crate) struct Fourier {
    side: usize,
    /// `exp(-i 2 pi k/side)`.
    roots: Vec<Complex>,
    /// Index with the binary digits in reverse order, for every index.
    reversed: Vec<usize>,
}

impl Fourier {
    /// Transforms of side x side numbers; `side` is a power of two and at least 2.
    pub(crate) fn new(side: usize) -> Self {
        assert!(side.is_power_of_two() && side > 1, "{side}");
        let digits = side.trailing_zeros();
        let root = |k: usize| {
            let angle = -TAU * k as f64 / side as f64;
            Complex::new(angle.cos(), angle.sin())
        };
        Self {
            side,
            roots: (0..side).map(root).collect(),
            reversed: (0..side)
                .map(|k| k.reverse_bits() >> (usize::BITS - digits))
                .collect(),
        }
    }

    /// `sum_j a_j exp(-i q.j)`, with rows and columns exchanged.
    pub(crate) fn forward(&self, square: &mut [Complex]) {
        self.rows(square);
        self.exchange(square);
        self.rows(square);
    }

    /// Inverse transform of numbers with rows and columns exchanged, as [`forward`](Self::forward) gives
    /// them.
    pub(crate) fn back(&self, square: &mut [Complex]) {
        let share = 1.0 / (self.side * self.side) as f64;
        for number in square.iter_mut() {
            *number = number.conjugate();
        }
        self.forward(square);
        for number in square.iter_mut() {
            *number = number.conjugate().times(share);
        }
    }

    fn exchange(&self, square: &mut [Complex]) {
        for row in 0..self.side {
            for column in 0..row {
                square.swap(row * self.side + column, column * self.side + row);
            }
        }
    }

    fn rows(&self, square: &mut [Complex]) {
        for row in square.chunks_exact_mut(self.side) {
            for (k, &other) in self.reversed.iter().enumerate() {
                if k < other {
                    row.swap(k, other);
                }
            }
            let mut half = 1;
            while half < self.side {
                for part in row.chunks_exact_mut(2 * half) {
                    let (low, high) = part.split_at_mut(half);
                    let roots = self.roots.iter().step_by(self.side / (2 * half));
                    for ((low, high), &root) in low.iter_mut().zip(high).zip(roots) {
                        let turned = *high * root;
                        *high = *low - turned;
                        *low = *low + turned;
                    }
                }
                half *= 2;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The transform of a single wave has a single number, and the inverse transform gives the wave again.
    #[test]
    fn a_wave_is_a_number() {
        let (side, across, along) = (8, 3, 1);
        let wave = |k: usize| {
            let angle = TAU * (across * (k / side) + along * (k % side)) as f64 / side as f64;
            Complex::new(angle.cos(), angle.sin())
        };
        let waves: Vec<Complex> = (0..side * side).map(wave).collect();
        let fourier = Fourier::new(side);
        let mut square = waves.clone();
        fourier.forward(&mut square);
        for (k, number) in square.iter().enumerate() {
            let expected = if k == along * side + across { 64.0 } else { 0.0 };
            // Rounding of some sums of 64 numbers.
            assert!((*number - Complex::new(expected, 0.0)).length() < 1e-12);
        }
        fourier.back(&mut square);
        for (number, wave) in square.iter().zip(waves) {
            assert!((*number - wave).length() < 1e-14);
        }
    }
}
