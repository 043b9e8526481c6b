//! The lengths of a case in blocks, and the sentences about them.

use slipfront_case::case::Case;

/// A sheet of 1 mm on blocks of 20 um.
const SHEET: &str = "slider = { blocks = [50, 50], block_size = '20 um', thickness = '20 um' }
drive = { v_star = 0.01, stiffness_per_area = '1875 MPa/um' }
[friction]
sigma_static_star = 0
sigma_kinetic_star = 0
";

fn case(text: &str) -> Case {
    Case::parse(text, "case", "", &[]).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// Name of each length, its number of blocks, and the sufficient number.
fn lengths(case: &Case) -> Vec<(String, f64, Option<f64>)> {
    let lengths = case.lengths().into_iter();
    lengths
        .map(|length| {
            let metres = length.blocks * case.scales.block_size;
            assert_eq!(length.metres, metres, "{}", length.name);
            (length.name, length.blocks, length.enough)
        })
        .collect()
}

fn assert_lengths(case: &Case, expected: &[(&str, f64, Option<f64>)]) {
    let found = lengths(case);
    let names: Vec<&str> = found.iter().map(|(name, ..)| name.as_str()).collect();
    let expected_names: Vec<&str> = expected.iter().map(|(name, ..)| *name).collect();
    assert_eq!(names, expected_names);
    for ((name, blocks, enough), (_, exact, expected_enough)) in found.iter().zip(expected) {
        // Rounding of some products and roots.
        let is_close = blocks == exact || (blocks / exact - 1.0).abs() < 1e-12;
        assert!(is_close, "{name}: {blocks} blocks, exact {exact}");
        assert_eq!(enough, expected_enough, "{name}");
    }
}

/// Critical size of a bulk body in blocks, `2.316 G/((1 - nu) w)` with G/(1 - nu) = 9/16 E, on cubic blocks:
/// w is W times E over the edge of a block.
fn of_bulk(weakening: f64) -> (&'static str, f64, Option<f64>) {
    ("critical size, bulk body", 2.316 * 0.5625 / weakening, None)
}

/// Note on the length with the given name.
fn note_on(case: &Case, name: &str) -> Option<String> {
    let begins = format!("the {name} is ");
    case.warnings().into_iter().find(|note| note.starts_with(&begins))
}

/// The critical size is `L_c = pi sqrt(9/(8 (W - k_s)))`, and the screening length is `sqrt(9/(8 k_s))`, with
/// k_s = 3/8.
#[test]
fn the_critical_size_decides_of_a_sheet() {
    let sheet = case(&format!("{SHEET}slip_weakening = {{ length_star = 0.8 }}"));
    let critical = std::f64::consts::PI * (1.125_f64 / (0.5 / 0.8 - 0.375)).sqrt();
    assert_lengths(
        &sheet,
        &[
            ("block", 1.0, None),
            ("screening length along", 3.0_f64.sqrt(), None),
            ("screening length across", 1.0, None),
            ("critical size", critical, Some(5.0)),
            of_bulk(0.5 / 0.8),
        ],
    );
    let said = sheet.deciding_length();
    assert_eq!(
        said,
        "the critical size sets the resolution: 6.664 blocks; 5 are enough for 2 % of a reduction"
    );
    assert_eq!(note_on(&sheet, "critical size"), None);

    let coarse = case(&format!("{SHEET}slip_weakening = {{ length_star = 0.4 }}"));
    assert_eq!(
        note_on(&coarse, "critical size").unwrap(),
        "the critical size is 3.562 blocks, and 5 are enough: the effect of a texture on mu_s* still depends on the \
         block size; use blocks of at most 14.25 um"
    );
}

/// Where some blocks do not touch, the critical size lies between two bounds. The exact sizes are from the
/// lattice: the width of the strip of blocks in contact for which the stiffness, with all blocks without
/// contact free, has the least eigenvalue W, plus one block for the neighbours that are held.
#[test]
fn blocks_without_contact_raise_the_critical_size() {
    let bounds = |blocks: [usize; 2], friction: &str, texture: &str| {
        let [nx, ny] = blocks;
        let text = format!(
            "slider = {{ blocks = [{nx}, {ny}], block_size = '1 um', edges = 'periodic' }}\nload = {{ redistribute = false }}\n\
             drive = {{ stiffness_star = 1e-9 }}\n\
             [friction]\n{friction}sigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = {{ length_star = 5 }}\n[time]\nduration_star = 100\n{texture}"
        );
        case(&text).expected.critical_size.unwrap()
    };
    let groove = |offset: f64, orientation: &str, width: f64, pitch: f64, count: usize| {
        (0..count)
            .map(|k| {
                let offset = offset + pitch * (k as f64 - 0.5 * (count - 1) as f64);
                format!("[[texture]]\nshape = 'groove'\norientation = '{orientation}'\nwidth = '{width} um'\noffset = '{offset} um'\n")
            })
            .collect::<String>()
    };
    // W = 0.1.
    let plain = std::f64::consts::PI * (1.125_f64 / 0.1).sqrt();
    for (textures, share, exact) in [
        (String::new(), 1.0, 10.53),
        (groove(0.0, "along", 2.0, 4.0, 12), 0.5, 13.45),
        (groove(0.0, "along", 3.0, 4.0, 12), 0.25, 17.95),
        (groove(0.0, "across", 2.0, 4.0, 12), 0.5, 12.92),
    ] {
        let [least, most] = bounds([48, 48], "", &textures);
        let spread = plain / f64::sqrt(share);
        assert!(
            (least - plain).abs() < 1e-6 && (most - spread).abs() < 1e-6,
            "{least} {most}, {spread}"
        );
        // A strip of the lattice has a whole number of blocks.
        assert!(
            least - 0.02 < exact && exact < most,
            "{exact} from {least} to {most}"
        );
    }
    // One line in a sheet of 201 x 121: 25.5 blocks on the lattice, 26.06 in the continuum.
    let [least, most] = bounds([48, 48], "", &groove(0.0, "along", 47.0, 0.0, 1));
    assert!(
        (least - plain).abs() < 1e-6 && (most - 26.055).abs() < 1e-3,
        "{least} {most}"
    );
    // At the edge of an upright sheet, exact on a lattice of 201 x 121: 12.18 blocks with halved springs
    // along the edge, 14.45 with whole ones. The formula neglects 5 %.
    let upright = |edge: &str| {
        let text = format!(
            "slider = {{ blocks = [60, 40], block_size = '1 um', edge_springs = '{edge}' }}\n[friction]\nalong = 'x'\n\
             sigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = {{ length_star = 5 }}\n"
        );
        case(&text).expected.critical_size.unwrap()
    };
    let found = [upright("halved"), upright("whole")];
    for ([least, most], exact) in found.into_iter().zip([12.18, 14.45]) {
        assert!(
            least == most && (least / exact - 1.0).abs() < 0.06,
            "{least} for {exact}"
        );
    }
}

/// A drive at an edge leaves most blocks without a spring. However stiff it is, it does not hold a patch far
/// away, and `L_c = pi sqrt(9/(8 W))`.
#[test]
fn a_stiff_drive_at_an_edge_does_not_make_slip_stable() {
    for (stiffness, edge) in [(0.375, "left"), (1000.0, "right")] {
        let sheet = case(&format!(
            "drive = {{ v_star = 0.01, stiffness_star = {stiffness}, attach = '{edge}' }}\n[slider]\nblocks = [50, 50]\nblock_size = \
             '20 um'\nthickness = '20 um'\n[friction]\nsigma_static_star = 0\nsigma_kinetic_star = 0\nslip_weakening = {{ length_star = \
             0.2 }}"
        ));
        let critical = std::f64::consts::PI * (1.125_f64 / (0.5 / 0.2)).sqrt();
        assert_lengths(
            &sheet,
            &[
                ("block", 1.0, None),
                ("critical size", critical, Some(5.0)),
                of_bulk(0.5 / 0.2),
            ],
        );
        assert_eq!(
            note_on(&sheet, "critical size").unwrap(),
            "the critical size is 2.107 blocks, and 5 are enough: the effect of a texture on mu_s* still depends on \
             the block size; use blocks of at most 8.43 um"
        );
    }
}

/// Where slip of any size is stable, or nearly so, the screening length of stress is shorter than the
/// critical size.
#[test]
fn the_screening_length_decides_where_slip_is_stable() {
    for (length, size) in [(2.0, f64::INFINITY), (1.0, std::f64::consts::PI * 3.0)] {
        let sheet = case(&format!("{SHEET}slip_weakening = {{ length_star = {length} }}"));
        let size_enough = size.is_finite().then_some(5.0);
        assert_lengths(
            &sheet,
            &[
                ("block", 1.0, None),
                ("screening length along", 3.0_f64.sqrt(), Some(3.0)),
                ("screening length across", 1.0, None),
                ("critical size", size, size_enough),
                of_bulk(0.5 / length),
            ],
        );
        let said = sheet.deciding_length();
        assert!(
            said.starts_with("the screening length along sets the resolution: 1.732 blocks; 3 are"),
            "{said}"
        );
        assert!(
            note_on(&sheet, "screening length along")
                .unwrap()
                .ends_with("at most 11.55 um")
        );
    }
}

#[test]
fn features_gaps_and_correlated_coefficients_are_lengths() {
    let text = format!(
        "{}slip_weakening = {{ length_star = 0.8 }}\ncorrelation_length = '9 um'\n[[texture]]\nshape = 'groove'\nwidth = '60 um'\n\
         pitch = '200 um'\n",
        SHEET.replace("sigma_static_star = 0", "sigma_static_star = 0.05")
    );
    let grooved = case(&text);
    let found = lengths(&grooved);
    let last: Vec<(&str, f64, Option<f64>)> = found[5..]
        .iter()
        .map(|(name, blocks, enough)| (name.as_str(), *blocks, *enough))
        .collect();
    assert_eq!(last.len(), 3);
    for ((name, blocks, enough), expected) in last.iter().zip([
        ("correlation length", 0.45, 0.5),
        ("smallest groove", 3.0, 5.0),
        ("smallest gap", 7.0, 2.0),
    ]) {
        assert!(
            *name == expected.0 && *enough == Some(expected.2),
            "{name} {enough:?}"
        );
        assert!((blocks / expected.1 - 1.0).abs() < 1e-9, "{name}: {blocks}");
    }
    let said = grooved.deciding_length();
    assert!(
        said.starts_with("the smallest groove sets the resolution: 3 blocks"),
        "{said}"
    );
    assert!(
        note_on(&grooved, "correlation length")
            .unwrap()
            .ends_with("at most 18 um")
    );
    // The note on the outline of a texture is separate, with the blocks to set.
    assert_eq!(
        grooved
            .warnings()
            .iter()
            .filter(|note| note.contains("groove is"))
            .count(),
        1
    );
}

/// A length that no key gives equals the block length, which then determines the error.
#[test]
fn the_block_decides_where_no_key_gives_a_length() {
    for (text, expected) in [
        (
            "",
            "the block size, 1 um, sets the resolution: it replaces `slider.thickness`, `drive.stiffness_per_area`, `friction.slip_weakening`, \
             `friction.correlation_length`, which this case does not give",
        ),
        (
            SHEET,
            "the block size, 20 um, sets the resolution: it replaces `friction.slip_weakening`, which this case does not give",
        ),
        ("slider.blocks = [1, 1]", "a single block has no mesh error"),
    ] {
        let case = case(text);
        assert_eq!(case.deciding_length(), expected);
    }
    let turning = case("drive.motion = 'rotation'");
    assert_lengths(&turning, &[("block", 1.0, None)]);
}
