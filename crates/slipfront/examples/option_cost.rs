//! Cost of a step of every option: other drives, sliders and laws of friction.
//!
//! ```console
//! $ cargo run --release -p slipfront --example option_cost -- 1 50 200 1024
//! ```
//!
//! The first number is the number of threads. The others are sizes: square sliders with the coefficients of
//! Fig. 3. They begin in steady sliding, and after a hundred steps some blocks stick and others slip. Every
//! block is computed at every step. The options are measured in turn, and the best time of each counts:
//! nanoseconds per step and block of the lattice, and the ratio to the plain model on the fused kernel.
//! Options that this kernel does not compute are listed below the plain model on the general kernel.

use std::error::Error;
use std::sync::Arc;
use std::time::{Duration, Instant};

use slipfront::communicator::Alone;
use slipfront::surface::{
    Adhesion, Coefficients, Contact, CorrelatedField, Distribution, Load, pressure_along,
};
use slipfront::{
    AfterBreak, Ageing, Body, ContactSprings, Coulomb, DeadLoad, Drive, Edge, Edges, Execution, Face,
    Friction, FrictionLaw, Kernel, Lattice, Loading, Model, Outline, Program, RateAndState, Rotation,
    Simulation, Slider, SlipWeakening, State, Surface, VectorField, Weakening, scales,
};

const V_STAR: f64 = 0.03;
const DT_STAR: f64 = 0.1;

/// Time for which each option runs in a turn: so short that other programs interrupt few turns.
const SLICE: Duration = Duration::from_millis(2);
/// Number of turns of every option.
const TURNS: usize = 150;
/// Steps after which a simulation that begins in steady sliding is measured.
const WARM_UP: usize = 100;

/// Departures from the plain model, one or several.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Choice {
    EdgeDrive,
    Program,
    Rotation,
    LoadProfile,
    DeadLoad,
    /// A dead load that differs from block to block.
    LoadField,
    Adhesion,
    Grading,
    Disc,
    Viscosity,
    Weakening,
    SlipWeakening,
    Healing,
    Correlated,
    Held,
    Ageing,
    Reversal,
    Literal,
    RateAndState,
    ContactSprings,
    /// A bulk body.
    Bulk,
}

use Choice::{Disc, Grading, LoadProfile, Viscosity};

/// The options that are measured, with their names.
pub(crate) const MEASURED: [(&str, &[Choice]); 26] = [
    ("plain", &[]),
    ("edge drive", &[Choice::EdgeDrive]),
    ("load profile", &[LoadProfile]),
    ("dead load", &[Choice::DeadLoad]),
    ("dead load, block by block", &[Choice::LoadField]),
    ("program", &[Choice::Program]),
    ("adhesion", &[Choice::Adhesion]),
    ("weakening", &[Choice::Weakening]),
    ("slip weakening", &[Choice::SlipWeakening]),
    (
        "slip weakening, healing",
        &[Choice::SlipWeakening, Choice::Healing],
    ),
    ("correlated coefficients", &[Choice::Correlated]),
    ("held drive", &[Choice::Held]),
    ("grading", &[Grading]),
    ("disc", &[Disc]),
    ("graded disc, weakening", &[Grading, Disc, Choice::Weakening]),
    ("bulk body", &[Choice::Bulk]),
    ("plain, general kernel", &[]),
    ("reversal", &[Choice::Reversal]),
    ("literal", &[Choice::Literal]),
    ("viscosity", &[Viscosity]),
    ("rotation of a disc", &[Disc, Choice::Rotation]),
    ("ageing", &[Choice::Ageing]),
    ("rate and state", &[Choice::RateAndState]),
    ("contact springs", &[Choice::ContactSprings]),
    (
        "graded disc, rotation, viscosity, ageing",
        &[Grading, Disc, Choice::Rotation, Viscosity, Choice::Ageing],
    ),
    (
        "graded disc, rotation, viscosity, rate and state",
        &[Grading, Disc, Choice::Rotation, Viscosity, Choice::RateAndState],
    ),
];

