//! Forces and fields that a sweep does not keep, computed again from displacements and velocities with the
//! exact spring law, whichever formula the sweep used: the forces on one block, and one field of all blocks,
//! tile by tile, with the same bits.

use fearless_simd::Level;
use slipfront_kernel::{Band, LANES, Layout, Step, Stress, StressReader, TILE};

use crate::kernel::block::{Block, Field};
use crate::kernel::engine::TakeSliding;
use crate::lattice::Bond;
use crate::model::Model;
use crate::vector_field::length;

/// Block `b` at a time of the drive, with its kinetic friction under its load at rest. `motion` returns
/// displacement and velocity of a block.
pub(super) fn block(
    model: &Model,
    drive_time_star: f64,
    b: usize,
    mut kinetic_force: f64,
    motion: impl Fn(usize) -> [[f64; 2]; 2],
) -> Block {
    let [displacement, velocity] = motion(b);
    let (drive_spring, load) = (model.slider.drive_spring(b), model.dead_load_of(b));
    let spring = model.drive.force(displacement, drive_time_star);
    let mut force_drive = [0, 1].map(|axis| drive_spring * spring[axis] + load[axis]);
    let force_lattice = lattice_force(model, b, displacement, |b| motion(b)[0]);
    let (interface, mut slip_velocity) = (model.friction.interface(), velocity);
    if let Some(interface) = &interface {
        slip_velocity[1] = 0.0;
        kinetic_force *= interface.share(model.surface.load(b), displacement[1]);
        force_drive[1] += interface.reaction_on(&model.surface, b, displacement[1]);
    }
    let mut force_friction = friction(kinetic_force, slip_velocity, force_drive, force_lattice);
    if interface.is_some() {
        force_friction[1] = 0.0;
    }
    Block {
        displacement,
        velocity,
        force_drive,
        force_lattice,
        force_friction,
        slides: slip_velocity != [0.0, 0.0],
    }
}

/// Eq. 3 for one block, with springs summed in the order of the sweep.
fn lattice_force(model: &Model, b: usize, u: [f64; 2], displacement: impl Fn(usize) -> [f64; 2]) -> [f64; 2] {
    let (i, j) = model.lattice.column_row(b);
    let pair = |bond: &Bond| {
        let [di, dj] = bond.offset;
        let force =
            |from: [f64; 2], to: [f64; 2]| bond.force([to[0] - from[0], to[1] - from[1]], model.epsilon);
        let neighbour = |offset| {
            let other = model.lattice.neighbour(i, j, offset)?;
            let slider = &model.slider;
            let moduli = [slider.modulus(b), slider.modulus(other)];
            let factor = slider.spring(&model.lattice, [i, j], offset, moduli);
            Some((displacement(other), factor))
        };
        let ahead = neighbour([di, dj]).map_or([0.0; 2], |(v, factor)| force(u, v).map(|f| factor * f));
        let behind = neighbour([-di, -dj]).map_or([0.0; 2], |(v, factor)| force(v, u).map(|f| factor * f));
        [ahead[0] - behind[0], ahead[1] - behind[1]]
    };
    let [e, n, ne, nw] = Bond::ALL.each_ref().map(pair);
    [(e[0] + n[0]) + (ne[0] + nw[0]), (e[1] + n[1]) + (ne[1] + nw[1])]
}

/// Friction `F_f` of the projection law: kinetic friction against the velocity after the update; for a stuck
/// block minus the sum of the other forces.
fn friction(kinetic_force: f64, velocity: [f64; 2], drive: [f64; 2], lattice: [f64; 2]) -> [f64; 2] {
    if velocity == [0.0, 0.0] {
        return [-(drive[0] + lattice[0]), -(drive[1] + lattice[1])];
    }
    // The velocity after the step has the same direction as the velocity without friction, along which
    // friction acts.
    let per_velocity = kinetic_force / length(velocity);
    [-per_velocity * velocity[0], -per_velocity * velocity[1]]
}

