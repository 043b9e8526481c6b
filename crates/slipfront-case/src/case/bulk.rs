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
use super::textures::{pitch, regular_pitch};
use slipfront_base::number_format::with_si_prefix;

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
    /// on a thin layer, the factor may be up to pi instead. A sheet has the critical size
    /// of a deep body of its material.
    pub(super) fn critical_size_of_bulk(&self) -> Option<f64> {
        let (model, scales) = (&self.model, &self.scales);
        let weakening = self.weakening_of_area().filter(|weakening| *weakening > 0.0)?;
        let modulus = scales.young_modulus;
        let metres = match model.body() {
            Some(body) => {
                let per_block = weakening * scales.block_size / modulus;
                size_at(per_block, &|q| body.along(q)) * scales.block_size
            }
            None => STRIP * shear_modulus(modulus, POISSON_RATIO) / ((1.0 - POISSON_RATIO) * weakening),
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
    /// mu_s l/(E h)` on one block, for a body `P mu_s q/K` with the stiffness K along a wave at least two
    /// blocks long.
    pub fn strain_of_load(&self) -> f64 {
        /// Number of wavelengths, in geometric progression; the longest is a thousand blocks.
        const WAVES: i32 = 40;
        let Some(body) = self.model.body() else {
            return self.groups.epsilon;
        };
        let strain = |k: i32| {
            let q = PI * libm::pow(500.0, -f64::from(k) / f64::from(WAVES));
            self.scales.stress() / self.scales.young_modulus * q / body.along(q)
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

/// `G = E/(2 (1 + nu))`.
fn shear_modulus(young_modulus: f64, poisson: f64) -> f64 {
    young_modulus / (2.0 * (1.0 + poisson))
}

/// Critical size in blocks for this decrease of strength per slip, where the stiffness along a wave increases
/// with its wave number; both in units of E over the block size.
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
