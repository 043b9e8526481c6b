//! Springs between the blocks and the substrate, which break and form again, or slide.

use slipfront::communicator::Alone;
use slipfront::lattice::K_DRIVE;
use slipfront::observe::{Curve, Scheduled};
use slipfront::surface::Coefficients;
use slipfront::surface::Load;
use slipfront::{
    AfterBreak, ContactSprings, DeadLoad, Drive, Friction, FrictionLaw, Lattice, Model, Rotation, Stop,
    Surface, scales,
};
use test_case::test_matrix;

use crate::common::{Slider, at_rest, cavity};

/// Blocks with thresholds distributed uniformly from 1 - w to 1 + w, in an order without a pattern.
fn spread(w: f64, law: ContactSprings, damping: f64, v_star: f64) -> Model {
    let lattice = Lattice::free(20, 20);
    let n = lattice.n_blocks();
    // 7 and 400 have no common factor.
    let place = |b: usize| ((7 * b * 7 * 7 * 7 + 3) % n) as f64;
    let thresholds: Vec<f64> = (0..n)
        .map(|b| 1.0 + w * ((2.0 * place(b) + 1.0) / n as f64 - 1.0))
        .collect();
    let given = Coefficients::given(thresholds, vec![0.0; n]);
    let surface = Surface::new(given, vec![false; n], Load::Redistributed, 1.0).unwrap();
    Model::new(
        lattice,
        surface,
        Drive::along_x(v_star),
        damping,
        0.0,
        Friction::ContactSprings(law),
    )
}

/// In steady sliding, springs that form again pull with half the mean of their thresholds on average.
#[test_matrix([0.05, 0.1, 0.2], [None, Some(5)])]
fn the_level_of_sliding_is_half_the_mean_threshold(w: f64, redraw: Option<u64>) {
    let stiffness = 1e-3 * K_DRIVE;
    let (v_star, damping) = (2.5, scales::damping(0.5));
    let model = spread(
        w,
        ContactSprings {
            stiffness,
            after_break: AfterBreak::FormsAgain { redraw },
        },
        damping,
        v_star,
    );
    assert!((model.steady_level(&Alone) - (0.5 + damping * v_star)).abs() < 1e-12);
}

/// Until the first spring breaks the slider moves as a rigid body against all springs: k_t u = k_t k_s V
/// t/(k_t + k_s) in equilibrium. It oscillates about this by at most V/w_0 with w_0^2 = k_s + k_t, because of
/// the sudden start; the step adds V dt.
#[test]
fn the_weakest_spring_breaks_first() {
    let law = ContactSprings {
        stiffness: 0.2,
        after_break: AfterBreak::FormsAgain { redraw: None },
    };
    let model = spread(0.2, law, 0.0, 1e-3);
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let found = simulation.time_star();
    let off = (found - model.first_slip_estimate(&Alone).unwrap()).abs();
    assert!(
        off < 1.0 / (K_DRIVE + 0.2_f64).sqrt() * (1.0 + 0.2) + 0.1,
        "{off}"
    );
    assert_eq!(simulation.peak().first_slip_drive_time_star, Some(found));
    // The first block to slip is the one with the least threshold.
    let weakest = (0..400).min_by(|&a, &b| model.surface.mu_static[a].total_cmp(&model.surface.mu_static[b]));
    assert!(!simulation.snapshot().first_slip_time_star()[weakest.unwrap()].is_nan());
}

/// Contact springs under which blocks slide after their springs have broken.
const SLIDING: ContactSprings = ContactSprings {
    stiffness: 0.4,
    after_break: AfterBreak::Slides,
};

/// Position of one block that is pulled from rest, in three pieces: held by `k_t` and the drive spring `k`,
/// sliding at `mu_k` on the drive spring alone from the extension 1/k_t on, and held again from the stop on.
struct Piecewise {
    mu_k: f64,
    v_star: f64,
}

impl Piecewise {
    /// Motion `u(t)`, `v(t)` under `u'' = k (V t - u) - f - k_t (u - a)`, from `[t, u, v]` on.
    fn motion(&self, [t0, u0, v0]: [f64; 3], k_t: f64, anchor: f64, f: f64) -> impl Fn(f64) -> [f64; 2] {
        let (square, v) = (K_DRIVE + k_t, self.v_star);
        let root = square.sqrt();
        let steady = move |t: f64| (K_DRIVE * v * t + k_t * anchor - f) / square;
        let speed = K_DRIVE * v / square;
        let (a, b) = (u0 - steady(t0), (v0 - speed) / root);
        move |t| {
            let (sin, cos) = (root * (t - t0)).sin_cos();
            [steady(t) + a * cos + b * sin, speed + root * (b * cos - a * sin)]
        }
    }

