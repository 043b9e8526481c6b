//! Laws that hold for any valid slider: random lattices, edges, textures, laws, dampings, directions,
//! surfaces.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

mod against_reference;
#[path = "../common/mod.rs"]
mod common;
mod meshes;
mod openings;
mod ranks;
#[path = "../reference/mod.rs"]
mod reference;
mod sharing;

use proptest::prelude::*;
use slipfront::communicator::Alone;
use slipfront::observe::Field;
use slipfront::observe::frames::Selection;
use slipfront::observe::{Curve, Instants, KineticHistory, KineticStart, Observer, Scheduled};
use slipfront::surface::{Adhesion, Array, Cavity, Groove, Load, Orientation, Shape, Texture, mesh};
use slipfront::{
    Drive, Edges, Execution, FrictionLaw, Kernel, Lattice, Loading, Model, Simulation, State, Stop, Surface,
    VectorField,
};

use common::{Slider, at_rest, from_state, thrown};

/// The kernel of the simulations of this test binary.
const KERNEL: Kernel = Kernel::Fused;

fn edges() -> impl Strategy<Value = [Edges; 2]> {
    let one = || prop_oneof![Just(Edges::Free), Just(Edges::Periodic)];
    [one(), one()]
}

/// Chains, rectangles, single blocks; a periodic axis has at least three blocks.
fn lattice() -> impl Strategy<Value = Lattice> {
    lattice_below(14)
}

fn lattice_below(blocks: usize) -> impl Strategy<Value = Lattice> {
    (1..blocks, 1..blocks, edges()).prop_map(|(nx, ny, edges)| {
        let enough = |n: usize, edges| if edges == Edges::Periodic { n.max(3) } else { n };
        Lattice::with_edges(enough(nx, edges[0]), enough(ny, edges[1]), edges)
    })
}

fn shape() -> impl Strategy<Value = Shape> {
    let place = -2.0..16.0_f64;
    prop_oneof![
        (
            [place.clone(), place.clone()],
            0.3..6.0_f64,
            1..6_u32,
            -0.95..0.95_f64,
            any::<bool>(),
            -400.0..400.0_f64,
        )
            .prop_map(|(center, lambda, s, w, across, rotate)| {
                Shape::Cavity(Cavity {
                    center,
                    lambda,
                    s,
                    w: w / f64::from(s),
                    across,
                    rotate,
                })
            }),
        (any::<bool>(), 0.1..4.0_f64, -8.0..8.0_f64).prop_map(|(across, width, offset)| {
            let orientation = if across {
                Orientation::Across
            } else {
                Orientation::Along
            };
            Shape::Groove(Groove {
                orientation,
                width,
                offset,
            })
        }),
        prop::collection::vec([place.clone(), place], 3..9).prop_map(Shape::Polygon),
    ]
}

prop_compose! {
    fn texture()(
        shape in shape(),
        arrays in prop::collection::vec(pattern(), 0..2),
        inverted in any::<bool>(),
    ) -> Texture {
        Texture { shape, arrays, inverted }
    }
}

prop_compose! {
    fn pattern()(
        count in [1..4_usize, 1..4_usize],
        spacing in [0.5..12.0_f64, 0.5..12.0_f64],
        staggered in any::<bool>(),
    ) -> Array {
        Array { count, spacing, staggered }
    }
}

fn law() -> impl Strategy<Value = FrictionLaw> {
    prop_oneof![
        Just(FrictionLaw::Projection),
        Just(FrictionLaw::Reversal),
        Just(FrictionLaw::Literal)
    ]
}

