//! A drive that rotates: the torsion of a disc.

use slipfront::communicator::Alone;
use slipfront::exact_solutions::torsion_first_slip;
use slipfront::observe::{Curve, Scheduled};
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Lattice, Model, Outline, Rotation, Stop, Surface};
use test_case::test_case;

use crate::common::{Slider, at_rest};

fn disc(across: usize) -> slipfront::Slider {
    let lattice = Lattice::free(across, across);
    let outline = Outline::new(Outline::disc(&lattice, 0..across), &Alone);
    slipfront::Slider::new(None, None, Some(outline), &Alone)
}

fn turned(slider: &Slider) -> Model {
    let mut model = slider.model();
    let rotation = Rotation::about_centroid(&model.lattice, &model.rows, model.slider(), &Alone);
    model.drive.rotation = Some(rotation);
    model
}

/// Distances of the existing blocks from the middle of the lattice.
fn radii(model: &Model) -> Vec<f64> {
    let half = [model.lattice.nx, model.lattice.ny].map(|n| 0.5 * n as f64);
    let blocks = (0..model.lattice.n_blocks()).filter(|&b| model.slider().exists(b));
    blocks
        .map(|b| {
            let (i, j) = model.lattice.column_row(b);
            (i as f64 + 0.5 - half[0]).hypot(j as f64 + 0.5 - half[1])
        })
        .collect()
}

/// A uniform slider slips at its largest radius first, at `sum r^2/(r_max sum r)` of the torque that it can
/// bear: 0.7577 for a disc of 20 blocks across, near the 3/4 of a continuous disc. The torque is found within
/// the rise of one step.
#[test_case([20, 20], disc(20))]
#[test_case([12, 7], slipfront::Slider::default())]
fn the_rim_slips_first(blocks: [usize; 2], body: slipfront::Slider) {
    let slider = Slider {
        blocks,
        body,
        ..Slider::default().uniform()
    };
    let model = turned(&slider);
    let radii = radii(&model);
    let exact = torsion_first_slip(&radii);
    if blocks == [20, 20] {
        assert!((exact - 0.7577).abs() < 5e-5, "{exact}");
    }
    // The spring at the largest radius stretches by V t.
    let time_star = 1.0 / (0.375 * slider.v_star);
    assert!((model.first_slip_estimate(&Alone).unwrap() / time_star - 1.0).abs() < 1e-14);
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    let now = simulation.snapshot();
    let rise = exact * 0.1 / time_star;
    let above = now.point.mu_star - exact;
    assert!(
        -1e-12 < above && above < rise * (1.0 + 1e-9),
        "{above} above {exact}"
    );
    assert!(now.point.mu_lateral_star.abs() < 1e-13);
    let slips = now.first_slip_time_star();
    let mut exists = (0..model.lattice.n_blocks()).filter(|&b| model.slider().exists(b));
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let at_rim = exists.by_ref().zip(&radii).filter(|(_, r)| **r > largest - 1e-9);
    assert!(at_rim.map(|(b, _)| b).all(|b| !slips[b].is_nan()));
    assert_eq!(
        slips.iter().filter(|time| !time.is_nan()).count(),
        if blocks == [20, 20] {
            now.totals.n_slipping
        } else {
            4
        }
    );
}

/// Thresholds proportional to the radius are reached everywhere at once, up to rounding: the whole disc slips
/// within a step, at the torque that it can bear.
#[test]
fn a_disc_of_thresholds_in_proportion_to_the_radius_slips_at_once() {
    let slider = Slider {
        blocks: [20, 20],
        body: disc(20),
        ..Slider::default().uniform()
    };
    let mut model = turned(&slider);
    let rotation = model.drive.rotation.unwrap();
    let coefficient = |b: usize| {
        let (i, j) = model.lattice.column_row(b);
        let [x, y] = [
            i as f64 + 0.5 - rotation.centre[0],
            j as f64 + 0.5 - rotation.centre[1],
        ];
        x.hypot(y) / rotation.radius
    };
    let mu: Vec<f64> = (0..400).map(coefficient).collect();
    let kinetic = mu.iter().map(|mu| 0.5 * mu).collect();
    model.surface = Surface::of_ranks(
        Coefficients::given(mu, kinetic),
        vec![false; 400],
        Contact::new(Load::Redistributed, 1.0),
        model.slider(),
        &Alone,
    )
    .unwrap();
    let mut simulation = at_rest(&model, 0.1);
    while simulation.snapshot().totals.n_slipping == 0 {
        simulation.step();
    }
    simulation.step();
    assert_eq!(simulation.snapshot().totals.n_slipping, model.surface.n_contact());
}

