//! Sliders that are not rectangles.

use slipfront::communicator::Alone;
use slipfront::observe::{Field, Frames, Scheduled, frames::Selection};
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Lattice, Model, Outline, Slider, Stop, Surface};
use test_case::{test_case, test_matrix};

use crate::common::{self, at_rest, cavity};

fn within(exists: Vec<bool>) -> Slider {
    Slider::new(None, None, Some(Outline::new(exists, &Alone)), &Alone)
}

/// A rectangle that is cut out of a larger lattice moves as a separate lattice does, to the last bit, in all
/// measured values.
#[test_matrix([0.0, 0.2], [0.0, 2.0])]
fn a_rectangle_cut_out_is_a_smaller_lattice(viscosity_time: f64, omega_star: f64) {
    let viscous = |slider| Slider {
        viscosity_time,
        ..slider
    };
    let small = common::Slider {
        blocks: [9, 7],
        textures: vec![cavity([9, 7], 10.0, 1, 0.0, false)],
        degrees: 30.0,
        omega_star,
        body: viscous(within(vec![true; 63])),
        ..common::Slider::default()
    };
    let [left, below, nx, ny] = [2, 3, 14, 12];
    let place = |b: usize| (b / 9 + below) * nx + b % 9 + left;
    let model = small.model();
    let (mut exists, mut textured) = (vec![false; nx * ny], vec![false; nx * ny]);
    let mut coefficients = [vec![0.7; nx * ny], vec![0.3; nx * ny]];
    let drawn = small.coefficients();
    for b in 0..63 {
        exists[place(b)] = true;
        textured[place(b)] = model.surface.textured[b];
        coefficients[0][place(b)] = drawn.mu_static[b];
        coefficients[1][place(b)] = drawn.mu_kinetic[b];
    }
    let body = viscous(within(exists));
    let [mu_static, mu_kinetic] = coefficients;
    let coefficients = Coefficients::given(mu_static, mu_kinetic);
    let contact = Contact::new(Load::Redistributed, 1.0);
    let surface = Surface::of_ranks(coefficients, textured, contact, &body, &Alone).unwrap();
    assert_eq!(surface.texture_percent(), model.surface.texture_percent());
    assert_eq!(
        surface.mean_static_coefficient(),
        model.surface.mean_static_coefficient()
    );
    assert_eq!(surface.min_slip_threshold(), model.surface.min_slip_threshold());
    let lattice = Lattice::free(nx, ny);
    let parts = (model.drive.clone(), model.damping, model.epsilon, model.friction);
    let (drive, damping, epsilon, friction) = parts;
    let cut = Model::new(lattice, surface, drive, damping, epsilon, friction).with_slider(body);
    assert_eq!(cut.steady_level(&Alone), model.steady_level(&Alone));
    let (mut one, mut other) = (at_rest(&model, 0.1), at_rest(&cut, 0.1));
    for step in 1..=small.steps(5.0) {
        one.run(Stop::at_step(step), &mut []).unwrap();
        other.run(Stop::at_step(step), &mut []).unwrap();
        let (one, other) = (one.snapshot(), other.snapshot());
        assert_eq!(one.point, other.point, "step {step}");
        assert_eq!(one.totals, other.totals, "step {step}");
        if step % 100 == 0 {
            (0..63).for_each(|b| assert_eq!(one.block(b), other.block(place(b))));
        }
    }
    assert!(one.peak().ended);
    assert_eq!(one.contact_stress_max(), other.contact_stress_max());
    // Missing blocks stay where they are, and have no values.
    let mut fields = Frames::new(Selection {
        fields: Field::ALL.to_vec(),
        stride: 1,
    });
    other.run(Stop::at_step(small.steps(5.0)), &mut []).unwrap();
    let last = other.snapshot().step + 1;
    other
        .run(Stop::at_step(last), &mut [Scheduled::always(&mut fields)])
        .unwrap();
    let inside: Vec<usize> = (0..63).map(place).collect();
    let frame = fields.frames.last().unwrap();
    for b in (0..nx * ny).filter(|b| !inside.contains(b)) {
        assert_eq!(other.state().displacement.at(b), [0.0; 2]);
        assert!(frame.values.iter().all(|values| values[b].is_nan()), "block {b}");
        assert!(other.snapshot().first_slip_time_star()[b].is_nan());
    }
    let displaced = &frame.values[2];
    assert!(inside.iter().all(|&b| !displaced[b].is_nan()));
}

/// A disc of equal blocks slips as a rigid body: mu_s* is 1, plus at most the pull of one step.
#[test_matrix([1, 2, 7, 20])]
fn a_uniform_disc_slips_as_one(across: usize) {
    let lattice = Lattice::free(across, across);
    let slider = common::Slider {
        blocks: [across; 2],
        body: within(Outline::disc(&lattice, 0..across)),
        ..common::Slider::default().uniform()
    };
    let peak = slider.run(4.0).peak.mu_star;
    let pull = 0.375 * slider.v_star * slider.dt_star;
    assert!(1.0 < peak + 1e-12 && peak < 1.0 + pull + 1e-12, "{peak}");
}

/// A disc has the area of a circle except for blocks along its rim, and the symmetry of a square.
#[test]
fn discs_are_round() {
    for across in 1..60 {
        let disc = Outline::disc(&Lattice::free(across, across), 0..across);
        let at = |i: usize, j: usize| disc[j * across + i];
        for j in 0..across {
            for i in 0..across {
                assert_eq!(at(i, j), at(j, i));
                assert_eq!(at(i, j), at(across - 1 - i, j));
            }
        }
        let area = disc.iter().filter(|&&exists| exists).count() as f64;
        let circle = 0.25 * std::f64::consts::PI * (across * across) as f64;
        // Gauss: the error is less than the number of blocks that the rim crosses, 4 per unit of the
        // diameter.
        assert!((area - circle).abs() < 4.0 * across as f64);
    }
    // As in the torsion of 20 blocks across: sum r^2/(r_max sum r) = 0.7577.
    let centre = |place: usize| place as f64 - 9.5;
    let disc = Outline::disc(&Lattice::free(20, 20), 0..20);
    let radii: Vec<f64> = (0..400)
        .filter(|&b| disc[b])
        .map(|b| centre(b % 20).hypot(centre(b / 20)))
        .collect();
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let [first, second] = [1, 2].map(|power| radii.iter().map(|r| r.powi(power)).sum::<f64>());
    assert!((second / (largest * first) - 0.7577).abs() < 5e-5);
}

/// Sliders that are made by hand, not by `Slider::new`, are refused where they cannot belong to the model.
#[test_case(
    Slider { stiffness: Some(vec![1.0; 5]), ..Slider::default() }, "the slider has 5 moduli for 4 blocks"
    ; "another lattice"
)]
#[test_case(
    Slider { drive_springs: None, ..within(vec![true, true, false, true]) },
    "block 2 does not exist, but has a drive"
    ; "no springs"
)]
#[test_case(Slider { outline: Some(Outline::new(vec![true, false, true, true], &Alone)), ..within(vec![true; 4]) },
    "block 1 does not exist, but has a drive spring"; "springs outside")]
fn impossible_sliders_are_refused(slider: Slider, words: &str) {
    let model = common::Slider {
        blocks: [2, 2],
        ..common::Slider::default()
    };
    let refused = std::panic::catch_unwind(|| model.model().with_slider(slider)).unwrap_err();
    let sentence = refused.downcast_ref::<String>().unwrap();
    assert!(sentence.contains(words), "{sentence}");
}
