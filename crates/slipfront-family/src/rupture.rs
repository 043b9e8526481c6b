//! Speed of a rupture along the edge of an upright sheet, and along a line across a sheet.

use std::f64::consts::{PI, SQRT_2};

use rayon::prelude::*;
use slipfront::communicator::Alone;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Coulomb, DeadLoad, Drive, Friction, Interface, Lattice, Model, Slider, Surface};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::falling_strength;
use crate::runs::Experiment;

/// Speed of shear waves in units of `sqrt(E/rho)`, squared.
pub(crate) const C_S_SQUARE: f64 = 3.0 / 8.0;
/// Speed of Rayleigh waves over that of shear waves.
const C_R: f64 = 0.9194;
const KINETIC: f64 = 0.5;
pub(crate) const STEP: f64 = 0.25;

/// Position of the contacts of a rupture.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Place {
    /// Lower edge of an upright sheet, along which friction acts.
    Edge,
    /// Line across the middle of a sheet that lies on its substrate; all other blocks are textured.
    Line,
}

/// A rupture along a row of contacts, from a weak patch in its middle.
pub(crate) struct Rupture {
    pub(crate) place: Place,
    /// Blocks along x and y.
    pub(crate) blocks: [usize; 2],
    /// Fall of strength per slip, `W`.
    pub(crate) weakening: f64,
    /// Strength excess over stress drop, the seismic parameter `S = (S - F_0)/(F_0 - K)`.
    pub(crate) strength_excess: f64,
}

impl Rupture {
    /// Row of the contacts.
    fn row(&self) -> usize {
        match self.place {
            Place::Edge => 0,
            Place::Line => self.blocks[1] / 2,
        }
    }

    /// Critical length of a shear crack under the prestress, `L_c = mu* (1 + S)^2/(pi W)`, where `mu*` is the
    /// stiffness of the sheet at the contacts, 1.1 or 2.25 (Andrews, 1976).
    pub(crate) fn critical_length(&self) -> f64 {
        let stiffness = match self.place {
            Place::Edge => 1.1,
            Place::Line => 2.25,
        };
        stiffness / self.weakening * (1.0 + self.strength_excess).powi(2) / PI
    }

    /// Half length of the weak patch.
    pub(crate) fn half_patch(&self) -> f64 {
        1.3 * self.critical_length()
    }

    /// The sheet at rest under its prestress.
    pub(crate) fn experiment(&self) -> Result<Experiment, FamilyError> {
        let [nx, ny] = self.blocks;
        let lattice = Lattice::free(nx, ny);
        let n = lattice.n_blocks();
        let shear = (1.0 + self.strength_excess * KINETIC) / (1.0 + self.strength_excess);
        let is_in_contact = |b: usize| b / nx == self.row();
        let is_weak = |b: usize| ((b % nx) as f64 - (nx / 2) as f64).abs() <= self.half_patch();
        let static_of = |b: usize| if is_weak(b) { shear - 0.004 } else { 1.0 };
        let coefficients = Coefficients::given((0..n).map(static_of).collect(), vec![KINETIC; n]);
        let slider = Slider::default();
        let (faces, textured, interface) = match self.place {
            Place::Edge => (
                Some((0..n).map(is_in_contact).collect()),
                vec![false; n],
                Some(Interface { foundation: 0.0 }),
            ),
            Place::Line => (None, (0..n).map(|b| !is_in_contact(b)).collect(), None),
        };
        let contact = Contact {
            faces,
            ..Contact::new(Load::Kept, 1.0)
        };
        let surface = Surface::of_ranks(coefficients, textured, contact, &slider, &Alone)?;
        let law = Friction::Coulomb(Coulomb {
            interface,
            ..falling_strength((1.0 - KINETIC) / self.weakening)
        });
        // The prestress drives the rupture; the force of the springs is negligible.
        let drive = Drive {
            k_drive: 1e-9,
            ..Drive::along_x(1e-6)
        };
        let on_contacts = (0..n).map(|b| f64::from(u8::from(is_in_contact(b)))).collect();
        let load = DeadLoad::of_blocks([shear, 0.0], on_contacts, &slider, &Alone);
        let model = Model::new(lattice, surface, drive, 0.0, 0.0, law).with_dead_load(load);
        Ok(Experiment::at_rest(model, STEP))
    }

    /// Distances from the middle in blocks, and the speed of the front over that of shear waves, averaged
    /// over the 25 blocks from there on.
    fn speeds(&self, duration: f64) -> Result<Vec<[f64; 2]>, FamilyError> {
        let mut simulation = self.experiment()?.begin();
        for _ in 0..(duration / STEP) as u64 {
            simulation.step();
        }
        let first = simulation.snapshot().first_slip_time_star();
        let nx = self.blocks[0];
        let (middle, from) = (self.row() * nx + nx / 2, self.half_patch() as usize + 5);
        let speeds = (from..nx / 2 - 20).step_by(25).map(|at| {
            let [begin, end] = [first[middle + at], first[middle + at + 24]];
            [at as f64, 24.0 / (end - begin) / C_S_SQUARE.sqrt()]
        });
        Ok(speeds.filter(|[_, speed]| speed.is_finite()).collect())
    }
}

