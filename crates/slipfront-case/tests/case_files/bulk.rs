//! Bulk bodies: the note on a slider that is a bulk body under its texture, not a sheet; what a body has and
//! has not; and its critical size.

use slipfront::{Body, Edges, Face, Loading};
use slipfront_case::case::Case;

/// Dimples of 100 um with a pitch of 200 um on a slider of 1 mm.
const DIMPLES: &str = "slider = { blocks = [50, 50], block_size = '20 um' }
[[texture]]
shape = 'cavity'
lambda = '50 um'
pitch = '200 um'
";

fn case(text: &str, overrides: &[String]) -> Case {
    Case::parse(text, "case", "", overrides).unwrap_or_else(|error| panic!("{text}\n{overrides:?}\n{error}"))
}

/// Settings in the form that a user writes for `--set`.
fn sets(sets: &[&str]) -> Vec<String> {
    sets.iter().map(|set| (*set).to_owned()).collect()
}

/// The note on a slider of this thickness. It must be one of the case's warnings.
fn note(text: &str, thickness: &str) -> Option<String> {
    let case = case(text, &[format!("slider.thickness=\"{thickness}\"")]);
    let note = case.thick_for_texture();
    let warned = case
        .warnings()
        .into_iter()
        .find(|warning| warning.starts_with("`slider.thickness`"));
    assert_eq!(warned, note);
    note
}

/// Factor by which the texture changes more in a bulk body, from the note.
fn times(text: &str, thickness: &str) -> String {
    let note = note(text, thickness).unwrap();
    let (_, from) = note.split_once("mu_s* by about ").unwrap();
    from.split_once(" times").unwrap().0.to_owned()
}

/// The keys in the sentence, in the form that a user copies for `--set`. The first quoted key is the subject
/// of the sentence.
fn keys(note: &str) -> Vec<String> {
    let quoted = note.split('`').skip(3).step_by(2);
    quoted.map(|keys| keys.replacen(" = ", "=", 1)).collect()
}

#[test]
fn a_thickness_above_a_third_of_the_feature_is_noted() {
    // A third of 100 um, with a margin of a thousandth for rounding.
    assert_eq!(note(DIMPLES, "33.3 um"), None);
    assert_eq!(
        note(DIMPLES, "33.4 um").unwrap(),
        "`slider.thickness` is 33.4 um, more than a third of the smallest feature of 100 um: a part of this thickness \
         is a bulk body, not a sheet. In a bulk body stress at the texture reaches about 200 um deep, and the texture \
         changes mu_s* by about 0.6 to 1.2 times as much as in this sheet; use `slider.body = \"bulk\"` and \
         `slider.height = \"33.4 um\"` instead"
    );
}

/// If the ratio of thickness to pitch is that of a known answer, the factor is the one of the answer.
#[test]
fn the_factor_is_that_of_the_known_thicknesses() {
    for (thickness, expected) in [
        ("100 um", "1.5 to 2.4"),
        ("1 mm", "11 to 18"),
        ("1.01 mm", "more than 11"),
        // The geometric means of the factors of half a pitch and of five: sqrt(1.5 11) and sqrt(2.4 18).
        ("316.22777 um", "4.1 to 6.6"),
    ] {
        assert_eq!(times(DIMPLES, thickness), expected, "{thickness}");
    }
    // Thinner than any known ratio: a tenth of the pitch.
    let small = DIMPLES.replace("lambda = '50 um'", "lambda = '10 um'");
    assert_eq!(times(&small, "19.9 um"), "less than 0.9");
}

#[test]
fn the_keys_that_a_note_gives_make_a_body_without_one() {
    let grooves = |orientation: &str| {
        format!(
            "slider = {{ blocks = [50, 50], block_size = '20 um' }}\n[[texture]]\nshape = 'groove'\norientation = '{orientation}'\nwidth = \
             '60 um'\npitch = '200 um'\n"
        )
    };
    let patch = format!("{DIMPLES}array = [2, 2]");
    let hexagonal = format!("{DIMPLES}lattice = 'hexagonal'");
    for text in [DIMPLES, &grooves("across"), &grooves("along"), &patch, &hexagonal] {
        let note = note(text, "2 mm").unwrap();
        let keys = keys(&note);
        assert_eq!(keys, ["slider.body=\"bulk\"", "slider.height=\"2 mm\""]);
        let body = case(text, &keys);
        assert_eq!(body.thick_for_texture(), None, "{text}");
        // In blocks of 20 um.
        assert_eq!(body.model.body().unwrap().height, 100.0);
    }
    assert!(
        note(&grooves("across"), "20.1 um")
            .unwrap()
            .contains("feature of 60 um")
    );
}

