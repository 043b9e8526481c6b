//! The strength of a bulk body under slow loading: increments of the drive that become finer before the
//! onset.
//!
//! The drive moves while the blocks are at rest. If they then run away, so that friction falls, the last
//! increment was too large: the search goes back to the last rest and divides the increment by four, three
//! times. It returns a [`Program`] of increments, which a run repeats without going back.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::checkpoint::Checkpoint;
use crate::drive::{Loading, Program};
use crate::error::RunError;
use crate::kernel::Execution;
use crate::model::Model;
use crate::simulation::Simulation;
use crate::snapshot::Snapshot;
use crate::state::State;

/// Rise of mu* in the first increments, of which all but the last are elastic.
const INCREMENT: f64 = 0.08;

/// Ratio of an increment of a held drive to the next smaller one.
pub const REFINEMENT: f64 = 4.0;

/// Number of sizes of increments.
const SIZES: usize = 5;

/// Increments of a held drive up to the onset of sliding.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Increments {
    /// Speed V* of the first increments: their path per time step.
    pub v_star: f64,
    /// The increments, as speeds of the drive in the time of the drive.
    pub program: Program,
    /// Number of increments up to the onset, with the one that leads to it.
    pub onset_steps: u64,
}

/// A search for the increments that lead to the onset.
pub struct Search {
    model: Model,
    dt_star: f64,
    execution: Execution,
    simulation: Simulation,
    /// Number of increments of each size so far, the largest first.
    counts: Vec<u64>,
    last_rest: Saved,
    /// Number of increments after which the search ends without a run-away.
    most: u64,
    /// Whether strength falls faster than the pull of the drive springs while all blocks slip.
    slips_on_as_a_whole: bool,
}

/// Result of some steps of a search.
#[expect(clippy::large_enum_variant, reason = "it is moved at once")]
pub enum SearchOutcome {
    /// The increments are not known yet.
    Unfinished(Search),
    /// The increments that lead to the onset.
    Found(Increments),
}

/// A simulation at rest.
struct Saved {
    checkpoint: Checkpoint,
    columns: Vec<Vec<f64>>,
}

impl Search {
    /// A search from the given state, or from rest. If nothing runs away, it ends where the drive springs
    /// would bear twice the strength, and the loss of strength over its slip.
    pub fn new(model: Model, dt_star: f64, state: Option<State>, execution: Execution) -> Self {
        let slip = model.friction.strength_over_slip().map_or(0.0, |law| law.length);
        let rise = 2.0 + model.drive.k_drive * slip;
        let weakening = model.surface.share_in_contact() * model.weakening().unwrap_or(0.0);
        let most = (rise / INCREMENT).ceil() as u64;
        let counts = vec![0];
        let first = with_increments(&model, dt_star, &counts);
        let simulation = Simulation::new(first, dt_star, state, execution.clone());
        let last_rest = Saved::new(&simulation);
        Self {
            dt_star,
            execution,
            simulation,
            counts,
            last_rest,
            most,
            slips_on_as_a_whole: weakening > model.drive.k_drive,
            model,
        }
    }

    /// Makes at most `steps` steps.
    ///
    /// # Errors
    /// [`RunError`] if the run diverges, or never comes to rest.
    pub fn advance(mut self, steps: u64) -> Result<SearchOutcome, RunError> {
        for _ in 0..steps {
            self.simulation.step();
            self.simulation.check()?;
            let now = self.simulation.snapshot();
            let (peak, mu_star, drive_steps) = (now.peak, now.point.mu_star, now.drive_steps);
            let slips_too_early = self.counts.len() == 1 && now.totals.n_slipping > 0;
            if slips_too_early {
                self = self.with_smaller_increments();
            } else if self.simulation.is_at_rest() {
                self.last_rest = Saved::new(&self.simulation);
                let finished: u64 = self.counts[..self.counts.len() - 1].iter().sum();
                *self.counts.last_mut().expect("there is a first size") = drive_steps - finished;
                let is_far = drive_steps >= self.most * REFINEMENT.powi(self.counts.len() as i32 - 1) as u64;
                if peak.is_fall_to(mu_star) || is_far {
                    return Ok(SearchOutcome::Found(self.found()));
                }
            } else if peak.is_fall_to(mu_star) {
                if self.counts.len() == SIZES {
                    return Ok(SearchOutcome::Found(self.found()));
                }
                self = self.with_smaller_increments();
            } else if self.counts.len() < SIZES
                && self.slips_on_as_a_whole
                && now.totals.n_slipping == self.model.surface.n_contact()
                && peak.is_above(mu_star)
            {
                // It would fall half-way, too, in several times as many steps.
                self = self.with_smaller_increments();
            }
        }
        Ok(SearchOutcome::Unfinished(self))
    }

