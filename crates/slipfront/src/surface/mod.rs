//! The sliding surface: local friction coefficients, texture and load of every block.
//!
//! [`Coefficients`] are drawn by block or from a [`CorrelatedField`], or given; [`mesh`] finds the textured
//! blocks, and the [`Load`] is distributed over the blocks in contact. [`Surface::new`] computes the friction
//! thresholds of all blocks from these three, and [`Surface::of_ranks`] does so for the blocks that a rank
//! holds.

mod clearance;
mod clip;
mod coefficients;
mod contour;
mod correlation;
mod drawing;
mod load;
mod load_sharing;
mod mask_outline;
mod mesh;
mod outline;
mod outline_distance;
mod pattern;
mod texture;
mod whole_surface;

pub use clearance::{Clearance, clearance};
pub use clip::clip;
pub use coefficients::{Coefficients, Distribution, STREAMS};
pub use contour::{Contour, Ellipse, Piece, contours};
pub use correlation::{CorrelatedField, deviation_along};
pub use drawing::{FillRule, Part};
pub use load::{Adhesion, Contact, Load, pressure_along};
pub use load_sharing::share_load;
pub use mask_outline::outline as mask_outline;
pub use mesh::{Meshed, copies_overlap, mesh, mesh_watched};
pub use pattern::{Array, n_copies};
pub use texture::{Cavity, Groove, Orientation, Shape, Texture, Tile, cavity_lambda, cavity_percent};

use std::ops::Range;

use self::coefficients::PART;
use self::whole_surface::Whole;
use crate::communicator::{Alone, Communicator};
use crate::error::SurfaceError;
use crate::lattice::Lattice;
use crate::parallel::*;
use crate::slider::Slider;

/// Friction of every block; arrays have one value per block that this process holds.
///
/// The results of its methods on the whole surface belong to the arrays at the time of its creation.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Whether a block has no contact with the substrate: it lies over a texture, or does not exist.
    pub textured: Vec<bool>,
    /// Local static coefficients `mu_si`; 0 over a texture.
    pub mu_static: Vec<f64>,
    /// Local kinetic coefficients `mu_ki`; 0 over a texture.
    pub mu_kinetic: Vec<f64>,
    contact: Contact,
    whole: Whole,
    /// Ratio of the normal force on a block in contact to `p_i l^2`.
    load_factor: f64,
    largest_load: f64,
    min_slip_threshold: f64,
}

impl Surface {
    /// A surface on which the coefficients of textured blocks, and negative coefficients, are set to 0 and
    /// the load, at first equal on all blocks, is distributed.
    ///
    /// `mu_static_mean` is the scale of all forces. Fails when no block is left in contact.
    pub fn new(
        coefficients: Coefficients,
        textured: Vec<bool>,
        load: Load,
        mu_static_mean: f64,
    ) -> Result<Self, SurfaceError> {
        let contact = Contact::new(load, mu_static_mean);
        Self::of_ranks(coefficients, textured, contact, &Slider::default(), &Alone)
    }

    /// The surface under the blocks of `slider` that this rank holds. All `ranks` of a lattice must call this
    /// together. Values for the whole surface have the same bits on all ranks, for any number of ranks. Fails
    /// when no block is left in contact.
    ///
    /// # Panics
    /// Unless coefficients, texture and pressures have the same number of blocks.
    pub fn of_ranks(
        mut coefficients: Coefficients,
        mut textured: Vec<bool>,
        contact: Contact,
        slider: &Slider,
        ranks: &dyn Communicator,
    ) -> Result<Self, SurfaceError> {
        let n = textured.len();
        assert_eq!(
            [
                coefficients.mu_static.len(),
                contact.pressure.as_ref().map_or(n, Vec::len)
            ],
            [n; 2],
            "coefficients, pressures and texture belong to different lattices"
        );
        if let Some(outline) = &slider.outline {
            for (textured, exists) in textured.iter_mut().zip(&outline.exists) {
                *textured |= !exists;
            }
        }
        for (textured, faces) in textured.iter_mut().zip(contact.faces.iter().flatten()) {
            *textured |= !faces;
        }
        let negative_draws = coefficients.restrict(&textured);
        let exists = slider.outline.as_ref().map(|outline| &outline.exists[..]);
        let whole = Whole::find(
            &coefficients,
            negative_draws,
            &textured,
            contact.pressure.as_deref(),
            [exists, contact.faces.as_deref()],
            ranks,
        );
        if whole.sum_pressure[1] <= 0.0 {
            let n_blocks = whole.n_blocks;
            return Err(SurfaceError::NoContact { n_blocks });
        }
        let mut surface = Self {
            textured,
            mu_static: coefficients.mu_static,
            mu_kinetic: coefficients.mu_kinetic,
            load_factor: contact.load.factor(whole.sum_pressure),
            contact,
            whole,
            largest_load: f64::NAN,
            min_slip_threshold: f64::NAN,
        };
        let blocks = (0..n).into_par_iter().with_min_len(PART);
        let in_contact = blocks.filter(|&b| !surface.textured[b]);
        let thresholds = in_contact
            .clone()
            .map(|b| surface.static_limit(b).max(surface.kinetic_force(b)) / slider.drive_spring(b));
        let loads = in_contact.map(|b| surface.normal_force(b));
        let mut largest = [
            -reduce(thresholds, || f64::INFINITY, f64::min),
            reduce(loads, || 0.0, f64::max),
        ];
        ranks.largest(&mut largest);
        surface.min_slip_threshold = -largest[0];
        surface.largest_load = largest[1];
        Ok(surface)
    }

