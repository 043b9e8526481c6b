//! Laws of friction in a case file.

use slipfront::{
    AfterBreak, Ageing, ContactSprings, Coulomb, Friction, FrictionLaw, Kernel, RateAndState, Weakening,
};
use slipfront_case::case::Case;

fn case(text: &str) -> Case {
    Case::parse(text, "case", "", &[]).unwrap_or_else(|error| panic!("{error}"))
}

const RATE_AND_STATE: &str = "friction = { law = 'rate_and_state', mu_static = 0.5, a = 0.01, b = 0.02, d_c_star = 0.5, v_0_star = 0.02 }";

/// Coefficients are relative to `mu_static`; missing ones follow from the others.
#[test]
fn keys_become_the_law_in_units_of_the_model() {
    let velocity = "velocity = { law = 'weakening', v_c_star = 0.1, ratio = 0.4 }";
    let ageing = "ageing = { law = 'logarithmic', beta = 0.02, time_star = 3 }";
    let varying = case(&format!("[friction]\n{velocity}\n{ageing}\n"));
    let coulomb = Coulomb {
        law: FrictionLaw::Projection,
        weakening: Some(Weakening {
            critical_speed: 0.1,
            ratio: 0.4,
        }),
        ageing: Some(Ageing {
            beta: 0.02,
            time: 3.0,
        }),
        slip_weakening: None,
        interface: None,
    };
    assert_eq!(varying.model.friction, Friction::Coulomb(coulomb));

    // The unit of displacement is 1 pm. It is 40 times as large on a sheet of 10 um under blocks of 20 um.
    let slips = |slider: &str| {
        let text = "friction = { slip_weakening = { length = '20 pm' }, healing_time_star = 7 }";
        match case(&format!("{slider}{text}")).model.friction {
            Friction::Coulomb(coulomb) => coulomb.slip_weakening.unwrap(),
            other => panic!("{other:?}"),
        }
    };
    let sheet = "slider = { block_size = '20 um', thickness = '10 um' }\n";
    for (slider, length) in [("", 20.0), (sheet, 0.5)] {
        let law = slips(slider);
        assert!((law.length / length - 1.0).abs() < 1e-14, "{}", law.length);
        assert_eq!(law.healing_time, Some(7.0));
    }

    let springs =
        case("friction = { contact = 'springs', contact_stiffness_star = 0.2, redraw = true, seed = 7 }");
    let expected = ContactSprings {
        stiffness: 0.2,
        after_break: AfterBreak::FormsAgain { redraw: Some(7) },
    };
    assert_eq!(springs.model.friction, Friction::ContactSprings(expected));
    assert_eq!(
        (springs.groups.r_star, springs.groups.sigma_kinetic_star),
        (0.0, 0.0)
    );

    let slides = case(
        "friction = { contact = 'springs', contact_stiffness_star = 0.2, after_break = 'slide', r_star = 0.6 }",
    );
    let expected = ContactSprings {
        stiffness: 0.2,
        after_break: AfterBreak::Slides,
    };
    assert_eq!(slides.model.friction, Friction::ContactSprings(expected));
    assert_eq!(
        (slides.groups.r_star, slides.groups.sigma_kinetic_star),
        (0.6, 0.05)
    );

    let stateful = case(RATE_AND_STATE);
    let expected = RateAndState {
        a: 0.02,
        b: 0.04,
        d_c: 0.5,
        v_0: 0.02,
        mu_0: 1.0,
        theta_0: 25.0,
        slip_speed: 0.003,
    };
    assert_eq!(stateful.model.friction, Friction::RateAndState(expected));
    assert_eq!(stateful.groups.sigma_static_star, 0.0);

    for other in [varying, springs, slides, stateful] {
        assert_eq!(Kernel::Fused.for_model(&other.model), Kernel::General);
    }
}

/// The stiffness below which sliding is unstable is 0.038 at D_c = 0.5 and 2.6 at 0.02; that of the drive is
/// 0.375.
#[test]
fn a_drive_that_is_too_soft_is_told() {
    let warns = |d_c: f64| {
        let case = case(&RATE_AND_STATE.replace("d_c_star = 0.5", &format!("d_c_star = {d_c}")));
        let mut warnings = case.warnings().into_iter();
        warnings.any(|warning| warning.contains("expect stick-slip"))
    };
    assert!(!warns(0.5));
    assert!(warns(0.02));
}

