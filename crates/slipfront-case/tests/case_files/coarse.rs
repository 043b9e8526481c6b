//! Notes on blocks that are too coarse for the outline of a texture, and the blocks that they suggest.

use slipfront_case::case::Case;

fn case(text: &str, overrides: &[String]) -> Case {
    Case::parse(text, "case", "", overrides).unwrap_or_else(|error| panic!("{text}\n{overrides:?}\n{error}"))
}

/// The settings that the sentence suggests, in the form that a user copies for `--set`.
fn remedies(note: &str) -> Vec<String> {
    let quoted = note.split('`').skip(1).step_by(2);
    quoted.map(|keys| keys.replacen(" = ", "=", 1)).collect()
}

fn blocks_of(overrides: &[String]) -> [u64; 2] {
    let inner = overrides[0]
        .trim_start_matches("slider.blocks=[")
        .trim_end_matches(']');
    let sides: Vec<u64> = inner.split(", ").map(|side| side.parse().unwrap()).collect();
    sides.try_into().unwrap()
}

const DIMPLES: &str =
    "[[texture]]\nshape = 'cavity'\nlambda = '30 um'\npitch = '120 um'\nlattice = 'hexagonal'";

/// Dimples of 60 um with a pitch of 120 um, on a slider of 2 mm: each needs five blocks, and each gap of 60
/// um needs two.
#[test]
fn a_slider_of_two_millimetres_needs_167_blocks() {
    for (blocks, expected) in [
        (
            30,
            Some(
                "the smallest dimple is 0.9 blocks across and the smallest gap 0.9; the outline needs 5 and 2",
            ),
        ),
        (
            50,
            Some(
                "the smallest dimple is 1.5 blocks across and the smallest gap 1.5; the outline needs 5 and 2",
            ),
        ),
        (
            100,
            Some("the smallest dimple is 3 blocks across; the outline needs 5"),
        ),
        (
            166,
            Some("the smallest dimple is 4.98 blocks across; the outline needs 5"),
        ),
        (167, None),
        (400, None),
    ] {
        let size = 2000.0 / f64::from(blocks);
        let text =
            format!("slider = {{ blocks = [{blocks}, {blocks}], block_size = '{size} um' }}\n{DIMPLES}");
        let expected = expected.map(|told| {
            format!(
                "{told}, at least 167 x 167 blocks (`slider.blocks = [167, 167]`, with `slider.block_size = \"11.9760479 um\"` for a \
                 slider of the same size)"
            )
        });
        let case = case(&text, &[]);
        assert_eq!(case.too_coarse(), expected);
        assert_eq!(
            case.warnings().contains(&expected.clone().unwrap_or_default()),
            expected.is_some()
        );
    }
}

