//! One field of all blocks, found from displacements and velocities as in `recompute.rs`, with the same bits, but eight blocks
//! at a time and every spring once.
//!
//! The lattice is read in strips of some columns, from row to row. A strip needs little memory, which stays in the cache: the
//! springs from the present row and from the row below to the next.

use fearless_simd::{Simd, SimdBase, SimdFloat, f64x8};

use super::blocks::{Step, pull, spring};
use super::springs::SquareRoot;
use super::vector::{LANES, add, bits, is_zero, load_at, scale, select, square, store_at, subtract};
use crate::field::Field;
use crate::lattice::{Bond, Edges};
use crate::model::Model;

/// Blocks of a row that are read together.
const READ: usize = 120;

/// Columns for which springs are computed: those that are read, and the neighbours before the first and after the last.
const WIDTH: usize = READ + LANES;

/// x and y of the displacements in these columns and in one more at either end.
type Displacements = [[f64; WIDTH + 2]; 2];

/// x and y of a vector of each block that is read.
type Vectors = [[f64; READ]; 2];

/// Where displacements and velocities of consecutive columns of a row are read from.
pub(super) trait Motion {
    /// Displacements of row `row`, from column `first` on. Rows and columns beyond the lattice are those at its other end where
    /// an axis is periodic; beyond free edges they may be anything.
    fn displacements(&self, row: isize, first: isize, into: [&mut [f64]; 2]);
    /// Velocities of row `row`, from column `first` on.
    fn velocities(&self, row: usize, first: usize, into: [&mut [f64]; 2]);
}

/// Values of `field` in every `stride`-th row, several blocks of a row at a time: `write` is given the row, the column of the
/// first value, and the values.
#[inline(always)]
pub(super) fn read_rows<S: Simd>(
    simd: S,
    model: &Model,
    step: Step,
    field: Field,
    stride: usize,
    motion: &impl Motion,
    write: &mut impl FnMut(usize, usize, &[f32]),
) {
    for first in (0..model.lattice.nx).step_by(READ) {
        let strip = Strip {
            simd,
            model,
            step,
            first,
            n: READ.min(model.lattice.nx - first),
            stride,
            motion,
        };
        match field {
            Field::ContactStress | Field::Traction => strip.stresses(field, write),
            Field::DisplacementX => strip.displacements(0, write),
            Field::DisplacementY => strip.displacements(1, write),
            Field::VelocityX => strip.velocities(|[x, _]| x, write),
            Field::VelocityY => strip.velocities(|[_, y]| y, write),
            Field::Sliding => strip.velocities(|v| f64::from(u8::from(v != [0.0, 0.0])), write),
        }
    }
}

/// The columns `first..first + n` of the lattice.
struct Strip<'a, S, M> {
    simd: S,
    model: &'a Model,
    step: Step,
    first: usize,
    n: usize,
    stride: usize,
    motion: &'a M,
}

/// Forces of the springs from a row to the next, x and y: to the north, north-east and north-west of each column.
type Upward = [[[f64; WIDTH]; 2]; 3];

/// Which columns have a neighbour to the east, and to the west, one bit each.
type Present = [[u8; WIDTH / LANES]; 2];

