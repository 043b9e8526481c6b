//! Fig. 6: onset time and number of time steps against speed, and the material properties that determine the
//! onset.

use crate::drawing::{Drawing, measured};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::number::MeasuredNumber;
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, ratios, smallest};
use crate::sweep::ParameterSweep;
use slipfront_plot::{Response, Responses};

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let sweep = runner.study("fig06")?;
    let speeds = sweep.axis(0);
    let onsets = sweep.numbers(&[], "onset_time_star");
    // Steps up to the onset, in the paper's step.
    let steps: Vec<MeasuredNumber> = (0..speeds.len())
        .map(|k| {
            let [times, steps] = ["onset_time_star", "dt_star"].map(|quantity| sweep.values(&[k], quantity));
            MeasuredNumber::from_values(&ratios(&times, &steps))
        })
        .collect();
    data.panel(
        "fig06",
        "Onset time and number of time steps up to the onset, with dt* = (2/3) V*, against speed, compared with Eqs. 12 and 14.",
        Drawing::Responses(Responses {
            x_title: "drive speed V*".to_owned(),
            log_x: true,
            log_y: true,
            y_title: "onset time t\u{209b}*, steps to the onset n\u{209b}*".to_owned(),
            curves: vec![
                measured("t\u{209b}*", &speeds, &onsets),
                Response::of_formula("(5/2)/V*", &speeds, |v| 2.5 / v),
                measured("n\u{209b}*", &speeds, &steps),
                Response::of_formula("(15/4)/V*\u{b2}", &speeds, |v| 3.75 / (v * v)),
            ],
            ..Responses::default()
        }),
    );
    let errors = |numbers: &[MeasuredNumber], fit: fn(f64) -> f64| {
        let pairs = numbers.iter().zip(&speeds);
        largest(pairs.map(|(number, &v)| 100.0 * (number.value / fit(v) - 1.0).abs()))
    };
    data.value("onset_error_percent", errors(&onsets, |v| 2.5 / v));
    data.value("steps_error_percent", errors(&steps, |v| 3.75 / (v * v)));
    data.value("slope", slope(&speeds, &onsets));
    let at = |v: f64| steps[sweep.level(v)].value;
    data.value("steps_ratio", at(0.01) / at(0.05));
    material(&runner.study("fig06_material")?, data);
    Ok(())
}

/// Exponent of a power law, fitted to the means by least squares of logarithms.
fn slope(x: &[f64], y: &[MeasuredNumber]) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = x
        .iter()
        .zip(y)
        .map(|(x, y)| (libm::log(*x), libm::log(y.value)))
        .unzip();
    let (center_x, center_y) = (mean(&x), mean(&y));
    let products = x.iter().zip(&y).map(|(x, y)| (x - center_x) * (y - center_y));
    products.sum::<f64>() / x.iter().map(|x| (x - center_x).powi(2)).sum::<f64>()
}

/// The effect of each quantity of the material on the onset time.
fn material(sweep: &ParameterSweep, data: &mut FigureData) {
    let names = sweep.names(0);
    let factor_of = |quantity: &str, k: usize| {
        let [changed, unchanged] = [k, 0].map(|k| sweep.values(&[k], quantity));
        MeasuredNumber::from_values(&ratios(&changed, &unchanged))
    };
    let factor = |quantity: &str, name: &str| {
        let place = names.iter().position(|other| other == name);
        place.map_or(MeasuredNumber::exact(f64::NAN), |k| factor_of(quantity, k))
    };
    let named = |name: &str| factor("onset_time_s", name);
    data.number("factor_of_young_modulus", named("E x 4"));
    data.number("factor_of_density", named("rho x 4"));
    let star = |name: &str| factor("onset_time_star", name);
    // sqrt(E/rho) doubled in two ways, and sqrt(E rho).
    for (name, changes) in [
        ("onset_star_factor_of_quotient", ["E x 4", "rho / 4"]),
        ("onset_star_factor_of_product", ["E x 4", "rho x 4"]),
    ] {
        data.value(name, largest(changes.map(|change| star(change).value)));
    }
    let load = [named("P x 2"), named("mu_s x 2")].map(|number| number.value);
    data.value("least_factor_of_load", smallest(load));
    data.number("factor_of_speed", named("V x 2"));
    // t* as printed does not contain l (D4): by that definition, the same slider would begin to slide later
    // with larger blocks.
    data.number("factor_of_block_size", named("l x 2"));
    data.number("onset_star_factor_of_block_size", star("l x 2"));
    let rows = names.iter().enumerate().map(|(k, name)| {
        [
            name.clone(),
            format!("{:.3}", mean(&sweep.values(&[k], "v_star"))),
            format!("{:.2}", 1e9 * mean(&sweep.values(&[k], "onset_time_s"))),
            format!("{:.3}", factor_of("onset_time_s", k).value),
        ]
    });
    data.table(
        "fig06_material",
        "Onset time after one quantity of case 8 of Table 1 is changed. The factor is relative to the unchanged case.",
        ["change", "V*", "onset time (ns)", "factor"],
        rows,
    );
}
