//! The stack of two sheets that models a bulk body.
//!
//! A body of height H is bonded to a rigid base. A sinusoidal displacement of amplitude u and wave number q
//! on its surface, under a prescribed pressure, takes a traction `Z u`, along the wave and across it (with `x
//! = q H` and `kappa = 3 - 4 nu`):
//!
//! ```text
//! Z_along = G q/(1 - nu) (2 kappa cosh 2x + 1 + kappa^2 + 4 x^2)/(2 kappa sinh 2x + 4 x)     Z_across = G q coth x
//! ```
//!
//! For a deep body these are `G q/(1 - nu)` and `G q`. Two sheets with the springs of the lattice, of
//! thickness h_1 and h_2, with a coupling g and a mount K, have the response
//!
//! ```text
//! Z = c E h_1 q^2 + g (K + c E h_2 q^2)/(g + K + c E h_2 q^2),   c = sqrt(27/64 r) along, c/r across
//! ```
//!
//! The springs of the sheets are [`SpringStiffness::with_ratio`] of `r = 1/(1 - nu)^2 + 1/2`. Without the
//! 1/2, the stiffness in both directions would equal that of the body. With it, reductions of friction do,
//! because central springs couple motion along x and along y as if r were 3. The geometric mean of both
//! directions is fitted to that of the body, from the wave number q_a of the longest wavelength of the
//! texture to 8 q_a, so that the largest relative difference is least. `docs/validation/bulk.md` has the
//! consequences for results.

mod fit;

use std::f64::consts::TAU;

use slipfront::lattice::POISSON_RATIO;
use slipfront::lattice::SpringStiffness;
use slipfront::{Lattice, Scales, Sheet};

use self::fit::{Fit, RANGE, THIN, directions, response};
use super::textures::regular_pitch;
use crate::case_file::{Body, CaseFile};
use crate::quantity::Length;

/// Geometric mean of the stiffness of a sheet along and across a wave, over `E h q^2`.
const OF_SHEET: f64 = 0.649_519_052_838_329;
/// Ratio of the stiffness of the paper's springs along a wave to that across it.
const OF_PAPER: f64 = 3.0;
/// Difference between the ratio of a sheet and the square of the ratio of a deep body. With this value,
/// reductions of friction by arrays of dimples, bands and patches agree best.
const MORE_ALONG: f64 = 0.5;
/// A stack of sheets in SI units, from the lowest up.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stack {
    /// Thickness of every sheet, m.
    pub thickness: Vec<f64>,
    /// Stiffness per area of the springs from every sheet to the one above, for the last one to the drive,
    /// N/m^3.
    pub couplings: Vec<f64>,
    /// Ratio of the stiffness of every sheet along a wave to that across it.
    pub along_to_across: f64,
}

/// A bulk body, with the stack of two sheets that models it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BulkBody {
    /// Longest wavelength of the fit, m: the one that the case gives, otherwise the pitch of its texture if
    /// one array fills the slider, otherwise the longer side of the slider.
    pub longest_wave: f64,
    /// Height of the body, m; infinite for a deep one.
    pub height: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Ratio of the stiffness of both sheets along a wave to that across it.
    pub along_to_across: f64,
    /// Thickness of the lower and the upper sheet, m.
    pub thickness: [f64; 2],
    /// Stiffness per area of the springs between the sheets, N/m^3.
    pub coupling: f64,
    /// Stiffness per area of the mount of the upper sheet, N/m^3.
    pub mount: f64,
    /// Largest relative difference between the stack and the body in the geometric mean of both directions,
    /// for wavelengths from the longest to an eighth of it.
    pub error: f64,
}

