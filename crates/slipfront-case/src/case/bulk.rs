//! Sliders that are so thick under their texture that they are a bulk body, not a sheet.
//!
//! The response of a sheet of thickness h on a mount K to a traction of wave number q is `K + 9/8 E h q^2`
//! along the wave and `K + 3/8 E h q^2` across it; that of a deep body is `G q/(1 - nu)` and `G q`. Around a
//! texture of pitch p, stress reaches about p deep in the body, and much farther along in a thick sheet. See
//! `docs/model.md`, "Thickness and mount".

use std::f64::consts::{PI, TAU};

use slipfront::lattice::POISSON_RATIO;

use super::coefficients::sharing_distance;
use super::runnable::Case;
use super::stack::{BulkBody, Stack, shear_modulus};
use super::textures::{pitch, regular_pitch};
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// Thickness over the pitch, or over the smallest feature, above which there is a note.
const THICK: f64 = 1.0 / 3.0;
/// Share by which a thickness may exceed the bound: rounding of lengths, and of a thickness to four digits.
const ROUNDING: f64 = 1e-3;
/// Critical size of a long strip on a rigid base in units of `G/((1 - nu) w)`: an eigenvalue, which is 2.313
/// to 2.319 on 400 cells.
const STRIP: f64 = 2.316;
/// Thickness over pitch, and the range of the ratio of two changes of static friction by a texture: in a bulk
/// body over in the sheet. For a square array of dimples half a pitch wide, R* = 0.5, nu = 1/3, a height of
/// five pitches, and `w p (1 - nu)/G` from 1 to 20 (`docs/validation/bulk.md`).
const BULK_OVER_SHEET: [(f64, [f64; 2]); 3] = [(0.1, [0.42, 0.86]), (0.5, [1.5, 2.4]), (5.0, [11.0, 18.0])];
/// Excess of the stiffness of the stack over that of the body above which there is a note.
const LARGE_EXCESS: f64 = 0.1;

/// Lengths of the textures of a case, m, by which it counts as a sheet or not.
#[derive(Clone, Copy, Debug, PartialEq)]
struct TextureLengths {
    /// Smallest feature, where one is known.
    feature: Option<f64>,
    /// Pitch of the innermost pattern, where there is one.
    pitch: Option<f64>,
    /// Whether one array of this pitch fills the slider.
    is_regular: bool,
}

impl Case {
    /// The bulk body of the case; none for a sheet, or where `slider.sheets` gives the stack.
    pub fn bulk_body(&self) -> Option<BulkBody> {
        BulkBody::of(&self.file, &self.scales)
    }

    /// The stack of sheets of the case; none for one sheet.
    fn stack(&self) -> Option<Stack> {
        Stack::of(&self.file, &self.scales)
    }

    /// Decrease of strength per slip of blocks in contact, `w = (mu_s - mu_k) P/D_c`, Pa/m; none under laws
    /// without a strength that decreases with slip.
    fn weakening_of_area(&self) -> Option<f64> {
        Some(self.model.weakening()? / self.scales.stiffness_of_area(1.0))
    }

    /// Critical size of slip in a bulk body on a rigid base in blocks, for a long strip across the drive,
    /// where strength decreases with slip; none for a chain. It is infinite where the stiffness that holds
    /// all blocks together is larger than the decrease of strength with slip.
    ///
    /// ```text
    /// L_c = 2.316/q,   Z(q) = w = (mu_s - mu_k) P/D_c,   P on blocks in contact
    /// ```
    ///
    /// Z is the stiffness along a wave. For a deep body it is `G q/(1 - nu)`, and 2.316 is exact; for a strip
    /// on a thin layer or on a given stack, the factor may be up to pi instead. A sheet has the critical size
    /// of a deep body of its material.
    pub(super) fn critical_size_of_bulk(&self) -> Option<f64> {
        let (model, scales) = (&self.model, &self.scales);
        let weakening = self.weakening_of_area().filter(|weakening| *weakening > 0.0)?;
        let modulus = scales.young_modulus;
        let metres = if let Some(body) = self.bulk_body() {
            size_at(weakening, &|q| body.along(modulus, q))
        } else if let Some(stack) = self.stack() {
            size_at(weakening, &|q| stack.along(modulus, q))
        } else {
            STRIP * shear_modulus(modulus, POISSON_RATIO) / ((1.0 - POISSON_RATIO) * weakening)
        };
        (model.lattice.nx > 1 && model.lattice.ny > 1).then_some(metres / scales.block_size)
    }

