//! Friction along x alone, for an upright sheet with blocks that move freely along y or rest on a foundation.

use std::ops::Range;

use fearless_simd::{Select, Simd, SimdBase, f64x8, i64x8};

use super::aligned::Aligned;
use super::blocks::{FrictionLoop, Moved, Shifts, Sums, mark_first_slips, zero_missing};
use super::layout::{Layout, TILE};
use super::pull::pull_of_differing;
use super::quanta::Quanta;
use super::step::Step;
use super::vector::{Chunks, add, bits, is_zero, load, load_vec2, or_zero_below, scale, splat};
use crate::integrator::SMALLEST_VELOCITY;
use crate::properties::Properties;

/// The interface under the elements of a band.
#[derive(Debug)]
pub(crate) struct Interface {
    /// Stiffness of the foundation under each element; 0 where there is no block in contact.
    foundation: Aligned,
    /// Normal forces `F_n` of the load.
    load: Aligned,
    /// `1/F_n`, or 0 without load.
    inverse_load: Aligned,
    /// Velocities along y as seen by friction: zeros.
    still: Aligned,
}

/// Numbers of the interface under some elements, in vectors of eight.
#[derive(Clone, Copy)]
pub(crate) struct InterfaceLoop<'a> {
    foundation: Chunks<'a>,
    load: Chunks<'a>,
    inverse_load: Chunks<'a>,
}

impl Interface {
    /// The interface under `n` elements from `first` on; none where friction acts in the plane.
    pub(crate) fn new(layout: &Layout, properties: &Properties, first: usize, n: usize) -> Option<Self> {
        let foundation = properties.foundation?;
        let zeros = |n| Aligned::filled(n, 0.0);
        let mut interface = Self {
            foundation: zeros(n),
            load: zeros(n),
            inverse_load: zeros(n),
            still: zeros(TILE),
        };
        for k in 0..n {
            let block = layout.block(first + k).map(|b| properties.blocks.block(b));
            let Some(block) = block.filter(|block| !block.is_textured) else {
                continue;
            };
            let load = block.normal_force;
            interface.foundation[k] = foundation;
            interface.load[k] = load;
            interface.inverse_load[k] = if load > 0.0 { 1.0 / load } else { 0.0 };
        }
        Some(interface)
    }

    /// The interface under some elements of the band.
    pub(crate) fn of_elements(&self, elements: Range<usize>) -> InterfaceLoop<'_> {
        InterfaceLoop {
            foundation: self.foundation[elements.clone()].as_chunks().0,
            load: self.load[elements.clone()].as_chunks().0,
            inverse_load: self.inverse_load[elements].as_chunks().0,
        }
    }

    /// Zeros in place of the velocities along y of `n` elements of a tile.
    pub(crate) fn still(&self, n: usize) -> Chunks<'_> {
        self.still[..n].as_chunks().0
    }
}

impl InterfaceLoop<'_> {
    /// Change of the normal forces on eight blocks that have risen by `rise`,
    /// `-min(K u_y, F_n)`, and the ratio of the normal forces to those of the load.
    #[inline(always)]
    pub(crate) fn reaction<S: Simd>(&self, simd: S, chunk: usize, rise: f64x8<S>) -> [f64x8<S>; 2] {
        let [foundation, bears, inverse] =
            [self.foundation, self.load, self.inverse_load].map(|array| load(simd, &array[chunk]));
        let held = foundation * rise;
        let reaction = -held.simd_lt(bears).select(held, bears);
        [reaction, splat(simd, 1.0) + reaction * inverse]
    }
}

/// Eqs. 2 and 4-7 along an interface, eight blocks at a time, and all sums that observers need at every step.
/// Returns whether any of the blocks moves.
#[inline(always)]
pub(crate) fn friction_along_x<S: Simd>(
    simd: S,
    step: Step,
    quanta: &Quanta,
    (arrays, interface): (FrictionLoop, InterfaceLoop),
    sums: &mut Sums<i64x8<S>, f64x8<S>>,
) -> bool {
    let (zero, shifts) = (splat(simd, 0.0), Shifts::new(simd, quanta));
    let [vx, vy] = arrays.velocity;
    let has_loads = !arrays.variation.loads.is_empty();
    let mut moves = false;
    for c in 0..vx.len() {
        let (blocks, in_contact) = (arrays.blocks[c], arrays.in_contact[c]);
        let displacement = load_vec2(simd, arrays.displacement, c);
        let lattice = load_vec2(simd, arrays.lattice, c);
        let before = [load(simd, &vx[c]), load(simd, &vy[c])];
        let drive_springs = load(simd, &arrays.variation.drive_springs[c]);
        let loads = has_loads.then(|| load(simd, &arrays.variation.loads[c]));
        let mut drive = pull_of_differing(simd, step, drive_springs, loads, displacement);
        let [reaction, share] = interface.reaction(simd, c, displacement[1]);
        drive[1] += reaction;
        let force = add(drive, lattice);
        let force_to_velocity =
            splat(simd, step.integrator.force_to_velocity) * load(simd, &arrays.variation.inverse_mass[c]);
        let free = add(
            scale(splat(simd, step.integrator.velocity_decay), before),
            scale(force_to_velocity, force),
        );
        let free = or_zero_below(simd, SMALLEST_VELOCITY, free);

        // As in `friction`, but with the x components alone.
        let removed_fraction = share * load(simd, &arrays.kinetic_impulses[c]) / free[0].abs();
        let limit_square = share * share * load(simd, &arrays.static_limit_squares[c]);
        let sticks = before[0].simd_eq(zero) & (force[0] * force[0]).simd_le(limit_square);
        let remaining = splat(simd, 1.0) - removed_fraction;
        let slides = !sticks & remaining.simd_gt(zero);
        let after = [slides.select(remaining * free[0], zero), free[1]];
        let after = zero_missing(simd, blocks, after);
        after[0].store_array(&mut vx[c]);
        after[1].store_array(&mut vy[c]);
        let (sliding, moving) = (bits(simd, slides), !bits(simd, is_zero(simd, after)));
        let slips = sliding & in_contact;
        arrays.moving[c] = moving;
        moves |= moving != 0;
        sums.sliding += sliding.count_ones();
        sums.slipping += slips.count_ones();

        let velocity_to_force =
            splat(simd, step.integrator.velocity_to_force) * load(simd, &arrays.variation.mass[c]);
        let kinetic = removed_fraction * velocity_to_force * free[0];
        let stress = [slides.select(lattice[0] - kinetic, -drive[0]), lattice[1]];
        let moved = Moved {
            blocks,
            displacement,
            before,
            after,
            against: [slides.select(kinetic, force[0]), zero],
            stress: zero_missing(simd, in_contact, stress),
        };
        sums.add_moved::<true, true>(simd, quanta, &shifts, &moved, (arrays.variation, c));
        mark_first_slips(
            slips,
            &mut arrays.slipped[c],
            &mut arrays.first_slip[c],
            step.number as u32,
        );
    }
    moves
}
