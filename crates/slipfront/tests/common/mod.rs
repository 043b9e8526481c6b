//! Helpers of all test binaries: a slider described by the dimensionless groups of the paper.
#![allow(dead_code)] // Each binary uses its own part of this.

use std::convert::Infallible;
use std::ops::Range;
use std::sync::Arc;

use slipfront::communicator::Alone;
use slipfront::observe::{Curve, CurveRow, Kinetic, KineticHistory, KineticStart, Observer, Peak, Scheduled};
use slipfront::surface::{
    Adhesion, Cavity, Coefficients, Contact, Distribution, Groove, Load, Orientation, Shape, Texture,
    cavity_lambda, mesh, mesh_watched, pressure_along,
};
use slipfront::{
    Communicator, Coulomb, DeadLoad, Drive, DriveSprings, Edges, Execution, Friction, FrictionLaw, Interface,
    Kernel, Lattice, Loading, Model, Outline, Program, Simulation, SlipWeakening, State, Stop, Surface,
    VectorField, Weakening, scales,
};

/// The fused kernel on one thread without skipping.
pub(crate) fn fused() -> Execution {
    Execution {
        kernel: Kernel::Fused,
        skips: false,
        ..Execution::on_threads(1)
    }
}

/// The general kernel on one thread.
pub(crate) fn general() -> Execution {
    Execution {
        kernel: Kernel::General,
        ..fused()
    }
}

/// A slider at rest, stepped by the kernel under test.
pub(crate) fn at_rest(model: &Model, dt_star: f64) -> Simulation {
    executed(model, dt_star, None)
}

/// A slider in a given state, stepped by the kernel under test.
pub(crate) fn from_state(model: &Model, dt_star: f64, state: State) -> Simulation {
    executed(model, dt_star, Some(state))
}

fn executed(model: &Model, dt_star: f64, state: Option<State>) -> Simulation {
    let execution = Execution {
        kernel: crate::KERNEL,
        ..Execution::default()
    };
    Simulation::new(model.clone(), dt_star, state, execution)
}

/// A run described by the groups of Eq. 11. The default is the baseline of Fig. 3.
#[derive(Clone, Debug)]
pub(crate) struct Slider {
    pub(crate) blocks: [usize; 2],
    pub(crate) edges: [Edges; 2],
    pub(crate) textures: Vec<Texture>,
    /// Heterogeneous properties of the whole lattice.
    pub(crate) body: slipfront::Slider,
    pub(crate) weakening: Option<Weakening>,
    pub(crate) slip_weakening: Option<SlipWeakening>,
    pub(crate) interface: Option<Interface>,
    pub(crate) program: Option<Arc<Program>>,
    pub(crate) loading: Loading,
    pub(crate) load: Load,
    /// Axis and relative slope of a pressure that varies along it.
    pub(crate) pressure: Option<(usize, f64)>,
    pub(crate) adhesion: Adhesion,
    /// Dead load along x and y, and whether it differs from block to block.
    pub(crate) dead_load: ([f64; 2], bool),
    pub(crate) v_star: f64,
    pub(crate) degrees: f64,
    pub(crate) r_star: f64,
    pub(crate) omega_star: f64,
    pub(crate) sigma_static_star: f64,
    pub(crate) sigma_kinetic_star: f64,
    pub(crate) epsilon: f64,
    pub(crate) law: FrictionLaw,
    pub(crate) seed: u64,
    pub(crate) dt_star: f64,
}

impl Default for Slider {
    fn default() -> Self {
        Self {
            blocks: [25, 25],
            edges: [Edges::Free; 2],
            textures: Vec::new(),
            body: slipfront::Slider::default(),
            weakening: None,
            slip_weakening: None,
            interface: None,
            program: None,
            loading: Loading::Constant,
            load: Load::Redistributed,
            pressure: None,
            adhesion: Adhesion::default(),
            dead_load: ([0.0; 2], false),
            v_star: 0.03,
            degrees: 0.0,
            r_star: 0.5,
            omega_star: 0.1,
            sigma_static_star: 0.05,
            sigma_kinetic_star: 0.05,
            epsilon: 1e-6,
            law: FrictionLaw::Projection,
            seed: 1,
            dt_star: 0.1,
        }
    }
}

/// Outcome of a run.
pub(crate) struct Outcome {
    pub(crate) peak: Peak,
    pub(crate) kinetic: Option<Kinetic>,
    pub(crate) rows: Vec<CurveRow>,
}