pub(crate) fn model(size: usize, choices: &[Choice]) -> Result<Model, Box<dyn Error + Send + Sync>> {
    let has = |choice: Choice| choices.contains(&choice);
    let edges = if has(Choice::Bulk) {
        Edges::Periodic
    } else {
        Edges::Free
    };
    let lattice = Lattice::with_edges(size, size, [edges; 2]);
    let n = lattice.n_blocks();
    let (rows, damping) = (0..lattice.ny, scales::damping(0.1));
    let graded = |from_to: [f64; 2]| has(Grading).then(|| Slider::grade(&lattice, rows.clone(), 0, from_to));
    let outline = has(Disc).then(|| Outline::new(Outline::disc(&lattice, rows.clone()), &Alone));
    let mut slider = Slider::new(graded([1.0, 0.5]), graded([1.2, 0.8]), outline, &Alone);
    if has(Choice::EdgeDrive) {
        slider.attach_edge(&lattice, &rows, Edge::Left, &Alone);
    }
    if has(Viscosity) {
        slider.viscosity_time = 0.1;
    }
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let contact = Contact {
        pressure: has(LoadProfile).then(|| pressure_along(&lattice, rows.clone(), 0, 0.5)),
        adhesion: if has(Choice::Adhesion) {
            Adhesion {
                of_static: 0.2,
                of_kinetic: 0.1,
            }
        } else {
            Adhesion::default()
        },
        ..Contact::new(Load::Redistributed, 1.0)
    };
    let drawn = if has(Choice::Correlated) {
        let field = CorrelatedField::new(&lattice, 5.0);
        Coefficients::draw_correlated(&field, &rows, gauss(1.0), gauss(0.5), 1)
    } else {
        Coefficients::draw(n, gauss(1.0), gauss(0.5), 1)
    };
    let surface = Surface::of_ranks(drawn, vec![false; n], contact, &slider, &Alone)?;
    let coulomb = Coulomb {
        law: if has(Choice::Reversal) {
            FrictionLaw::Reversal
        } else if has(Choice::Literal) {
            FrictionLaw::Literal
        } else {
            FrictionLaw::Projection
        },
        weakening: has(Choice::Weakening).then_some(Weakening {
            critical_speed: 0.1,
            ratio: 0.5,
        }),
        ageing: has(Choice::Ageing).then_some(Ageing {
            beta: 0.02,
            time: 1.0,
        }),
        slip_weakening: has(Choice::SlipWeakening).then_some(SlipWeakening {
            length: 1.0,
            healing_time: has(Choice::Healing).then_some(10.0),
        }),
        interface: None,
    };
    let d_c = 0.5;
    let friction = if has(Choice::RateAndState) {
        Friction::RateAndState(RateAndState {
            a: 0.01,
            b: 0.02,
            d_c,
            v_0: V_STAR,
            mu_0: 0.6,
            theta_0: d_c / V_STAR,
            slip_speed: 1e-3,
        })
    } else if has(Choice::ContactSprings) {
        Friction::ContactSprings(ContactSprings {
            stiffness: 1.0,
            after_break: AfterBreak::FormsAgain { redraw: None },
        })
    } else {
        Friction::Coulomb(coulomb)
    };
    let plain = Model::new(lattice, surface, Drive::along_x(V_STAR), damping, 1e-6, friction);
    let mut model = plain.with_slider(slider);
    if has(Choice::DeadLoad) {
        model = model.with_dead_load(DeadLoad::uniform([0.3, 0.0]));
    }
    if has(Choice::LoadField) {
        let relative = (0..n).map(|b| (b % 7) as f64 / 3.0).collect();
        let load = DeadLoad::of_blocks([0.3, 0.0], relative, model.slider(), &Alone);
        model = model.with_dead_load(load);
    }
    if has(Choice::Rotation) {
        model.drive.rotation = Some(Rotation::about_centroid(
            &lattice,
            &model.rows,
            model.slider(),
            &Alone,
        ));
    }
    if has(Choice::Program) {
        let segments = [(V_STAR, 5.0), (0.5 * V_STAR, 9.0), (V_STAR, f64::INFINITY)];
        model.drive.program = Some(Arc::new(Program::new(segments)));
    }
    if has(Choice::Bulk) {
        model = model.with_body(Body {
            height: 100.0,
            poisson: 0.3,
            face: Face::Pressure,
        });
    }
    if has(Choice::Held) {
        model.drive.loading = Loading::Held {
            onset_steps: u64::MAX,
        };
    }
    Ok(model)
}

