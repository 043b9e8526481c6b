//! Claims of the paper (doi 10.1016/j.triboint.2023.108866) that one run or a few runs can show.
//!
//! Numbers in comments come from one surface in an independent program. Tolerances are three standard
//! deviations of the same quantity over ten surfaces of this program, unless a comment says otherwise.

use slipfront::communicator::Alone;
use slipfront::surface::{Coefficients, Distribution, Load, Orientation, Texture};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Scales, Surface, scales};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, cavity, groove};

/// The slider of the texture figures: 50 x 50 blocks, sigma_s* = 0.
fn textured(textures: Vec<Texture>, seed: u64) -> Slider {
    Slider {
        blocks: [50, 50],
        textures,
        sigma_static_star: 0.0,
        seed,
        ..Slider::default()
    }
}

/// Reduction of mu_s* in % (Eq. 16), compared with the same surface without texture.
fn reduction(slider: &Slider) -> f64 {
    let plain = Slider {
        textures: Vec::new(),
        ..slider.clone()
    };
    let (with, without) = (slider.onset(), plain.onset());
    assert!(with.ended && without.ended, "both have a transition");
    100.0 * (1.0 - with.mu_star / without.mu_star)
}

fn middle(percent: f64, s: u32, w: f64, across: bool) -> Texture {
    cavity([50, 50], percent, s, w, across)
}

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// Standard deviation of a sample.
fn scatter(x: &[f64]) -> f64 {
    let center = mean(x);
    (x.iter().map(|x| (x - center).powi(2)).sum::<f64>() / (x.len() - 1) as f64).sqrt()
}

/// Sections 3.2 and 3.3. With sigma_s* = 0 only kinetic coefficients scatter, and reductions by 0.04 to 0.13;
/// by 0.33 for the smallest cavity. The different step, 0.1 here and 0.02 there, changes them by as much
/// again.
#[test_case(middle(10.0, 1, 0.0, false), 31.1, 0.5; "circle")]
#[test_case(middle(1.0, 1, 0.0, false), 22.7, 1.2; "small circle is already remarkable")]
#[test_case(middle(30.0, 1, 0.0, false), 37.0, 0.7; "large circle takes more than 35")]
#[test_case(groove(Orientation::Across, 5.0), 37.6, 0.5; "groove across")]
#[test_case(groove(Orientation::Along, 5.0), 31.0, 0.5; "groove along is like the circle")]
#[test_case(middle(10.0, 1, 0.6, true), 34.5, 0.5; "elongated across")]
#[test_case(middle(10.0, 1, 0.6, false), 30.3, 0.5; "elongated along")]
fn textures_reduce_static_friction(texture: Texture, claimed: f64, tolerance: f64) {
    for seed in [1, 2] {
        let found = reduction(&textured(vec![texture.clone()], seed));
        assert!(
            (found - claimed).abs() < tolerance,
            "{found} %, claimed {claimed} %"
        );
    }
}

/// Elongation across the sliding direction improves a cavity, and along it slightly worsens it: by many times
/// the scatter.
#[test]
fn elongation_across_improves_and_along_worsens() {
    let [across, circle, along] = [(0.6, true), (0.0, false), (0.6, false)]
        .map(|(w, a)| reduction(&textured(vec![middle(10.0, 1, w, a)], 3)));
    assert!(
        across > circle + 2.0 && along < circle - 0.3,
        "{across} {circle} {along}"
    );
    let steps = [0.2, 0.4, 0.6].map(|w| reduction(&textured(vec![middle(10.0, 1, w, true)], 3)));
    assert!(steps.is_sorted() && steps[0] > circle - 0.4, "{steps:?}");
}

/// Fig. 18: neither the number nor the sharpness of vertices matters much: 30.7 to 33.7, with a scatter of
/// 0.13.
#[test_matrix([2, 3, 4], [1.0, 0.2])]
fn shapes_make_no_notable_difference(s: u32, sharpness: f64) {
    let found = reduction(&textured(
        vec![middle(10.0, s, sharpness / f64::from(s), false)],
        1,
    ));
    assert!((30.3..34.1).contains(&found), "s = {s}: {found} %");
}

