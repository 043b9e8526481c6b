//! Measures of a run: the instants A-F, the end of the first peak, divergence, runs without an end.

use slipfront::communicator::Alone;
use slipfront::observe::frames::Selection;
use slipfront::observe::{
    Curve, Field, Instants, KineticHistory, KineticStart, Largest, Observer, Scheduled,
};
use slipfront::surface::{Coefficients, Load};
use slipfront::{Drive, FrictionLaw, Lattice, Model, RunError, State, Stop, StopReason, Surface};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, cavity, from_state};

fn textured() -> Slider {
    Slider {
        textures: vec![cavity([25, 25], 10.0, 1, 0.0, false)],
        ..Slider::default()
    }
}

/// A-F of Fig. 4 against their definitions, on the recorded curve.
#[test_case(Slider::default(), KineticStart::Auto; "baseline")]
#[test_case(textured(), KineticStart::Auto; "textured")]
#[test_case(Slider { v_star: 0.2, dt_star: 0.02, ..Slider::default() }, KineticStart::Auto; "fast")]
#[test_case(Slider::default(), KineticStart::At(200.0); "given start")]
#[test_case(
    Slider { v_star: 0.125, dt_star: 2.0 / 3.0 * 0.125, ..Slider::default() }, KineticStart::Auto
    ; "a falls on a step"
)]
fn instants_are_those_of_their_definitions(slider: Slider, kinetic: KineticStart) {
    let model = slider.model();
    let steps = slider.steps(8.0);
    let end = steps as f64 * slider.dt_star;
    let selection = Selection {
        fields: vec![Field::Sliding, Field::DisplacementX, Field::Traction],
        stride: 3,
    };
    let mut instants = Instants::new(selection.clone(), kinetic, end);
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut instants)])
        .unwrap();
    let first = simulation.peak().first_slip_drive_time_star;
    let peak = simulation.peak();
    let found = instants.found();
    let letters: String = found.iter().map(|(letter, _)| *letter).collect();
    assert_eq!(letters, "ABCDEF");
    let rows = slider.run(8.0).rows;
    let v = slider.v_star;
    let kinetic_from = kinetic.time_star(&peak, v);
    let first_at = |time: f64| rows.iter().position(|row| row.time_star >= time).unwrap() as u64;
    let after = |from: u64, to: f64| {
        rows.iter()
            .filter(move |row| row.step >= from && row.time_star <= to)
    };
    let most = after(peak.step, peak.time_star + 2.5 / v)
        .map(|row| row.point.n_sliding)
        .max()
        .unwrap();
    let d = after(peak.step, f64::INFINITY)
        .find(|row| row.point.n_sliding == most)
        .unwrap()
        .step;
    let least = after(d, kinetic_from)
        .map(|row| row.point.mu_star)
        .fold(f64::INFINITY, f64::min);
    let e = after(d, f64::INFINITY)
        .find(|row| row.point.mu_star == least)
        .unwrap()
        .step;
    let b = first_at(first.unwrap());
    let expected = [
        first_at(0.5 / v),
        b,
        peak.step,
        d,
        e,
        first_at(0.5 * (kinetic_from + end)),
    ];
    let steps: Vec<u64> = found.iter().map(|(_, frame)| frame.step).collect();
    assert_eq!(steps, expected);
    for (letter, frame) in &found {
        assert_eq!(frame.point, rows[frame.step as usize].point, "{letter}");
        assert_eq!(frame.values.len(), 3);
        assert!(frame.values.iter().all(|field| field.len() == 9 * 9));
        // The fields belong to the step of the curve: a run up to this step has the same fields.
        let mut again = at_rest(&model, slider.dt_star);
        again.run(Stop::at_step(frame.step), &mut []).unwrap();
        let exact = selection.capture(&again.snapshot());
        for (one, other) in frame.values.iter().flatten().zip(exact.values.iter().flatten()) {
            assert!(one == other || (one.is_nan() && other.is_nan()), "{letter}");
        }
    }
}

