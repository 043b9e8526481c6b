//! Nucleation of slip on a line of contacts across the middle of a sheet, under a slowly rising load.

use std::sync::Arc;

use rayon::prelude::*;
use slipfront::communicator::Alone;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{DeadLoad, Drive, Friction, Lattice, Model, Program, Slider, Surface, scales};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::falling_strength;
use crate::runs::Experiment;

const BLOCKS: [usize; 2] = [201, 101];
/// Row of the contacts.
const ROW: usize = 50;
/// Stiffness of the drive springs of the line, in units of `E h`.
const SPRINGS: f64 = 1e-4;
/// Number of blocks on each side of the middle with recorded first slips.
const WATCHED: usize = 30;
/// Numbers of blocks n, and the excess of the load over 1 at which a patch of n blocks grows for W = 0.1,
/// quasi-static on this lattice, from the Schur complement of the stiffness on the line.
const QUASI_STATIC: [(usize, f64); 3] = [(9, 1.56e-3), (17, 3.95e-3), (21, 4.93e-3)];
/// Fall of strength per slip W, excess of the largest quasi-static load over 1, and number of blocks for
/// which the least eigenvalue of the stiffness on the line is W, from the same Schur complement.
const CRITICAL: [[f64; 3]; 4] = [
    [0.07, 1.050e-2, 36.1],
    [0.1, 5.29e-3, 25.5],
    [0.14, 2.758e-3, 18.4],
    [0.2, 1.365e-3, 12.8],
];
/// Time within which the next block follows once slip is unstable.
const RUNAWAY: f64 = 40.0;

/// Excess of the load over 1 and time of the first slip of each block in one half of a line, from the middle
/// on. The strength rises from the middle as `1 + (x/60)^2/2`, and falls by `weakening` per slip, `W`.
/// `largest` is the excess of the largest quasi-static load over 1. The load rises fast to 0.15 of it, slowly
/// to 0.83, and then by 5e-7 per unit of time, or less if the largest load is smaller.
fn loads(weakening: f64, largest: f64) -> Result<Vec<[f64; 2]>, FamilyError> {
    let [nx, ny] = BLOCKS;
    let lattice = Lattice::free(nx, ny);
    let n = lattice.n_blocks();
    let is_line = |b: usize| b / nx == ROW;
    let static_of = |b: usize| 1.0 + 0.5 * ((b % nx) as f64 - (nx / 2) as f64).powi(2) / 3600.0;
    let coefficients = Coefficients::given(
        (0..n).map(static_of).collect(),
        (0..n).map(|b| static_of(b) - 0.5).collect(),
    );
    let mut slider = Slider::default();
    slider.attach(n, is_line, &Alone);
    let textured = (0..n).map(|b| !is_line(b)).collect();
    let contact = Contact::new(Load::Kept, 1.0);
    let surface = Surface::of_ranks(coefficients, textured, contact, &slider, &Alone)?;
    // Speeds of the drive, in units of the load 1e-4, and the times at which they end.
    let slow = 0.005 * (largest / 5.29e-3).min(1.0);
    let start = 1.0 - 1e-3;
    let fast_until = (0.15 * largest + 1e-3) / SPRINGS;
    let medium_until = fast_until + 0.68 * largest / SPRINGS / (10.0 * slow);
    let program = [
        (1.0, fast_until),
        (10.0 * slow, medium_until),
        (slow, f64::INFINITY),
    ];
    let drive = Drive {
        k_drive: SPRINGS,
        program: Some(Arc::new(Program::new(program))),
        ..Drive::along_x(1.0)
    };
    let on_line = (0..n).map(|b| f64::from(u8::from(is_line(b)))).collect();
    let load = DeadLoad::of_blocks([start, 0.0], on_line, &slider, &Alone);
    let law = Friction::Coulomb(falling_strength(0.5 / weakening));
    let model = Model::new(lattice, surface, drive, scales::damping(0.05), 0.0, law);
    let experiment = Experiment::at_rest(model.with_slider(slider).with_dead_load(load), 0.4);
    let mut simulation = experiment.begin();
    let middle = ROW * nx + nx / 2;
    // Far beyond the largest quasi-static load.
    while simulation.time_star() < medium_until + 0.5 * largest / SPRINGS / slow {
        for _ in 0..100 {
            simulation.step();
        }
        if simulation.snapshot().first_slip_time_star()[middle + WATCHED].is_finite() {
            break;
        }
    }
    let first = simulation.snapshot().first_slip_time_star();
    let drive = &experiment.model.drive;
    let slips = (0..=WATCHED).map(|k| first[middle + k]);
    Ok(slips
        .map(|time| [start + SPRINGS * drive.path(time) - 1.0, time])
        .collect())
}

/// Number of slipping blocks and excess of the load over 1 when the next block first follows within 40
/// t*, for patches of at least half the critical size.
fn runaway(loads: &[[f64; 2]], critical: f64) -> [f64; 2] {
    let pairs = loads.windows(2).enumerate();
    let sizes = pairs.map(|(k, pair)| (2 * k + 1, pair[1][1] - pair[0][1], pair[0][0]));
    let mut late = sizes.filter(|(size, ..)| *size as f64 > 0.5 * critical);
    let found = late.find(|(_, until_next, _)| *until_next < RUNAWAY);
    found.map_or([f64::NAN; 2], |(size, _, load)| [size as f64, load])
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let found: Vec<Vec<[f64; 2]>> = CRITICAL
        .par_iter()
        .map(|&[weakening, largest, _]| loads(weakening, largest))
        .collect::<Result<_, _>>()?;
    let mut sizes = Vec::new();
    for (loads, [weakening, largest, critical]) in found.iter().zip(CRITICAL) {
        if weakening == 0.1 {
            for (n, load) in QUASI_STATIC {
                chapter.add(
                    format!("W = {weakening}: excess load at which a patch of {n} blocks grows"),
                    [load, loads[n / 2 + 1][0]],
                    0.05 * load,
                    "slip grows slowly near the instability: the delay scales with the loading rate to the power 2/3",
                );
            }
        }
        let [size, load] = runaway(loads, critical);
        chapter.add(
            format!("W = {weakening}: excess load from which the next block slips within 40 t*"),
            [largest, load],
            0.05 * largest,
            "delay of slow growth near the instability",
        );
        sizes.push(size);
    }
    let all: Vec<f64> = (0..=30).map(|k| 0.06 + 0.005 * f64::from(k)).collect();
    let [weakenings, critical_sizes] = [0, 2].map(|column| CRITICAL.map(|row| row[column]));
    let continuum = |weakening: f64| 1.158 * 2.25 / weakening;
    chapter.draw(
        "Patch size in blocks at which slip runs away, against the rate of weakening W. For the runs it is the size at which the next block slips \
         within 40 t*. The load continues to rise slowly while the patch grows from its critical size.",
        ["rate of weakening W", "blocks"],
        vec![
            Response::of_values("runs", &weakenings, &sizes),
            Response::of_values("lattice, quasi-static", &weakenings, &critical_sizes),
            Response::of_formula("continuum, 1.158 \u{3bc}*/W", &all, continuum),
        ],
    );
    Ok(())
}
