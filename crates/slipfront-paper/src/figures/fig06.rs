//! Fig. 6: onset time and number of time steps against speed, and what of the material decides on the onset.

use crate::drawing::{Drawing, formula, measured};
use crate::error::PaperError;
use crate::measurements::{Found, Number, Table, largest, mean, smallest};
use crate::runner::{Bench, Sweep};
use slipfront_plot::Responses;

pub(super) fn find(bench: &mut Bench) -> Result<Found, PaperError> {
    let mut found = Found::default();
    let sweep = bench.study("fig06")?;
    let speeds = sweep.axis(0);
    let onsets: Vec<Number> = (0..speeds.len())
        .map(|k| sweep.number(&[k], "onset_time_star"))
        .collect();
    // Steps up to the onset, in the paper's step.
    let steps: Vec<Number> = (0..speeds.len())
        .map(|k| {
            let (times, steps) = (
                sweep.values(&[k], "onset_time_star"),
                sweep.values(&[k], "dt_star"),
            );
            let counts: Vec<f64> = times.iter().zip(&steps).map(|(time, step)| time / step).collect();
            Number::of(&counts)
        })
        .collect();
    let curves = |title: &str, numbers: &[Number], label: &str, fit: fn(f64) -> f64| {
        Drawing::Responses(Responses {
            x_title: "drive speed V*".to_owned(),
            log_x: true,
            log_y: true,
            y_title: title.to_owned(),
            curves: vec![
                measured("measured", &speeds, numbers),
                formula(label, &speeds, fit),
            ],
            ..Responses::default()
        })
    };
    found.panel(
        "fig06",
        "Onset time against speed, beside Eq. 12.",
        curves("onset time t\u{209b}*", &onsets, "(5/2)/V*", |v| 2.5 / v),
    );
    found.panel(
        "fig06_steps",
        "Time steps up to the onset with dt* = (2/3) V*, beside Eq. 14.",
        curves("steps to the onset n\u{209b}*", &steps, "(15/4)/V*\u{b2}", |v| {
            3.75 / (v * v)
        }),
    );
    let errors = |numbers: &[Number], fit: fn(f64) -> f64| {
        let errors = numbers
            .iter()
            .zip(&speeds)
            .map(|(number, &v)| 100.0 * (number.value / fit(v) - 1.0).abs());
        largest(errors)
    };
    found.value("fig06.onset_error_percent", errors(&onsets, |v| 2.5 / v));
    found.value("fig06.steps_error_percent", errors(&steps, |v| 3.75 / (v * v)));
    found.value("fig06.slope", slope(&speeds, &onsets));
    let at = |v: f64| {
        speeds
            .iter()
            .position(|&speed| speed == v)
            .map_or(f64::NAN, |k| steps[k].value)
    };
    found.value("fig06.steps_ratio", at(0.01) / at(0.05));
    material(&bench.study("fig06_material")?, &mut found);
    Ok(found)
}

/// Exponent of a power law through the means, by least squares of logarithms.
fn slope(x: &[f64], y: &[Number]) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = x.iter().zip(y).map(|(x, y)| (x.ln(), y.value.ln())).unzip();
    let (center_x, center_y) = (mean(&x), mean(&y));
    let products = x.iter().zip(&y).map(|(x, y)| (x - center_x) * (y - center_y));
    products.sum::<f64>() / x.iter().map(|x| (x - center_x).powi(2)).sum::<f64>()
}

/// What changing one quantity of the material does to the onset, in seconds.
fn material(sweep: &Sweep, found: &mut Found) {
    let names = sweep.names(0);
    let times = |k: usize| sweep.values(&[k], "onset_time_s");
    let before = times(0);
    let factor = |k: usize| {
        let ratios: Vec<f64> = times(k)
            .iter()
            .zip(&before)
            .map(|(after, before)| after / before)
            .collect();
        Number::of(&ratios)
    };
    let named = |name: &str| {
        names
            .iter()
            .position(|other| other == name)
            .map_or(Number::exact(f64::NAN), factor)
    };
    found.number("fig06.factor_of_young_modulus", named("E x 4"));
    found.number("fig06.factor_of_density", named("rho x 4"));
    let star = |name: &str| {
        let times = |k: usize| sweep.values(&[k], "onset_time_star");
        let place = names.iter().position(|other| other == name);
        let ratios = place.map(|k| {
            times(k)
                .iter()
                .zip(times(0))
                .map(|(after, before)| after / before)
                .collect::<Vec<f64>>()
        });
        Number::of(&ratios.unwrap_or_default())
    };
    found.number("fig06.onset_star_factor_of_young_modulus", star("E x 4"));
    found.number("fig06.onset_star_factor_of_low_density", star("rho / 4"));
    let load = [named("P x 2"), named("mu_s x 2")].map(|number| number.value);
    found.value("fig06.least_factor_of_load", smallest(load));
    found.number("fig06.factor_of_speed", named("V x 2"));
    // t* as printed has no l in it (D4): the same slider made of larger blocks would begin to slide later in it.
    found.number("fig06.factor_of_block_size", named("l x 2"));
    let mut table = Table {
        name: "fig06_material".to_owned(),
        caption: "Onset time in seconds after one quantity of Table 1 case 8 is changed, over the onset time before."
            .to_owned(),
        header: ["change", "V*", "onset time (ns)", "factor"].map(str::to_owned).to_vec(),
        rows: Vec::new(),
    };
    for (k, name) in names.iter().enumerate() {
        let factor = factor(k);
        table.rows.push(vec![
            name.clone(),
            format!("{:.3}", mean(&sweep.values(&[k], "v_star"))),
            format!("{:.2}", 1e9 * mean(&times(k))),
            format!("{:.3}", factor.value),
        ]);
    }
    found.tables.push(table);
}
