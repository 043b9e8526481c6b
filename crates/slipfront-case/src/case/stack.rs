//! The stack of two sheets that stands for a bulk body.
//!
//! A sinusoidal displacement of amplitude u and wave number q on the surface of a body that is glued to a
//! rigid base at the height H, under a prescribed pressure, takes a traction `Z u`, along the wave and across
//! it (with `x = q H` and `kappa = 3 - 4 nu`):
//!
//! ```text
//! Z_along = G q/(1 - nu) (2 kappa cosh 2x + 1 + kappa^2 + 4 x^2)/(2 kappa sinh 2x + 4 x)     Z_across = G q coth x
//! ```
//!
//! which are `G q/(1 - nu)` and `G q` of a deep body. Two sheets with the springs of the lattice, of
//! thickness h_1 and h_2, a coupling g and a mount K, answer with
//!
//! ```text
//! Z = c E h_1 q^2 + g (K + c E h_2 q^2)/(g + K + c E h_2 q^2),   c = 9/8 along, 3/8 across
//! ```
//!
//! The geometric mean of both directions is fitted to that of the body, from the wave number q_a of the
//! longest wave length of the texture to 8 q_a, so that the largest relative difference is least.
//! `docs/model.md`, "Bulk bodies", has what that means for answers.

use std::f64::consts::TAU;

use slipfront::lattice::POISSON_RATIO;
use slipfront::{Lattice, Scales, Sheet};

use super::textures::regular_pitch;
use crate::case_file::{Body, CaseFile};
use crate::quantity::Length;

/// Geometric mean of the stiffness of a sheet along and across, over `E h q^2`.
const OF_SHEET: f64 = 0.649_519_052_838_329;
/// Stiffness of a sheet along and across over [their mean](OF_SHEET): sqrt(3) and its inverse.
const DIRECTIONS: [f64; 2] = [1.732_050_807_568_877_2, 0.577_350_269_189_625_8];
/// Ratio of the largest to the smallest wave number of the fit.
const RANGE: f64 = 8.0;
/// Number of wave numbers of the fit, at equal ratios.
const WAVES: usize = 41;
/// Range of `b` in the search for the pole at `q^2 = -b q_a^2`, and its steps by the golden section.
const POLE: [f64; 2] = [0.5, 1000.0];
const STEPS: usize = 40;
/// Number of times that the wave numbers are weighted anew.
const WEIGHTINGS: usize = 15;
/// Number of fits, each with the mean of both directions as the one before leaves it. The last ones differ by
/// less than a thousandth of the error.
const FITS: usize = 8;
/// Share of the lower sheet of the first fit that others keep at least.
const LEAST_LOWER: f64 = 0.5;
/// Wave number times height below which a glued layer yields by shear alone, with G/H, within a thousandth:
/// the fit to longer waves would be one to rounding.
const THIN: f64 = 0.05;

/// A stack of sheets in SI units, from the lowest on.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stack {
    /// Thickness of every sheet, m.
    pub thickness: Vec<f64>,
    /// Stiffness per area of the springs from every sheet to the one above, of the last to the drive, N/m^3.
    pub couplings: Vec<f64>,
}

/// A bulk body, with the stack of two sheets that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BulkBody {
    /// Longest wave length of the fit, m: the one that the case gives, else the pitch of its texture if one
    /// array fills the slider, else the longer side of the slider.
    pub longest_wave: f64,
    /// Height of the body, m; infinite for a deep one.
    pub height: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Thickness of the lower and the upper sheet, m.
    pub thickness: [f64; 2],
    /// Stiffness per area of the springs between both sheets, N/m^3.
    pub coupling: f64,
    /// Stiffness per area of the mount of the upper sheet, N/m^3.
    pub mount: f64,
    /// Largest relative difference between the stack and the body in the geometric mean of both directions,
    /// for wave lengths from the longest to an eighth of it.
    pub error: f64,
}

impl Stack {
    /// The stack of a case; none if its slider is one sheet. The thickness of `scales` is not read.
    pub(super) fn of(file: &CaseFile, scales: &Scales) -> Option<Self> {
        if let Some(given) = &file.slider.sheets {
            return Some(Self {
                thickness: given.iter().map(|sheet| sheet.thickness.si()).collect(),
                couplings: given.iter().map(|sheet| sheet.coupling.si()).collect(),
            });
        }
        BulkBody::of(file, scales).map(|body| Self {
            thickness: body.thickness.into(),
            couplings: vec![body.coupling, body.mount],
        })
    }