prop_compose! {
    /// Any slider that a case file could specify, with or without contact.
    fn slider()(
        lattice in lattice(),
        textures in prop::collection::vec(texture(), 0..3),
        kept in any::<bool>(),
        pressure in prop::option::of((0..2_usize, -0.99..0.99_f64)),
        adhesion in prop::option::of([0.0..2.0_f64, 0.0..1.0_f64]),
        v_star in 0.001..0.5_f64,
        degrees in -720.0..720.0_f64,
        r_star in 0.0..1.5_f64,
        omega_star in prop_oneof![Just(0.0), 0.0..1.0_f64, 1.0..100.0_f64],
        sigma in [0.0..0.6_f64, 0.0..0.6_f64],
        epsilon in prop_oneof![Just(0.0), Just(1e-12), 1e-9..0.02_f64],
        law in law(),
        seed in any::<u64>(),
        dt_star in 0.001..0.9_f64,
    ) -> Slider {
        Slider {
            blocks: [lattice.nx, lattice.ny],
            edges: lattice.edges,
            textures,
            body: slipfront::Slider::default(),
            weakening: None,
            slip_weakening: None,
            interface: None,
            program: None,
            loading: Loading::Constant,
            load: if kept { Load::Kept } else { Load::Redistributed },
            pressure,
            adhesion: adhesion.map_or(Adhesion::default(), |[of_static, of_kinetic]| Adhesion { of_static, of_kinetic }),
            dead_load: ([0.0; 2], false),
            v_star,
            degrees,
            r_star,
            omega_star,
            sigma_static_star: sigma[0],
            sigma_kinetic_star: sigma[1],
            epsilon,
            law,
            seed,
            dt_star,
        }
    }
}