/// Values of S, and speeds of ruptures along an edge from an independent NumPy program.
const NUMPY: [(f64, &[f64]); 3] = [
    (2.0, &[0.682, 0.825, 0.852, 0.866]),
    (1.4, &[0.757, 0.852, 0.871, 0.881]),
    (0.9, &[0.968, 1.340, 1.507, 1.552, 1.584, 1.616]),
];
/// Values of S, and speeds of ruptures along a line from the same NumPy program.
const NUMPY_LINE: [(f64, &[f64]); 2] = [
    (0.9, &[0.881, 1.234, 1.340, 1.412, 1.479, 1.537, 1.568]),
    (2.0, &[0.661, 0.992, 1.066, 1.089]),
];

/// Values of S of the picture.
const EXCESSES: [f64; 6] = [0.5, 0.9, 1.2, 1.4, 1.77, 2.0];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let at = |place: Place, strength_excess: f64| Rupture {
        place,
        blocks: [600, 160],
        weakening: 0.2,
        strength_excess,
    };
    let critical_length = |excess: f64| at(Place::Edge, excess).critical_length();
    // Until waves return from the upper edge.
    let speeds_of = |place: Place, excesses: Vec<f64>| {
        let runs = excesses
            .into_par_iter()
            .map(|excess| at(place, excess).speeds(300.0));
        runs.collect::<Result<Vec<_>, _>>()
    };
    let (along_edges, along_lines) = rayon::join(
        || speeds_of(Place::Edge, EXCESSES.to_vec()),
        || speeds_of(Place::Line, NUMPY_LINE.map(|(excess, _)| excess).to_vec()),
    );
    let (along_edges, along_lines) = (along_edges?, along_lines?);
    let of = |excess: f64| {
        let at = EXCESSES.iter().position(|&other| other == excess);
        at.map_or(&[][..], |at| &along_edges[at])
    };
    let edges = NUMPY.map(|(excess, speeds)| ("", excess, speeds, of(excess)));
    let lines = NUMPY_LINE.into_iter().zip(&along_lines);
    let lines = lines.map(|((excess, speeds), found)| ("line, ", excess, speeds, &found[..]));
    for (place, excess, speeds, found) in edges.into_iter().chain(lines) {
        for (&reference, &[distance, speed]) in speeds.iter().zip(found) {
            chapter.add(
                format!("{place}S = {excess}: v/c_S at {distance} blocks, reference: NumPy"),
                [reference, speed],
                2.0 * STEP / 24.0 * C_S_SQUARE.sqrt() * reference * reference,
                "slip times at both ends of the 25 blocks are whole steps",
            );
        }
    }
    for excess in [1.4, 2.0] {
        let speeds = of(excess).iter();
        let beyond = speeds.filter(|[distance, _]| *distance >= critical_length(excess));
        let fastest = beyond.map(|[_, speed]| *speed).fold(0.0, f64::max);
        let bound = chapter.add(
            format!("S = {excess}: largest v/c_S, at most c_R/c_S"),
            [C_R, fastest],
            0.01 * C_R,
            "1 % for dispersion with six blocks in the cohesive zone; any lower speed passes",
        );
        bound.tolerance_below = f64::INFINITY;
    }
    let mut late = of(0.9)
        .iter()
        .filter(|[distance, _]| *distance >= 8.0 * critical_length(0.9));
    let bound = chapter.add(
        "S = 0.9: v/c_S at 8 L_c, at least √2",
        [SQRT_2, late.next().map_or(f64::NAN, |[_, speed]| *speed)],
        f64::INFINITY,
        "any speed above √2 c_S passes",
    );
    bound.tolerance_below = 0.0;
    let curves = EXCESSES.iter().zip(&along_edges).map(|(&excess, speeds)| {
        let length = critical_length(excess);
        let distances: Vec<f64> = speeds.iter().map(|[distance, _]| distance / length).collect();
        let speeds: Vec<f64> = speeds.iter().map(|[_, speed]| *speed).collect();
        Response {
            line: true,
            ..Response::of_values(&format!("S = {excess}"), &distances, &speeds)
        }
    });
    chapter.draw(
        "Front speed relative to shear waves against distance over L_c. No front runs steadily between c_R = 0.919 and 1: a front stays below \
         this range or jumps across it.",
        ["distance/L_c", "front speed v/c_S"],
        curves.collect(),
    );
    Ok(())
}