/// State in which every block slides at about the speed of the drive. Blocks lag behind the drive by the
/// stretch of the drive springs that keeps them sliding.
pub(crate) fn steady_state(model: &Model) -> State {
    let behind = match model.friction {
        Friction::ContactSprings(_) => 0.0,
        _ => (model.mean_dead_load()[0] - model.steady_level(&Alone)) / model.drive.k_drive,
    };
    let field = |factor: f64, scatter: f64| {
        let at = |b: usize| {
            let factor = factor * (1.0 + scatter * ((b * 7919 % 1000) as f64 / 500.0 - 1.0));
            let [x, y] = model.drive.direction_at(&model.lattice, b);
            let factor = if model.slider().exists(b) { factor } else { 0.0 };
            (factor * x, factor * y)
        };
        let (x, y): (Vec<f64>, Vec<f64>) = (0..model.surface.n_blocks()).map(at).unzip();
        VectorField { x, y }
    };
    State {
        displacement: field(behind, 0.0),
        velocity: field(model.drive.v_star, 0.5),
    }
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let numbers: Vec<usize> = std::env::args()
        .skip(1)
        .map(|word| word.parse())
        .collect::<Result<_, _>>()?;
    let [threads, sizes @ ..] = numbers.as_slice() else {
        return Err("usage: option_cost THREADS SIZE...".into());
    };
    rayon::ThreadPoolBuilder::new()
        .num_threads(*threads)
        .build_global()?;
    for &size in sizes {
        rayon::scope(|_| print_costs(size, *threads))?;
    }
    Ok(())
}

fn print_costs(size: usize, threads: usize) -> Result<(), Box<dyn Error + Send + Sync>> {
    let mut simulations = Vec::new();
    for (name, choices) in MEASURED {
        let model = model(size, choices)?;
        let is_plain_general = name.ends_with("general kernel");
        let execution = Execution {
            kernel: if is_plain_general {
                Kernel::General
            } else {
                Kernel::Fused
            },
            skips: false,
            ..Execution::on_threads(threads)
        };
        let state = Some(steady_state(&model));
        let mut simulation = Simulation::new(model, DT_STAR, state, execution);
        (0..WARM_UP).for_each(|_| simulation.step());
        simulations.push(simulation);
    }
    let mut best = vec![f64::INFINITY; simulations.len()];
    for _ in 0..TURNS {
        for (best, simulation) in best.iter_mut().zip(&mut simulations) {
            // Brings its arrays into the cache, which holds those of the other simulations.
            simulation.step();
            let (began, mut steps) = (Instant::now(), 0);
            while began.elapsed() < SLICE {
                simulation.step();
                steps += 1;
            }
            let nanoseconds = began.elapsed().as_secs_f64() * 1e9;
            *best = best.min(nanoseconds / f64::from(steps) / (size * size) as f64);
        }
    }
    println!(
        "{size} x {size} blocks, {threads} threads, {}: ns per block and step, times plain",
        slipfront::simd_width()
    );
    for ((name, _), time) in MEASURED.iter().zip(&best) {
        println!("{name:50} {time:7.2} {:6.2}", time / best[0]);
    }
    Ok(())
}
