//! Speeds that `check` proposes, against runs at these speeds and the limit of slow loading.

use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;

const CAVITY: &str = "texture=[{shape='cavity', coverage=10}]";

fn case(changes: &[&str]) -> Case {
    let text = "slider.blocks = [25, 25]\ntime.stop = 'after_onset'\nfriction.sigma_static_star = 0.05";
    let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
    Case::parse(text, "case", "", &changes).unwrap()
}

/// The numbers of the speed of a case and of its multiples: V* N, k_2 V* N + 0.005 and Omega V*/R* with Omega
/// = sqrt(0.75) Omega*; the path is held.
#[test]
fn a_speed_has_the_numbers_of_its_formulas() {
    let given = case(&["time.stop='end'"]).loading_speed().unwrap();
    assert_eq!(given.steps.steps, [2667.0; 2]);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-3 * b;
    assert!(near(given.steps.front_ratio, 0.75));
    assert!(near(given.static_bound(), 0.375 * 0.75 + 0.005));
    assert!(near(given.drag_share, 0.75_f64.sqrt() * 0.1 * 0.03 / 0.5));
    let slow = given.times(given.factor_to_slow());
    assert!(near(slow.static_bound(), 0.01) && slow.drag_share < 0.005);
    assert!(near(slow.steps.steps[0], 2667.0 * 0.375 * 0.75 / 0.005));
    // On soft springs the drag decides.
    let soft = case(&["drive.stiffness_star=1e-4"]).loading_speed().unwrap();
    let slow = soft.times(soft.factor_to_slow());
    assert!(near(slow.drag_share, 0.005) && slow.static_bound() < 0.006);
    // Without kinetic friction drag is compared with a tenth of static friction.
    let without = case(&["friction.r_star=0", "friction.sigma_static_star=0"])
        .loading_speed()
        .unwrap();
    assert!(without.is_share_of_static && !given.is_share_of_static);
    assert!(near(without.drag_share, 0.75_f64.sqrt() * 0.1 * 0.03 / 0.1));
}

/// No other speed is proposed if the speed is part of the physics.
#[test]
fn a_speed_that_matters_has_no_others() {
    for change in [
        "friction.velocity={law='weakening', v_c_star=0.1, ratio=0.5}",
        "friction.ageing={law='logarithmic', beta=0.02, time_star=1}",
        "drive={program=[{v_star=0.03, until_star=50}, {v_star=0.1}]}",
        "drive.loading='held'",
        "time.step='paper'",
    ] {
        assert_eq!(case(&[change]).loading_speed(), None, "{change}");
    }
}

/// Static friction is within the bound at the speed of the case and at the one that is slow enough; there the
/// bound is one point, which the speed of the case misses by far.
#[test]
fn static_friction_is_within_the_bound_of_its_speed() {
    for texture in ["texture=[]", CAVITY] {
        let held = ["drive.loading='held'", "drive.v_star=0.003", texture];
        let limit = run_summary(&case(&held)).unwrap().static_friction_star;
        let given = case(&[texture]);
        let speed = given.loading_speed().unwrap();
        let factor = speed.factor_to_slow();
        let slow = format!("drive.v_star={}", factor * given.groups.v_star);
        let off = |case: &Case| (run_summary(case).unwrap().static_friction_star - limit).abs();
        assert!(off(&given) < speed.static_bound());
        let slow_bound = speed.times(factor).static_bound();
        assert!((off(&case(&[texture, &slow])) < slow_bound) && off(&given) > slow_bound);
    }
}