/// Without scatter of kinetic coefficients nothing is random; 37.4 is rounded, and belongs to another step.
#[test]
fn a_groove_without_any_scatter() {
    let slider = Slider {
        sigma_kinetic_star: 0.0,
        dt_star: 0.05,
        ..textured(vec![groove(Orientation::Across, 5.0)], 1)
    };
    let found = reduction(&slider);
    assert!((found - 37.4).abs() < 0.15, "{found} %");
}

/// With grooves on periodic edges, mu* climbs higher than the first peak in the next cycle, so that the rule
/// of the first peak matters. By how much depends on the step, since nothing breaks the symmetry along the
/// groove: 1.3 % at 0.02, 2.3 % at 0.1, 4 % in the other program.
#[test]
fn a_groove_on_periodic_edges_climbs_higher_later() {
    let slider = Slider {
        edges: [Edges::Periodic; 2],
        sigma_kinetic_star: 0.0,
        ..textured(vec![groove(Orientation::Across, 5.0)], 1)
    };
    let peak = slider.summary(8.0).0;
    assert!(peak.ended && (1.5..1.9).contains(&(peak.time_star * slider.v_star)));
    let excess = peak.largest.mu_star / peak.mu_star - 1.0;
    assert!((0.005..0.05).contains(&excess), "{excess}");
    assert!((reduction(&slider) - 37.3).abs() < 0.3);
}

/// D9: the 31 % hold only at V* = 0.03 and 50 blocks. The scatter is 0.1, and the step changes as much.
#[test_case(25, 0.03, 32.5)]
#[test_case(100, 0.03, 26.1)]
#[test_case(50, 0.01, 34.9)]
#[test_case(50, 0.05, 27.4)]
#[test_case(50, 0.1, 19.9)]
fn a_cavity_acts_less_on_large_and_fast_sliders(n: usize, v_star: f64, claimed: f64) {
    let slider = Slider {
        blocks: [n, n],
        v_star,
        ..textured(vec![cavity([n, n], 10.0, 1, 0.0, false)], 1)
    };
    let found = reduction(&slider);
    assert!((found - claimed).abs() < 0.6, "{found} %, claimed {claimed} %");
}

/// Fig. 16: rough surfaces gain less. Differences are 7 and more, with a scatter of up to 1.
#[test]
fn static_scatter_attenuates_the_effect_of_a_texture() {
    let found = [0.0, 0.05, 0.1, 0.2].map(|sigma_static_star| {
        reduction(&Slider {
            sigma_static_star,
            ..textured(vec![middle(10.0, 1, 0.0, false)], 1)
        })
    });
    assert!(found.windows(2).all(|pair| pair[1] < pair[0] - 3.0), "{found:?}");
}

/// Without redistributing the texture's load, the cavity would reduce mu_s* by 37 %.
#[test]
fn without_redistribution_the_cavity_takes_37_percent() {
    let kept = Slider {
        load: Load::Kept,
        ..textured(vec![middle(10.0, 1, 0.0, false)], 1)
    };
    let found = reduction(&kept);
    assert!((found - 37.0).abs() < 0.6, "{found} %");
}

fn over_seeds(slider: &Slider, quantity: impl Fn(&Slider) -> f64) -> Vec<f64> {
    let seeds = 1..=6;
    seeds
        .map(|seed| {
            quantity(&Slider {
                seed,
                ..slider.clone()
            })
        })
        .collect()
}

/// Fig. 5 and 6: mu_s* rises with V* towards 1, and t_s* is nearly (5/2)/V*. `scatter`: of mu_s* over ten
/// seeds; the difference of a mean of six seeds from a single seed has 1.08 times this scatter.
#[test_case(0.01, 0.859, 0.0164, 2.28)]
#[test_case(0.02, 0.872, 0.0142, 2.33)]
#[test_case(0.03, 0.883, 0.0114, 2.37)]
#[test_case(0.05, 0.901, 0.0079, 2.43)]
#[test_case(0.1, 0.932, 0.0043, 2.53)]
#[test_case(0.2, 0.971, 0.0026, 2.67)]
fn static_friction_and_its_time_depend_on_speed(v_star: f64, claimed: f64, scatter: f64, turns: f64) {
    let slider = Slider {
        v_star,
        ..Slider::default()
    };
    let peaks: Vec<_> = (1..=6)
        .map(|seed| {
            Slider {
                seed,
                ..slider.clone()
            }
            .onset()
        })
        .collect();
    let mu = mean(&peaks.iter().map(|p| p.mu_star).collect::<Vec<_>>());
    assert!(
        (mu - claimed).abs() < 3.0 * 1.08 * scatter,
        "mu_s* = {mu}, claimed {claimed}"
    );
    // t_s* V* = (8/3) mu_s*, except for blocks that have slipped already, and it scatters as mu_s* does.
    let time = mean(&peaks.iter().map(|p| p.time_star * v_star).collect::<Vec<_>>());
    assert!(
        (time - turns).abs() < 3.0 * 8.0 / 3.0 * scatter,
        "t_s* V* = {time}, claimed {turns}"
    );
    assert!(
        (time - 2.5).abs() < 0.25,
        "t_s* = (5/2)/V* within a tenth: {time}"
    );
}

