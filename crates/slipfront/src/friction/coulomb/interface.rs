//! Friction of a sheet that is upright on its substrate: x is the direction of slip, y the normal of the
//! interface.

use std::ops::Range;

use super::law_readings::{BlockState, LawReading, Update};
use crate::forces::{part, part_mut};
use crate::friction::needs::Needs;
use crate::surface::Surface;
use crate::vector_field::VectorField;
use slipfront_kernel::Integrator;

/// An interface under the edge of an upright sheet. Friction acts on a block along x alone. Along y the block
/// moves freely, or rests on a foundation with springs that hold it up against its load:
///
/// ```text
/// N_i = max(0, F_n,i - K u_y,i)
/// ```
///
/// The normal force `N_i` replaces `F_n,i` in both thresholds, and the difference `N_i - F_n,i` acts on the
/// block along y: at rest the foundation bears the load, and a block that has risen by `F_n,i/K` has lost
/// contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interface {
    /// Stiffness `K` of the foundation under a block in contact, in units of `E h`; 0 for blocks that move
    /// freely along y under the normal forces of the load.
    pub foundation: f64,
}

impl Interface {
    /// Needs of friction along an interface: thresholds that follow the normal force.
    pub(super) const NEEDS: Needs = Needs {
        varies: true,
        ..Needs::NONE
    };

    /// Change of the normal force on a block that bears `load` at rest and has risen by `rise`:
    ///
    /// ```text
    /// N - F_n = -min(K u_y, F_n)
    /// ```
    ///
    /// ```
    /// let interface = slipfront::Interface { foundation: 0.5 };
    /// // Pressed down, raised, and lifted off.
    /// assert_eq!([-1.0, 1.0, 4.0].map(|rise| interface.reaction(1.0, rise)), [0.5, -0.5, -1.0]);
    /// ```
    #[inline(always)]
    pub fn reaction(&self, load: f64, rise: f64) -> f64 {
        let held = self.foundation * rise;
        -if held < load { held } else { load }
    }

    /// Change of the normal force on block `b` of a surface if the block has risen by `rise`; 0 over a
    /// texture.
    #[inline(always)]
    pub(crate) fn reaction_on(&self, surface: &Surface, b: usize, rise: f64) -> f64 {
        if surface.textured[b] {
            0.0
        } else {
            self.reaction(surface.load(b), rise)
        }
    }

    /// Adds the change of the normal force of some blocks to the other forces on them.
    #[inline(always)]
    pub(crate) fn add_reactions(
        &self,
        surface: &Surface,
        blocks: &Range<usize>,
        displacement: &VectorField,
        force: &mut VectorField,
    ) {
        if self.foundation == 0.0 {
            return;
        }
        let ([_, fy], [_, uy]) = (part_mut(force, blocks), part(displacement, blocks));
        for (k, b) in blocks.clone().enumerate() {
            fy[k] += self.reaction_on(surface, b, uy[k]);
        }
    }

    /// Ratio `N/F_n` of the normal force to the `load` for a block that has risen by `rise`; 1 without load.
    #[inline(always)]
    pub(crate) fn share(&self, load: f64, rise: f64) -> f64 {
        let inverse = if load > 0.0 { 1.0 / load } else { 0.0 };
        1.0 + self.reaction(load, rise) * inverse
    }

    /// Energy of the foundation under a block and of its load, relative to rest: the work against
    /// [`reaction`](Self::reaction).
    ///
    /// ```
    /// let interface = slipfront::Interface { foundation: 0.5 };
    /// // K u^2/2, and behind F_n/K = 2 the load alone.
    /// assert_eq!([1.0, 2.0, 4.0].map(|rise| interface.energy(1.0, rise)), [0.25, 1.0, 3.0]);
    /// ```
    pub fn energy(&self, load: f64, rise: f64) -> f64 {
        let held = -self.reaction(load, rise);
        if self.foundation > 0.0 {
            held * (rise - 0.5 * held / self.foundation)
        } else {
            0.0
        }
    }
}

/// The interface under the blocks of a band of the general kernel.
#[derive(Debug)]
pub(super) struct InterfaceContact {
    interface: Interface,
    /// Velocities of slip: along x, with zeros along y.
    slip_velocity: VectorField,
    /// Static and kinetic thresholds at the present normal forces.
    limits: [Vec<f64>; 2],
}

impl InterfaceContact {
    pub(super) fn new(interface: Interface, n_blocks: usize) -> Self {
        Self {
            interface,
            slip_velocity: VectorField::zeros(n_blocks),
            limits: [vec![0.0; n_blocks], vec![0.0; n_blocks]],
        }
    }

    /// The velocities of some blocks along the interface.
    #[inline(always)]
    pub(super) fn slip_velocity(&mut self, blocks: &Range<usize>, velocity: &VectorField) -> &VectorField {
        let x = &velocity.x[blocks.clone()];
        self.slip_velocity.x[blocks.clone()].copy_from_slice(x);
        &self.slip_velocity
    }

    /// Thresholds of some blocks at their present normal forces, from the thresholds under their loads.
    #[inline(always)]
    pub(super) fn under_normal_force<'a>(
        &'a mut self,
        surface: &Surface,
        blocks: &Range<usize>,
        displacement: &VectorField,
        under_load: [&'a [f64]; 2],
    ) -> [&'a [f64]; 2] {
        if self.interface.foundation == 0.0 {
            return under_load;
        }
        for b in blocks.clone() {
            let share = self.interface.share(surface.load(b), displacement.y[b]);
            for (limit, under_load) in self.limits.iter_mut().zip(under_load) {
                limit[b] = share * under_load[b];
            }
        }
        [&self.limits[0], &self.limits[1]]
    }
}

/// Moreau's time-stepping as in [`Projection`](super::law_readings::Projection), along x alone.
pub(super) struct AlongX;

impl LawReading for AlongX {
    #[inline(always)]
    fn update(&self, block: &BlockState, integrator: &Integrator) -> Update {
        let force = block.force;
        let stays = (block.velocity[0] == 0.0) & (force[0].abs() <= block.static_limit);
        let free = integrator.accelerate(block.velocity, force);
        let removed_fraction = integrator.force_to_velocity * block.kinetic_force / free[0].abs();
        let remaining = 1.0 - removed_fraction;
        let slides = !stays & (remaining > 0.0);
        let pull = removed_fraction * integrator.velocity_to_force;
        Update {
            velocity: [if slides { remaining * free[0] } else { 0.0 }, free[1]],
            friction: [if slides { -pull * free[0] } else { -force[0] }, 0.0],
            slides,
        }
    }
}
