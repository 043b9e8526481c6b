//! Fig. 2: the local friction coefficients of one surface, as drawn from Eq. 1.

use statrs::distribution::{ContinuousCDF, Normal};

use crate::drawing::{Drawing, coefficient_maps};
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::blank_map;
use crate::runner::FigureRunner;
use crate::statistics::largest;
use slipfront_case::case::Case;
use slipfront_plot::{FieldMap, Response, Responses};

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let case = runner.case("fig02", &[])?;
    let (surface, groups) = (&case.model.surface, &case.groups);
    let scaled = |mu: &[f64], mean: f64| -> Vec<f64> { mu.iter().map(|mu| mu / mean).collect() };
    let mean = case.scales.mu_static_mean;
    let mu_static = scaled(&surface.mu_static, mean);
    let mu_kinetic = scaled(&surface.mu_kinetic, mean * groups.r_star);
    let map = |label: &str, values: &[f64]| FieldMap {
        values: values.iter().map(|&value| value as f32).collect(),
        ..blank_map(&case, label)
    };
    data.panel(
        "fig02",
        "Local static and kinetic friction coefficients of one random surface, divided by their means.",
        coefficient_maps(
            "\u{3bc}_i/\u{27e8}\u{3bc}\u{27e9}",
            groups.sigma_static_star,
            vec![
                map("static, \u{3bc}\u{209b}\u{1d62}", &mu_static),
                map("kinetic, \u{3bc}\u{2096}\u{1d62}", &mu_kinetic),
            ],
        ),
    );
    distribution(groups.sigma_static_star, &mu_static, &mu_kinetic, data);
    let scores = scores(&runner.case_on_surfaces("fig02")?);
    data.value("distance_to_gaussian", distance_to_normal(scores));
    Ok(())
}

/// Histograms of both coefficients over their means, compared with the Gaussian density.
fn distribution(sigma: f64, mu_static: &[f64], mu_kinetic: &[f64], data: &mut FigureData) {
    // Bins of half a standard deviation, up to three standard deviations on either side.
    let edge = |k: i32| 1.0 + 0.5 * sigma * f64::from(k);
    let bins: Vec<[f64; 2]> = (-6..6).map(|k| [edge(k), edge(k + 1)]).collect();
    let density =
        |x: f64| libm::exp(-0.5 * ((x - 1.0) / sigma).powi(2)) / (sigma * std::f64::consts::TAU.sqrt());
    let fine: Vec<f64> = (-60..=60).map(|k| 1.0 + 0.05 * sigma * f64::from(k)).collect();
    data.panel(
        "fig02_distribution",
        "Probability densities of these coefficients, with the Gaussian of Eq. 1.",
        Drawing::Responses(Responses {
            x_title: "local coefficient/mean".to_owned(),
            y_title: "density".to_owned(),
            curves: vec![
                histogram("static", &bins, mu_static),
                histogram("kinetic", &bins, mu_kinetic),
                Response::of_formula("Eq. 1", &fine, density),
            ],
            ..Responses::default()
        }),
    );
}

/// Deviations of all coefficients of these surfaces from their means, over the standard deviation of Eq. 1.
fn scores(cases: &[Case]) -> Vec<f64> {
    let mut scores = Vec::new();
    for case in cases {
        let (surface, groups) = (&case.model.surface, &case.groups);
        let mut add = |mu: &[f64], mean: f64, sigma: f64| {
            scores.extend(mu.iter().map(|mu| (mu / mean - 1.0) / sigma));
        };
        let mean = case.scales.mu_static_mean;
        add(&surface.mu_static, mean, groups.sigma_static_star);
        add(
            &surface.mu_kinetic,
            groups.r_star * mean,
            groups.sigma_kinetic_star,
        );
    }
    scores
}

fn histogram(label: &str, bins: &[[f64; 2]], values: &[f64]) -> Response {
    let share = |&[low, high]: &[f64; 2]| {
        let inside = values.iter().filter(|&value| (low..high).contains(value));
        inside.count() as f64 / values.len() as f64 / (high - low)
    };
    let middles: Vec<f64> = bins.iter().map(|[low, high]| 0.5 * (low + high)).collect();
    let shares: Vec<f64> = bins.iter().map(share).collect();
    Response::of_values(label, &middles, &shares)
}

/// Kolmogorov-Smirnov distance between a sample and the standard Gaussian, times sqrt(n): below 1.36 with
/// 95 % confidence if the sample is Gaussian.
fn distance_to_normal(mut sorted: Vec<f64>) -> f64 {
    let normal = Normal::standard();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let gaps = sorted.iter().enumerate().map(|(k, &value)| {
        let expected = normal.cdf(value);
        (expected - k as f64 / n).max((k + 1) as f64 / n - expected)
    });
    largest(gaps) * n.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_is_near_and_a_uniform_sample_far() {
        let normal = Normal::standard();
        let at = |k: usize| (k as f64 + 0.5) / 400.0;
        let gaussian: Vec<f64> = (0..400).map(|k| normal.inverse_cdf(at(k))).collect();
        // A uniform distribution with the same mean and standard deviation.
        let uniform: Vec<f64> = (0..400).map(|k| 12f64.sqrt() * (at(k) - 0.5)).collect();
        assert!(distance_to_normal(gaussian) < 0.1);
        assert!(distance_to_normal(uniform) > 1.0);
    }
}