impl Slider {
    /// The slider with equal coefficients for all blocks.
    pub(crate) fn uniform(self) -> Self {
        Self {
            sigma_static_star: 0.0,
            sigma_kinetic_star: 0.0,
            ..self
        }
    }

    pub(crate) fn lattice(&self) -> Lattice {
        Lattice::with_edges(self.blocks[0], self.blocks[1], self.edges)
    }

    pub(crate) fn coefficients(&self) -> Coefficients {
        self.coefficients_of(0..self.lattice().n_blocks())
    }

    pub(crate) fn coefficients_of(&self, blocks: Range<usize>) -> Coefficients {
        let gauss = |mean: f64, star: f64| Distribution {
            mean,
            deviation: star * mean,
        };
        Coefficients::draw_blocks(
            blocks,
            gauss(1.0, self.sigma_static_star),
            gauss(self.r_star, self.sigma_kinetic_star),
            self.seed,
        )
    }

    pub(crate) fn surface(&self) -> Surface {
        let lattice = self.lattice();
        let textured = mesh(&lattice, &self.textures).textured;
        let contact = self.contact(0..lattice.ny);
        Surface::of_ranks(self.coefficients(), textured, contact, &self.body, &Alone).unwrap()
    }

    /// Contact of some rows: load and adhesion.
    pub(crate) fn contact(&self, rows: Range<usize>) -> Contact {
        let pressure = |(axis, slope)| pressure_along(&self.lattice(), rows, axis, slope);
        Contact {
            pressure: self.pressure.map(pressure),
            adhesion: self.adhesion,
            ..Contact::new(self.load, 1.0)
        }
    }

    pub(crate) fn model(&self) -> Model {
        let lattice = self.lattice();
        self.model_with(lattice, 0..lattice.ny, self.surface(), self.body.clone(), &Alone)
    }

    /// The model of one of several ranks.
    pub(crate) fn model_of(&self, rank: &dyn Communicator) -> Model {
        let lattice = self.lattice();
        let rows = lattice.rows_of(rank);
        let Ok(meshed) = mesh_watched::<Infallible>(&lattice, &rows, &self.textures, &mut |_| Ok(()));
        let coefficients = self.coefficients_of(lattice.blocks_of(&rows));
        let contact = self.contact(rows.clone());
        let body = part(&self.body, lattice.blocks_of(&rows));
        let surface = Surface::of_ranks(coefficients, meshed.textured, contact, &body, rank).unwrap();
        self.model_with(lattice, rows, surface, body, rank)
    }

    fn model_with(
        &self,
        lattice: Lattice,
        rows: Range<usize>,
        surface: Surface,
        body: slipfront::Slider,
        ranks: &dyn Communicator,
    ) -> Model {
        let drive = Drive {
            program: self.program.clone(),
            loading: self.loading,
            ..Drive::at_angle(self.v_star, self.degrees)
        };
        let friction = Friction::Coulomb(Coulomb {
            weakening: self.weakening,
            slip_weakening: self.slip_weakening,
            interface: self.interface,
            ..self.law.into()
        });
        let damping = scales::damping(self.omega_star);
        let (force, differs) = self.dead_load;
        let load = if differs {
            let blocks = lattice.blocks_of(&rows);
            let relative = blocks.map(|b| 0.3 + 0.7 * (1.9 * b as f64).sin()).collect();
            DeadLoad::of_blocks(force, relative, &body, ranks)
        } else {
            DeadLoad::uniform(force)
        };
        Model::of_rows(lattice, rows, surface, drive, damping, self.epsilon, friction)
            .with_slider(body)
            .with_dead_load(load)
    }

    /// Number of steps to t* = `turns`/V*.
    pub(crate) fn steps(&self, turns: f64) -> u64 {
        (turns / self.v_star / self.dt_star).ceil() as u64
    }

    /// Runs until the first peak has ended, or to t* = 8/V* at most.
    pub(crate) fn onset(&self) -> Peak {
        let model = self.model();
        let mut simulation = at_rest(&model, self.dt_star);
        simulation
            .run(Stop::after_onset(self.steps(8.0)), &mut [])
            .unwrap();
        simulation.peak()
    }

    /// Runs to t* = `turns`/V*: first peak and kinetic friction.
    pub(crate) fn summary(&self, turns: f64) -> (Peak, Option<Kinetic>) {
        self.observed(turns, &mut [])
    }