/// The suggested blocks are fine enough, and the next coarser ones are not, for any cause of coarseness.
#[test]
fn the_blocks_that_are_named_are_the_fewest() {
    let on = |slider: &str, texture: &str| format!("[slider]\n{slider}\n[[texture]]\n{texture}");
    let square = "blocks = [50, 50]\nblock_size = '3.7 um'";
    let periodic = "blocks = [60, 52]\nedges = 'periodic'";
    for text in [
        on(square, "shape = 'cavity'\ncoverage = 0.3"),
        on(
            square,
            "shape = 'cavity'\ncoverage = 0.3\ncenter = ['0 um', '90 um']",
        ),
        on(square, "shape = 'cavity'\ncoverage = 30\narray = [9, 9]"),
        on(
            square,
            "shape = 'cavity'\ncoverage = 30\narray = [9, 9]\nlattice = 'staggered'\ninvert = true",
        ),
        on(
            square,
            "shape = 'cavity'\nw = 0.6\nrotate = 33\ncoverage = 20\narray = [4, 6]",
        ),
        on(
            square,
            "shape = 'cavity'\ns = 3\nw = 0.3333333333333333\nrotate = 10\ncoverage = 20\narray = [8, 8]",
        ),
        on(square, "shape = 'groove'\ncoverage = 3"),
        on(
            square,
            "shape = 'groove'\norientation = 'along'\nwidth = '9.3 um'\narray = [1, 4]",
        ),
        on(square, "shape = 'groove'\nwidth = '20 um'\npitch = '25 um'"),
        on(
            square,
            "shape = 'groove'\nwidth = '30 um'\noffset = '-40 um'\n[[texture]]\nshape = 'cavity'\nlambda = '20 um'",
        ),
        on(
            square,
            "shape = 'polygon'\npoints = [['20 um', '20 um'], ['60 um', '30 um'], ['22 um', '28 um']]",
        ),
        on(
            square,
            "shape = 'polygon'\npoints = [['20 um', '20 um'], ['60 um', '20 um'], ['60 um', '60 um'], ['40 um', '60 um'], ['40 um', '25 um'], ['20 um', '25 um']]\narray = [2, 2]",
        ),
        on(
            periodic,
            "shape = 'cavity'\nlambda = '4 um'\npitch = '9 um'\nlattice = 'hexagonal'",
        ),
        on(
            periodic,
            "shape = 'cavity'\nlambda = '1.6 um'\narray = [3, 3]\npitch = '5 um'\nrepeat = { array = [3, 2] }",
        ),
        on(periodic, "shape = 'groove'\ncoverage = 97"),
        on("blocks = [200, 1]", "shape = 'groove'\nwidth = '2.3 um'"),
        on(
            "blocks = [61, 53]",
            "shape = 'cavity'\nlambda = '1 um'\npitch = '11 um'",
        ),
        on(
            "blocks = [40, 40]\noutline = 'disc'",
            "shape = 'cavity'\nlambda = '2 um'\npitch = '9 um'",
        ),
    ] {
        let coarse = case(&text, &[]);
        let note = coarse.too_coarse().unwrap_or_else(|| panic!("{text}"));
        let remedies = remedies(&note);
        let (old, new) = (
            [coarse.model.lattice.nx as u64, coarse.model.lattice.ny as u64],
            blocks_of(&remedies),
        );
        let fine = case(&text, &remedies);
        assert_eq!(fine.too_coarse(), None, "{text}\n{note}");
        // The size of the slider is unchanged, to the digits of its block size.
        for axis in 0..2 {
            let length = |case: &Case, blocks: u64| case.scales.block_size * blocks as f64;
            let change = length(&fine, new[axis]) / length(&coarse, old[axis]) - 1.0;
            assert!(change.abs() < 1e-9, "{text}\n{note}");
        }
        // The next coarser blocks that divide both sides.
        let step = [0, 1].map(|axis| {
            (1..=old[axis]).find(|part| old[axis] % part == 0 && old[1 - axis] * part % old[axis] == 0)
        });
        let fewer = [0, 1].map(|axis| new[axis] - step[axis].unwrap());
        if fewer == old || fewer.contains(&0) {
            continue;
        }
        let size = coarse.scales.block_size * old[0] as f64 / fewer[0] as f64;
        let overrides = [
            format!("slider.blocks={fewer:?}"),
            format!("slider.block_size=\"{size:e} m\""),
        ];
        assert!(
            case(&text, &overrides).too_coarse().is_some(),
            "{text}\n{note}\n{overrides:?}"
        );
    }
}

#[test]
fn what_is_fine_enough_or_not_known_is_not_noted() {
    for text in [
        "",
        "[[texture]]\nshape = 'groove'\nwidth = '5 um'",
        // Off the slider.
        "[[texture]]\nshape = 'cavity'\nlambda = '1 um'\ncenter = ['-5 um', '5 um']",
        // Only one copy is on the slider.
        "[[texture]]\nshape = 'cavity'\nlambda = '4 um'\narray = [3, 3]\npitch = '26 um'",
        // Crossing grooves have no gap between them.
        "[[texture]]\nshape = 'groove'\nwidth = '5 um'\n[[texture]]\nshape = 'groove'\norientation = 'along'\nwidth = '5 um'",
    ] {
        assert_eq!(case(text, &[]).too_coarse(), None, "{text}");
    }
    let folder = tempfile::tempdir().unwrap();
    let mask: Vec<bool> = (0..40 * 40).map(|block| block % 3 == 0).collect();
    std::fs::write(
        folder.path().join("mask.png"),
        slipfront_case::arrays::png_of_mask(40, 40, &mask).unwrap(),
    )
    .unwrap();
    let text = "slider.blocks = [40, 40]\n[[texture]]\nshape = 'mask'\nfile = 'mask.png'";
    let masked = Case::parse(text, "case", folder.path(), &[]).unwrap();
    assert_eq!(masked.too_coarse(), None);
}

#[test]
fn what_no_slider_can_show_is_told_as_such() {
    let text = "[slider]\nblocks = [40, 40]\n[[texture]]\nshape = 'cavity'\nlambda = '0.5 nm'";
    let note = case(text, &[]).too_coarse().unwrap();
    assert_eq!(
        note,
        "the smallest dimple is 0.001 blocks across; the outline needs 5, blocks of 200 pm, of which no slider of this size can be made"
    );
    // The coverage of a disc is a share of blocks that other blocks do not reproduce exactly.
    let text = "[slider]\nblocks = [40, 40]\noutline = 'disc'\n[[texture]]\nshape = 'cavity'\ncoverage = 0.5";
    assert!(
        case(text, &[])
            .too_coarse()
            .unwrap()
            .contains("the outline needs 5, about ")
    );
}
