//! Both kernels compared with the reference, step by step, over random sliders with every option.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use proptest::prelude::*;
use proptest::test_runner::{TestCaseError, TestCaseResult, TestRunner, contextualize_config};
use slipfront::communicator::Alone;
use slipfront::observe::{Curve, CurveRow, Scheduled};
use slipfront::surface::{Contact, Load, mesh};
use slipfront::{
    AfterBreak, Ageing, Body, ContactSprings, Coulomb, DeadLoad, Drive, Edge, Edges, Execution, Face,
    Friction, FrictionLaw, Interface, Kernel, Loading, Model, Outline, Program, RateAndState, Rotation,
    Simulation, SlipWeakening, Snapshot, State, Stop, Surface, VectorField, Weakening, next_side, scales,
};

use crate::common::Slider;
use crate::reference::Reference;
use crate::slider;

/// Number of steps of a comparison, in which blocks slip, stop, age and slip again.
const STEPS: u64 = 40;

/// Options that [`Slider`] does not have.
#[derive(Clone, Debug)]
struct Options {
    friction: Friction,
    /// Moduli, densities and pressures, block by block.
    graded: [bool; 3],
    /// A bulk body, for equal blocks with periodic edges.
    body: Option<Body>,
    outline: bool,
    attached: Option<Edge>,
    viscosity_time: f64,
    /// Speeds of a program over V*, and the number of steps after which each ends.
    program: Option<Vec<(f64, u32)>>,
    rotates: bool,
    held: bool,
    k_drive: f64,
    dead_load: [f64; 2],
    /// Whether the dead load differs from block to block.
    uneven_load: bool,
    /// Scale of forces over the mean static coefficient.
    mu_static_mean: f64,
    /// Size of displacements and velocities at the start, and n, where every n-th block has a velocity.
    start: Option<(f64, usize)>,
    /// Whether the reference receives the state of the kernel before each step.
    follows: bool,
    /// Stiffness of the foundation under an upright sheet.
    foundation: Option<f64>,
    halves_edge_springs: bool,
}

fn friction() -> impl Strategy<Value = Friction> {
    let coulomb = |law, weakening, ageing| {
        Friction::Coulomb(Coulomb {
            law,
            weakening,
            ageing,
            slip_weakening: None,
            interface: None,
        })
    };
    let of_slip = |(length, healing_time)| {
        Friction::Coulomb(Coulomb {
            slip_weakening: Some(SlipWeakening { length, healing_time }),
            ..FrictionLaw::Projection.into()
        })
    };
    let weakening = || {
        let law = |(critical_speed, ratio)| Weakening {
            critical_speed,
            ratio,
        };
        (0.01..1.0, 0.0..1.0).prop_map(law)
    };
    let ageing = || (0.01..3.0, 0.01..10.0).prop_map(|(beta, time)| Ageing { beta, time });
    let projection = FrictionLaw::Projection;
    prop_oneof![
        4 => Just(coulomb(projection, None, None)),
        1 => Just(coulomb(FrictionLaw::Reversal, None, None)),
        1 => Just(coulomb(FrictionLaw::Literal, None, None)),
        2 => weakening().prop_map(move |law| coulomb(projection, Some(law), None)),
        1 => ageing().prop_map(move |law| coulomb(projection, None, Some(law))),
        1 => (weakening(), ageing()).prop_map(move |(falls, grows)| coulomb(projection, Some(falls), Some(grows))),
        2 => (0.05..3.0, prop::option::of(0.05..2.0)).prop_map(of_slip),
        2 => rate_and_state().prop_map(Friction::RateAndState),
        2 => (0.05..2.0, after_break()).prop_map(|(stiffness, after_break)| {
            Friction::ContactSprings(ContactSprings { stiffness, after_break })
        }),
    ]
}

fn after_break() -> impl Strategy<Value = AfterBreak> {
    let forms_again = prop::option::of(any::<u64>()).prop_map(|redraw| AfterBreak::FormsAgain { redraw });
    prop_oneof![forms_again, Just(AfterBreak::Slides)]
}