    /// The instant up to which the search has come.
    pub fn snapshot(&self) -> Snapshot<'_> {
        self.simulation.snapshot()
    }

    /// The search from its last rest, with smaller increments.
    fn with_smaller_increments(mut self) -> Self {
        // It makes room for the next one.
        drop(self.simulation);
        self.counts.push(0);
        let model = with_increments(&self.model, self.dt_star, &self.counts);
        let Saved { checkpoint, columns } = &self.last_rest;
        let read = |column: usize, first: usize, values: &mut [f64]| {
            values.copy_from_slice(&columns[column][first..first + values.len()]);
            Ok::<(), std::convert::Infallible>(())
        };
        let execution = self.execution.clone();
        self.simulation = match Simulation::resume(model, self.dt_star, checkpoint, execution, read) {
            Ok(Some(simulation)) => simulation,
            Ok(None) => unreachable!("the kernel is the one that wrote the checkpoint"),
            Err(never) => match never {},
        };
        self
    }

    fn found(&self) -> Increments {
        let v_star = speed_of_increments(&self.model, self.dt_star);
        let mut segments = segments(v_star, self.dt_star, &self.counts);
        // One more of the smallest leads to the onset, and sliding is loaded by those of the second size.
        let steps = self.counts.iter().sum::<u64>() + 1;
        if let Some((_, until_star)) = segments.last_mut() {
            *until_star = steps as f64 * self.dt_star;
        }
        segments.push((v_star / REFINEMENT, f64::INFINITY));
        Increments {
            v_star,
            program: Program::new(segments),
            // Until the next one the blocks have run away.
            onset_steps: steps + 1,
        }
    }
}

impl Saved {
    fn new(simulation: &Simulation) -> Self {
        let n_blocks = simulation.snapshot().model.surface.n_blocks();
        let n_columns = simulation.snapshot().model.n_columns();
        let mut columns = vec![vec![0.0; n_blocks]; n_columns];
        let write = |column: usize, first: usize, values: &[f64]| {
            columns[column][first..first + values.len()].copy_from_slice(values);
            Ok::<(), std::convert::Infallible>(())
        };
        let Ok(()) = simulation.write_columns(write);
        Self {
            checkpoint: simulation.checkpoint(),
            columns,
        }
    }
}

/// Speed V* of the largest increments of a held drive: their path per time step.
pub fn speed_of_increments(model: &Model, dt_star: f64) -> f64 {
    INCREMENT * model.share_of_load() / (model.drive.k_drive * model.driven_share() * dt_star)
}

/// The speed of each size of increments up to its last t* if there are so many of it, from the speed of the
/// largest; the last size has no end.
fn segments(mut speed: f64, dt_star: f64, counts: &[u64]) -> Vec<(f64, f64)> {
    let mut steps = 0;
    let segment = |(size, count): (usize, &u64)| {
        steps += count;
        let until_star = if size + 1 == counts.len() {
            f64::INFINITY
        } else {
            steps as f64 * dt_star
        };
        let segment = (speed, until_star);
        speed /= REFINEMENT;
        segment
    };
    counts.iter().enumerate().map(segment).collect()
}

