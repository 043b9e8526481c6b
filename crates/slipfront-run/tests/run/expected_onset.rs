//! The onset that `check` expects where only some blocks touch, against runs.

use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;

/// Expected and found path of the drive to the onset, and the texture.
fn paths(texture: &str, redistribute: bool, drive: &str) -> ([f64; 2], f64) {
    let text = format!(
        "slider.blocks = [40, 40]\nload.redistribute = {redistribute}\n{drive}\ntime.stop = 'after_onset'\ntexture = [{texture}]\n\
         friction = {{ sigma_static_star = 0, sigma_kinetic_star = 0 }}"
    );
    let case = Case::parse(&text, "case", "", &[]).unwrap();
    let v_star = case.groups.v_star;
    let found = run_summary(&case).unwrap().onset_time_star;
    (case.expected.onset_star.map(|star| star * v_star), found * v_star)
}

/// Sparse contacts are pulled by the blocks around them: without redistribution of their load, they slip up
/// to five times as early as blocks that carry it alone. A front that starts early lowers the earlier bound
/// by at most 15 %.
#[test]
fn the_onset_of_sparse_contacts_is_expected_where_it_is_found() {
    const PILLARS: &str = "{ shape = 'cavity', lambda = '1.5 um', pitch = '8 um', invert = true }";
    const CAVITY: &str = "{ shape = 'cavity', coverage = 30 }";
    const LINE: &str = "{ shape = 'groove', coverage = 5, orientation = 'along', invert = true }";
    for texture in [PILLARS, CAVITY, LINE] {
        for redistribute in [false, true] {
            let ([from, to], found) = paths(texture, redistribute, "drive.v_star = 0.01");
            let within = 0.85 * from..=to;
            assert!(
                within.contains(&found),
                "{texture} {redistribute}: {found} {from} to {to}"
            );
        }
    }
    // A drive at an edge pulls all blocks together: 5 % of them bear 5 % of the load.
    let edge = "drive = { v_star = 0.01, attach = 'left' }";
    let ([whole, _], _) = paths("", true, edge);
    let ([from, to], _) = paths(LINE, false, edge);
    assert!(
        from == to && (from / whole - 0.05).abs() < 1e-12,
        "{from} {to} {whole}"
    );
}

/// A line of contacts that carries the only load of the slider loses half of its friction when it slips. This
/// is a transition with a front, however small the line's share of the load is.
#[test]
fn a_line_of_contacts_has_a_transition() {
    let text = "slider.blocks = [40, 40]\nload.redistribute = false\ndrive.v_star = 0.003\n\
                texture = [{ shape = 'groove', coverage = 2.5, orientation = 'along', invert = true }]";
    let case = Case::parse(text, "case", "", &[]).unwrap();
    let summary = run_summary(&case).unwrap();
    assert!(summary.transition, "{summary:?}");
    assert!(summary.static_friction_star < 0.025 && summary.front_duration_star.is_some());
}