    /// The time at which a function that falls from `from` on is 0.
    fn root(from: f64, falls: impl Fn(f64) -> f64) -> f64 {
        let mut low = from;
        while falls(low + 0.01) > 0.0 {
            low += 0.01;
        }
        let mut high = low + 0.01;
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if falls(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        low
    }

    /// Times of the break and of the stop, and the position at a time after the stop.
    fn solve(&self, after_stop: f64) -> [f64; 3] {
        let k_t = SLIDING.stiffness;
        let held = self.motion([0.0; 3], k_t, 0.0, 0.0);
        let breaks = Self::root(0.0, |t| 1.0 - k_t * held(t)[0]);
        let [u, v] = held(breaks);
        let slides = self.motion([breaks, u, v], 0.0, 0.0, self.mu_k);
        let stops = Self::root(breaks, |t| slides(t)[1]);
        let [u, v] = slides(stops);
        let again = self.motion([stops, u, v], k_t, u - self.mu_k / k_t, 0.0);
        [breaks, stops, again(stops + after_stop)[0]]
    }
}

/// Compares one block with the exact solution, through hold, slide and hold. A break and a stop are detected
/// up to a step late. The force is wrong by at most 1 - mu_k then, so that the error of the speed is
/// (1 - mu_k) dt. The error of the position, which oscillates with the frequency sqrt(k + k_t), is this over
/// the frequency, for each of the two events.
#[test_matrix([0.05, 0.005])]
fn one_block_slides_and_is_held_again(dt_star: f64) {
    let exact = Piecewise {
        mu_k: 0.4,
        v_star: 0.05,
    };
    let lattice = Lattice::free(1, 1);
    let model = Model::new(
        lattice,
        Surface::uniform(&lattice, 1.0, exact.mu_k),
        Drive::along_x(exact.v_star),
        0.0,
        0.0,
        Friction::ContactSprings(SLIDING),
    );
    let [breaks, stops, position] = exact.solve(1.5);
    let mut simulation = at_rest(&model, dt_star);
    let (mut changes, mut slid) = (Vec::new(), false);
    while simulation.time_star() < stops + 1.5 - 0.5 * dt_star {
        simulation.step();
        let slides = simulation.snapshot().totals.n_slipping == 1;
        if slides != slid {
            changes.push(simulation.time_star());
        }
        slid = slides;
    }
    assert_eq!(changes.len(), 2, "{changes:?}");
    let found = simulation.snapshot().block(0).displacement[0];
    let speed = 0.05 + (1.0 - exact.mu_k) * 2.0;
    let late = (1.0 - exact.mu_k) * dt_star;
    assert!((changes[0] - breaks).abs() <= dt_star && (changes[1] - stops).abs() <= 3.0 * dt_star);
    let bound = 2.0 * late / (K_DRIVE + SLIDING.stiffness).sqrt() + dt_star * speed;
    assert!((found - position).abs() < bound, "{found} {position} {bound}");
}

/// A rigid slider that moves at V slides at the mean kinetic friction plus Omega V, at any stiffness.
#[test]
fn a_slider_that_slides_pulls_with_its_kinetic_friction() {
    let mut model = spread(0.1, SLIDING, scales::damping(0.5), 0.5);
    let kinetic = (0..400).map(|b| 0.3 + 0.1 * f64::from(b % 3)).collect();
    let given = Coefficients::given(model.surface.mu_static.clone(), kinetic);
    model.surface = Surface::new(given, vec![false; 400], Load::Redistributed, 1.0).unwrap();
    let mean = model.surface.mu_kinetic.iter().sum::<f64>() / 400.0;
    let level = mean + model.damping * 0.5;
    assert!((model.steady_level(&Alone) - level).abs() < 1e-12);
    let mut simulation = at_rest(&model, 0.1);
    let mut curve = Curve::every(1);
    let until = Stop::at_step(4000);
    simulation
        .run(until, &mut [Scheduled::always(&mut curve)])
        .unwrap();
    // The oscillation about it decays as exp(-Omega t/2), here to below 1e-12 of the first peak.
    let found = curve.rows.last().unwrap().point.mu_star;
    assert!((found - level).abs() < 1e-9, "{found} {level}");
    assert_eq!(simulation.snapshot().totals.n_slipping, 400);
}

/// A kinetic friction above the static friction is the force at which a spring yields (D12): the block then
/// slides at the same force, and no energy is lost with the spring.
#[test]
fn a_kinetic_friction_above_the_static_one_holds() {
    let lattice = Lattice::free(1, 1);
    let surface = Surface::uniform(&lattice, 1.0, 1.2);
    let drive = Drive::along_x(2e-3);
    let model = Model::new(lattice, surface, drive, 0.1, 0.0, SLIDING);
    let expected = model.first_slip_estimate(&Alone).unwrap();
    let delay = (K_DRIVE + SLIDING.stiffness) / SLIDING.stiffness;
    assert!((expected / (delay * 1.2 / (K_DRIVE * 2e-3)) - 1.0).abs() < 1e-12);
    let mut simulation = at_rest(&model, 0.1);
    let mut curve = Curve::every(1);
    let until = Stop::at_step((1.2 * expected / 0.1) as u64);
    simulation
        .run(until, &mut [Scheduled::always(&mut curve)])
        .unwrap();
    // The block lags by the drag and oscillates by at most V/w.
    let first = simulation.peak().first_slip_drive_time_star.unwrap();
    assert!(
        (first - expected).abs() < delay * (0.1 + 1.0) / K_DRIVE,
        "{first} {expected}"
    );
    let energies = curve.rows.last().unwrap().energies;
    // The overshoot of a step, in which the extension grows by at most V dt.
    assert!((0.0..1.2 * 2e-3 * 0.1).contains(&energies.broken_springs_loss));
}

/// Contact springs delay first slip and onset by (k_s + k_t)/k_t, in a rotation at every radius. If the drive
/// springs differ the slider bends, and the first slip is not known.
#[test]
fn first_slip_and_onset_are_delayed_alike() {
    let rigid = spread(0.1, SLIDING, 0.0, 0.01);
    let delay = (K_DRIVE + SLIDING.stiffness) / SLIDING.stiffness;
    let estimates = |model: &Model| (model.first_slip_estimate(&Alone), model.onset_estimate(None)[1]);
    for turns in [false, true] {
        let mut springs = rigid.clone();
        if turns {
            let rotation =
                Rotation::about_centroid(&springs.lattice, &springs.rows, springs.slider(), &Alone);
            springs.drive.rotation = Some(rotation);
        }
        let mut stiff = springs.clone();
        stiff.friction = FrictionLaw::Projection.into();
        let [(late, onset), (first, onset_of_stiff)] = [&springs, &stiff].map(estimates);
        assert!((late.unwrap() / first.unwrap() / delay - 1.0).abs() < 1e-12);
        assert!((onset / onset_of_stiff / delay - 1.0).abs() < 1e-12);
    }
    let mut slider = slipfront::Slider::default();
    slider.attach(400, |b| b % 20 == 0, &Alone);
    assert_eq!(rigid.with_slider(slider).first_slip_estimate(&Alone), None);
}

/// Springs hold a dead load below their thresholds: no block moves.
#[test_matrix([AfterBreak::Slides, AfterBreak::FormsAgain { redraw: None }])]
fn springs_hold_a_dead_load(after_break: AfterBreak) {
    let law = ContactSprings {
        stiffness: 0.3,
        after_break,
    };
    let model = spread(0.1, law, 0.0, 0.0).with_dead_load(DeadLoad::uniform([0.6, -0.5]));
    let mut simulation = at_rest(&model, 0.1);
    for _ in 0..100 {
        simulation.step();
    }
    let state = simulation.state();
    // The load over the stiffness, times the stiffness, differs from the load by some units in the last
    // place.
    assert!(
        state
            .displacement
            .x
            .iter()
            .chain(&state.displacement.y)
            .all(|u| u.abs() < 1e-13)
    );
}

/// All energy is accounted for: stored, lost to damping, to friction of blocks that slide, or with the
/// springs that broke. Each of these loses threshold^2/(2 k_t), less the energy that is left, except for the
/// overshoot of a step. The error is proportional to the square of the step.
#[test_matrix([AfterBreak::Slides, AfterBreak::FormsAgain { redraw: Some(1) }])]
fn the_balance_of_energy_closes(after_break: AfterBreak) {
    let error = |dt: f64| {
        let slider = Slider {
            blocks: [12, 10],
            textures: vec![cavity([12, 10], 12.0, 1, 0.2, false)],
            v_star: 0.1,
            degrees: 20.0,
            dt_star: dt,
            ..Slider::default()
        };
        let mut model = slider.model();
        let stiffness = 0.3;
        model.friction = Friction::ContactSprings(ContactSprings {
            stiffness,
            after_break,
        });
        let mut simulation = at_rest(&model, dt);
        let mut curve = Curve::every(1);
        slider.watch(&mut simulation, 20.0, &mut [&mut curve]);
        let energies = curve.rows.last().unwrap().energies;
        let slides = after_break == AfterBreak::Slides;
        assert_eq!(energies.friction_loss > 0.1 * energies.work, slides);
        assert!(energies.broken_springs_loss > 0.02 * energies.work && energies.contact_springs > 0.0);
        energies.error().abs()
    };
    let [coarse, fine] = [0.2, 0.05].map(error);
    assert!(coarse < 1e-2 && fine < 1e-3, "{coarse} {fine}");
}