prop_compose! {
    /// Parameters for which friction matters at all speeds: where
    /// `ln(2 V_0) - (mu_0 + b ln(V_0 theta/D_c))/a` is large there is almost none, and the library computes
    /// speeds only to an absolute error of the exponential of this, times a unit in the last place.
    fn rate_and_state()(
        a in 0.005..0.03,
        b_over_a in 0.0..3.0,
        d_c in 0.05..1.0,
        v_0 in 0.01..0.2,
        mu_0 in 0.5..1.0,
        theta_0 in 0.1..50.0,
        slip_speed in 0.01..0.3,
    ) -> RateAndState {
        RateAndState { a, b: b_over_a * a, d_c, v_0, mu_0, theta_0, slip_speed }
    }
}

prop_compose! {
    fn options()(
        friction in friction(),
        graded in any::<[bool; 3]>(),
        outline in any::<bool>(),
        body in prop::option::of(body()),
        attached in prop::option::of(prop::sample::select(vec![Edge::Left, Edge::Right, Edge::Bottom, Edge::Top])),
        viscosity_time in prop_oneof![3 => Just(0.0), 1 => 0.01..1.0],
        program in prop::option::of(prop::collection::vec((-1.0..1.0, 1..20_u32), 1..4)),
        rotates in prop::bool::weighted(0.25),
        held in prop::bool::weighted(0.3),
        k_drive in 0.02..0.6,
        dead_load in prop_oneof![3 => Just([0.0; 2]), 2 => [-0.3..0.3, -0.3..0.3]],
        uneven_load in any::<bool>(),
        mu_static_mean in 0.5..2.0,
        start in prop::option::of((prop_oneof![1e-3..0.1, 0.1..2.0], 1..5_usize)),
        follows in any::<bool>(),
        foundation in prop::option::weighted(0.3, prop_oneof![Just(0.0), 0.05..2.0]),
        halves_edge_springs in prop::bool::weighted(0.3),
    ) -> Options {
        Options {
            friction, graded, outline, body, attached, viscosity_time, program, rotates, held, k_drive, dead_load, uneven_load, mu_static_mean,
            start, follows, foundation, halves_edge_springs,
        }
    }
}

fn body() -> impl Strategy<Value = Body> {
    let face = prop::sample::select(vec![Face::Pressure, Face::Flat]);
    (0.5..20.0, 0.0..0.49, face).prop_map(|(height, poisson, face)| Body {
        height,
        poisson,
        face,
    })
}

/// Numbers from `low` to `high`, one for each block.
fn spread(n: usize, seed: u64, low: f64, high: f64) -> Vec<f64> {
    let phase = 1.0 + (seed % 1000) as f64;
    let one = |b: usize| low + (high - low) * 0.5 * (1.0 + (phase * (b as f64 + 1.0)).sin());
    (0..n).map(one).collect()
}

/// Input of both implementations.
struct Setting {
    model: Model,
    contact: Contact,
    dt: f64,
    state: State,
    follows: bool,
}

