//! A slider that is driven at an edge: precursors.

use slipfront::Edge;
use slipfront::exact_solutions::precursor_load;
use slipfront::observe::Precursors;
use slipfront_plot::Responses;

use super::answer::{Answer, Chapter};
use super::runs::Run;
use crate::drawing::{Drawing, formula, measured};
use crate::error::PaperError;
use crate::number::Number;

const KINETIC: f64 = 0.45;
const SLOPES: [f64; 3] = [-0.833, 0.0, 0.833];

/// Lengths and loads of the events that are longer than all before, and the largest load.
fn precursors(slope: f64) -> Result<(Vec<[f64; 2]>, f64), PaperError> {
    let text = format!(
        "[slider]\nblocks = [100, 1]\nomega_star = 0\nviscosity_time_star = 0.365\n\
         [load]\nprofile = {{ along = \"x\", relative_slope = {slope} }}\n\
         [drive]\nv_star = 1\nattach = \"left\"\ntotal_stiffness_star = 0.00242\n\
         [friction]\nmu_static = 0.7\nmu_kinetic = {KINETIC}\nsigma_static_star = 0\nsigma_kinetic_star = 0\n\
         [time]\nstep = 0.1\nduration_star = 34600"
    );
    let mut observer = Precursors::new(Edge::Left);
    let run = Run::watched("precursors", &text, &mut [&mut observer])?;
    let mut longest = 0.0;
    let mut points = Vec::new();
    for event in observer.events() {
        if let Some((_, mu_star)) = event.after
            && event.length > longest
            && event.length < 1.0
        {
            longest = event.length;
            points.push([longest, 0.7 * mu_star]);
        }
    }
    Ok((points, 0.7 * run.largest()))
}

pub(super) fn chapter() -> Result<Chapter, PaperError> {
    let mut answers = Vec::new();
    let mut curves = Vec::new();
    for slope in SLOPES {
        let (points, peak) = precursors(slope)?;
        let errors = points
            .iter()
            .filter(|[length, _]| *length > 0.2)
            .map(|[length, load]| load / precursor_load(*length, KINETIC, slope) - 1.0);
        let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0);
        for error in errors {
            squares += error * error;
            largest = largest.max(error.abs());
            count += 1;
        }
        let rms = (squares / f64::from(count)).sqrt();
        let reason =
            "of 100 blocks: the force on the block at the tip, and what the drive adds during an event";
        answers.push(Answer::new(
            format!("{count} events beyond a fifth of the length, θ = {slope}: relative error of F_T, rms"),
            [0.0, rms],
            (0.03, reason),
        ));
        answers.push(Answer::new(
            format!("the same, θ = {slope}: largest"),
            [0.0, largest],
            (0.08, reason),
        ));
        answers.push(Answer::new(
            format!("largest F_T/F_N, θ = {slope}: that of kinetic friction of the whole chain"),
            [KINETIC, peak],
            (0.03, "it tends to it with the number of blocks"),
        ));
        let lengths: Vec<f64> = (1..=50).map(|k| 0.02 * f64::from(k)).collect();
        curves.push(formula(
            &format!("\u{3b8} = {slope}, exact"),
            &lengths,
            |length| precursor_load(length, KINETIC, slope),
        ));
        let [x, y] = [0, 1].map(|k| points.iter().map(|point| point[k]).collect::<Vec<_>>());
        let loads: Vec<Number> = y.into_iter().map(Number::exact).collect();
        curves.push(measured(&format!("\u{3b8} = {slope}"), &x, &loads));
    }
    Ok(Chapter {
        title: "Driven at an edge: precursors",
        name: "precursors",
        text: include_str!("text/edge_drive.md"),
        answers,
        picture: Some((
            "Load after each event that reached farther than all before, against its length, under three profiles of pressure.",
            Drawing::Responses(Responses {
                x_title: "length of the event over that of the chain".to_owned(),
                y_title: "load F_T/F_N".to_owned(),
                curves,
                ..Responses::default()
            }),
        )),
    })
}