/// A steel slider on a machine of 0.5 N/um: as slow as the paper's slider in terms of V* N_x, but pulled
/// faster than its blocks can slide. The drag is Omega V* with Omega = sqrt(0.75) Omega*, so the warnings
/// begin where it is a hundredth of R*, and where both together are 1.
#[test]
fn sliding_that_takes_as_much_force_as_its_start_is_told() {
    let warnings = |changes: &[&str]| {
        let changes: Vec<String> = changes.iter().map(ToString::to_string).collect();
        let text = "slider.omega_star = 0.2\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }";
        Case::parse(text, "case", "", &changes)
            .unwrap()
            .warnings()
            .join("\n")
    };
    let speed = |drag: f64| format!("drive.v_star={:?}", drag / (0.75_f64.sqrt() * 0.2));
    let soft = "drive.stiffness_star=1e-3";
    let [drag, no_transition] = ["damping drag at", "no transition is possible"];
    for (size, has_drag, is_flat) in [
        (0.00499, false, false),
        (0.00501, true, false),
        (0.4999, true, false),
        (0.5001, true, true),
    ] {
        let said = warnings(&[&speed(size), soft]);
        assert_eq!(
            [said.contains(drag), said.contains(no_transition)],
            [has_drag, is_flat],
            "{size}: {said}"
        );
    }
    let said = warnings(&[&speed(0.9), soft]);
    assert!(
        said.contains("needs mu* = 1.4, including a damping drag of 0.9"),
        "{said}"
    );
    assert!(said.contains("adds 0.9 to the kinetic friction of 0.5"), "{said}");
    // Drag is small up to the reported speed. Adhesion raises the static strength, so that a transition
    // remains possible.
    assert!(said.contains("up to V* = 0.02887"), "{said}");
    let held = warnings(&[&speed(0.6), soft, "friction.adhesion='20 kPa'"]);
    assert!(held.contains(drag) && !held.contains(no_transition), "{held}");
    // For blocks without kinetic friction, the limit is a thousandth of their static strength.
    for (size, has_drag) in [(0.00099, false), (0.00101, true)] {
        let said = warnings(&[&speed(size), soft, "friction.r_star=0"]);
        assert_eq!(said.contains(drag), has_drag, "{size}: {said}");
    }
    // A rotating slider is slow near its centre.
    let turning = warnings(&[&speed(0.00501), soft, "drive.motion='rotation'"]);
    assert!(!turning.contains(drag), "{turning}");
    // Blocks that lose no friction when they slip have another warning.
    let equal = warnings(&["friction.r_star=1"]);
    assert!(
        equal.contains("friction does not drop when blocks slip") && !equal.contains(no_transition),
        "{equal}"
    );
}

/// Tests a surface in metres: blocks of a half and a third of the size, a texture, and another spread do not
/// change the field.
#[test]
fn coefficients_that_are_alike_over_a_length_are_those_of_the_place() {
    let made = |parts: usize, edges: &str, rest: &str| {
        let (nx, ny, size) = (12 * parts, 10 * parts, 30 / parts);
        case(&format!(
            "slider = {{ blocks = [{nx}, {ny}], block_size = '{size} um', edges = '{edges}' }}\n\
             friction.correlation_length = '0.1 mm'\nfriction.mu_static = 0.5\nfriction.seed = 9\n{rest}"
        ))
    };
    for edges in ["free", "periodic"] {
        let coarse = made(1, edges, "").model;
        for parts in [2, 3] {
            let fine = made(parts, edges, "").model;
            for (one, other) in [
                (&coarse.surface.mu_static, &fine.surface.mu_static),
                (&coarse.surface.mu_kinetic, &fine.surface.mu_kinetic),
            ] {
                for (b, parent) in one.iter().enumerate() {
                    let [i, j] = [parts * (b % 12), parts * (b / 12)];
                    let rows = (j..j + parts).map(|j| &other[12 * parts * j + i..][..parts]);
                    let mean = rows.flatten().sum::<f64>() / (parts * parts) as f64;
                    // Rounding: about 700 differences of error functions, each to 1e-16 of 1, are added and
                    // multiplied by a spread of 0.025.
                    assert!(
                        (mean - parent).abs() < 1e-14,
                        "{edges} {parts} {b}: {mean} {parent}"
                    );
                }
            }
        }
    }
    let texture = "friction.sigma_static_star = 0.1\ntexture = [{ shape = 'cavity', coverage = 20 }]";
    let [plain, textured] = ["", texture].map(|rest| made(1, "free", rest).model);
    for b in (0..plain.n_blocks()).filter(|&b| !textured.surface.textured[b]) {
        let doubled = 0.5 + 2.0 * (plain.surface.mu_static[b] - 0.5);
        // Each has one rounding of 0.5.
        assert!((textured.surface.mu_static[b] - doubled).abs() < 1e-15);
        assert_eq!(textured.surface.mu_kinetic[b], plain.surface.mu_kinetic[b]);
    }
    // Without the key, every block draws its own coefficient.
    let by_block = case("slider.blocks = [3, 2]\nfriction.seed = 9").model;
    let gauss = |mean: f64| slipfront::surface::Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let drawn = slipfront::surface::Coefficients::draw(6, gauss(1.0), gauss(0.5), 9);
    assert_eq!(by_block.surface.mu_static, drawn.mu_static);
}