    /// The surface under some of the blocks. Values for the whole surface stay the same.
    pub(crate) fn of_some_blocks(&self, blocks: &Range<usize>) -> Self {
        let part = |values: &[f64]| values[blocks.clone()].to_vec();
        let marks = |marks: &[bool]| marks[blocks.clone()].to_vec();
        Self {
            textured: marks(&self.textured),
            mu_static: part(&self.mu_static),
            mu_kinetic: part(&self.mu_kinetic),
            contact: Contact {
                pressure: self.contact.pressure.as_deref().map(part),
                faces: self.contact.faces.as_deref().map(marks),
                ..self.contact
            },
            ..*self
        }
    }

    /// Equal coefficients for all blocks and no texture. Coefficients are in units of their static mean, so
    /// that `mu_static` is 1 in the model of the paper.
    pub fn uniform(lattice: &Lattice, mu_static: f64, mu_kinetic: f64) -> Self {
        let n = lattice.n_blocks();
        let coefficients = Coefficients::given(vec![mu_static; n], vec![mu_kinetic; n]);
        let made = Self::new(coefficients, vec![false; n], Load::Redistributed, 1.0);
        made.expect("a lattice has a block, and all are in contact")
    }

    /// Normal force `F_n,i` on block `b` in units of `P l^2`; 0 over a texture.
    #[inline(always)]
    pub fn normal_force(&self, b: usize) -> f64 {
        if self.textured[b] {
            return 0.0;
        }
        let pressure = self.contact.pressure.as_ref().map_or(1.0, |pressure| pressure[b]);
        self.load_factor * pressure
    }

    /// Normal force `F_n,i` on block `b` in units of `P mu_s l^2`, the unit of other forces; 0 over a
    /// texture.
    pub(crate) fn load(&self, b: usize) -> f64 {
        self.normal_force(b) / self.contact.mu_static_mean
    }

    /// Static threshold `mu_si F_n,i + tau_a l^2` of block `b` in units of `P mu_s l^2`; 0 over a texture.
    #[inline(always)]
    pub fn static_limit(&self, b: usize) -> f64 {
        self.static_limit_with(self.mu_static[b], b)
    }

    /// The static threshold that block `b` would have with another coefficient.
    #[inline(always)]
    pub(crate) fn static_limit_with(&self, coefficient: f64, b: usize) -> f64 {
        self.limit(coefficient, self.contact.adhesion.of_static, b)
    }

    /// Friction that does not depend on the load.
    pub fn adhesion(&self) -> Adhesion {
        self.contact.adhesion
    }

    /// Kinetic friction `mu_ki F_n,i + tau_ak l^2` of block `b` in units of `P mu_s l^2`; 0 over a texture.
    #[inline(always)]
    pub fn kinetic_force(&self, b: usize) -> f64 {
        self.limit(self.mu_kinetic[b], self.contact.adhesion.of_kinetic, b)
    }

    #[inline(always)]
    fn limit(&self, coefficient: f64, adhesion: f64, b: usize) -> f64 {
        let adhesion = if self.textured[b] { 0.0 } else { adhesion };
        coefficient / self.contact.mu_static_mean * self.normal_force(b) + adhesion
    }

    /// Reads [`kinetic_force`](Self::kinetic_force) of the blocks from `first` on.
    #[inline(always)]
    pub(crate) fn read_kinetic_forces(&self, first: usize, forces: &mut [f64]) {
        for (b, force) in (first..).zip(forces) {
            *force = self.kinetic_force(b);
        }
    }

    /// Number of blocks that this process holds.
    pub fn n_blocks(&self) -> usize {
        self.textured.len()
    }

    /// Number of blocks of the whole surface in contact with the substrate.
    pub fn n_contact(&self) -> usize {
        self.whole.n_contact
    }