impl Setting {
    /// The setting of a slider with options; none if no block is in contact.
    fn new(slider: &Slider, options: &Options) -> Option<Self> {
        let (lattice, seed) = (slider.lattice(), slider.seed);
        let has_sides = [lattice.nx, lattice.ny].iter().all(|&n| next_side(n) == n);
        let of_bulk = options
            .body
            .filter(|_| has_sides && lattice.edges == [Edges::Periodic; 2]);
        let is_bulk = of_bulk.is_some();
        let n = lattice.n_blocks();
        let given = |number: usize, low, high| {
            (options.graded[number] && (number == 2 || !is_bulk))
                .then(|| spread(n, seed.wrapping_add(number as u64), low, high))
        };
        let exists: Vec<bool> = spread(n, seed.wrapping_add(3), 0.0, 1.0)
            .iter()
            .map(|&x| x > 0.2)
            .collect();
        let outline = (options.outline && !is_bulk).then(|| Outline::new(exists, &Alone));
        let mut body = slipfront::Slider::new(given(0, 0.25, 1.0), given(1, 0.5, 2.0), outline, &Alone);
        if let Some(edge) = options.attached.filter(|_| !is_bulk) {
            body.attach_edge(&lattice, &(0..lattice.ny), edge, &Alone);
        }
        if !is_bulk {
            body.viscosity_time = options.viscosity_time;
            body.halves_edge_springs = options.halves_edge_springs;
        }
        let mut contact = Contact {
            mu_static_mean: options.mu_static_mean,
            ..slider.contact(0..lattice.ny)
        };
        contact.pressure = given(2, 0.1, 2.0).or(contact.pressure);
        let textured = mesh(&lattice, &slider.textures).textured;
        let surface =
            Surface::of_ranks(slider.coefficients(), textured, contact.clone(), &body, &Alone).ok()?;
        let drive = Drive {
            k_drive: options.k_drive,
            ..Drive::at_angle(slider.v_star, slider.degrees)
        };
        let damping = scales::damping(slider.omega_star);
        let mut friction = options.friction;
        if let (Friction::Coulomb(law), Some(foundation), false) =
            (&mut friction, options.foundation, is_bulk)
            && law.law == FrictionLaw::Projection
            && law.ageing.is_none()
        {
            law.interface = Some(Interface { foundation });
        }
        let is_upright = friction.interface().is_some();
        let mut model = Model::new(lattice, surface, drive, damping, slider.epsilon, friction);
        model = model.with_slider(body);
        if let Some(body) = of_bulk {
            model = model.with_body(body);
        }
        let dt = slider.dt_star * model.stable_step_limit(&Alone);
        if let Some(parts) = &options.program {
            let mut steps = 0;
            let segments = parts.iter().map(|&(speed, count)| {
                steps += count;
                (speed * slider.v_star, f64::from(steps) * dt)
            });
            model.drive.program = Some(Arc::new(Program::new(segments)));
        }
        // A single block has no lever arm.
        if options.rotates && model.n_blocks() > 1 && !is_bulk && !is_upright {
            let rotation = Rotation::about_centroid(&lattice, &model.rows, model.slider(), &Alone);
            model.drive.rotation = Some(rotation);
        }
        if options.held {
            model.drive.loading = Loading::Held { onset_steps: 20 };
        }
        if model.drive.rotation.is_none() {
            let load = if options.uneven_load {
                let relative = spread(n, seed.wrapping_add(4), -1.0, 2.0);
                DeadLoad::of_blocks(options.dead_load, relative, model.slider(), &Alone)
            } else {
                DeadLoad::uniform(options.dead_load)
            };
            model = model.with_dead_load(load);
        }
        let state = start(&model, options.start, seed);
        Some(Self {
            model,
            contact,
            dt,
            state,
            follows: options.follows,
        })
    }