    /// Runs to t* = `turns`/V* and records every step.
    pub(crate) fn run(&self, turns: f64) -> Outcome {
        let mut curve = Curve::every(1);
        let (peak, kinetic) = self.observed(turns, &mut [&mut curve]);
        Outcome {
            peak,
            kinetic,
            rows: curve.rows,
        }
    }

    fn observed(&self, turns: f64, others: &mut [&mut dyn Observer]) -> (Peak, Option<Kinetic>) {
        let model = self.model();
        let mut simulation = at_rest(&model, self.dt_star);
        let kinetic = self.watch(&mut simulation, turns, others);
        (simulation.peak(), kinetic)
    }

    /// Runs a simulation of this slider to t* = `turns`/V*, and returns its kinetic friction.
    pub(crate) fn watch(
        &self,
        simulation: &mut Simulation,
        turns: f64,
        others: &mut [&mut dyn Observer],
    ) -> Option<Kinetic> {
        let steps = self.steps(turns);
        let mut history = KineticHistory::new(steps);
        let mut observers = vec![Scheduled::always(&mut history)];
        observers.extend(others.iter_mut().map(|o| Scheduled::always(*o)));
        simulation.run(Stop::at_step(steps), &mut observers).unwrap();
        let from = KineticStart::Auto.time_star(&simulation.peak(), self.v_star);
        history.kinetic(from, self.dt_star, self.v_star)
    }
}

/// The part of a slider with these blocks.
fn part(body: &slipfront::Slider, blocks: Range<usize>) -> slipfront::Slider {
    let of = |values: &Option<Vec<f64>>| values.as_ref().map(|values| values[blocks.clone()].to_vec());
    slipfront::Slider {
        stiffness: of(&body.stiffness),
        density: of(&body.density),
        mean_mass: body.mean_mass,
        mean_slowness: body.mean_slowness,
        drive_springs: body.drive_springs.as_ref().map(|springs| DriveSprings {
            relative: springs.relative[blocks.clone()].to_vec(),
            sum: springs.sum,
        }),
        drives_some: body.drives_some,
        outline: body.outline.as_ref().map(|outline| Outline {
            exists: outline.exists[blocks.clone()].to_vec(),
            n_blocks: outline.n_blocks,
        }),
        viscosity_time: body.viscosity_time,
        halves_edge_springs: body.halves_edge_springs,
    }
}

/// A heterogeneous slider of `n` blocks: moduli from 0.25 to 1, densities from 0.5 to 1.5; with an outline,
/// one block in nine does not exist.
pub(crate) fn varied(n: usize, has_outline: bool) -> slipfront::Slider {
    let wave = |k: f64, low: f64, high: f64| -> Vec<f64> {
        let one = |b: usize| 0.5 * (low + high) + 0.5 * (high - low) * (k * b as f64 + 2.0).sin();
        (0..n).map(one).collect()
    };
    let exists = || (0..n).map(|b| b * b % 9 != 4).collect();
    let outline = has_outline.then(|| Outline::new(exists(), &Alone));
    slipfront::Slider::new(
        Some(wave(1.3, 0.25, 1.0)),
        Some(wave(2.3, 0.5, 1.5)),
        outline,
        &Alone,
    )
}

/// Blocks displaced by up to `size`, every `apart`-th of them with a velocity.
pub(crate) fn thrown(n_blocks: usize, size: f64, apart: usize) -> State {
    let wave = |k: f64, apart: usize| {
        let one = |b: usize| {
            if b.is_multiple_of(apart) {
                size * (k * b as f64 + 1.0).sin()
            } else {
                0.0
            }
        };
        (0..n_blocks).map(one).collect()
    };
    State {
        displacement: VectorField {
            x: wave(1.7, 1),
            y: wave(2.9, 1),
        },
        velocity: VectorField {
            x: wave(0.7, apart),
            y: wave(1.3, apart),
        },
    }
}

/// A cavity of Eq. 17 in the middle of a lattice of `blocks`, covering `percent`.
pub(crate) fn cavity(blocks: [usize; 2], percent: f64, s: u32, w: f64, across: bool) -> Texture {
    Shape::Cavity(Cavity {
        center: [0.5 * blocks[0] as f64, 0.5 * blocks[1] as f64],
        lambda: cavity_lambda(percent, blocks[0] * blocks[1], s, w, 1),
        s,
        w,
        across,
        rotate: 0.0,
    })
    .into()
}

/// A groove through the middle.
pub(crate) fn groove(orientation: Orientation, width: f64) -> Texture {
    Shape::Groove(Groove {
        orientation,
        width,
        offset: 0.0,
    })
    .into()
}