impl Stack {
    /// The stack of a case; none if its slider is one sheet. The thickness of `scales` is not used.
    pub(super) fn of(file: &CaseFile, scales: &Scales) -> Option<Self> {
        if let Some(given) = &file.slider.sheets {
            return Some(Self {
                thickness: given.iter().map(|sheet| sheet.thickness.si()).collect(),
                couplings: given.iter().map(|sheet| sheet.coupling.si()).collect(),
                along_to_across: file.slider.along_to_across.unwrap_or(OF_PAPER),
            });
        }
        BulkBody::of(file, scales).map(|body| body.stack())
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

    /// Ratio of traction to displacement along and across a wave of wave number q, Pa/m.
    fn response(&self, young_modulus: f64, q: f64) -> [f64; 2] {
        directions(self.along_to_across).map(|direction| {
            let per_thickness = direction * OF_SHEET * young_modulus * q * q;
            let sheets = self.thickness.iter().zip(&self.couplings).rev();
            // The support above the highest sheet does not move.
            sheets.fold(f64::INFINITY, |above, (thickness, coupling)| {
                per_thickness * thickness + 1.0 / (1.0 / coupling + 1.0 / above)
            })
        })
    }

    /// Ratio of traction to displacement along a wave of wave number q, Pa/m.
    pub(super) fn along(&self, young_modulus: f64, q: f64) -> f64 {
        self.response(young_modulus, q)[0]
    }

    /// Springs between neighbouring blocks of every sheet.
    pub(super) fn springs(&self) -> SpringStiffness {
        SpringStiffness::with_ratio(self.along_to_across)
    }

    /// Stiffness per area of the mount of the highest sheet, N/m^3.
    pub(super) fn mount(&self) -> f64 {
        self.couplings[self.couplings.len() - 1]
    }
}

impl BulkBody {
    /// The body of a case with a stack derived from it; none for a sheet, or where `slider.sheets` gives the
    /// stack. The thickness of `scales` is not used.
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
        let along_to_across = 1.0 / ((1.0 - poisson) * (1.0 - poisson)) + MORE_ALONG;
        let fit = Fit::of(q_a * height, poisson, along_to_across);
        let [lower, upper, coupling, mount] = fit.stiffness();
        let shear_modulus = shear_modulus(young_modulus, poisson);
        let per_area = shear_modulus * q_a;
        let thickness = |of_mean: f64| of_mean * shear_modulus / (OF_SHEET * young_modulus * q_a);
        Self {
            longest_wave,
            height,
            poisson,
            along_to_across,
            thickness: [thickness(lower), thickness(upper)],
            coupling: coupling * per_area,
            mount: mount * per_area,
            error: fit.error,
        }
    }

    /// The stack that models the body.
    pub(super) fn stack(&self) -> Stack {
        Stack {
            thickness: self.thickness.into(),
            couplings: vec![self.coupling, self.mount],
            along_to_across: self.along_to_across,
        }
    }

    /// Ratio of traction to displacement along a wave of wave number q in the body, Pa/m.
    pub(super) fn along(&self, young_modulus: f64, q: f64) -> f64 {
        let shear_modulus = shear_modulus(young_modulus, self.poisson);
        if q == 0.0 {
            return shear_modulus / self.height;
        }
        shear_modulus * q * response(q * self.height, self.poisson)[0]
    }

    /// Ratio of the stiffness of the stack to that of the body at a wavelength in m, less 1, in the geometric
    /// mean of both directions.
    pub(super) fn excess(&self, young_modulus: f64, wave_length: f64) -> f64 {
        let q = TAU / wave_length;
        let [along, across] = response(q * self.height, self.poisson);
        let of_body = shear_modulus(young_modulus, self.poisson) * q * (along * across).sqrt();
        let [along, across] = self.stack().response(young_modulus, q);
        (along * across).sqrt() / of_body - 1.0
    }

    /// The longest and the shortest wavelength of the fit, m.
    pub fn waves(&self) -> [f64; 2] {
        [self.longest_wave, self.longest_wave / RANGE]
    }
}

/// Longest wavelength for which the stack of a case is fitted to its body, m; none for a sheet, or where
/// `slider.sheets` gives the stack. The thickness of `scales` is not used.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Error within 1.35 % for every body, bonded or deep, from the longest wave to an eighth of it.
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
                // Between the wave numbers of the fit, which are 5 % apart, the error is larger by at most
                // 1.2e-4. A thin layer is fitted to shorter waves than these.
                let fits_these = height >= THIN;
                assert!(error < body.error + 3e-4, "{error} {body:?}");
                assert!(!fits_these || error > body.error - 3e-4, "{error} {body:?}");
                largest = largest.max(error);
            }
        }
        assert!(largest < 0.0135, "{largest}");
    }

    /// The sheets of a deep body agree within 1 % with a direct search over all four numbers: the fit ends
    /// where its error changes by less than a thousandth.
    #[test]
    fn a_deep_body_has_known_sheets() {
        for (poisson, known) in [
            (0.25, [0.0659, 0.597, 4.17, 0.603]),
            (1.0 / 3.0, [0.0642, 0.602, 4.23, 0.585]),
            (0.49, [0.0588, 0.618, 4.42, 0.527]),
        ] {
            let body = BulkBody::new(1.0, poisson, f64::INFINITY, TAU);
            let m = shear_modulus(1.0, poisson) / (1.0 - poisson).sqrt();
            let scaled = [
                body.thickness[0] * OF_SHEET / m,
                body.thickness[1] * OF_SHEET / m,
                body.coupling / m,
                body.mount / m,
            ];
            for (found, known) in scaled.into_iter().zip(known) {
                assert!((found / known - 1.0).abs() < 0.01, "{poisson}: {found} {known}");
            }
        }
    }

    /// A thin layer deforms only by shear, and so does the stack under slow loading: `g K/(g + K) = G/H`.
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