/// A body with its keys, in blocks, on the periodic edges and under the slow loading of the defaults. Its
/// drive springs stand for its shear, G/H, unless they are given; a deep body has those of five times its
/// side.
#[test]
fn the_model_has_the_body_of_the_case() {
    let bulk = "slider.body=\"bulk\"";
    let body = case(
        DIMPLES,
        &sets(&[
            bulk,
            "slider.height=\"0.5 mm\"",
            "slider.poisson=0.25",
            "slider.face=\"flat\"",
        ]),
    );
    let expected = Body {
        height: 25.0,
        poisson: 0.25,
        face: Face::Flat,
    };
    assert_eq!(body.model.body(), Some(&expected));
    assert_eq!(body.model.lattice.edges, [Edges::Periodic; 2]);
    // Strength does not fall with slip here.
    assert_eq!(body.time_plan.loading, Loading::Constant);
    // G = 0.4 E, over 25 blocks.
    assert!((body.model.drive.k_drive / 0.016 - 1.0).abs() < 1e-14);
    let deep = case(DIMPLES, &sets(&[bulk, "slider.poisson=0.25"]));
    assert!(deep.model.body().unwrap().height.is_infinite());
    assert!((deep.model.drive.k_drive / (0.4 / 250.0) - 1.0).abs() < 1e-14);
    let given = case(DIMPLES, &sets(&[bulk, "drive.stiffness_star=0.2"]));
    assert_eq!(given.model.drive.k_drive, 0.2);
}

#[test]
fn strength_that_falls_with_slip_is_loaded_slowly() {
    let weakening = "friction.slip_weakening={ length = '1 um' }";
    let bulk = case(DIMPLES, &sets(&["slider.body=\"bulk\"", weakening]));
    assert!(bulk.search(slipfront::Execution::default()).is_some());
    let fast = case(
        DIMPLES,
        &sets(&[
            "slider.body=\"bulk\"",
            weakening,
            "drive={ loading = 'constant', v_star = 0.1 }",
        ]),
    );
    assert!(fast.search(slipfront::Execution::default()).is_none());
    assert!(
        fast.warnings()
            .iter()
            .any(|note| note.contains("loads this body in"))
    );
    let sheet = case(DIMPLES, &sets(&[weakening]));
    assert_eq!(sheet.time_plan.loading, Loading::Constant);
}

#[test]
fn what_a_bulk_body_does_not_have_is_refused() {
    let refusal = |given: &[&str]| {
        let refused = Case::parse(DIMPLES, "case", "", &sets(given)).unwrap_err();
        refused.to_string()
    };
    let bulk = "slider.body=\"bulk\"";
    for (key, value, why) in [
        ("slider.thickness", "'1 mm'", "a bulk body has a `height`"),
        ("slider.outline", "'disc'", "periodic piece"),
        ("slider.edges", "'free'", "a piece of a larger part"),
        ("slider.blocks", "[50, 49]", "the next ones are [50, 50]"),
        (
            "slider.stiffness_grade",
            "{ along = 'x', from = 1, to = 0.5 }",
            "how far they reach",
        ),
        ("slider.viscosity_time_star", "0.1", "no dampers"),
        ("drive.attach", "'left'", "its whole back is driven"),
        (
            "drive.motion",
            "'rotation'",
            "its equations for rotation are not derived",
        ),
    ] {
        let refused = refusal(&[bulk, &format!("{key}={value}")]);
        assert!(refused.contains(key) && refused.contains(why), "{refused}");
    }
    for key in ["slider.height='1 mm'", "slider.poisson=0.3", "slider.face='flat'"] {
        let refused = refusal(&[key]);
        assert!(
            refused.contains("belongs to `slider.body` = \"bulk\""),
            "{refused}"
        );
    }
    for (key, why) in [
        ("slider.longest_wave='1 mm'", "exact for every wavelength"),
        ("slider.sheets=[]", "`slider.height`"),
        ("slider.along_to_across=2", "`slider.poisson`"),
    ] {
        assert!(refusal(&[bulk, key]).contains(why), "{}", refusal(&[bulk, key]));
    }
    for blocks in ["[1, 1]", "[50, 1]"] {
        assert!(refusal(&[bulk, &format!("slider.blocks={blocks}")]).contains("at least 3"));
    }
    assert!(refusal(&[bulk, "slider.height='19 um'"]).contains("less than a block of \"20 um\""));
    assert!(refusal(&[bulk, "slider.poisson=0.6"]).contains("rubber nearly 0.5"));
}