    /// The sheets above the lowest one, in units of this case.
    pub(super) fn sheets(&self, scales: &Scales) -> Vec<Sheet> {
        let above = self.thickness.iter().skip(1).zip(&self.couplings);
        let sheet = |(thickness, coupling): (&f64, &f64)| Sheet {
            thickness: thickness / self.thickness[0],
            coupling: scales.stiffness_of_area(*coupling),
        };
        above.map(sheet).collect()
    }

    /// Stiffness per area of the mount of the highest sheet, N/m^3.
    pub(super) fn mount(&self) -> f64 {
        self.couplings[self.couplings.len() - 1]
    }
}

impl BulkBody {
    /// The body of a case whose stack follows from it; none of a sheet, or where `slider.sheets` gives the
    /// stack. The thickness of `scales` is not read.
    pub(super) fn of(file: &CaseFile, scales: &Scales) -> Option<Self> {
        let slider = &file.slider;
        Some(Self::new(
            slider.young_modulus.si(),
            slider.poisson.unwrap_or(POISSON_RATIO),
            slider.height.as_ref().map_or(f64::INFINITY, Length::si),
            longest_wave(file, scales)?,
        ))
    }

    fn new(young_modulus: f64, poisson: f64, height: f64, longest_wave: f64) -> Self {
        let q_a = (TAU / longest_wave).max(THIN / height);
        // In units of q_a, and of G q_a for stiffnesses per area.
        let fit = Fit::of(q_a * height, poisson);
        let shear_modulus = shear_modulus(young_modulus, poisson);
        let per_area = shear_modulus * q_a;
        let thickness = |of_mean: f64| of_mean * shear_modulus / (OF_SHEET * young_modulus * q_a);
        Self {
            longest_wave,
            height,
            poisson,
            thickness: [thickness(fit.lower), thickness(fit.upper())],
            coupling: fit.coupling * per_area,
            mount: fit.mount() * per_area,
            error: fit.error,
        }
    }

    /// Stiffness of the stack over that of the body at a wave length in m, less 1, in the geometric mean of
    /// both directions.
    pub(super) fn excess(&self, young_modulus: f64, wave_length: f64) -> f64 {
        let q = TAU / wave_length;
        let [along, across] = response(q * self.height, self.poisson);
        let of_body = shear_modulus(young_modulus, self.poisson) * q * (along * across).sqrt();
        self.stiffness(young_modulus, q) / of_body - 1.0
    }

    /// Traction over displacement of the stack at wave number q, in the geometric mean of both directions,
    /// Pa/m.
    fn stiffness(&self, young_modulus: f64, q: f64) -> f64 {
        let [along, across] = DIRECTIONS.map(|direction| {
            let of_sheet = direction * OF_SHEET * young_modulus * q * q;
            let [lower, upper] = self.thickness.map(|h| of_sheet * h);
            let above = self.mount + upper;
            lower + self.coupling * above / (self.coupling + above)
        });
        (along * across).sqrt()
    }

    /// The longest and the shortest wave length of the fit, m.
    pub fn waves(&self) -> [f64; 2] {
        [self.longest_wave, self.longest_wave / RANGE]
    }
}

/// Longest wave length for which the stack of a case stands for its body, m; none of a sheet, or where
/// `slider.sheets` gives the stack. The thickness of `scales` is not read.
pub(super) fn longest_wave(file: &CaseFile, scales: &Scales) -> Option<f64> {
    let slider = &file.slider;
    if slider.body == Body::Sheet || slider.sheets.is_some() {
        return None;
    }
    let [nx, ny] = slider.blocks.map(|count| count as usize);
    let of_texture = || {
        let lattice = Lattice::with_edges(nx, ny, slider.edges);
        let pitch = regular_pitch(&file.texture, scales, &lattice);
        pitch.unwrap_or(nx.max(ny) as f64) * scales.block_size
    };
    Some(slider.longest_wave.as_ref().map_or_else(of_texture, Length::si))
}

/// `G = E/(2 (1 + nu))`.
pub(super) fn shear_modulus(young_modulus: f64, poisson: f64) -> f64 {
    young_modulus / (2.0 * (1.0 + poisson))
}

/// Traction over displacement along and across a wave of wave number q, over G q, for `x = q H`.
fn response(x: f64, poisson: f64) -> [f64; 2] {
    let kappa = 3.0 - 4.0 * poisson;
    // Both times exp(-2 x), which keeps large numbers away.
    let decay = libm::exp(-2.0 * x);
    let decay_of_x = |power: f64| {
        if decay > 0.0 {
            4.0 * libm::pow(x, power) * decay
        } else {
            0.0
        }
    };
    let cosh = kappa * (1.0 + decay * decay) + (1.0 + kappa * kappa) * decay + decay_of_x(2.0);
    let sinh = kappa * (1.0 - decay * decay) + decay_of_x(1.0);
    let along = cosh / sinh / (1.0 - poisson);
    [along, (1.0 + decay) / (1.0 - decay)]
}