/// In a run that stays up (R* = 1, strong damping) there is no transition: the largest value is reported, and
/// D and E are missing.
#[test]
fn without_a_fall_there_is_no_transition() {
    let slider = Slider {
        r_star: 1.0,
        omega_star: 3.0,
        ..Slider::default()
    };
    let model = slider.model();
    let steps = slider.steps(8.0);
    let selection = Selection {
        fields: vec![Field::Sliding],
        stride: 1,
    };
    let mut instants = Instants::new(selection, KineticStart::Auto, steps as f64 * slider.dt_star);
    let mut simulation = at_rest(&model, slider.dt_star);
    simulation
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut instants)])
        .unwrap();
    let peak = simulation.peak();
    assert!(!peak.ended && peak.mu_star == peak.largest.mu_star);
    let letters: String = instants.found().iter().map(|(letter, _)| *letter).collect();
    assert_eq!(letters, "ABCF");
}

/// The run ends at the very step at which mu* has fallen half-way from its peak to the steady level.
#[test]
fn a_run_may_stop_as_soon_as_the_fall_is_seen() {
    let slider = Slider::default();
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let reason = simulation.run(Stop::after_onset(slider.steps(8.0)), &mut []);
    assert_eq!(reason, Ok(StopReason::Onset));
    let rows = slider.run(8.0).rows;
    let (step, peak) = (simulation.snapshot().step as usize, simulation.peak());
    let half_way = 0.5 * (peak.mu_star + model.steady_level(&Alone));
    assert!(rows[step].point.mu_star <= half_way && rows[step - 1].point.mu_star > half_way);
    let reason = at_rest(&model, slider.dt_star).run(Stop::after_onset(100), &mut []);
    assert_eq!(reason, Ok(StopReason::End));
}

/// Time is the step times dt*, to the last bit, for any length of the run.
#[test]
fn time_is_a_product() {
    let slider = Slider {
        blocks: [1, 1],
        ..Slider::default()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, 0.1);
    for step in 1..=10_000_u32 {
        simulation.step();
        assert_eq!(simulation.time_star(), f64::from(step) * 0.1);
    }
    let exact = 1000.0 * 0.03;
    assert_eq!(
        simulation.snapshot().model.drive.position(simulation.time_star()),
        [exact, 0.0]
    );
}