/// The load of a textured block goes to the blocks in contact within a pitch, in metres, for any mesh. The
/// total load is conserved.
#[test]
fn load_is_shared_within_a_pitch() {
    let patch = format!("{DIMPLES}array = [2, 2]");
    let load = |text: &str, given: &[&str]| {
        let surface = &case(text, &sets(given)).model.surface;
        (0..surface.n_blocks())
            .map(|b| surface.normal_force(b))
            .collect::<Vec<f64>>()
    };
    let bulk = "slider.body='bulk'";
    let found = load(&patch, &[bulk]);
    // A tenth of a pitch is 1 block: the pitch has 10 blocks.
    assert_eq!(load(&patch, &["load.redistribute={ within = '200 um' }"]), found);
    let total: f64 = found.iter().sum();
    assert!((total / 2500.0 - 1.0).abs() < 1e-12, "{total}");
    // Far from the patch the load is unchanged; near it, it is more than with equal sharing.
    let equal = load(&patch, &[])[0];
    assert!(found[0] == 1.0 && equal > 1.0, "{} {equal}", found[0]);
    let largest = found.iter().copied().fold(0.0, f64::max);
    assert!(largest > 1.2, "{largest}");
    let finer = load(
        &patch,
        &[bulk, "slider.blocks=[100,100]", "slider.block_size='10 um'"],
    );
    let largest_finer = finer.iter().copied().fold(0.0, f64::max);
    assert!(
        (largest_finer / largest - 1.0).abs() < 0.1,
        "{largest_finer} {largest}"
    );
}

#[test]
fn a_texture_without_a_pitch_says_how_near() {
    let single = "slider = { blocks = [50, 50], block_size = '20 um', body = 'bulk' }\n[[texture]]\nshape = 'cavity'\nlambda = '50 um'";
    let refused = |given: &[&str]| {
        Case::parse(single, "case", "", &sets(given))
            .unwrap_err()
            .to_string()
    };
    assert!(
        refused(&[]).contains("texture 1 is not an array of several features"),
        "{}",
        refused(&[])
    );
    let too_near = refused(&["load.redistribute={ within = '30 um' }"]);
    assert!(
        too_near.contains("no block in contact is within 1.5 blocks of the textured block"),
        "{too_near}"
    );
    assert!(refused(&["load.redistribute={ within = '3 km' }"]).contains("it must be"));
    assert!(refused(&["load.redistribute='all'"]).contains("it must be true, false, or a distance"));
}

#[test]
fn paper_blocks_bare_sliders_and_thin_sheets_have_no_note() {
    assert_eq!(case(DIMPLES, &[]).thick_for_texture(), None);
    assert_eq!(note("", "1 mm"), None);
    assert_eq!(note(DIMPLES, "8 um"), None);
}

/// If a mask is repeated, its pitch is known, but its features are not.
#[test]
fn of_a_mask_the_pitch_counts() {
    let folder = tempfile::tempdir().unwrap();
    let mask: Vec<bool> = (0..10 * 10).map(|block| block % 3 == 0).collect();
    let image = slipfront_case::arrays::png_of_mask(10, 10, &mask).unwrap();
    std::fs::write(folder.path().join("mask.png"), image).unwrap();
    let note = |pattern: &str, thickness: &str| {
        let text = format!(
            "slider = {{ blocks = [50, 50], block_size = '20 um', thickness = '{thickness}' }}\n[[texture]]\nshape = 'mask'\nfile = \
             'mask.png'\n{pattern}"
        );
        let masked = Case::parse(&text, "case", folder.path(), &[]).unwrap();
        masked.thick_for_texture()
    };
    assert_eq!(note("pitch = '200 um'", "66.6 um"), None);
    let told = note("pitch = '200 um'", "66.8 um").unwrap();
    assert!(
        told.contains("more than a third of the pitch of 200 um"),
        "{told}"
    );
    assert_eq!(note("", "2 mm"), None);
}

/// Textures drawn by a search have a smallest feature, but no pitch.
#[test]
fn a_feature_alone_is_enough_for_a_note() {
    let sheet = case(DIMPLES, &["slider.thickness=\"20 um\"".to_owned()]);
    assert_eq!(sheet.thick_for_feature(60e-6), None);
    let note = sheet.thick_for_feature(59e-6).unwrap();
    assert!(
        note.contains("smallest feature of 59 um") && note.contains("`slider.height = \"20 um\"`"),
        "{note}"
    );
}