    /// All options, and whether this setting uses them.
    fn options(&self) -> [(&'static str, bool); 41] {
        let (model, body, load) = (&self.model, self.model.slider(), self.model.dead_load());
        let coulomb = match model.friction {
            Friction::Coulomb(coulomb) => Some(coulomb),
            Friction::RateAndState(_) | Friction::ContactSprings(_) => None,
        };
        let of_slip = coulomb.and_then(|coulomb| coulomb.slip_weakening);
        let slips = |heals: bool| of_slip.is_some_and(|law| law.healing_time.is_some() == heals);
        let reads = |law| coulomb.is_some_and(|coulomb| coulomb.law == law);
        let springs = match model.friction {
            Friction::ContactSprings(springs) => Some(springs.after_break),
            Friction::Coulomb(_) | Friction::RateAndState(_) => None,
        };
        let redraws = matches!(springs, Some(AfterBreak::FormsAgain { redraw: Some(_) }));
        let [of_static, of_kinetic] = [self.contact.adhesion.of_static, self.contact.adhesion.of_kinetic];
        [
            ("projection", reads(FrictionLaw::Projection)),
            ("reversal", reads(FrictionLaw::Reversal)),
            ("literal", reads(FrictionLaw::Literal)),
            (
                "weakening",
                coulomb.is_some_and(|coulomb| coulomb.weakening.is_some()),
            ),
            ("ageing", coulomb.is_some_and(|coulomb| coulomb.ageing.is_some())),
            ("slip weakening", slips(false)),
            ("slip weakening that heals", slips(true)),
            (
                "rate and state",
                matches!(model.friction, Friction::RateAndState(_)),
            ),
            ("contact springs", springs.is_some()),
            ("contact springs drawn anew", redraws),
            ("contact springs that slide", springs == Some(AfterBreak::Slides)),
            (
                "interface",
                coulomb.is_some_and(|coulomb| coulomb.interface.is_some()),
            ),
            (
                "interface on a foundation",
                model
                    .friction
                    .interface()
                    .is_some_and(|interface| interface.foundation > 0.0),
            ),
            (
                "interface whose strength changes",
                coulomb.is_some_and(|law| {
                    law.interface.is_some() && (law.weakening.is_some() || law.slip_weakening.is_some())
                }),
            ),
            ("halved springs along edges", body.halves_edge_springs),
            ("free edges", model.lattice.edges.contains(&Edges::Free)),
            ("periodic edges", model.lattice.edges.contains(&Edges::Periodic)),
            ("chain", model.lattice.ny == 1),
            ("outline", body.outline.is_some()),
            ("bulk body", model.body().is_some()),
            ("moduli", body.stiffness.is_some()),
            ("densities", body.density.is_some()),
            ("viscosity", body.viscosity_time > 0.0),
            ("damping", model.damping > 0.0),
            ("exact geometry", model.epsilon > 0.0),
            ("texture", model.surface.textured.contains(&true)),
            ("redistributed load", self.contact.load == Load::Redistributed),
            ("kept load", self.contact.load == Load::Kept),
            ("uneven pressure", self.contact.pressure.is_some()),
            (
                "adhesion",
                coulomb.is_some() && of_static > 0.0 && of_kinetic > 0.0,
            ),
            (
                "edge drive",
                body.drive_springs
                    .as_ref()
                    .is_some_and(|springs| springs.relative.contains(&0.0)),
            ),
            ("even dead load", load.acts() && load.field.is_none()),
            ("uneven dead load", load.acts() && load.field.is_some()),
            ("program", model.drive.program.is_some()),
            ("held drive", model.drive.is_held()),
            ("translation", model.drive.rotation.is_none()),
            ("rotation", model.drive.rotation.is_some()),
            ("start in motion", self.state.velocity.x.iter().any(|&v| v != 0.0)),
            ("start at rest", self.state.velocity.x.iter().all(|&v| v == 0.0)),
            ("single steps", self.takes_single_steps()),
            ("chains of steps", !self.takes_single_steps()),
        ]
    }

    /// Whether every step begins in the state of the kernel. This is necessary where an error does not stay
    /// small by itself: where friction falls with speed, or follows the direction of a velocity that may be
    /// nearly zero.
    fn takes_single_steps(&self) -> bool {
        let keeps_errors_small = match self.model.friction {
            Friction::Coulomb(coulomb) => {
                coulomb.law == FrictionLaw::Projection
                    && coulomb.weakening.is_none()
                    && coulomb.slip_weakening.is_none()
            }
            Friction::ContactSprings(_) => true,
            Friction::RateAndState(_) => false,
        };
        self.follows || !keeps_errors_small
    }
}

/// Displacements of the existing blocks, and velocities of every `apart`-th block.
fn start(model: &Model, start: Option<(f64, usize)>, seed: u64) -> State {
    let n = model.lattice.n_blocks();
    let Some((size, apart)) = start else {
        return State::at_rest(n);
    };
    let component = |number: u64, apart: usize| {
        let mut values = spread(n, seed.wrapping_add(number), -size, size);
        let still = |b: &usize| !b.is_multiple_of(apart) || !model.slider().exists(*b);
        (0..n).filter(still).for_each(|b| values[b] = 0.0);
        values
    };
    State {
        displacement: VectorField {
            x: component(5, 1),
            y: component(6, 1),
        },
        velocity: VectorField {
            x: component(7, apart),
            y: component(8, apart),
        },
    }
}

/// Largest difference between the results of both implementations.
struct Tolerance {
    force: f64,
    velocity: f64,
    displacement: f64,
    /// Tolerance of sums of energies over all blocks, and of the work and losses in a step.
    energy: f64,
}

impl Tolerance {
    /// A force is a sum of some ten terms, each computed in a few operations, all of which round to half a
    /// unit in the last place of the largest: 32 units. In a step this error, times dt/(m c_+), changes a
    /// velocity, and so does the rounding of the velocity itself. In n consecutive steps velocities
    /// accumulate n such errors and displacements n^2, since the laws that are compared over several steps do
    /// not amplify them.
    fn new(setting: &Setting, state: &State, step: u64) -> Self {
        let (model, slider) = (&setting.model, setting.model.slider());
        let blocks = || (0..model.lattice.n_blocks()).filter(|&b| slider.exists(b));
        let most = |values: &VectorField| {
            values
                .x
                .iter()
                .chain(&values.y)
                .fold(0.0_f64, |most, x| most.max(x.abs()))
        };
        let masses = || blocks().map(|b| slider.mass(b));
        let lightest = masses().fold(f64::INFINITY, f64::min);
        let heaviest = masses().fold(0.0, f64::max);
        let threshold = |b: usize| {
            let surface = &model.surface;
            surface.normal_force(b) + surface.static_limit(b) + surface.kinetic_force(b)
        };
        let bears = blocks().map(threshold).fold(0.0, f64::max);
        let (distance, speed) = (most(&state.displacement), most(&state.velocity));
        let path = model.drive.farthest_path(step as f64 * setting.dt);
        // All springs of a block together have a stiffness of less than 10, a body one of less than 5, and
        // dampers less than 10 times their time.
        let stiffness = 10.0;
        let springs = stiffness * (distance + path + slider.viscosity_time * speed) + 1.0;
        let inertia = (1.0 + model.damping * setting.dt) * speed / setting.dt;
        let largest = springs + bears + heaviest * inertia;
        let steps = if setting.takes_single_steps() {
            1.0
        } else {
            (step * step).max(1) as f64
        };
        let force = 32.0 * f64::EPSILON * largest * steps;
        let velocity = force * setting.dt / lightest;
        // Terms of sums are rounded to a unit in the last place of their bounds. Those on speeds assume that
        // springs are stretched by as much as blocks may have moved since displacements were measured, which
        // is done every 16 steps.
        let gap = distance + path + 2.0 * 16.0 * setting.dt * speed;
        let highest = speed + (stiffness * gap + bears) * setting.dt / lightest;
        let powers = heaviest * (1.0 + model.damping * setting.dt) / setting.dt * highest * highest;
        // A contact spring stretches until it bears the threshold, also with a dead load at the start.
        let contact = match model.friction {
            Friction::ContactSprings(springs) => 0.5 * bears * bears / springs.stiffness,
            _ => 0.0,
        };
        let potentials = stiffness * gap * gap + contact;
        let n = model.n_blocks() as f64;
        Self {
            force,
            velocity,
            displacement: velocity * setting.dt + 2.0 * f64::EPSILON * distance,
            energy: n * 8.0 * f64::EPSILON * (powers * 2.0 * setting.dt + potentials) * steps,
        }
    }
}

/// Coverage of the comparisons.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    instants: usize,
    /// Number of instants at which rounding decides which blocks slide.
    undecided: usize,
    /// Number of blocks that begin to slide.
    slips: usize,
    /// Number of blocks that stop.
    stops: usize,
}