/// The surface stays the same and the speed rises: no scatter affects the comparison.
#[test]
fn static_friction_rises_with_speed_on_every_surface() {
    for seed in [1, 2, 3] {
        let found = [0.01, 0.03, 0.1, 0.2, 0.5].map(|v_star| {
            Slider {
                v_star,
                seed,
                ..Slider::default()
            }
            .onset()
            .mu_star
        });
        assert!(found.is_sorted(), "{found:?}");
        assert!(found[4] > 0.98, "towards 1: {found:?}");
    }
}

/// Fig. 10: mu_s* falls with sigma_s*. At sigma_s* = 0 all blocks slip at once, and only the slip's own k_s
/// V^2/(2 (1 - R)) and a step's k_s V dt exceed 1.
#[test_case(0.0, 1.000, 0.0004)]
#[test_case(0.01, 0.980, 0.0020)]
#[test_case(0.025, 0.941, 0.0063)]
#[test_case(0.05, 0.878, 0.0114)]
#[test_case(0.1, 0.806, 0.0083)]
#[test_case(0.2, 0.752, 0.0065)]
fn static_friction_falls_with_scatter(sigma_static_star: f64, claimed: f64, scatter: f64) {
    let slider = Slider {
        sigma_static_star,
        ..Slider::default()
    };
    let found = mean(&over_seeds(&slider, |s| s.onset().mu_star));
    assert!(
        (found - claimed).abs() < 3.0 * 1.08 * scatter,
        "{found}, claimed {claimed}"
    );
}

/// Over five random surfaces the paper finds a deviation of less than 0.015. This holds for the standard
/// deviation, 0.013 here; the farthest of five may be 0.024 from their mean.
#[test]
fn five_surfaces_deviate_by_less_than_0_015() {
    let found: Vec<f64> = (1..=5)
        .map(|seed| {
            Slider {
                seed,
                ..Slider::default()
            }
            .onset()
            .mu_star
        })
        .collect();
    assert!(scatter(&found) < 0.015, "{found:?}");
    assert!(
        found.iter().all(|mu| (mu - mean(&found)).abs() < 0.03),
        "{found:?}"
    );
}

/// Fig. 7: mu_k* is about R*, somewhat larger, and more so at R* = 0.25 (D8). Its scatter over seeds is
/// 0.0013 to 0.0053.
#[test_case(0.25, 0.305, 0.016)]
#[test_case(0.5, 0.529, 0.006)]
#[test_case(0.75, 0.765, 0.006)]
fn kinetic_friction_is_about_r_star(r_star: f64, claimed: f64, tolerance: f64) {
    for seed in [1, 2] {
        let slider = Slider {
            r_star,
            seed,
            ..Slider::default()
        };
        let found = slider.summary(8.0).1.unwrap().mu_star;
        assert!((found - claimed).abs() < tolerance, "{found}, claimed {claimed}");
        assert!(found > r_star);
    }
}

/// Fig. 8: at Omega* >= 1 stick-slip ends and all blocks slide. At exactly Omega* = 1, one block in 600 still
/// sticks on some surfaces; at 2 and 3 none does. Below 1, a tenth of the blocks slide at a time.
#[test_case(0.1, 10.0, 20.0)]
#[test_case(1.0, 99.0, 100.0)]
#[test_case(2.0, 100.0, 100.0)]
#[test_case(3.0, 100.0, 100.0)]
fn strong_damping_ends_stick_slip(omega_star: f64, least: f64, most: f64) {
    for seed in [1, 2] {
        let slider = Slider {
            omega_star,
            seed,
            ..Slider::default()
        };
        let kinetic = slider.summary(8.0).1.unwrap();
        assert!(
            (least..=most).contains(&kinetic.sliding_percent),
            "{}",
            kinetic.sliding_percent
        );
        let above = kinetic.mu_star - slider.model().steady_level(&Alone);
        assert!(
            omega_star < 1.0 || above.abs() < 2e-3,
            "{above} above steady sliding"
        );
    }
}