impl<S: Simd, M: Motion> Strip<'_, S, M> {
    /// The rows that are read.
    fn rows(&self) -> impl Iterator<Item = usize> + use<S, M> {
        (0..self.model.lattice.ny).step_by(self.stride)
    }

    /// Displacements along one axis.
    #[inline(always)]
    fn displacements(&self, axis: usize, write: &mut impl FnMut(usize, usize, &[f32])) {
        let mut read = [[0.0; WIDTH + 2]; 2];
        let mut values = [0.0; READ];
        for j in self.rows() {
            self.motion
                .displacements(j as isize, self.first as isize, first_n(&mut read, self.n));
            for (value, u) in values.iter_mut().zip(&read[axis]) {
                *value = *u as f32;
            }
            write(j, self.first, &values[..self.n]);
        }
    }

    /// A quantity that depends on the velocity alone.
    #[inline(always)]
    fn velocities(&self, quantity: impl Fn([f64; 2]) -> f64, write: &mut impl FnMut(usize, usize, &[f32])) {
        let mut read = [[0.0; READ]; 2];
        let mut values = [0.0; READ];
        for j in self.rows() {
            self.motion.velocities(j, self.first, first_n(&mut read, self.n));
            let [x, y] = &read;
            for ((value, x), y) in values.iter_mut().zip(x).zip(y) {
                *value = quantity([*x, *y]) as f32;
            }
            write(j, self.first, &values[..self.n]);
        }
    }

    /// Contact stress or traction.
    #[inline(always)]
    fn stresses(&self, field: Field, write: &mut impl FnMut(usize, usize, &[f32])) {
        let present = self.present();
        let mut displacements = [[[0.0; WIDTH + 2]; 2]; 2];
        let mut springs = [[[[0.0; WIDTH]; 2]; 3]; 2];
        let mut window = Window {
            displacements: displacements.each_mut(),
            springs: springs.each_mut(),
        };
        let mut lattice = [[0.0; READ]; 2];
        let mut velocities = [[0.0; READ]; 2];
        let mut values = [0.0; READ];
        let mut before = None;
        for j in self.rows() {
            let row = j as isize;
            if before != Some(row - 1) {
                self.read_displacements(row - 1, window.displacements[1]);
                self.advance_to(row - 1, &present, &mut window);
            }
            self.advance_to(row, &present, &mut window);
            before = Some(row);
            self.lattice_forces(&present, &window, &mut lattice);
            self.motion
                .velocities(j, self.first, first_n(&mut velocities, self.n));
            let friction = self.friction(j, window.displacements[0], &lattice, &velocities);
            self.magnitudes(field, j, &friction, &lattice, &mut values);
            write(j, self.first, &values[..self.n]);
        }
    }

    /// Displacements of a row from two columns before the first block that is read to two after the last: springs are computed
    /// from one column before and after, and lead to one more.
    #[inline(always)]
    fn read_displacements(&self, row: isize, into: &mut Displacements) {
        self.motion
            .displacements(row, self.first as isize - 2, first_n(into, self.n + 4));
    }

    fn present(&self) -> Present {
        let nx = self.model.lattice.nx as isize;
        let periodic = self.model.lattice.edges[0] == Edges::Periodic;
        let mut present = [[0; WIDTH / LANES]; 2];
        for c in 0..WIDTH {
            let column = self.first as isize - 1 + c as isize;
            let east = periodic || (0..nx - 1).contains(&column);
            let west = periodic || (1..nx).contains(&column);
            present[0][c / LANES] |= u8::from(east) << (c % LANES);
            present[1][c / LANES] |= u8::from(west) << (c % LANES);
        }
        present
    }

    /// Number of columns for which springs are computed, in whole vectors.
    fn width(&self) -> usize {
        (self.n + 2).next_multiple_of(LANES)
    }

    /// Moves the window on to `row`, the one after its present row.
    #[inline(always)]
    fn advance_to(&self, row: isize, present: &Present, window: &mut Window) {
        window.displacements.swap(0, 1);
        window.springs.swap(0, 1);
        let [here, north] = &mut window.displacements;
        self.read_displacements(row + 1, north);
        let lattice = &self.model.lattice;
        let joined = lattice.edges[1] == Edges::Periodic || (0..lattice.ny as isize - 1).contains(&row);
        for (k, bond) in [Bond::NORTH, Bond::NORTH_EAST, Bond::NORTH_WEST]
            .iter()
            .enumerate()
        {
            let forces = &mut window.springs[1][k];
            for c in (0..self.width()).step_by(LANES) {
                let missing = match bond.offset[0] {
                    0 => u8::MAX,
                    1 => present[0][c / LANES],
                    _ => present[1][c / LANES],
                };
                let mask = if joined { missing } else { 0 };
                let there = load_at(self.simd, north, (c + 1).wrapping_add_signed(bond.offset[0]));
                let force = spring(
                    self.simd,
                    self.geometry(),
                    bond,
                    mask,
                    load_at(self.simd, here, c + 1),
                    there,
                );
                store_at(force, forces, c);
            }
        }
    }

    fn geometry(&self) -> SquareRoot {
        SquareRoot {
            epsilon: self.model.epsilon,
        }
    }

    /// Eq. 3, with the springs summed in the order of the sweep.
    #[inline(always)]
    fn lattice_forces(&self, present: &Present, window: &Window, forces: &mut Vectors) {
        let simd = self.simd;
        let here = &*window.displacements[0];
        let [[south, south_west, south_east], [north, north_east, north_west]] =
            window.springs.each_ref().map(|springs| springs.each_ref());
        let mut east = [[0.0; WIDTH]; 2];
        for c in (0..self.width()).step_by(LANES) {
            let (u, v) = (load_at(simd, here, c + 1), load_at(simd, here, c + 2));
            let force = spring(simd, self.geometry(), &Bond::EAST, present[0][c / LANES], u, v);
            store_at(force, &mut east, c);
        }
        for k in (0..self.n).step_by(LANES) {
            let c = k + 1;
            let at = |springs: &[[f64; WIDTH]; 2], c: usize| load_at(simd, springs, c);
            let force = add(
                add(
                    subtract(at(&east, c), at(&east, c - 1)),
                    subtract(at(north, c), at(south, c)),
                ),
                add(
                    subtract(at(north_east, c), at(south_west, c - 1)),
                    subtract(at(north_west, c), at(south_east, c + 1)),
                ),
            );
            store_at(force, forces, k);
        }
    }

    /// Friction (Eq. 4, projection law): against the velocity of a sliding block; for a stuck one minus the sum of the other
    /// forces.
    #[inline(always)]
    fn friction(
        &self,
        row: usize,
        displacements: &Displacements,
        lattice: &Vectors,
        velocities: &Vectors,
    ) -> Vectors {
        let simd = self.simd;
        let mut friction = [[0.0; READ]; 2];
        let mut kinetic = [0.0; READ];
        // Without an early exit, so that the loop is vectorised.
        let slides = velocities
            .as_flattened()
            .iter()
            .fold(false, |slides, &v| slides | (v != 0.0));
        if slides {
            let first = self.model.lattice.block(self.first, row);
            self.model
                .surface
                .read_kinetic_forces(first, &mut kinetic[..self.n]);
        }
        for k in (0..self.n).step_by(LANES) {
            let velocity = load_at(simd, velocities, k);
            let stuck = is_zero(simd, velocity);
            let drive = pull(simd, self.step, load_at(simd, displacements, k + 2));
            let [x, y] = add(drive, load_at(simd, lattice, k));
            let mut force = [-x, -y];
            if bits(stuck) != u8::MAX {
                let kinetic = f64x8::from_slice(simd, &kinetic[k..k + LANES]);
                let per_velocity = kinetic / square(velocity).sqrt();
                force = select(stuck, force, scale(-per_velocity, velocity));
            }
            store_at(force, &mut friction, k);
        }
        friction
    }

    /// Contact stress `|F_f + F_c|` (Eq. 10) or traction `|F_f|`, which a textured block has none of.
    #[inline(always)]
    fn magnitudes(
        &self,
        field: Field,
        row: usize,
        friction: &Vectors,
        lattice: &Vectors,
        values: &mut [f32; READ],
    ) {
        let mut lengths = [0.0; READ];
        for k in (0..self.n).step_by(LANES) {
            let mut force = load_at(self.simd, friction, k);
            if field == Field::ContactStress {
                force = add(force, load_at(self.simd, lattice, k));
            }
            square(force).sqrt().store_slice(&mut lengths[k..k + LANES]);
        }
        for (value, length) in values.iter_mut().zip(lengths) {
            *value = length as f32;
        }
        if field == Field::Traction {
            let first = self.model.lattice.block(self.first, row);
            let textured = &self.model.surface.textured[first..first + self.n];
            for (value, &textured) in values.iter_mut().zip(textured) {
                *value = if textured { f32::NAN } else { *value };
            }
        }
    }
}

/// The first `n` of both components.
fn first_n<const N: usize>([x, y]: &mut [[f64; N]; 2], n: usize) -> [&mut [f64]; 2] {
    [&mut x[..n], &mut y[..n]]
}

/// What is kept of a strip from one row to the next.
struct Window<'a> {
    /// Displacements of the present row and of the next.
    displacements: [&'a mut Displacements; 2],
    /// Springs from the row below to the present one, and from this to the next.
    springs: [&'a mut Upward; 2],
}