/// A field that is nearly uniform over the surface differs between seeds, and a warning says so.
#[test]
fn a_field_that_is_longer_than_the_slider_is_warned_of() {
    let said = |rest: &str| {
        let case = case(&format!("slider.blocks = [25, 25]\n{rest}"));
        let mut warnings = case.warnings().into_iter();
        warnings.find(|warning| warning.contains("correlated over much of the slider"))
    };
    // I = 0.8615 at xi = L, and more than half of the spread for xi above 0.47 L.
    let warned = said("friction.correlation_length = '25 um'").unwrap();
    assert!(
        warned.contains("between seeds by 0.8615 of the spread"),
        "{warned}"
    );
    assert_eq!(said("friction.correlation_length = '5 um'"), None);
    let even = "friction = { correlation_length = '25 um', sigma_static_star = 0, sigma_kinetic_star = 0 }";
    assert_eq!(said(even), None);
}

/// The contact of the lowest row of an upright sheet is as wide as the sheet is thick, and bears the whole
/// load.
#[test]
fn an_upright_sheet_stands_on_its_lowest_row() {
    let text = "slider = { blocks = [20, 8], block_size = '2.5 mm', thickness = '6 mm', young_modulus = '3 GPa' }\n\
        load = { pressure = '0.2 MPa', foundation = '1e11 N/m^3' }\n\
        friction = { along = 'x', mu_static = 0.5 }\n";
    let upright = case(text);
    let (scales, surface) = (&upright.scales, &upright.model.surface);
    // A block has a contact of 2.5 mm x 6 mm: 3 N, and a foundation of 1.5e6 N/m.
    assert!((scales.force() - 0.5 * 3.0).abs() < 1e-12, "{scales:?}");
    let Friction::Coulomb(Coulomb {
        interface: Some(interface),
        ..
    }) = upright.model.friction
    else {
        panic!("{:?}", upright.model.friction)
    };
    assert!(
        (interface.foundation - 1.5e6 / (3e9 * 6e-3)).abs() < 1e-15,
        "{interface:?}"
    );
    assert!((0..160).all(|b| surface.textured[b] == (b >= 20)));
    assert_eq!(
        (surface.n_contact(), surface.n_facing(), surface.load_factor()),
        (20, 20, 1.0)
    );
    assert_eq!(
        (surface.texture_percent(), upright.model.mu_star_divisor()),
        (0.0, 20.0)
    );

    // A shear load acts only along the interface.
    let sheared = case(&text.replace("load = {", "load = { shear = '50 kPa',"));
    assert!((sheared.model.mean_dead_load()[0] - 0.5).abs() < 1e-15);
    assert!((0..160).all(|b| sheared.model.dead_load().relative(b) == f64::from(u8::from(b < 20))));

    // A groove across the row transfers its load to the other blocks of the row.
    let grooved = case(&format!(
        "{text}[[texture]]\nshape = 'groove'\norientation = 'across'\nwidth = '12.5 mm'\n"
    ));
    let surface = &grooved.model.surface;
    assert_eq!((surface.n_contact(), surface.load_factor()), (15, 20.0 / 15.0));
    assert_eq!(surface.texture_percent(), 25.0);
}