/// Eq. 14: number of steps before slip with the paper's step (2/3) V*, within the few % by which t_s* V*
/// differs from 5/2.
#[test_matrix([0.05, 0.1, 0.2])]
fn steps_before_slip(v_star: f64) {
    let slider = Slider {
        v_star,
        dt_star: 2.0 / 3.0 * v_star,
        ..Slider::default()
    };
    let found = slider.onset().step as f64;
    assert!(
        (found * v_star * v_star / (15.0 / 4.0) - 1.0).abs() < 0.08,
        "{found}"
    );
}

/// mu_s* of the same surface agrees within 3e-4 at steps from 0.002 to 0.05, and so does 0.1 on two surfaces
/// of three (within 4e-4 on the first): there mu* rises by k_s V dt = 1.1e-3 per step, at which events occur.
#[test_case(1, 4.5e-4)]
#[test_case(2, 3e-4)]
#[test_case(3, 3e-4)]
fn static_friction_does_not_depend_on_the_step(seed: u64, at_a_tenth: f64) {
    let at = |dt_star| {
        Slider {
            dt_star,
            seed,
            ..Slider::default()
        }
        .onset()
        .mu_star
    };
    let exact = at(0.004);
    for dt_star in [0.01, 0.02, 0.05] {
        assert!(
            (at(dt_star) - exact).abs() < 3e-4,
            "{} at {dt_star}, {exact}",
            at(dt_star)
        );
    }
    assert!((at(0.1) - exact).abs() < at_a_tenth, "{}, {exact}", at(0.1));
}

/// The paper cannot have used Eq. 4 to the letter: at its step of 0.02, mu_k* = 0.97, all blocks slide
/// forever, and there is no transition. (mu_k* is 0.64 at a step of 0.1, with a transition, 0.90 at 0.05, and
/// 0.998 at 0.005: it tends to 1.)
#[test]
fn the_literal_law_never_comes_down() {
    let slider = Slider {
        law: FrictionLaw::Literal,
        dt_star: 0.02,
        ..Slider::default()
    };
    let (peak, kinetic) = slider.summary(8.0);
    let kinetic = kinetic.unwrap();
    assert!((kinetic.mu_star - 0.97).abs() < 0.01, "{}", kinetic.mu_star);
    assert_eq!(kinetic.sliding_percent, 100.0);
    assert!(!peak.ended);
}

/// The two readings with memory agree on mu_s* to 1e-6 on most surfaces, and to 3e-5 on all of these; they
/// agree on mu_k* within its scatter of 0.002.
#[test]
fn implicit_and_explicit_friction_agree() {
    let with = |law, seed| {
        Slider {
            law,
            seed,
            dt_star: 0.05,
            ..Slider::default()
        }
        .summary(8.0)
    };
    for seed in [1, 2, 3] {
        let (one, other) = (
            with(FrictionLaw::Projection, seed),
            with(FrictionLaw::Reversal, seed),
        );
        let difference = (one.0.mu_star - other.0.mu_star).abs();
        assert!(difference < 1e-4, "{difference}");
        let difference = (one.1.unwrap().mu_star - other.1.unwrap().mu_star).abs();
        assert!(difference < 3.0 * 2.0_f64.sqrt() * 0.002, "{difference}");
    }
}

/// D7: at V* = 0.2 the slider oscillates as a whole, sticking and slipping, at any stable time step.
#[test_matrix([0.02, 0.1, 0.2, 0.4])]
fn fast_drives_swing_the_slider_at_any_step(dt_star: f64) {
    let slider = Slider {
        v_star: 0.2,
        dt_star,
        ..Slider::default()
    };
    let outcome = slider.run(16.0);
    let kinetic = outcome.kinetic.unwrap();
    assert!((kinetic.mu_star - 0.547).abs() < 0.006, "{}", kinetic.mu_star);
    let late = outcome
        .rows
        .iter()
        .filter(|row| row.time_star > 40.0)
        .map(|row| row.point);
    let (mut least, mut most, mut mu) = (100.0_f64, 0.0_f64, [f64::INFINITY, f64::NEG_INFINITY]);
    for point in late {
        (least, most) = (least.min(point.sliding_percent), most.max(point.sliding_percent));
        mu = [mu[0].min(point.mu_star), mu[1].max(point.mu_star)];
    }
    assert!(
        least < 25.0 && most > 75.0 && mu[1] - mu[0] > 0.1,
        "{least} {most} {mu:?}"
    );
}

