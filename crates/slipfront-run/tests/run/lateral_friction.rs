//! Friction across the drive in the summary equals that of the curve.

use std::sync::Arc;

use slipfront_case::case::Case;
use slipfront_run::running;

#[test]
fn the_summary_has_what_is_across_the_drive() {
    let text = "slider.blocks = [12, 9]\ndrive = { v_star = 0.1, direction = 30 }\noutput.series = 0.1\n\
                texture = [{ shape = 'groove', coverage = 25 }]";
    let case = Arc::new(Case::parse(text, "case", "", &[]).unwrap());
    let record = running::run(&case, 1).unwrap();
    let (summary, rows) = (record.summary, record.rows);
    assert_eq!(rows.len() as u64, summary.steps + 1, "a row for every step");
    let peak = rows
        .iter()
        .find(|row| row.point.mu_star == summary.static_friction_star)
        .unwrap();
    let across = peak.point.mu_lateral_star;
    assert!(
        summary.static_lateral_friction_star == across && across != 0.0,
        "{across}"
    );

    let [from, to] = summary.kinetic_window_star.unwrap();
    let half_a_step = 0.05;
    let in_window = |time: f64| (from - half_a_step..=to + half_a_step).contains(&time);
    let window = rows.iter().filter(|row| in_window(row.time_star));
    let across: Vec<f64> = window.map(|row| row.point.mu_lateral_star).collect();
    let mean = across.iter().sum::<f64>() / across.len() as f64;
    let found = summary.kinetic_lateral_friction_star.unwrap();
    // Sums of some hundred numbers below 1.
    assert!(
        (found - mean).abs() < 1e-14 && mean.abs() > 1e-4,
        "{found} {mean}"
    );
}