/// Compares the kernel with the reference over [`STEPS`] steps.
fn compare(setting: &Setting, kernel: Kernel, seen: &mut Seen) -> TestCaseResult {
    let execution = Execution {
        kernel,
        ..Execution::default()
    };
    let begin = Some(setting.state.clone());
    let mut simulation = Simulation::new(setting.model.clone(), setting.dt, begin, execution);
    let mut reference = Reference::new(&setting.model, &setting.contact, setting.dt, &setting.state);
    let mut curve = Curve::every(1);
    // Work and losses keep the errors of all steps so far.
    let mut energy_tolerance = 0.0;
    let mut largest_stress = 0.0_f64;
    let mut is_decided = true;
    for step in 0..=STEPS {
        if step > 0 {
            if setting.takes_single_steps() {
                reference.move_to(&simulation.state());
            }
            let before = reference.slides.clone();
            // Where rounding decides which blocks slide, it also decides whether the drive stands still.
            let moves = match is_decided {
                true => reference.drive_moves(),
                false => simulation.snapshot().next_drive_time_star() > simulation.snapshot().drive_time_star,
            };
            reference.step(moves);
            for (before, now) in before.into_iter().zip(&reference.slides) {
                seen.slips += usize::from(!before && *now);
                seen.stops += usize::from(before && !now);
            }
        }
        let steps = u64::from(step > 0);
        let ended = simulation.advance(Stop::never(), steps, &mut [Scheduled::always(&mut curve)]);
        prop_assert!(ended.is_ok(), "{:?}", ended);
        largest_stress = largest_stress.max(reference.largest_contact_stress());
        let state = simulation.state();
        let (now, tolerance) = (simulation.snapshot(), Tolerance::new(setting, &state, step));
        energy_tolerance += tolerance.energy;
        let tolerance = Tolerance {
            energy: energy_tolerance,
            ..tolerance
        };
        let place = |error| TestCaseError::fail(format!("{kernel:?}, step {step}: {error}"));
        compare_blocks(&now, &reference, &tolerance).map_err(place)?;
        prop_assert_eq!(now.drive_steps, reference.drive_steps);
        // Energies are known at steps in which the drive has moved.
        if let Some(row) = curve.rows.last().filter(|row| row.step == step) {
            compare_sums(row, &reference, &tolerance).map_err(place)?;
        }
        let stress = simulation.contact_stress_max();
        agree("largest stress", stress, largest_stress, 2.0 * tolerance.force).map_err(place)?;
        seen.instants += 1;
        is_decided = !is_undecided(&now, &state, &reference, &tolerance);
        if is_decided {
            compare_counts(&now, &reference).map_err(place)?;
        } else {
            seen.undecided += 1;
        }
    }
    Ok(())
}