/// A row of Table 1: V in mm/s, P in kPa, E in MPa, rho in g/cm^3, mean mu_s.
struct Row(f64, f64, f64, f64, f64);

const TABLE_1: [Row; 8] = [
    Row(0.0949, 0.1, 1.0, 1.0, 1.0),
    Row(0.9490, 1.0, 10.0, 0.1, 1.0),
    Row(1.8980, 2.0, 0.1, 10.0, 2.0),
    Row(0.9490, 0.1, 1.0, 0.01, 1.0),
    Row(4.7450, 1e3, 1e4, 4.0, 1.0),
    Row(0.1898, 2.0, 1e3, 0.1, 3.0),
    Row(0.9490, 10.0, 1e2, 1.0, 2.0),
    Row(0.0949, 1e2, 1e5, 10.0, 1.0),
];

/// Speeds that give V* = 0.03 by Eq. 11a (D3).
const CORRECTED: [(usize, f64); 3] = [(2, 3.796), (5, 0.5694), (6, 1.898)];

fn table_1(case: usize, corrected: bool) -> Model {
    let Row(mut speed, pressure, young, density, mean) = TABLE_1[case];
    if corrected {
        speed = CORRECTED.iter().find(|c| c.0 == case).map_or(speed, |c| c.1);
    }
    let scales = Scales {
        block_size: 1e-6,
        thickness: 1e-6,
        contact_width: 1e-6,
        young_modulus: young * 1e6,
        density: density * 1e3,
        pressure: pressure * 1e3,
        mu_static_mean: mean,
    };
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let lattice = Lattice::free(25, 25);
    let drawn = Coefficients::draw(625, gauss(mean), gauss(0.5 * mean), 1);
    let surface = Surface::new(drawn, vec![false; 625], Load::Redistributed, mean).unwrap();
    let drive = Drive::along_x(speed * 1e-3 / scales.speed());
    let damping = scales::damping(0.1);
    Model::new(
        lattice,
        surface,
        drive,
        damping,
        scales.epsilon(),
        FrictionLaw::Projection,
    )
}

/// Largest difference of mu* from case 8 at the same times t* up to the end of the transition.
fn difference_from_case_8(case: usize, corrected: bool) -> f64 {
    let (one, other) = (table_1(case, corrected), table_1(7, false));
    let (mut one, mut other) = (at_rest(&one, 0.1), at_rest(&other, 0.1));
    let mut largest = 0.0_f64;
    while !other.peak().ended {
        assert!(other.time_star() < 200.0, "no transition");
        one.step();
        other.step();
        largest = largest.max((one.snapshot().point.mu_star - other.snapshot().point.mu_star).abs());
    }
    largest
}

/// Fig. 3: the eight cases coincide before and through the transition. All have V* = 0.03001 to every digit,
/// so that only the strain differs: eps = 1e-6 to 2e-4 changes mu* by 1e-4 eps, the 0.04 of case 3 by 0.01
/// eps.
#[test_matrix([0, 1, 2, 3, 4, 5, 6])]
fn the_cases_of_table_1_coincide(case: usize) {
    let model = table_1(case, true);
    assert!(
        (model.drive.v_star - 0.03).abs() < 3e-5,
        "V* = {}",
        model.drive.v_star
    );
    let found = difference_from_case_8(case, true);
    let bound = 1e-9 + 0.02 * model.epsilon;
    assert!(found < bound, "{found} at eps = {}", model.epsilon);
}

/// D3: cases 3, 6 and 7 as printed have V* = 0.015, 0.010, 0.015, and different curves.
#[test_case(2, 0.015)]
#[test_case(5, 0.010)]
#[test_case(6, 0.015)]
fn three_cases_of_table_1_do_not_coincide_as_printed(case: usize, v_star: f64) {
    let found = table_1(case, false).drive.v_star;
    assert!((found - v_star).abs() < 1e-5, "{found}");
    assert!(difference_from_case_8(case, false) > 0.3);
}