/// The response of two sheets, over G q_a, with q in units of q_a: `a q^2 + g - d/(q^2 + b)`.
struct Fit {
    /// `a`, of the lower sheet.
    lower: f64,
    /// `g`.
    coupling: f64,
    /// `d = g^2/a_2` with the upper sheet's `a_2`.
    residue: f64,
    /// `b = (g + K)/a_2`.
    pole: f64,
    /// Largest relative difference.
    error: f64,
}

impl Fit {
    /// The best fit to a body of the height `q_a H`.
    ///
    /// One stiffness of a sheet for both directions, their mean, makes the fit a linear one. What that one
    /// gives is not the mean of what the two give; the body is divided by their ratio, and fitted again.
    fn of(height: f64, poisson: f64) -> Self {
        let waves: [f64; WAVES] = std::array::from_fn(|k| libm::pow(RANGE, k as f64 / (WAVES - 1) as f64));
        let mean = |q: f64| {
            let [along, across] = response(q * height, poisson);
            q * (along * across).sqrt()
        };
        let of_body = waves.map(mean);
        let mut found = Self::to(&waves, &of_body);
        let first = found.lower;
        let mut share = 1.0;
        for _ in 1..FITS {
            let ratio = |k: usize| found.along(1.0, waves[k]) / found.mean(waves[k]);
            let targets = std::array::from_fn(|k| of_body[k] * libm::pow(ratio(k), share));
            let next = Self::to(&waves, &targets);
            // Two sheets are more than a thin layer needs, and the thickness of one may fall to nothing.
            if next.lower > LEAST_LOWER * first && next.coupling > 0.0 && next.mount() > 0.0 {
                found = next;
            } else {
                share *= 0.5;
            }
        }
        let difference = |(q, of_body): (&f64, &f64)| (found.mean(*q) / of_body - 1.0).abs();
        found.error = waves.iter().zip(&of_body).map(difference).fold(0.0, f64::max);
        found
    }

    /// Stiffness of the upper sheet over q^2, `a_2`.
    fn upper(&self) -> f64 {
        self.coupling * self.coupling / self.residue
    }

    /// Stiffness of the mount, K.
    fn mount(&self) -> f64 {
        self.upper() * self.pole - self.coupling
    }

    /// Response at the wave number q where sheets have this stiffness, in units of [the mean](OF_SHEET).
    fn along(&self, direction: f64, q: f64) -> f64 {
        let square = direction * q * q;
        self.lower * square + self.coupling - self.residue / (square + self.pole)
    }

    /// Geometric mean of the responses along and across.
    fn mean(&self, q: f64) -> f64 {
        let [along, across] = DIRECTIONS.map(|direction| self.along(direction, q));
        (along * across).sqrt()
    }

    /// The fit of one response: the other numbers follow from the pole by linear equations.
    fn to(waves: &[f64; WAVES], targets: &[f64; WAVES]) -> Self {
        let at = |log_pole: f64| Self::with_pole(libm::exp(log_pole), waves, targets);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let [mut low, mut high] = POLE.map(libm::log);
        let mut within =
            [high - golden * (high - low), low + golden * (high - low)].map(|x| (x, at(x).error));
        for _ in 0..STEPS {
            let [(x1, error1), (x2, error2)] = within;
            if error1 < error2 {
                high = x2;
                let x = high - golden * (high - low);
                within = [(x, at(x).error), (x1, error1)];
            } else {
                low = x1;
                let x = low + golden * (high - low);
                within = [(x2, error2), (x, at(x).error)];
            }
        }
        at(0.5 * (low + high))
    }