    /// Number of blocks of the whole surface that face the substrate, textured or not: all that exist, or
    /// those at the lower edge of an upright sheet, see [`Contact::faces`].
    pub fn n_facing(&self) -> usize {
        self.whole.n_blocks
    }

    /// Share of the [facing blocks](Self::n_facing) that are in contact.
    pub fn share_in_contact(&self) -> f64 {
        self.n_contact() as f64 / self.n_facing() as f64
    }

    /// Number of negative draws of coefficients that were set to 0, static and kinetic together, of all
    /// blocks in contact of the whole surface.
    pub fn negative_draws(&self) -> usize {
        self.whole.negative_draws
    }

    /// Textured share of the whole surface as meshed, `A*` in % (Eq. 15).
    pub fn texture_percent(&self) -> f64 {
        let Whole {
            n_blocks, n_contact, ..
        } = self.whole;
        100.0 * (n_blocks - n_contact) as f64 / n_blocks as f64
    }

    /// Mean of `mu_si` over all blocks in contact.
    pub fn mean_static_coefficient(&self) -> f64 {
        self.whole.sum_static / self.whole.n_contact as f64
    }

    /// Mean of `mu_ki` over all blocks in contact.
    pub fn mean_kinetic_coefficient(&self) -> f64 {
        self.whole.sum_kinetic / self.whole.n_contact as f64
    }

    /// Mean of the local pressures over the [facing blocks](Self::n_facing), in units of `P`.
    pub fn mean_pressure(&self) -> f64 {
        self.whole.sum_pressure[0] / self.whole.n_blocks as f64
    }

    /// Mean kinetic friction over the [facing blocks](Self::n_facing), textured ones included:
    /// `mean(mu_ki F_n,i + tau_ak l^2)` in units of `P mu_s l^2`.
    pub fn mean_kinetic_force(&self) -> f64 {
        let whole = &self.whole;
        let sum = whole.sum_kinetic_pressure / self.contact.mu_static_mean * self.load_factor;
        (sum + whole.n_contact as f64 * self.contact.adhesion.of_kinetic) / whole.n_blocks as f64
    }

    /// Mean static threshold over the [facing blocks](Self::n_facing), textured ones included:
    /// `mean(mu_si F_n,i + tau_as l^2)` in units of `P mu_s l^2`.
    pub fn mean_static_force(&self) -> f64 {
        let whole = &self.whole;
        let sum = whole.sum_static_pressure / self.contact.mu_static_mean * self.load_factor;
        (sum + whole.n_contact as f64 * self.contact.adhesion.of_static) / whole.n_blocks as f64
    }

    /// Ratio of the load of a block in contact to its load if all blocks were in contact: `N/N_contact` for a
    /// uniform pressure; 1 if the load of textured blocks is not redistributed.
    pub fn load_factor(&self) -> f64 {
        self.load_factor
    }

    /// Largest normal force on a block of the whole surface, in units of `P l^2`: the [load
    /// factor](Self::load_factor) under a uniform pressure.
    pub fn largest_load(&self) -> f64 {
        self.largest_load
    }

    /// Mean normal force over the [facing blocks](Self::n_facing), textured ones included, in units of
    /// `P l^2`.
    pub fn mean_normal_force(&self) -> f64 {
        self.load_factor * self.whole.sum_pressure[1] / self.whole.n_blocks as f64
    }

    /// The part of [`mean_kinetic_force`](Self::mean_kinetic_force) that is adhesion.
    pub fn mean_kinetic_adhesion(&self) -> f64 {
        self.whole.n_contact as f64 * self.contact.adhesion.of_kinetic / self.whole.n_blocks as f64
    }

    /// The smallest force that makes a block in contact slip: the larger of its static threshold and its
    /// kinetic friction (D12), over the relative stiffness of its drive spring, as a minimum over the whole
    /// surface.
    pub fn min_slip_threshold(&self) -> f64 {
        self.min_slip_threshold
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texture_takes_load_and_friction_and_conserves_the_total() {
        let lattice = Lattice::free(4, 2);
        let mut textured = vec![false; 8];
        textured[3] = true;
        textured[5] = true;
        let given = Coefficients::given(vec![2.0; 8], vec![1.0; 8]);
        let surface = Surface::new(given, textured, Load::Redistributed, 2.0).unwrap();
        assert_eq!(surface.static_limit(0), 8.0 / 6.0);
        assert_eq!(
            (
                surface.static_limit(3),
                surface.kinetic_force(5),
                surface.mu_static[3]
            ),
            (0.0, 0.0, 0.0)
        );
        let load: f64 = (0..8).map(|b| surface.normal_force(b)).sum();
        assert!((load - lattice.n_blocks() as f64).abs() < 1e-12);
        assert_eq!(surface.texture_percent(), 25.0);
    }
}