/// Steady rotation: kinetic friction along the circles and damping,
/// `[sum mu_k F_n r + Omega V sum r^2/r_max]/sum r`. All motions of the lattice are overdamped, Omega > 2
/// sqrt(6.5 k_1), so that the slow blocks next to the middle do not stick. Across its circle a block with the
/// speed v moves as if damped by `Omega + mu_k F_n/v`, and returns at a rate of k_s over this. The test waits
/// until the slowest of these motions, next to the middle, has decayed to exp(-25).
#[test]
fn the_level_of_steady_rotation_is_that_of_friction_and_damping() {
    let slider = Slider {
        blocks: [16, 16],
        body: disc(16),
        omega_star: 6.0,
        v_star: 0.1,
        epsilon: 0.0,
        ..Slider::default()
    };
    let model = turned(&slider);
    let radii = radii(&model);
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let blocks = (0..256).filter(|&b| model.slider().exists(b)).zip(&radii);
    let torque: f64 = blocks
        .map(|(b, r)| model.surface.kinetic_force(b) * r + model.damping * slider.v_star * r * r / largest)
        .sum();
    let exact = torque / radii.iter().sum::<f64>();
    assert!((model.steady_level(&Alone) / exact - 1.0).abs() < 1e-13);
    let slowest = slider.v_star * 0.5_f64.sqrt() / largest;
    let duration = 60.0 / slider.v_star + 25.0 * (model.damping + 0.6 / slowest) / 0.375;
    let mut simulation = at_rest(&model, 0.1);
    simulation
        .run(Stop::at_step((duration / 0.1) as u64), &mut [])
        .unwrap();
    let now = simulation.snapshot();
    assert!(
        (now.point.mu_star / exact - 1.0).abs() < 1e-6,
        "{} {exact}",
        now.point.mu_star
    );
    assert_eq!(now.totals.n_sliding, model.n_blocks());
}

/// A uniform disc looks the same after a quarter turn, to the last bit, at rest and in motion.
#[test]
fn a_quarter_turn_changes_nothing() {
    let slider = Slider {
        blocks: [14, 14],
        body: disc(14),
        v_star: 0.1,
        ..Slider::default().uniform()
    };
    let mut simulation = at_rest(&turned(&slider), 0.1);
    simulation.run(Stop::at_step(900), &mut []).unwrap();
    assert!(simulation.snapshot().totals.n_sliding > 0);
    let state = simulation.state();
    for (i, j) in (0..196).map(|b| (b % 14, b / 14)) {
        let (from, to) = (j * 14 + i, i * 14 + (13 - j));
        for field in [&state.displacement, &state.velocity] {
            let [x, y] = field.at(from);
            assert_eq!(field.at(to), [-y, x], "block ({i}, {j})");
        }
    }
}

/// Work is torque times angle. It is exact while only the springs take up work. Later the balance misses the
/// energy that blocks lose when they stop, in proportion to the square of the step.
#[test]
fn the_ledger_closes_in_rotation() {
    let slider = Slider {
        blocks: [14, 14],
        body: disc(14),
        v_star: 0.2,
        ..Slider::default()
    };
    let energies = |dt_star: f64, until: f64| {
        let mut curve = Curve::every(u64::MAX);
        let mut simulation = at_rest(&turned(&slider), dt_star);
        let stop = Stop::at_step((until / dt_star).round() as u64);
        simulation
            .run(stop, &mut [Scheduled::always(&mut curve)])
            .unwrap();
        curve.rows.last().unwrap().energies
    };
    let stuck = energies(0.1, 10.0);
    let squares: f64 = {
        let radii = radii(&turned(&slider));
        let largest = radii.iter().copied().fold(0.0, f64::max);
        radii.iter().map(|r| (r / largest).powi(2)).sum()
    };
    assert!((stuck.work / (0.5 * 0.375 * 4.0 * squares) - 1.0).abs() < 1e-12);
    assert!(stuck.friction_loss == 0.0 && stuck.error().abs() < 1e-12);
    let [coarse, fine] = [0.1, 0.025].map(|dt_star| energies(dt_star, 120.0));
    assert!(coarse.friction_loss > 0.3 * coarse.work);
    // Only half of the factor of 16 is required, since blocks stop at other instants.
    let errors = [coarse, fine].map(|energies| energies.error().abs());
    assert!(errors[0] < 1e-2 && errors[1] < errors[0] / 8.0, "{errors:?}");
}