/// The model with these numbers of increments of each size; those of the last size have no end.
fn with_increments(model: &Model, dt_star: f64, counts: &[u64]) -> Model {
    let v_star = speed_of_increments(model, dt_star);
    let segments = segments(v_star, dt_star, counts);
    let mut model = model.clone().with_loading(Loading::Held {
        onset_steps: u64::MAX,
    });
    model.drive.v_star = v_star;
    model.drive.program = Some(Arc::new(Program::new(segments)));
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{Body, Face};
    use crate::drive::Drive;
    use crate::friction::{Coulomb, Friction, FrictionLaw, SlipWeakening};
    use crate::lattice::{Edges, Lattice};
    use crate::stop::Stop;
    use crate::surface::{Coefficients, Load, Surface};

    /// Centres of a square array, each shifted by up to a quarter of the pitch.
    const SHIFTED: [[f64; 2]; 16] = [
        [0.5625, 0.6986],
        [0.6378, 1.3626],
        [0.4001, 2.6868],
        [0.2526, 3.6606],
        [1.6485, 0.484],
        [1.4015, 1.3892],
        [1.3774, 2.4725],
        [1.5023, 3.5267],
        [2.7478, 0.6463],
        [2.5611, 1.7445],
        [2.3577, 2.3301],
        [2.5563, 3.272],
        [3.2678, 0.5074],
        [3.4831, 1.7086],
        [3.5646, 2.5071],
        [3.4984, 3.3738],
    ];

    /// Random centres.
    const RANDOM: [[f64; 2]; 12] = [
        [0.047, 0.77],
        [2.768, 0.802],
        [1.478, 0.015],
        [3.32, 0.618],
        [1.07, 3.521],
        [2.039, 3.389],
        [2.559, 2.967],
        [0.366, 2.165],
        [2.031, 3.485],
        [1.445, 2.393],
        [0.237, 1.551],
        [1.292, 0.601],
    ];

    /// A body with sides of whole numbers of pitches: `textured(x, y)` says by place in pitches which blocks
    /// do not touch. Height in pitches, weakening W p/(G/(1 - nu)), the mount over G/p.
    struct Array {
        textured: Box<dyn Fn(f64, f64) -> bool>,
        pitches: usize,
        blocks_per_pitch: usize,
        poisson: f64,
        weakening: f64,
        height: f64,
        degrees: f64,
        mount: f64,
    }

    fn circle(x: f64, y: f64) -> bool {
        (x - 0.5).powi(2) + (y - 0.5).powi(2) < 0.0625
    }

    fn diagonal(x: f64, y: f64) -> bool {
        (x - y).rem_euclid(1.0) < 0.3
    }

    /// Circles of this radius around these centres, in a square of four pitches that is repeated.
    fn circles(centres: &'static [[f64; 2]], radius: f64) -> Box<dyn Fn(f64, f64) -> bool> {
        let across = |x: f64| (x + 2.0).rem_euclid(4.0) - 2.0;
        Box::new(move |x, y| {
            let is_in = |c: &[f64; 2]| across(x - c[0]).powi(2) + across(y - c[1]).powi(2) < radius.powi(2);
            centres.iter().any(is_in)
        })
    }

    impl Array {
        fn model(&self) -> (Model, f64) {
            let (n, side) = (self.blocks_per_pitch as f64, self.pitches * self.blocks_per_pitch);
            let lattice = Lattice::with_edges(side, side, [Edges::Periodic; 2]);
            let place = |k: usize| (k as f64 + 0.5) / n;
            let textured: Vec<bool> = (0..side * side)
                .map(|b| (self.textured)(place(b % side), place(b / side)))
                .collect();
            let n_contact = textured.iter().filter(|textured| !**textured).count();
            let strength = (side * side) as f64 / n_contact as f64;
            let coefficients = Coefficients::given(vec![1.0; side * side], vec![0.5; side * side]);
            let surface = Surface::new(coefficients, textured, Load::Redistributed, 1.0).unwrap();
            let body = Body {
                height: self.height * n,
                poisson: self.poisson,
                face: Face::Pressure,
            };
            // Stiffness G/p over E times the block size.
            let unit = body.shear_modulus() / n;
            let friction = Friction::Coulomb(Coulomb {
                slip_weakening: Some(SlipWeakening {
                    length: 0.5 * strength / (unit * self.weakening / (1.0 - self.poisson)),
                    healing_time: None,
                }),
                ..FrictionLaw::Projection.into()
            });
            let drive = Drive {
                k_drive: unit * self.mount,
                ..Drive::at_angle(1.0, self.degrees)
            };
            // Half of the critical damping of the longest wave.
            let damping = (body.shear_modulus() * std::f64::consts::TAU / side as f64).sqrt();
            let model = Model::new(lattice, surface, drive, damping, 0.0, friction).with_body(body);
            let dt_star = 1.8 / body.largest_stiffness().max(model.drive.k_drive).sqrt();
            (model, dt_star)
        }

        /// The reduction of strength in %, and the steps of the search and of the run.
        fn reduction(&self) -> (f64, [u64; 2]) {
            let (model, dt_star) = self.model();
            let mut search = Search::new(model.clone(), dt_star, None, Execution::default());
            let mut steps = 0;
            let found = loop {
                steps += 1;
                search = match search.advance(1).unwrap() {
                    SearchOutcome::Unfinished(search) => search,
                    SearchOutcome::Found(found) => break found,
                };
            };
            let mut model = model.with_loading(Loading::Held {
                onset_steps: found.onset_steps,
            });
            (model.drive.v_star, model.drive.program) = (found.v_star, Some(Arc::new(found.program)));
            let mut simulation = Simulation::new(model, dt_star, None, Execution::default());
            simulation.run(Stop::after_onset(u64::MAX), &mut []).unwrap();
            assert!(simulation.peak().ended);
            (
                100.0 * (1.0 - simulation.peak().mu_star),
                [steps, simulation.snapshot().step],
            )
        }
    }

    #[test]
    fn arrays_lose_the_strength_that_other_solvers_find() {
        let deep = |textured: fn(f64, f64) -> bool, poisson, weakening, degrees| Array {
            textured: Box::new(textured),
            pitches: 1,
            blocks_per_pitch: 16,
            poisson,
            weakening,
            height: 5.0,
            degrees,
            mount: 1.0,
        };
        let glued = |poisson, weakening, height| Array {
            height,
            mount: 1.0 / height,
            ..deep(circle, poisson, weakening, 0.0)
        };
        let soft = |array: Array| Array { mount: 0.2, ..array };
        let irregular = |textured, poisson, weakening| Array {
            textured,
            pitches: 4,
            blocks_per_pitch: 8,
            mount: 0.5,
            ..deep(circle, poisson, weakening, 0.0)
        };
        for (array, expected) in [
            (soft(deep(circle, 1.0 / 3.0, 2.0, 0.0)), 7.68),
            (soft(deep(circle, 1.0 / 3.0, 5.0, 0.0)), 16.83),
            (glued(0.45, 2.0, 0.25), 9.29),
            (glued(0.3, 2.0, 0.25), 6.30),
            (glued(0.3, 5.0, 0.15), 11.35),
            (glued(0.49, 5.0, 0.15), 17.19),
            (glued(0.45, 10.0, 0.1), 20.25),
            (deep(circle, 0.2, 4.0, 45.0), 10.38),
            (deep(circle, 0.49, 4.0, 45.0), 14.06),
            (deep(diagonal, 0.49, 4.0, 45.0), 18.59),
            (deep(circle, 0.0, 4.0, 45.0), 9.23),
            (deep(diagonal, 0.3, 4.0, -45.0), 9.05),
            (deep(circle, 0.2, 4.0, 0.0), 11.61),
            (irregular(circles(&SHIFTED, 0.25), 0.3, 4.0), 17.50),
            (irregular(circles(&RANDOM, 0.3), 0.3, 3.0), 22.82),
            (irregular(circles(&RANDOM, 0.3), 0.49, 6.0), 34.40),
            (irregular(circles(&[[2.0, 2.0]], 0.6), 0.3, 4.0), 28.48),
        ] {
            let (found, steps) = array.reduction();
            // Tolerance of the figures, which come from meshes of the same size under other loading.
            assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
            println!(
                "{found:.2} % for {expected} % ({:+.1} %) {steps:?}",
                100.0 * (found / expected - 1.0)
            );
        }
    }
}