/// Whether a slider has contact: its texture may leave none.
fn has_contact(slider: &Slider) -> bool {
    mesh(&slider.lattice(), &slider.textures)
        .textured
        .contains(&false)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn load_and_coverage_are_conserved(slider in slider()) {
        let textured = mesh(&slider.lattice(), &slider.textures).textured;
        let n = textured.len();
        let n_textured = textured.iter().filter(|&&t| t).count();
        prop_assume!(n_textured < n);
        let surface = slider.surface();
        prop_assert_eq!(&surface.textured, &textured);
        prop_assert_eq!(surface.n_contact(), n - n_textured);
        prop_assert!((surface.texture_percent() - 100.0 * n_textured as f64 / n as f64).abs() < 1e-12);
        let load: f64 = (0..n).map(|b| surface.normal_force(b)).sum();
        let contact = slider.contact(0..slider.blocks[1]);
        let pressure = |b: usize| contact.pressure.as_ref().map_or(1.0, |pressure| pressure[b]);
        let is_carried = |b: &usize| slider.load == Load::Redistributed || !textured[*b];
        let carried: f64 = (0..n).filter(is_carried).map(pressure).sum();
        prop_assert!((load / carried - 1.0).abs() < 1e-12);
        // A linear profile has the mean 1.
        let all: f64 = (0..n).map(pressure).sum();
        prop_assert!((all / n as f64 - 1.0).abs() < 1e-12);
        for (b, &over) in textured.iter().enumerate() {
            let felt = [surface.static_limit(b), surface.kinetic_force(b), surface.normal_force(b)];
            let nothing = felt == [0.0; 3];
            prop_assert!(felt.iter().all(|&f| f >= 0.0) && (!over || nothing));
        }
    }

    #[test]
    fn textures_unite(slider in slider(), more in texture()) {
        let lattice = slider.lattice();
        let one = mesh(&lattice, &slider.textures).textured;
        let other = mesh(&lattice, std::slice::from_ref(&more)).textured;
        let mut all = slider.textures;
        all.push(more);
        let both = mesh(&lattice, &all).textured;
        for b in 0..both.len() {
            prop_assert_eq!(both[b], one[b] || other[b]);
        }
    }

    /// A shift by whole blocks along periodic axes shifts the mesh.
    #[test]
    fn textures_wrap_round_periodic_axes(
        blocks in [4..14_usize, 4..14_usize],
        center in [0.0..14.0_f64, 0.0..14.0_f64],
        lambda in 0.4..5.0_f64,
        w in -0.9..0.9_f64,
        shift in [0..14_usize, 0..14_usize],
    ) {
        let lattice = Lattice::with_edges(blocks[0], blocks[1], [Edges::Periodic; 2]);
        // Centres are off the outline by more than rounding, so that the shift moves no block across it.
        let center = center.map(|c| (c * 64.0).round() / 64.0 + 0.003_1);
        let cavity = |center| Shape::Cavity(Cavity {
            center, lambda, s: 1, w, across: false, rotate: 17.0,
        }).into();
        let here = mesh(&lattice, &[cavity(center)]).textured;
        let moved = [center[0] + shift[0] as f64, center[1] + shift[1] as f64];
        let there = mesh(&lattice, &[cavity(moved)]).textured;
        for (b, &over) in here.iter().enumerate() {
            let (i, j) = lattice.column_row(b);
            let to = lattice.block((i + shift[0]) % lattice.nx, (j + shift[1]) % lattice.ny);
            prop_assert_eq!(over, there[to]);
        }
    }

    /// On periodic axes an outline covers the same blocks as its copies in a sheet of many sliders, folded
    /// back onto one slider: also if it is larger than the slider.
    #[test]
    fn periodic_meshes_are_folded_sheets(
        blocks in [3..9_usize, 3..9_usize],
        center in [0.0..8.0_f64, 0.0..8.0_f64],
        lambda in 0.4..9.0_f64,
        s in 1..5_u32,
        w in -0.9..0.9_f64,
        rotate in 0.0..360.0_f64,
    ) {
        const COPIES: usize = 15;
        let periodic = Lattice::with_edges(blocks[0], blocks[1], [Edges::Periodic; 2]);
        let sheet = Lattice::free(COPIES * blocks[0], COPIES * blocks[1]);
        let cavity = |center| Shape::Cavity(Cavity {
            center, lambda, s, w: w / f64::from(s), across: false, rotate,
        }).into();
        let found = mesh(&periodic, &[cavity(center)]).textured;
        let to_middle = |axis: usize| center[axis] + ((COPIES / 2) * blocks[axis]) as f64;
        let copies = mesh(&sheet, &[cavity([to_middle(0), to_middle(1)])]).textured;
        let mut folded = vec![false; periodic.n_blocks()];
        for (b, &over) in copies.iter().enumerate() {
            let (i, j) = sheet.column_row(b);
            folded[periodic.block(i % blocks[0], j % blocks[1])] |= over;
        }
        prop_assert_eq!(found, folded);
    }

    #[test]
    fn any_slider_runs_its_first_steps(slider in slider()) {
        prop_assume!(has_contact(&slider));
        let model = slider.model();
        let n = model.lattice.n_blocks();
        let mut simulation = at_rest(&model, slider.dt_star);
        let selection = Selection { fields: vec![Field::ContactStress, Field::Traction, Field::Sliding], stride: 2 };
        let mut instants = Instants::new(selection, KineticStart::Auto, 30.0 * slider.dt_star);
        let (mut curve, mut history) = (Curve::every(1), KineticHistory::new(30));
        simulation.run(Stop::at_step(30), &mut [
            Scheduled::always(&mut instants),
            Scheduled::always(&mut curve),
            Scheduled::always(&mut history),
        ]).unwrap();
        let (now, state) = (simulation.snapshot(), simulation.state());
        let finite = |f: &VectorField| f.x.iter().chain(&f.y).all(|v| v.is_finite());
        prop_assert!(finite(&state.displacement) && finite(&state.velocity));
        prop_assert!((0..n).all(|b| now.block(b).force_friction.iter().all(|f| f.is_finite())));
        prop_assert!(simulation.contact_stress_max().is_finite());
        prop_assert_eq!(curve.rows.len(), 31);
        for (step, row) in curve.rows.iter().enumerate() {
            prop_assert_eq!(row.step, step as u64);
            prop_assert_eq!(row.time_star, step as f64 * slider.dt_star);
            let e = row.energies;
            prop_assert!(e.stored.kinetic >= 0.0 && e.stored.lattice >= 0.0 && e.stored.drive_springs >= 0.0 && e.damping_loss >= 0.0);
            prop_assert!((0.0..=100.0).contains(&row.point.sliding_percent));
            prop_assert!((row.point.sliding_percent - 100.0 * row.point.n_sliding as f64 / n as f64).abs() < 1e-12);
        }
        let moving = |b: &usize| state.velocity.at(*b) != [0.0, 0.0];
        prop_assert!((0..n).all(|b| now.block(b).slides == moving(&b)));
        prop_assert_eq!(now.point.n_sliding, (0..n).filter(moving).count());
        let slips = |b: &usize| moving(b) && !model.surface.textured[*b];
        prop_assert_eq!(now.totals.n_slipping, (0..n).filter(slips).count());
    }

    /// Friction on a sliding block is mu_k F_n against its motion. On a stuck block it balances the other
    /// forces and never exceeds max(mu_s, mu_k) F_n unless the block has just stopped.
    #[test]
    fn friction_stays_in_its_bounds(slider in slider()) {
        prop_assume!(has_contact(&slider));
        let slider = Slider { law: FrictionLaw::Projection, ..slider };
        let model = slider.model();
        let mut simulation = at_rest(&model, slider.dt_star);
        for _ in 0..40 {
            let before = simulation.state().velocity;
            simulation.step();
            let now = simulation.snapshot();
            for b in 0..model.lattice.n_blocks() {
                let block = now.block(b);
                let ([fx, fy], [vx, vy]) = (block.force_friction, block.velocity);
                let friction = (fx * fx + fy * fy).sqrt();
                if block.slides {
                    prop_assert!((friction - model.surface.kinetic_force(b)).abs() < 1e-12);
                    prop_assert!(fx * vx + fy * vy <= 0.0);
                } else if before.at(b) == [0.0, 0.0] {
                    let threshold = model.surface.static_limit(b).max(model.surface.kinetic_force(b));
                    prop_assert!(friction <= threshold * (1.0 + 1e-14));
                    let (drive, lattice) = (block.force_drive, block.force_lattice);
                    prop_assert_eq!([fx, fy], [-(drive[0] + lattice[0]), -(drive[1] + lattice[1])]);
                }
            }
        }
    }

    /// The number of threads and skipping do not change any bit, and the general kernel agrees to rounding,
    /// from rest and from a state in motion.
    #[test]
    fn kernels_and_executions_agree(
        slider in slider(), lattice in lattice_below(41), moves in any::<bool>(),
        v_star in 0.01..0.5_f64, dt_star in 0.02..0.7_f64, threads in 1..5_usize, skips in any::<bool>(),
    ) {
        let slider = Slider {
            blocks: [lattice.nx, lattice.ny], edges: lattice.edges, law: FrictionLaw::Projection, v_star, dt_star, ..slider
        };
        prop_assume!(has_contact(&slider));
        let (model, n) = (slider.model(), lattice.n_blocks());
        let run = |kernel, threads, skips| {
            let state = moves.then(|| thrown(n, 0.2, 5));
            Simulation::new(model.clone(), dt_star, state, Execution { kernel, skips, ..Execution::on_threads(threads) })
        };
        let mut plain = run(Kernel::Fused, 1, false);
        let mut other = run(Kernel::Fused, threads, skips);
        let mut general = run(Kernel::General, 1, false);
        for step in 1..=400 {
            for simulation in [&mut plain, &mut other, &mut general] {
                simulation.step();
            }
            let (here, there) = (plain.snapshot(), other.snapshot());
            prop_assert_eq!(here.totals, there.totals, "step {}", step);
            prop_assert_eq!(here.point.mu_star.to_bits(), there.point.mu_star.to_bits());
            prop_assert_eq!(plain.contact_stress_max(), other.contact_stress_max(), "step {}", step);
            if step % 20 != 0 {
                continue;
            }
            let (here, there, exact) = (plain.state(), other.state(), general.state());
            prop_assert!(here == there, "step {}", step);
            let size = |v: &VectorField| v.x.iter().chain(&v.y).fold(1.0_f64, |most, x| x.abs().max(most));
            for (a, b) in [(&here.displacement, &exact.displacement), (&here.velocity, &exact.velocity)] {
                let far = (0..n).map(|k| (a.x[k] - b.x[k]).abs().max((a.y[k] - b.y[k]).abs())).fold(0.0, f64::max);
                // Rounding errors of 1e-16 in each of hundreds of steps, which accumulate where nothing
                // dissipates energy.
                prop_assert!(far < 1e-12 * size(b), "step {}: {:e} apart", step, far);
            }
        }
        let bits = |times: Vec<f64>| times.into_iter().map(f64::to_bits).collect::<Vec<_>>();
        prop_assert_eq!(bits(plain.snapshot().first_slip_time_star()), bits(other.snapshot().first_slip_time_star()));
    }

    /// Newton's third law: the forces between blocks add up to zero, and so do their moments about any point
    /// if edges are free.
    #[test]
    fn forces_between_blocks_cancel(lattice in lattice(), seed in any::<u64>(), epsilon in prop_oneof![Just(0.0), 1e-6..0.2_f64]) {
        let n = lattice.n_blocks();
        let wave = |k: f64| (0..n).map(|b| (k * (b as f64 + 1.0) * (1.0 + (seed % 1000) as f64)).sin()).collect();
        let u = VectorField { x: wave(1.7), y: wave(2.9) };
        let surface = Surface::uniform(&lattice, 1.0, 0.5);
        let model = Model::new(lattice, surface, Drive::along_x(0.0), 0.0, epsilon, FrictionLaw::Projection);
        let bent = State { displacement: u.clone(), velocity: VectorField::zeros(n) };
        let simulation = from_state(&model, 0.1, bent.clone());
        let mut force = VectorField::zeros(n);
        for b in 0..n {
            [force.x[b], force.y[b]] = simulation.snapshot().block(b).force_lattice;
        }
        let tolerance = 1e-14 * n as f64;
        prop_assert!(force.x.iter().sum::<f64>().abs() < tolerance && force.y.iter().sum::<f64>().abs() < tolerance);
        if lattice.edges == [Edges::Free; 2] {
            let moment: f64 = (0..n).map(|b| {
                let (i, j) = lattice.column_row(b);
                let at = [i as f64 + epsilon * u.x[b], j as f64 + epsilon * u.y[b]];
                at[0] * force.y[b] - at[1] * force.x[b]
            }).sum();
            prop_assert!(moment.abs() < 30.0 * tolerance, "moment {moment}");
        }
        // Springs pull back: to first order the work of the forces over the displacement is minus twice the
        // energy.
        if epsilon == 0.0 {
            let work: f64 = (0..n).map(|b| force.x[b] * u.x[b] + force.y[b] * u.y[b]).sum();
            prop_assert!(work <= tolerance);
            let mut curve = Curve::every(1);
            let mut again = from_state(&model, 0.1, bent);
            again.run(Stop::at_step(0), &mut [Scheduled::always(&mut curve)]).unwrap();
            prop_assert!((curve.rows[0].energies.stored.lattice + 0.5 * work).abs() < tolerance);
        }
    }

    /// The first peak of a whole run, compared with two passes over its curve.
    #[test]
    fn the_first_peak_is_that_of_two_passes_over_the_curve(
        slider in slider(), r_star in 0.1..1.1_f64, omega_star in 0.0..2.0_f64, seed in any::<u64>(),
    ) {
        let slider = Slider {
            blocks: slider.blocks.map(|n| n.min(5)), r_star, omega_star, seed, v_star: 0.1, dt_star: 0.2,
            ..slider
        };
        prop_assume!(has_contact(&slider));
        let outcome = slider.run(6.0);
        let (level, most) = (slider.model().steady_level(&Alone), slider.model().share_of_load());
        let curve: Vec<f64> = outcome.rows.iter().map(|row| row.point.mu_star).collect();
        let largest_to = |n: usize| {
            (0..=n).fold(0, |best, k| if curve[k] > curve[best] { k } else { best })
        };
        let is_fall = |n: usize| {
            let largest = curve[largest_to(n)];
            let half_way = 0.5 * (largest + level);
            largest > level && curve[n] <= half_way && largest - curve[n] >= 0.05 * (most - level).max(0.0)
        };
        // If mu* falls too late the slider has crept: no later fall ends its peak.
        let time = |n: usize| outcome.rows[n].time_star;
        let is_in_time = |n: &usize| time(*n) - time(largest_to(*n)) <= slider.model().longest_fall();
        let fall = (0..curve.len()).find(|&n| is_fall(n)).filter(is_in_time);
        let peak = outcome.peak;
        prop_assert_eq!(peak.ended, fall.is_some());
        prop_assert_eq!(peak.step as usize, largest_to(fall.unwrap_or(curve.len() - 1)));
        prop_assert_eq!(peak.mu_star, curve[peak.step as usize]);
        prop_assert_eq!(peak.time_star, outcome.rows[peak.step as usize].time_star);
        prop_assert_eq!(peak.largest.mu_star, curve.iter().copied().fold(f64::NEG_INFINITY, f64::max));
    }

    /// The means kept in bins, compared with a direct mean over the steps of the window.
    #[test]
    fn kinetic_means_are_those_of_the_steps(
        last_step in 1..60_000_u64, from in 0.0..1.0_f64, rate in 0.0001..1.0_f64,
    ) {
        let slider = Slider { blocks: [1, 1], ..Slider::default() };
        let model = slider.model();
        let simulation = at_rest(&model, 0.1);
        let mut history = KineticHistory::new(last_step);
        let curve = |n: u64| (rate * n as f64).sin();
        for n in 0..=last_step {
            let mut now = simulation.snapshot();
            now.step = n;
            now.point.mu_star = curve(n);
            now.point.sliding_percent = 50.0 + 50.0 * curve(n);
            history.observe(&now).unwrap();
        }
        let dt = 0.1;
        let end = last_step as f64 * dt;
        let found = history.kinetic(from * end, dt, 1.0);
        let bin = (last_step + 1).div_ceil(KineticHistory::BINS);
        let Some(found) = found else {
            // Only a window shorter than two bins can be empty.
            prop_assert!((1.0 - from) * end < 2.0 * bin as f64 * dt);
            return Ok(());
        };
        let [one, last] = found.window_star.map(|t| (t / dt).round() as u64);
        prop_assert!(one as f64 * dt >= from * end - 1e-9 && one as f64 * dt < from * end + bin as f64 * dt + 1e-9);
        prop_assert!(last <= last_step && last + bin > last_step);
        let mean = (one..=last).map(curve).sum::<f64>() / (last - one + 1) as f64;
        prop_assert!((found.mu_star - mean).abs() < 1e-10, "{} {mean}", found.mu_star);
        prop_assert!((found.sliding_percent - 50.0 - 50.0 * mean).abs() < 1e-8);
    }

    /// Fields of a frame, compared with those of single blocks, at any stride.
    #[test]
    fn frames_hold_every_nth_block(slider in slider(), stride in 1..6_usize, steps in 0..60_u32) {
        prop_assume!(has_contact(&slider));
        let model = slider.model();
        let mut simulation = at_rest(&model, slider.dt_star);
        for _ in 0..steps {
            simulation.step();
        }
        let now = simulation.snapshot();
        let fields = vec![Field::DisplacementX, Field::VelocityY, Field::Sliding, Field::Traction];
        let frame = Selection { fields, stride }.capture(&now);
        prop_assert_eq!((frame.step, frame.point), (now.step, now.point));
        let (nx, ny) = (model.lattice.nx.div_ceil(stride), model.lattice.ny.div_ceil(stride));
        for field in &frame.values {
            prop_assert_eq!(field.len(), nx * ny);
        }
        for b in 0..model.lattice.n_blocks() {
            let (i, j) = model.lattice.column_row(b);
            if i % stride != 0 || j % stride != 0 {
                continue;
            }
            let at = (j / stride) * nx + i / stride;
            let block = now.block(b);
            prop_assert_eq!(frame.values[0][at], block.displacement[0] as f32);
            prop_assert_eq!(frame.values[1][at], block.velocity[1] as f32);
            prop_assert_eq!(frame.values[2][at], f32::from(u8::from(block.slides)));
            prop_assert_eq!(frame.values[3][at].is_nan(), model.surface.textured[b]);
        }
    }
}
