//! The note on few blocks with random coefficients that no key asks for.

use slipfront_case::case::Case;
use slipfront_case::case_file::CaseFile;
use test_case::test_case;

fn case(text: &str) -> Case {
    Case::parse(text, "case", "", &[]).unwrap_or_else(|error| panic!("{text}\n{error}"))
}

/// The note on a case. It must be one of the case's warnings.
fn note(text: &str) -> Option<String> {
    let case = case(text);
    let note = case.few_random_blocks();
    let warned = case
        .warnings()
        .into_iter()
        .find(|warning| warning.contains("in contact draw"));
    assert_eq!(warned, note);
    note
}

/// 5 %/sqrt(n): 5 % of one block, 2.5 % of four.
#[test]
fn few_blocks_that_draw_their_coefficients_are_noted() {
    assert_eq!(
        note("slider.blocks = [1, 1]").unwrap(),
        "1 block in contact draws its static and kinetic coefficients at random, with the default spread of 0.05 about the mean: the \
         coefficients of the slider scatter by about 5 % from seed to seed; `friction.sigma_static_star = 0` and \
         `friction.sigma_kinetic_star = 0` give the block the mean"
    );
    assert_eq!(
        note("slider.blocks = [2, 2]\nfriction.sigma_kinetic_star = 0").unwrap(),
        "4 blocks in contact draw their static coefficients at random, with the default spread of 0.05 about their mean: the mean static \
         coefficient of the slider scatters by about 2.5 % from seed to seed; `friction.sigma_static_star = 0` gives all blocks the mean"
    );
    let note = note("slider.blocks = [1, 1]\nfriction.sigma_static_star = 0").unwrap();
    assert!(
        note.contains("draws its kinetic coefficients")
            && note.contains("the kinetic coefficient of the slider")
    );
}

/// Textured blocks do not count: 6 x 6 blocks, half of them textured, count as 18.
#[test_case("slider.blocks = [5, 5]", false)]
#[test_case("slider.blocks = [4, 6]", true)]
#[test_case("slider.blocks = [6, 6]", false)]
#[test_case("slider.blocks = [6, 6]\n[[texture]]\nshape = 'groove'\nwidth = '3 um'", true)]
fn blocks_in_contact_count(text: &str, is_noted: bool) {
    assert_eq!(note(text).is_some(), is_noted);
}

/// A spread other than the default was given deliberately, and so was a correlation length. Rate and state
/// draws no coefficients, and springs in contact have no kinetic coefficient.
#[test]
fn coefficients_that_are_not_drawn_by_default_have_no_note() {
    for keys in [
        "friction = { sigma_static_star = 0, sigma_kinetic_star = 0 }",
        "friction = { sigma_static_star = 0.1, sigma_kinetic_star = 0.02 }",
        "friction.correlation_length = '1 um'",
        "friction = { law = 'rate_and_state', a = 0.02, b = 0.04, d_c_star = 0.5, v_0_star = 0.02 }",
        "friction = { contact = 'springs', contact_stiffness_star = 1, sigma_static_star = 0 }",
    ] {
        assert_eq!(note(&format!("slider.blocks = [2, 2]\n{keys}")), None, "{keys}");
    }
}

/// A case that a run has recorded has all keys, and the same warnings as the original case.
#[test]
fn a_printed_case_has_the_same_note() {
    let text = "slider.blocks = [2, 2]";
    let printed = CaseFile::parse(text, "case", &[]).unwrap().to_toml().unwrap();
    assert!(printed.contains("sigma_static_star"));
    assert_eq!(note(&printed), note(text));
}