fn agree(what: &str, found: f64, expected: f64, tolerance: f64) -> TestCaseResult {
    let is_near = (found - expected).abs() <= tolerance;
    prop_assert!(
        is_near,
        "{what}: {found:e}, expected {expected:e} within {tolerance:e}"
    );
    Ok(())
}

/// Whether rounding decides if a block slides: a block without friction that moves by no more than rounding,
/// since the forces on it cancel or a wave has just reached it. For other blocks rounding decides with a
/// probability of 1e-13 per block and step, if a force comes this close to a threshold.
fn is_undecided(now: &Snapshot, state: &State, reference: &Reference, tolerance: &Tolerance) -> bool {
    let model = now.model;
    let is_upright = model.friction.interface().is_some();
    let is_tiny = |[x, y]: [f64; 2]| {
        let speed = if is_upright { x.abs() } else { x.hypot(y) };
        speed > 0.0 && speed <= 2.0 * tolerance.velocity
    };
    let is_free = |b: &usize| model.surface.static_limit(*b) == 0.0;
    let mut free = (0..reference.velocity.len()).filter(is_free);
    free.any(|b| {
        // The spring of a contact yields to any force, before the block has moved.
        is_tiny(state.velocity.at(b))
            || is_tiny(reference.velocity[b])
            || now.block(b).slides != reference.slides[b]
    })
}

/// Compares the motion of every block and the forces on it.
fn compare_blocks(now: &Snapshot, reference: &Reference, tolerance: &Tolerance) -> TestCaseResult {
    for b in (0..reference.velocity.len()).filter(|&b| now.model.slider().exists(b)) {
        let block = now.block(b);
        for (what, found, expected, tolerance) in [
            (
                "displacement",
                block.displacement,
                reference.displacement[b],
                tolerance.displacement,
            ),
            (
                "drive",
                block.force_drive,
                reference.force_drive[b],
                tolerance.force,
            ),
            (
                "lattice",
                block.force_lattice,
                reference.force_lattice[b],
                tolerance.force,
            ),
            (
                "friction",
                block.force_friction,
                reference.force_friction[b],
                tolerance.force,
            ),
            (
                "velocity",
                block.velocity,
                reference.velocity[b],
                tolerance.velocity,
            ),
        ] {
            for axis in 0..2 {
                agree(what, found[axis], expected[axis], tolerance)?;
            }
        }
        let stress = reference.contact_stress(b);
        agree(
            "contact stress",
            block.contact_stress(),
            stress,
            2.0 * tolerance.force,
        )?;
    }
    Ok(())
}

