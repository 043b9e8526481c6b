//! Fig. 8: static friction against speed.

use crate::drawing::{Drawing, measured, stress_maps};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::values;
use crate::run::peak_maps;
use crate::runner::FigureRunner;
use crate::statistics::{rises, smallest};
use slipfront_plot::Responses;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig08")?;
    let speeds = sweep.axis(0);
    let numbers = sweep.numbers(&[], "static_friction_star");
    data.panel(
        "fig08",
        "Static friction against speed. Lines: means over five random surfaces; bands: 95 % confidence intervals of these means.",
        Drawing::Responses(Responses {
            x_title: "drive speed V*".to_owned(),
            y_title: "static friction \u{3bc}\u{209b}*".to_owned(),
            curves: vec![measured("", &speeds, &numbers)],
            note: runner.note_on_bands(),
            ..Responses::default()
        }),
    );
    let runs = runner.run(sweep.first_cases()?)?;
    let labels: Vec<String> = speeds.iter().map(|speed| format!("V* = {speed}")).collect();
    data.panel(
        "fig08_maps",
        "Contact stress at the friction peak. At higher drive speed more blocks slip before the peak.",
        stress_maps(peak_maps(&runs, &labels)?, 3),
    );
    let means = values(&numbers);
    data.value("least_rise", smallest(rises(&means)));
    data.number("at_the_fastest", numbers[numbers.len() - 1]);
    data.value("whole_rise", means[means.len() - 1] - means[0]);
    Ok(())
}
