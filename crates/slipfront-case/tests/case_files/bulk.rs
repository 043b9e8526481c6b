//! The note on a slider that is a bulk body under its texture and no sheet, and the critical size of such a
//! body.

use slipfront_case::case::Case;

/// Dimples of 100 um at 200 um on a slider of 1 mm.
const DIMPLES: &str = "slider = { blocks = [50, 50], block_size = '20 um' }
[[texture]]
shape = 'cavity'
lambda = '50 um'
pitch = '200 um'
";

fn case(text: &str, overrides: &[String]) -> Case {
    Case::parse(text, "case", "", overrides).unwrap_or_else(|error| panic!("{text}\n{overrides:?}\n{error}"))
}

/// The note on a slider of this thickness, which is one of its warnings.
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

/// How many times as much the texture changes in a bulk body.
fn times(text: &str, thickness: &str) -> String {
    let note = note(text, thickness).unwrap();
    let (_, from) = note.split_once("mu_s* by about ").unwrap();
    from.split_once(" times").unwrap().0.to_owned()
}

/// The keys that the sentence gives, as a user copies them for `--set`; the first quoted key is the one that
/// it is about.
fn keys(note: &str) -> Vec<String> {
    let quoted = note.split('`').skip(3).step_by(2);
    quoted.map(|keys| keys.replacen(" = ", "=", 1)).collect()
}

/// The sheet that fits has h = p/(8 pi) and K = 9/16 pi E/p, since nu = 1/3 and G = 3/8 E.
#[test]
fn a_thickness_above_a_third_of_the_feature_is_noted() {
    // A third of 100 um, and a thousandth more for rounding.
    assert_eq!(note(DIMPLES, "33.3 um"), None);
    assert_eq!(
        note(DIMPLES, "33.4 um").unwrap(),
        "`slider.thickness` is 33.4 um, more than a third of the smallest feature of 100 um: so thick a part is no sheet but a bulk body, in \
         which stress beside the texture reaches about 200 um deep, and the texture changes mu_s* by about 0.6 to 1.2 times as much as in this \
         sheet; one sheet that fits this pitch has `slider.thickness = \"7.958 um\"` and `drive.stiffness_per_area = \"8.836e14 N/m^3\"`, and finds 5 % \
         less to 18 % more than a bulk body of nu = 1/3; it fails for patterns with longer wave lengths: random dimples, bands, patches"
    );
}

/// Where thickness and pitch have the ratio of a known answer, the factor is that of the answer.
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
    // Thinner than any that is known: a tenth of the pitch.
    let small = DIMPLES.replace("lambda = '50 um'", "lambda = '10 um'");
    assert_eq!(times(&small, "19.9 um"), "less than 0.9");
}

#[test]
fn the_keys_that_a_note_gives_make_a_sheet_without_one() {
    let grooves = |orientation: &str| {
        format!(
            "slider = {{ blocks = [50, 50], block_size = '20 um' }}\n[[texture]]\nshape = 'groove'\norientation = '{orientation}'\nwidth = \
             '60 um'\npitch = '200 um'\n"
        )
    };
    let small = DIMPLES.replace("lambda = '50 um'", "lambda = '10 um'");
    let hexagonal = format!("{DIMPLES}lattice = 'hexagonal'");
    let at_an_edge = format!("drive.attach = 'left'\n{DIMPLES}");
    for (text, n_keys) in [
        (DIMPLES.to_owned(), 2),
        (grooves("across"), 2),
        (grooves("along"), 2),
        (small, 2),
        (hexagonal, 2),
        (at_an_edge, 3),
    ] {
        let note = note(&text, "2 mm").unwrap();
        let keys = keys(&note);
        assert_eq!(keys.len(), n_keys, "{note}");
        assert_eq!(case(&text, &keys).thick_for_texture(), None, "{text}\n{keys:?}");
    }
    assert!(
        note(&grooves("across"), "20.1 um")
            .unwrap()
            .contains("feature of 60 um")
    );
}

/// A pattern that does not fill the slider, or is no single array, has wave lengths above its pitch.
#[test]
fn a_pattern_with_longer_wave_lengths_has_no_sheet_that_fits() {
    let single = "slider = { blocks = [50, 50], block_size = '20 um' }\n[[texture]]\nshape = 'cavity'\nlambda = '50 um'";
    let patch = format!("{DIMPLES}array = [2, 2]");
    let band = format!("{DIMPLES}array = [5, 2]");
    let of_patches = DIMPLES.replace(
        "pitch = '200 um'",
        "array = [2, 2]\npitch = '150 um'\nrepeat = { array = [2, 2] }",
    );
    let two = format!("{DIMPLES}[[texture]]\nshape = 'groove'\nwidth = '200 um'\n");
    for text in [single, &patch, &band, &of_patches, &two] {
        let note = note(text, "2 mm").unwrap();
        assert!(note.contains("no single sheet stands for it"), "{text}\n{note}");
        assert!(!note.contains("slider.thickness ="), "{note}");
    }
    // In the array whose answers are known a feature is half a pitch wide.
    assert!(
        note(single, "2 mm")
            .unwrap()
            .contains("reaches about 200 um deep")
    );
}

#[test]
fn paper_blocks_bare_sliders_and_thin_sheets_have_no_note() {
    assert_eq!(case(DIMPLES, &[]).thick_for_texture(), None);
    assert_eq!(note("", "1 mm"), None);
    assert_eq!(note(DIMPLES, "8 um"), None);
}

/// Where a mask is repeated, the pitch is known, and the features in it are not.
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

/// Textures that a search draws have a smallest feature and no pitch.
#[test]
fn a_feature_alone_is_enough_for_a_note() {
    let sheet = case(DIMPLES, &["slider.thickness=\"20 um\"".to_owned()]);
    assert_eq!(sheet.thick_for_feature(60e-6), None);
    let note = sheet.thick_for_feature(59e-6).unwrap();
    assert!(
        note.contains("smallest feature of 59 um") && note.contains("no single sheet"),
        "{note}"
    );
}

/// `L_c = 2.316 G/((1 - nu) w)` with G/(1 - nu) = 9/16 E and `w = (mu_s - mu_k) P/D_c`, whatever the
/// thickness.
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
        // Of some products and sums of equal numbers.
        assert!(
            (found.metres / expected - 1.0).abs() < 1e-12,
            "{} m for {expected} m",
            found.metres
        );
    }
}