/// `L_c = 2.316 G/((1 - nu) w)` with G/(1 - nu) = 9/16 E and `w = (mu_s - mu_k) P/D_c`, for any thickness.
#[test]
fn the_critical_size_of_a_bulk_body_depends_on_no_thickness() {
    for thickness in ["20 um", "2 mm"] {
        let text = format!(
            "slider = {{ blocks = [50, 50], block_size = '20 um', thickness = '{thickness}' }}\n[friction]\nmu_static = 0.6\nr_star = \
             0.5\nsigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = {{ length = '10 nm' }}"
        );
        let weakening = 0.3 * 100e3 / 10e-9;
        let expected = 2.316 * 9.0 / 16.0 * 100e9 / weakening;
        let lengths = case(&text, &[]).lengths();
        let found = lengths
            .iter()
            .find(|length| length.name == "critical size, bulk body")
            .unwrap();
        assert_eq!(found.enough, None);
        let of_body = text.replace(&format!("thickness = '{thickness}'"), "body = 'bulk'");
        let of_body = case(&of_body, &[]).lengths();
        let of_body = of_body.iter().find(|length| length.name == found.name).unwrap();
        assert_eq!(of_body.enough, Some(2.0));
        // Rounding of some products and sums of equal numbers.
        assert!((of_body.blocks / found.blocks - 1.0).abs() < 1e-12);
        // Rounding of some products and sums of equal numbers.
        assert!(
            (found.metres / expected - 1.0).abs() < 1e-12,
            "{} m for {expected} m",
            found.metres
        );
    }
}

/// A layer in which slip of any size is stable has no critical size. A layer just above this limit has one of
/// the order of `pi sqrt(a G H/(w - G/H))` with `a = (4 - 2 kappa/3)/(1 + kappa)`, because the stiffness
/// along a long wave is `G/H + a G H q^2`.
#[test]
fn slip_in_stiff_layers_is_stable() {
    let text = "slider = { blocks = [50, 50], block_size = '20 um', body = 'bulk' }\n[friction]\nmu_static = 0.6\nr_star = 0.5\n\
                sigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = { length = '10 nm' }";
    let size = |set: &[String]| {
        let lengths = case(text, set).lengths();
        lengths
            .into_iter()
            .find(|length| length.name == "critical size, bulk body")
            .unwrap()
    };
    let weakening = 0.3 * 100e3 / 10e-9;
    let shear_modulus = 100e9 / (2.0 * (4.0 / 3.0));
    let height = |share: f64| {
        [format!(
            "slider.height='{:e} m'",
            share * shear_modulus / weakening
        )]
    };
    let stable = size(&height(0.99));
    assert!(stable.blocks.is_infinite() && stable.enough.is_none());
    let found = size(&height(1.01));
    assert_eq!(found.enough, Some(2.0));
    let (kappa, high): (f64, f64) = (3.0 - 4.0 / 3.0, 1.01 * shear_modulus / weakening);
    let of_layer = (4.0 - 2.0 * kappa / 3.0) / (1.0 + kappa) * shear_modulus * high;
    let expected = (of_layer / (weakening - shear_modulus / high)).sqrt();
    // 2.316 in place of pi; terms of the fourth order in q H, which is a tenth, are neglected.
    assert!(
        (found.metres / (2.316 * expected) - 1.0).abs() < 0.02,
        "{} {expected}",
        found.metres
    );
}

/// The strain of a body follows from its modulus, not from the thickness of a sheet that models it. For a
/// deep body it is `P mu_s (1 - nu)/G`.
#[test]
fn the_strain_of_a_body_is_its_own() {
    let body = case(DIMPLES, &sets(&["slider.body=\"bulk\"", "slider.poisson=0.4"]));
    let expected = body.scales.stress() * 0.6 / (100e9 / 2.8);
    // Rounding of some products.
    assert!(
        (body.strain_of_load() / expected - 1.0).abs() < 1e-12,
        "{} {expected}",
        body.strain_of_load()
    );
    let sheet = case(DIMPLES, &[]);
    assert_eq!(sheet.strain_of_load(), sheet.groups.epsilon);
    assert_eq!(body.load_distance(), Some(200e-6));
    assert_eq!(sheet.load_distance(), None);
}