/// Reads `field` in every `stride`-th row, several blocks of a row at a time: `write` receives the row, the
/// column of the first value, and the values.
pub(super) fn read_rows(
    model: &Model,
    (level, step): (Level, Step),
    (field, stride): (Field, usize),
    (layout, bands): (&Layout, &[Band]),
    write: &mut dyn FnMut(usize, usize, &[f32]),
) {
    let mut values = [0.0; TILE];
    for band in bands {
        let stress = match field {
            Field::ContactStress => Some(Stress::Contact),
            Field::Traction => Some(Stress::Traction),
            _ => None,
        };
        let mut stresses = stress.map(|stress| StressReader::new(level, band, stress, step, model.epsilon));
        for t in 0..band.tiles.len() {
            let elements = band.elements(t);
            let rows = || layout.rows_among(band.first + elements.start..band.first + elements.end);
            if !rows().any(|(j, ..)| layout.lattice_row(j).is_multiple_of(stride)) {
                continue;
            }
            let displaced = band.halo + elements.start..band.halo + elements.end;
            if let Some(stresses) = &mut stresses {
                let mut forces = [[0.0; LANES]; TILE / LANES];
                if band.tiles[t].moving {
                    for (j, i, blocks) in rows() {
                        let first = elements.start + blocks.start;
                        let kinetic = &mut forces.as_flattened_mut()[blocks];
                        model
                            .surface
                            .read_kinetic_forces(model.lattice.block(i, j), kinetic);
                        for (k, force) in (first..).zip(kinetic) {
                            *force = band.kinetic_force(k, *force, step.integrator.velocity_to_force);
                        }
                    }
                }
                stresses.read(t, &mut forces);
                round(&mut values, forces.as_flattened());
            }
            match field {
                Field::ContactStress | Field::Traction => {}
                Field::DisplacementX => round(&mut values, &band.displacement.x[displaced]),
                Field::DisplacementY => round(&mut values, &band.displacement.y[displaced]),
                Field::VelocityX => round(&mut values, &band.velocity.x[elements.clone()]),
                Field::VelocityY => round(&mut values, &band.velocity.y[elements.clone()]),
                Field::Sliding => {
                    for (values, v) in values.chunks_mut(LANES).zip(band.vectors(t)) {
                        let sliding = band.sliding(v);
                        for (lane, value) in values.iter_mut().enumerate() {
                            *value = f32::from(sliding >> lane & 1);
                        }
                    }
                }
            }
            for (j, i, blocks) in rows().filter(|(j, ..)| layout.lattice_row(*j).is_multiple_of(stride)) {
                let values = &mut values[blocks];
                if field == Field::Traction {
                    let textured = &model.surface.textured[model.lattice.block(i, j)..];
                    for (value, &textured) in values.iter_mut().zip(textured) {
                        *value = if textured { f32::NAN } else { *value };
                    }
                }
                write(j, i, values);
            }
        }
    }
}

/// Passes the blocks of moving tiles to `take`, some of a row at a time: the first, whether each slides, and
/// their velocities.
pub(super) fn read_sliding(model: &Model, layout: &Layout, bands: &[Band], take: TakeSliding) {
    let mut slides = [false; TILE];
    for band in bands {
        for t in (0..band.tiles.len()).filter(|t| band.tiles[*t].moving) {
            let elements = band.elements(t);
            let [x, y] = [&band.velocity.x, &band.velocity.y].map(|v| &v[elements.clone()]);
            for (slides, v) in slides.chunks_mut(LANES).zip(band.vectors(t)) {
                let sliding = band.sliding(v);
                for (lane, slides) in slides.iter_mut().enumerate() {
                    *slides = sliding >> lane & 1 == 1;
                }
            }
            for (j, i, blocks) in layout.rows_among(band.first + elements.start..band.first + elements.end) {
                let velocities = [&x[blocks.clone()], &y[blocks.clone()]];
                take(model.lattice.block(i, j), &slides[blocks], velocities);
            }
        }
    }
}

fn round(values: &mut [f32; TILE], exact: &[f64]) {
    for (value, exact) in values.iter_mut().zip(exact) {
        *value = *exact as f32;
    }
}
