//! A rigid slider on a spring, in newtons, metres and seconds.

use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;

/// A slider of 30.7 g and 0.301 N on a spring of 168 N/m, pulled at 1.1 mm/s, of this size, density and
/// pressure.
fn case(size: &str, density: f64, pressure: f64) -> Case {
    let text = format!(
        "slider = {{ rigid = true, blocks = [1, 1], block_size = '{size}', density = '{density:e} kg/m^3', damping_rate = '10 1/s' }}\n\
         load.pressure = '{pressure:e} Pa'\ndrive = {{ speed = '1.1 mm/s', total_stiffness = '168 N/m' }}\ntime.duration = '5 s'\n\
         friction = {{ mu_static = 0.4, r_star = 0.8, sigma_static_star = 0, sigma_kinetic_star = 0 }}\n"
    );
    Case::parse(&text, "rigid", "", &[]).unwrap()
}

/// Slip begins when the spring bears mu_s times the weight, at t = mu_s W/(k V), and the size has no effect
/// at equal mass and weight.
#[test]
fn its_size_has_no_effect() {
    let (mass, weight) = (30.7e-3, 0.301);
    let of_size = |size: &str, metres: f64| {
        let case = case(size, mass / metres.powi(3), weight / metres.powi(2));
        assert!(case.warnings().is_empty(), "{:?}", case.warnings());
        (
            case.time_plan.dt_star * case.scales.time(),
            run_summary(&case).unwrap(),
        )
    };
    let (step, small) = of_size("1 mm", 1e-3);
    let (_, large) = of_size("4 cm", 4e-2);
    let onset = 0.4 * weight / (168.0 * 1.1e-3);
    assert!(
        (small.onset_time_s - onset).abs() < 2.0 * step,
        "{} for {onset}",
        small.onset_time_s
    );
    // Rounding of the units alone.
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9 * b;
    assert!(near(small.onset_time_s, large.onset_time_s));
    assert!(near(small.static_friction, large.static_friction));
    assert!(near(
        small.kinetic_friction.unwrap(),
        large.kinetic_friction.unwrap()
    ));
}

#[test]
fn it_is_one_block_on_a_spring() {
    for (change, sentence) in [
        ("slider.blocks=[2,2]", "a rigid slider is one block"),
        (
            "slider.young_modulus='1 GPa'",
            "a rigid slider has none: leave it out",
        ),
    ] {
        let text = "slider = { rigid = true, blocks = [1, 1] }\ndrive.total_stiffness = '168 N/m'";
        let error = Case::parse(text, "rigid", "", &[change.to_owned()])
            .unwrap_err()
            .to_string();
        assert!(error.contains(sentence), "{change}: {error}");
    }
    let text = "slider = { rigid = true, blocks = [1, 1] }";
    let error = Case::parse(text, "rigid", "", &[]).unwrap_err().to_string();
    assert!(error.contains("give it in N/m"), "{error}");
}