    /// Distance in m within which blocks in contact carry the load of a textured one; none where all of them
    /// share it equally, or where none carries it.
    pub fn load_distance(&self) -> Option<f64> {
        let blocks = sharing_distance(&self.file, &self.scales, &self.model.lattice).ok()?;
        blocks.map(|blocks| blocks * self.scales.block_size)
    }

    /// Largest strain of the slider under a wave of traction as large as its friction. For a sheet this is `P
    /// mu_s l/(E h)` on one block, for a stack `P mu_s q/Z` with the stiffness Z along a wave at least two
    /// blocks long.
    pub fn strain_of_load(&self) -> f64 {
        /// Number of wavelengths, in geometric progression; the longest is a thousand blocks.
        const WAVES: i32 = 40;
        let scales = &self.scales;
        let Some(stack) = self.stack() else {
            return self.groups.epsilon;
        };
        let strain = |k: i32| {
            let q = PI / scales.block_size * libm::pow(500.0, -f64::from(k) / f64::from(WAVES));
            scales.stress() * q / stack.along(scales.young_modulus, q)
        };
        (0..=WAVES).map(strain).fold(0.0, f64::max)
    }

    /// A sentence on a slider with a given thickness that is not a sheet under its texture: the approximate
    /// error of its answer, and what to write instead. None where neither a pitch nor a feature is known.
    pub fn thick_for_texture(&self) -> Option<String> {
        self.note_on_thickness(self.texture_lengths())
    }

    /// Like [`thick_for_texture`](Self::thick_for_texture), for textures that are not drawn yet, with a
    /// smallest feature in m.
    pub fn thick_for_feature(&self, feature: f64) -> Option<String> {
        self.note_on_thickness(TextureLengths {
            feature: Some(feature),
            pitch: None,
            is_regular: false,
        })
    }

    fn note_on_thickness(&self, lengths: TextureLengths) -> Option<String> {
        let thickness = self.file.slider.thickness.as_ref()?.si();
        let (name, smallest) = lengths.smallest()?;
        // The sheet that fits is known only for a regular array.
        let fits = if lengths.is_regular {
            fitting_thickness(lengths.reach())
        } else {
            0.0
        };
        if thickness <= (THICK * smallest).max(fits) * (1.0 + ROUNDING) {
            return None;
        }
        Some(format!(
            "`slider.thickness` is {}, more than a third of the {name} of {}: a part of this thickness is a bulk body, not a \
             sheet. In a bulk body stress at the texture reaches about {} deep, and the texture changes mu_s* by about {} times \
             as much as in this sheet; use `slider.body = \"bulk\"` and `slider.height = \"{}\"` instead",
            with_si_prefix(thickness, "m"),
            with_si_prefix(smallest, "m"),
            with_si_prefix(lengths.reach(), "m"),
            times_as_much(thickness / lengths.reach()),
            with_si_prefix(thickness, "m")
        ))
    }

    /// Sentences on the limits of the stack as a model of the bulk body: waves shorter or longer than those
    /// of the fit, and uniform slip of all blocks.
    pub(super) fn bulk_notes(&self) -> Vec<String> {
        let Some(body) = self.bulk_body() else {
            return Vec::new();
        };
        let short = self.texture_lengths().feature.and_then(|feature| {
            let excess = body.excess(self.scales.young_modulus, 2.0 * feature);
            (2.0 * feature < body.longest_wave && excess > LARGE_EXCESS).then(|| {
                format!(
                    "the smallest feature of {} is small compared with the longest wavelength of {}: at twice the feature the \
                     stack is {:.0} % stiffer than the body. Use one array with a `pitch` that fills the slider, which makes the \
                     pitch the longest wavelength, or set `slider.longest_wave`, or three `slider.sheets`",
                    with_si_prefix(feature, "m"),
                    with_si_prefix(body.longest_wave, "m"),
                    100.0 * excess
                )
            })
        });
        let long = self.texture_lengths().pitch.and_then(|pitch| {
            let excess = body.excess(self.scales.young_modulus, pitch);
            (pitch > body.longest_wave && excess > LARGE_EXCESS).then(|| {
                format!(
                    "the longest wavelength of the slider is {}, shorter than the pitch of {}: at the pitch the stack is {:.0} \
                     % stiffer than the body; set `slider.longest_wave` = \"{1}\"",
                    with_si_prefix(body.longest_wave, "m"),
                    with_si_prefix(pitch, "m"),
                    100.0 * excess
                )
            })
        });
        let modulus = self.scales.young_modulus;
        let of_all = self.weakening_of_area().and_then(|weakening| {
            let (held, by_body) = (body.stack().along(modulus, 0.0), body.along(modulus, 0.0));
            (by_body < weakening && weakening < held).then(|| {
                format!(
                    "for uniform slip the stack is {} times as stiff as the body, and stiffer than the weakening of friction: \
                     once all blocks slide, slip does not run away in the stack. mu* then falls in proportion to the drive path, \
                     but drops at once in the body; a longer `slider.longest_wave` is closer to the body",
                    if by_body > 0.0 { four_digits(held / by_body) } else { "infinitely many".to_owned() }
                )
            })
        });
        short.into_iter().chain(long).chain(of_all).collect()
    }