/// Beyond the limit of stability a run diverges, and names the block with the largest displacement: by then
/// squares of speeds are infinite, and displacements are still finite. Strains as large as the last two
/// stiffen springs beyond the stability limit of the step.
#[test_matrix([(1.0, 0.0), (1.0, 1e-6), (0.9, 1.0), (0.9, 1e3)])]
fn a_diverging_run_is_reported((dt_star, epsilon): (f64, f64)) {
    let slider = Slider {
        dt_star,
        epsilon,
        v_star: 10.0,
        omega_star: 0.0,
        r_star: 0.0,
        sigma_static_star: 1.0,
        ..textured()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let found = simulation.run(Stop::at_step(100_000), &mut []);
    let Err(RunError::NotFinite {
        step, i, j, value, ..
    }) = found
    else {
        panic!("it ran: {found:?}")
    };
    assert!(step < 100_000);
    let State { displacement, .. } = simulation.state();
    let sizes = displacement
        .x
        .iter()
        .zip(&displacement.y)
        .map(|(x, y)| x.abs().max(y.abs()));
    let largest = sizes.clone().fold(0.0, f64::max);
    // Speeds with infinite squares come from displacements of about that size.
    assert!(largest > 1e140 && largest.is_finite());
    assert_eq!(
        sizes.clone().position(|size| size == largest),
        Some(model.lattice.block(i, j))
    );
    assert_eq!(value.abs(), largest);
    let said = found.unwrap_err().to_string();
    assert!(said.contains("has diverged") && said.len() < 250, "{said}");
}

/// NaN forces hold blocks that do not move: the run still ends before its first step.
#[test_matrix([0.0, 1e-6, 1e3])]
fn a_state_too_large_to_compute_with_is_reported(epsilon: f64) {
    let slider = Slider {
        blocks: [5, 5],
        epsilon,
        ..Slider::default()
    };
    let mut state = State::at_rest(25);
    state.displacement.y[7] = -1e200;
    let found = from_state(&slider.model(), slider.dt_star, state).run(Stop::at_step(0), &mut []);
    let Err(RunError::NotFinite {
        step: 0,
        i: 2,
        j: 1,
        value: -1e200,
        ..
    }) = found
    else {
        panic!("{found:?}")
    };
}

/// A state at the start of a run must be finite.
#[test_matrix([f64::NAN, f64::INFINITY, f64::NEG_INFINITY], [0, 1, 2, 3])]
#[should_panic(expected = "of the state to begin with is not finite")]
fn a_state_that_is_not_finite_is_refused(bad: f64, place: usize) {
    let slider = Slider {
        blocks: [5, 5],
        ..Slider::default()
    };
    let mut state = State::at_rest(25);
    let State {
        displacement,
        velocity,
    } = &mut state;
    [
        &mut displacement.x,
        &mut displacement.y,
        &mut velocity.x,
        &mut velocity.y,
    ][place][24] = bad;
    from_state(&slider.model(), slider.dt_star, state);
}

/// Eq. 9 as printed: the sum of the drive springs' forces over the load, along the drive and to its left.
#[test]
fn mu_star_is_the_mean_pull_along_and_across_the_drive() {
    let slider = Slider {
        degrees: 30.0,
        ..textured()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, slider.dt_star);
    let mut lateral = 0.0_f64;
    for _ in 0..1500 {
        simulation.step();
        let now = simulation.snapshot();
        let mean = |axis: usize| (0..625).map(|b| now.block(b).force_drive[axis]).sum::<f64>() / 625.0;
        let pull = [mean(0), mean(1)];
        let (s, c) = 30.0_f64.to_radians().sin_cos();
        assert!((now.point.mu_star - (pull[0] * c + pull[1] * s)).abs() < 1e-13);
        assert!((now.point.mu_lateral_star - (pull[1] * c - pull[0] * s)).abs() < 1e-13);
        lateral = lateral.max(now.point.mu_lateral_star.abs());
    }
    assert!(lateral > 1e-4, "there is something across to be seen: {lateral}");
}

/// D is searched for up to t_s* + 2.5/V* and E up to the kinetic window, and later values do not count. The
/// later part of the curve is invented, because N* and mu* of a real run rarely reach such values again.
#[test]
fn what_comes_after_the_windows_is_neither_d_nor_e() {
    let slider = Slider {
        blocks: [5, 5],
        ..Slider::default()
    };
    let model = slider.model();
    let selection = Selection {
        fields: vec![],
        stride: 1,
    };
    for (kinetic, e_until) in [(KineticStart::Auto, 2.5), (KineticStart::At(220.0), 220.0)] {
        let mut instants = Instants::new(selection.clone(), kinetic, 267.0);
        let mut simulation = at_rest(&model, slider.dt_star);
        simulation
            .run(
                Stop::after_onset(slider.steps(8.0)),
                &mut [Scheduled::always(&mut instants)],
            )
            .unwrap();
        let peak = simulation.peak();
        assert!(peak.ended);
        let d_until = peak.time_star + 2.5 / slider.v_star;
        let e_until = if kinetic == KineticStart::Auto {
            d_until
        } else {
            e_until
        };
        // Just inside each window N* or mu* is extreme, and later even more so.
        for step in simulation.snapshot().step + 1..=2670 {
            let mut now = simulation.snapshot();
            now.step = step;
            now.time_star = step as f64 * slider.dt_star;
            now.drive_time_star = now.time_star;
            now.point.sliding_percent = if now.time_star <= d_until - 20.0 {
                0.0
            } else {
                100.0 + step as f64
            };
            now.point.mu_star = -0.001 * step as f64;
            instants.observe(&now).unwrap();
        }
        let found = instants.found();
        let time = |letter| found.iter().find(|(l, _)| *l == letter).unwrap().1.time_star;
        assert!(
            (d_until - 0.11..=d_until).contains(&time('D')),
            "{} {d_until}",
            time('D')
        );
        assert!(
            (e_until - 0.11..=e_until).contains(&time('E')),
            "{} {e_until}",
            time('E')
        );
    }
}

/// A run without an end is advanced as long as its user likes, and gives the same results as a run of known
/// length.
#[test]
fn a_run_without_an_end_is_a_run_of_known_length_that_has_not_ended() {
    let slider = Slider::default();
    let steps = slider.steps(8.0);
    let mut expected = KineticHistory::new(steps);
    let mut whole = at_rest(&slider.model(), slider.dt_star);
    whole
        .run(Stop::at_step(steps), &mut [Scheduled::always(&mut expected)])
        .unwrap();

    let mut history = KineticHistory::new(u64::MAX);
    let mut endless = at_rest(&slider.model(), slider.dt_star);
    for part in [1, 1000, steps - 1001] {
        let ended = endless.advance(Stop::never(), part, &mut [Scheduled::always(&mut history)]);
        assert_eq!(ended, Ok(None));
    }
    assert_eq!(endless.snapshot().step, steps);
    assert_eq!(endless.state(), whole.state());
    assert_eq!(endless.peak(), whole.peak());
    assert_eq!(
        history.kinetic(200.0, slider.dt_star, slider.v_star),
        expected.kinetic(200.0, slider.dt_star, slider.v_star)
    );
    assert!(history.kinetic(200.0, slider.dt_star, slider.v_star).is_some());
}

/// Bars that an evolutionary search has placed so that mu* ripples just above the level of sliding, at
/// 0.5005, and falls half-way to it, a fifth below its peak. A rule in which any fall of half-way ends the
/// first peak returns 0.5005. (Four bars of three blocks, 600 tries; L = 0.5, and a surface without texture
/// gives 1.)
#[test]
fn a_search_that_cheats_the_first_peak_is_not_rewarded() {
    let lattice = Lattice::free(50, 50);
    let rows = include_str!("first_peak_mask.txt").lines().rev();
    let textured: Vec<bool> = rows
        .flat_map(|row| row.bytes().map(|mark| mark == b'#'))
        .collect();
    let given = Coefficients::given(vec![1.0; 2500], vec![0.5; 2500]);
    let surface = Surface::new(given, textured, Load::Redistributed, 1.0).unwrap();
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.005),
        0.1,
        1e-6,
        FrictionLaw::Projection,
    );
    let level = model.steady_level(&Alone);
    let mut simulation = at_rest(&model, 0.1);
    let mut curve = Curve::every(1);
    simulation
        .run(Stop::at_step(6000), &mut [Scheduled::always(&mut curve)])
        .unwrap();
    let mut largest = 0.0;
    let by_half_way_alone = curve.rows.iter().find_map(|row| {
        let mu_star = row.point.mu_star;
        largest = mu_star.max(largest);
        (largest > level && mu_star <= 0.5 * (largest + level)).then_some((largest, row.time_star))
    });
    let (ripple, fall) = by_half_way_alone.unwrap();
    assert!(ripple < 0.51, "{ripple}");
    let peak = simulation.peak();
    assert!(
        peak.ended && peak.mu_star > 0.59 && peak.mu_star == peak.largest.mu_star,
        "{peak:?}"
    );
    // The largest mu* until a path is the ripple if the path ends there, and the peak if the path covers the
    // whole run.
    let (mut until_the_fall, mut until_the_end) = (Largest::until(0.005 * fall), Largest::until(3.0));
    at_rest(&model, 0.1)
        .run(
            Stop::at_step(6000),
            &mut [
                Scheduled::always(&mut until_the_fall),
                Scheduled::always(&mut until_the_end),
            ],
        )
        .unwrap();
    assert!(until_the_fall.is_complete());
    assert_eq!(
        [until_the_fall.mu_star, until_the_end.mu_star],
        [ripple, peak.mu_star]
    );
    assert_eq!(until_the_end.time_star, peak.time_star);
}
