//! Fig. 3 and Table 1: eight materials at one dimensionless speed, as printed and as corrected (D3).

use crate::drawing::Drawing;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{FigureRun, mu_star, sliding_percent};
use crate::runner::FigureRunner;
use crate::statistics::range;

/// The cases with a printed speed that does not give V* = 0.03.
const CORRECTED: [u32; 3] = [3, 6, 7];
/// V* of Table 1.
const V_STAR: f64 = 0.03;

fn files(corrected: bool) -> impl Iterator<Item = String> {
    (1..=8).map(move |case| {
        if corrected && CORRECTED.contains(&case) {
            format!("table1/case{case}_corrected")
        } else {
            format!("table1/case{case}")
        }
    })
}

/// Measures Table 1: V* from its parameters.
pub(super) fn measure_table(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let mut rows = Vec::new();
    let (mut printed_error, mut corrected_error) = (0.0_f64, 0.0_f64);
    for (printed, corrected) in files(false).zip(files(true)) {
        let (printed, corrected) = (runner.case(&printed, &[])?, runner.case(&corrected, &[])?);
        let error = |v_star: f64| 100.0 * (v_star / V_STAR - 1.0).abs();
        printed_error = printed_error.max(error(printed.groups.v_star));
        corrected_error = corrected_error.max(error(corrected.groups.v_star));
        let speed = |v_star: f64| format!("{:.4}", v_star * printed.scales.speed() * 1e3);
        let number = |value: f64| {
            let digits = format!("{value:.4}");
            digits.trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        rows.push([
            (rows.len() + 1).to_string(),
            speed(printed.groups.v_star),
            number(printed.scales.pressure / 1e3),
            number(printed.scales.young_modulus / 1e6),
            number(printed.scales.density / 1e3),
            number(printed.scales.mu_static_mean),
            format!("{:.4}", printed.groups.v_star),
            speed(corrected.groups.v_star),
            format!("{:.0e}", printed.groups.epsilon),
        ]);
    }
    let header = [
        "case",
        "V (mm/s)",
        "P (kPa)",
        "E (MPa)",
        "rho (g/cm^3)",
        "mu_s",
        "V* as printed",
        "V (mm/s) for V* = 0.03",
        "epsilon",
    ];
    data.table(
        "table1",
        "Table 1: printed speeds, the V* that they give by Eq. 11a, and the speeds that give V* = 0.03 (D3).",
        header,
        rows,
    );
    data.value("v_star_error_percent", printed_error);
    data.value("v_star_error_corrected_percent", corrected_error);
    Ok(())
}

/// Fig. 3: the curves of the eight cases in one picture.
pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let corrected = runs(runner, true)?;
    let printed = runs(runner, false)?;
    // Case 8 is the one that every other figure varies.
    let [.., main] = &corrected[..] else {
        return Ok(());
    };
    let until = main.instant('E')?.time_star;
    for (name, runs) in [("corrected", &corrected), ("printed", &printed)] {
        let spread = |value| main.largest_difference_of(runs, [0.0, until], value);
        data.value(&format!("spread_{name}"), spread(mu_star));
        data.value(&format!("sliding_spread_{name}_percent"), spread(sliding_percent));
    }
    other_surfaces(runner, main, data)?;
    let window = main.kinetic_window()?;
    data.value(
        "kinetic_spread",
        main.largest_difference_of(&corrected, window, mu_star),
    );
    let means = corrected
        .iter()
        .filter_map(|run| run.record.summary.kinetic_friction_star);
    data.value("kinetic_mean_spread", range(&means.collect::<Vec<_>>()));
    let curves = |runs: &[FigureRun]| {
        let label = |index: usize| format!("case {}", index + 1);
        let curves = runs.iter().enumerate().map(|(index, run)| match index {
            7 => run.lettered_curve(&label(index)),
            _ => run.curve(&label(index)),
        });
        Drawing::Curves(curves.collect())
    };
    data.panel(
        "fig03",
        "The eight cases of Table 1, with three speeds corrected so that all have V* = 0.03 (D3). Top: friction; bottom: sliding \
         blocks. A-F are the instants of Fig. 4.",
        curves(&corrected),
    );
    data.panel(
        "fig03_as_printed",
        "The eight cases with the printed speeds. Cases 3, 6 and 7 have V* = 0.015, 0.010 and 0.015, so their curves differ.",
        curves(&printed),
    );
    Ok(())
}

/// Case 8 on seven surfaces that differ from the common one of all eight cases.
fn other_surfaces(runner: &FigureRunner, main: &FigureRun, data: &mut FigureData) -> Result<(), PaperError> {
    let until = main.instant('E')?.time_star;
    let cases = (2..=8).map(|seed| runner.case("table1/case8", &[&format!("friction.seed={seed}")]));
    let runs = runner.run(cases.collect::<Result<_, _>>()?)?;
    let rows = runs.iter().map(|run| {
        let difference = |value| main.largest_difference(run, [0.0, until], value);
        [
            run.case.file.friction.seed.to_string(),
            format!("{:.3}", difference(mu_star)),
            format!("{:.1}", difference(sliding_percent)),
        ]
    });
    data.table(
        "fig03_surfaces",
        "Case 8 on other random surfaces: largest difference from the first surface, which all curves of Fig. 3 use here, up \
         to the end of the transition.",
        ["surface", "difference of mu*", "difference of N* (%)"],
        rows,
    );
    Ok(())
}

fn runs(runner: &FigureRunner, corrected: bool) -> Result<Vec<FigureRun>, PaperError> {
    let cases = files(corrected).map(|file| runner.case(&file, &[]));
    runner.run(cases.collect::<Result<_, _>>()?)
}