/// Compares the blocks that slide now, and the times of their first slips.
fn compare_counts(now: &Snapshot, reference: &Reference) -> TestCaseResult {
    // Of a block without strength, rounding may have decided it at an earlier instant.
    let has_strength = |b: &usize| now.model.surface.static_limit(*b) > 0.0;
    let bits = |times: &[f64]| -> Vec<u64> {
        let blocks = (0..times.len()).filter(has_strength);
        blocks.map(|b| times[b].to_bits()).collect()
    };
    prop_assert_eq!(bits(&now.first_slip_time_star()), bits(&reference.first_slips));
    prop_assert_eq!([now.totals.n_sliding, now.totals.n_slipping], reference.sliding());
    // A quotient of integers.
    agree("N*", now.point.sliding_percent, reference.n_star(), 1e-13)
}

/// Compares mu* and the energy balance.
fn compare_sums(row: &CurveRow, reference: &Reference, tolerance: &Tolerance) -> TestCaseResult {
    let (point, energies, losses) = (&row.point, &row.energies, reference.losses());
    let [mu_star, mu_lateral_star] = reference.mu_star();
    agree("mu*", point.mu_star, mu_star, tolerance.force)?;
    agree(
        "lateral mu*",
        point.mu_lateral_star,
        mu_lateral_star,
        tolerance.force,
    )?;
    for (what, found, expected) in [
        (
            "kinetic energy",
            energies.stored.kinetic,
            reference.kinetic_energy(),
        ),
        (
            "lattice energy",
            energies.stored.lattice,
            reference.lattice_energy(),
        ),
        (
            "drive energy",
            energies.stored.drive_springs,
            reference.drive_energy(),
        ),
        (
            "contact energy",
            energies.contact_springs,
            reference.contact_energy(),
        ),
        ("foundation", energies.foundation, reference.foundation_energy()),
        ("work", energies.work, losses.work),
        ("friction loss", energies.friction_loss, losses.friction),
        ("damping loss", energies.damping_loss, losses.damping),
        ("viscous loss", energies.viscous_loss, losses.viscosity),
        (
            "broken springs",
            energies.broken_springs_loss,
            losses.broken_springs,
        ),
    ] {
        agree(what, found, expected, tolerance.energy)?;
    }
    let state = reference.mean_state();
    // Each step rounds the state of a contact some ten times.
    agree(
        "state",
        row.mean_state,
        state,
        1e-14 * (row.step + 1) as f64 * state,
    )
}

/// Both kernels agree with the reference in single steps from arbitrary states, and in chains of steps, with
/// any options.
#[test]
fn kernels_agree_with_the_reference() {
    let reached = RefCell::new(BTreeMap::<&str, usize>::new());
    let seen = RefCell::new(Seen::default());
    // With the seed and the number of cases of the environment, as `proptest!` has them.
    let config = contextualize_config(ProptestConfig {
        cases: 600,
        ..ProptestConfig::default()
    });
    let outcome = TestRunner::new(config).run(&(slider(), options()), |(slider, options)| {
        let Some(setting) = Setting::new(&slider, &options) else {
            return Err(TestCaseError::reject("nothing is in contact"));
        };
        let fused = (Kernel::Fused.for_model(&setting.model) == Kernel::Fused).then_some(Kernel::Fused);
        for kernel in fused.into_iter().chain([Kernel::General]) {
            compare(&setting, kernel, &mut seen.borrow_mut())?;
        }
        let of_fused = ("fused kernel", fused.is_some());
        for (option, is_used) in setting.options().into_iter().chain([of_fused]) {
            *reached.borrow_mut().entry(option).or_insert(0) += usize::from(is_used);
        }
        Ok(())
    });
    outcome.unwrap_or_else(|failure| panic!("{failure}"));
    let (reached, seen) = (reached.into_inner(), seen.into_inner());
    for (option, count) in reached {
        assert!(count > 0, "no slider has this option: {option}");
    }
    assert!(
        10 * seen.undecided < seen.instants && seen.slips > 1000 && seen.stops > 1000,
        "{seen:?}"
    );
}