    /// The smallest feature and pitch of all textures.
    fn texture_lengths(&self) -> TextureLengths {
        let textures = &self.file.texture;
        let (scales, lattice) = (&self.scales, &self.model.lattice);
        let pitches = textures
            .iter()
            .filter_map(|texture| Some(pitch(texture, scales, lattice)?.0));
        let in_metres = |blocks: f64| blocks * scales.block_size;
        TextureLengths {
            feature: self.clearance().feature.map(in_metres),
            pitch: pitches.reduce(f64::min).map(in_metres),
            is_regular: regular_pitch(textures, scales, lattice).is_some(),
        }
    }
}

impl TextureLengths {
    /// The smaller of pitch and feature, with its name.
    fn smallest(&self) -> Option<(&'static str, f64)> {
        let feature = self.feature.map(|feature| ("smallest feature", feature));
        let pitch = self.pitch.map(|pitch| ("pitch", pitch));
        feature
            .into_iter()
            .chain(pitch)
            .min_by(|(_, one), (_, other)| one.total_cmp(other))
    }

    /// Depth to which stress reaches around the texture: a pitch. Without a pitch, twice the width of a
    /// feature, which is the pitch of the measured array.
    fn reach(&self) -> f64 {
        self.pitch
            .or(self.feature.map(|feature| 2.0 * feature))
            .unwrap_or(0.0)
    }
}

/// Critical size in m for this decrease of strength per slip in Pa/m, where the stiffness along a wave
/// increases with its wave number.
fn size_at(weakening: f64, along: &dyn Fn(f64) -> f64) -> f64 {
    /// Halvings after which the ends are adjacent floating-point numbers.
    const HALVINGS: usize = 60;
    if along(0.0) >= weakening {
        return f64::INFINITY;
    }
    let mut high = 1.0;
    while along(high) < weakening {
        high *= 2.0;
    }
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if along(middle) < weakening {
            low = middle;
        } else {
            high = middle;
        }
    }
    STRIP / high
}

/// Thickness of the sheet that, on its matching mount, responds to tractions of wave number `q = 2 pi/pitch`
/// along and across like a bulk body:
///
/// ```text
/// h = (2/3) nu/((1 - nu^2) q)
/// ```
fn fitting_thickness(pitch: f64) -> f64 {
    let nu = POISSON_RATIO;
    2.0 / 3.0 * nu / (1.0 - nu * nu) * (pitch / TAU)
}

/// Range of the change by a texture in a bulk body over its change in a sheet with this ratio of thickness to
/// pitch, in words. Between known ratios, interpolates linearly on logarithmic scales.
fn times_as_much(thickness_over_pitch: f64) -> String {
    let known = BULK_OVER_SHEET;
    let ((thinnest, [_, most]), (thickest, [least, _])) = (known[0], known[known.len() - 1]);
    if thickness_over_pitch < thinnest {
        return format!("less than {most:.1}");
    }
    if thickness_over_pitch > thickest * (1.0 + ROUNDING) {
        return format!("more than {least:.0}");
    }
    let above = known
        .iter()
        .position(|(thickness, _)| thickness_over_pitch <= *thickness);
    let upper = above.unwrap_or(known.len() - 1).max(1);
    let [(from, low), (to, high)] = [known[upper - 1], known[upper]];
    let place = libm::log(thickness_over_pitch / from) / libm::log(to / from);
    let at = |end: usize| low[end] * libm::pow(high[end] / low[end], place);
    format!("{} to {}", two_digits(at(0)), two_digits(at(1)))
}

fn two_digits(ratio: f64) -> String {
    if ratio < 9.95 {
        format!("{ratio:.1}")
    } else {
        format!("{ratio:.0}")
    }
}