    /// The fit with this pole whose largest relative difference is least. Weights that are multiplied by the
    /// differences lead there (C. L. Lawson, 1961).
    fn with_pole(pole: f64, waves: &[f64; WAVES], targets: &[f64; WAVES]) -> Self {
        let row = |k: usize| {
            let square = waves[k] * waves[k];
            [square, 1.0, -1.0 / (square + pole)].map(|term| term / targets[k])
        };
        let rows: [[f64; 3]; WAVES] = std::array::from_fn(row);
        let mut weights = [1.0; WAVES];
        let (mut found, mut error) = ([0.0; 3], f64::INFINITY);
        for _ in 0..WEIGHTINGS {
            let mut matrix = [[0.0; 3]; 3];
            let mut right = [0.0; 3];
            for (row, weight) in rows.iter().zip(weights) {
                for i in 0..3 {
                    right[i] += weight * row[i];
                    for j in 0..3 {
                        matrix[i][j] += weight * row[i] * row[j];
                    }
                }
            }
            found = solution(matrix, right);
            let differences = rows.map(|row| (dot(row, found) - 1.0).abs());
            error = differences.iter().copied().fold(0.0, f64::max);
            if error == 0.0 {
                break;
            }
            for (weight, difference) in weights.iter_mut().zip(differences) {
                *weight *= difference / error;
            }
        }
        let [lower, coupling, residue] = found;
        Self {
            lower,
            coupling,
            residue,
            pole,
            error,
        }
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Solution of three linear equations, by Cramer's rule.
fn solution(matrix: [[f64; 3]; 3], right: [f64; 3]) -> [f64; 3] {
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    // The matrix is symmetric: rows are columns.
    let [x, y, z] = matrix;
    let determinant = dot(x, cross(y, z));
    [
        dot(right, cross(y, z)) / determinant,
        dot(x, cross(right, z)) / determinant,
        dot(x, cross(y, right)) / determinant,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Within 2 % of every body, glued or deep, from the longest wave to an eighth of it.
    #[test]
    fn two_sheets_answer_as_the_body_does() {
        let mut largest = 0.0_f64;
        for poisson in [0.0, 0.1, 0.25, 1.0 / 3.0, 0.45, 0.49, 0.5] {
            for height in [
                1e-6, 1e-3, 0.05, 0.07, 0.088, 0.09, 0.1, 0.12, 0.15, 0.2, 0.3, 0.5, 0.7, 0.8, 1.0, 1.2,
                1.35, 1.5, 1.7, 2.0, 3.0, 5.0, 1e9,
            ] {
                let (young_modulus, q_a) = (2.6e9, 2.0e4);
                let body = BulkBody::new(young_modulus, poisson, height / q_a, TAU / q_a);
                let all = [body.thickness[0], body.thickness[1], body.coupling, body.mount];
                assert!(all.iter().all(|&x| x > 0.0), "{poisson} {height}: {body:?}");
                let mut error = 0.0_f64;
                for k in 0..=200 {
                    let wave_length = TAU / q_a / 8.0_f64.powf(f64::from(k) / 200.0);
                    error = error.max(body.excess(young_modulus, wave_length).abs());
                }
                // Between the wave numbers of the fit, 5 % apart, it is larger by 1.2e-4 at the most.
                assert!((error - body.error).abs() < 3e-4, "{error} {body:?}");
                eprintln!(
                    "SC {poisson:.2} {height} {error:.5} {:.4} {:?} {}",
                    body.error, body.thickness, body.coupling
                );
                largest = largest.max(error);
            }
        }
        assert!(largest < 0.02, "{largest}");
    }

    /// The sheets of a deep body as a plain search over all four numbers found them, to 1 %: it ended when
    /// three digits stood still.
    #[test]
    fn a_deep_body_has_known_sheets() {
        let (young_modulus, poisson, q_a) = (1.0, 0.25, 1.0);
        let body = BulkBody::new(young_modulus, poisson, f64::INFINITY, TAU / q_a);
        let m = shear_modulus(young_modulus, poisson) / (1.0 - poisson).sqrt();
        let scaled = [
            body.thickness[0] * OF_SHEET / m,
            body.thickness[1] * OF_SHEET / m,
            body.coupling / m,
            body.mount / m,
        ];
        for (found, known) in scaled.into_iter().zip([0.0633, 0.604, 4.26, 0.575]) {
            assert!((found / known - 1.0).abs() < 0.01, "{found} {known}");
        }
    }

    /// A thin layer yields by shear alone, and slow loading of the stack does as well: `g K/(g + K) = G/H`.
    #[test]
    fn thin_layers_shear() {
        for poisson in [0.0, 0.3, 0.49] {
            let height = 0.1;
            let body = BulkBody::new(1.0, poisson, height, TAU);
            let series = body.coupling * body.mount / (body.coupling + body.mount);
            let shear = 0.5 / (1.0 + poisson) / height;
            assert!((series / shear - 1.0).abs() < 0.002, "{series} {shear}");
            let [along, across] = response(1e-4, poisson);
            assert!((along * 1e-4 - 1.0).abs() < 1e-6 && (across * 1e-4 - 1.0).abs() < 1e-6);
        }
    }
}
