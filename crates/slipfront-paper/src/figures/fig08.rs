//! Fig. 8: static friction against speed.

use crate::drawing::{Drawing, measured, stress_maps};
use crate::error::PaperError;
use crate::measurements::{Found, Number, rises, smallest};
use crate::runner::Bench;
use slipfront_plot::Responses;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig08")?;
    let speeds = sweep.axis(0);
    let numbers: Vec<Number> = (0..speeds.len())
        .map(|k| sweep.number(&[k], "static_friction_star"))
        .collect();
    found.panel(
        "fig08",
        "Static friction against speed, means of five surfaces with their 95 % intervals.",
        Drawing::Responses(Responses {
            x_title: "drive speed V*".to_owned(),
            y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
            curves: vec![measured("", &speeds, &numbers)],
            ..Responses::default()
        }),
    );
    let cases = (0..speeds.len())
        .map(|k| sweep.case(&[k], 0))
        .collect::<Result<_, _>>()?;
    let mut maps = Vec::new();
    for (run, speed) in bench.run(cases)?.iter().zip(&speeds) {
        maps.push(run.stress_map(run.instant('C')?, &format!("V* = {speed}"))?);
    }
    found.panel(
        "fig08_maps",
        "Contact stress at the peak of friction: the faster the drive, the more blocks slip before it comes.",
        stress_maps(maps, 3),
    );
    let means: Vec<f64> = numbers.iter().map(|number| number.value).collect();
    found.value("fig08.least_rise", smallest(rises(&means)));
    found.number("fig08.at_the_fastest", numbers[numbers.len() - 1]);
    found.value("fig08.whole_rise", means[means.len() - 1] - means[0]);
    Ok(found)
}
