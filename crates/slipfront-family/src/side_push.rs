//! An upright plate that is pushed at its side, near the interface.

use slipfront_case::case::FilesInMemory;
use slipfront_plot::{Response, Responses};

use crate::answer::{Answer, Chapter};
use crate::error::FamilyError;
use crate::runs::Experiment;

const CASE: &str = include_str!("../cases/vertical_slider.toml");
const PUSHED: &[u8] = include_bytes!("../cases/vertical_slider_push.png");
const PUSHED_NAME: &str = "vertical_slider_push.png";
/// mu* at which the first block slips, and the column of that block, quasi-static on this lattice. They come
/// from one solution of the linear equations: the lowest row is held along x and rests on its foundation, and
/// the drive spring acts on the pushed block.
const FIRST_SLIP: (f64, f64) = (0.112095, 2.0);
/// Static and kinetic coefficient of the case.
const COEFFICIENTS: [f64; 2] = [0.4, 0.17];
/// Blocks of the interface.
const BLOCKS: usize = 57;

pub(crate) fn chapter() -> Result<Chapter, FamilyError> {
    let files = FilesInMemory::from([(PUSHED_NAME.to_owned(), PUSHED.into())]);
    let (experiment, last_step) = Experiment::of_case_with("vertical_slider", CASE, &files)?;
    let events = experiment.events("vertical_slider", last_step)?;
    let (mu_static, mu_kinetic) = (COEFFICIENTS[0], COEFFICIENTS[1]);
    let whole = events.iter().position(|event| event.blocks == BLOCKS);
    let precursors = &events[..whole.unwrap_or(events.len())];
    let grow = precursors
        .windows(2)
        .filter(|pair| pair[1].blocks > pair[0].blocks);
    let first = &events[0];
    let drive = &experiment.model.drive;
    let rise = drive.k_drive * drive.v_star * experiment.dt_star / BLOCKS as f64;
    let largest = events
        .iter()
        .map(|event| event.mu_star_before)
        .fold(0.0, f64::max);
    let [middle, half] = [0.5 * (mu_static + mu_kinetic), 0.5 * (mu_static - mu_kinetic)];
    let answers = vec![
        Answer::new(
            "\u{3bc}* at the first slip",
            [FIRST_SLIP.0, first.mu_star_before],
            (rise, "increase of the drive force in one step"),
        ),
        Answer::new(
            "column of the first block to slip",
            [FIRST_SLIP.1, f64::from(first.nucleation[0])],
            (0.0, "a whole number, no error"),
        ),
        Answer::new(
            "number of precursors longer than the one before, without the first",
            [(precursors.len().max(1) - 1) as f64, grow.count() as f64],
            (0.0, "every precursor must be longer"),
        ),
        Answer::new(
            "largest F_T/F_N, compared with (\u{3bc}_s + \u{3bc}_k)/2",
            [middle, mu_static * largest],
            (
                half,
                "(\u{3bc}_s - \u{3bc}_k)/2, since not all blocks carry static friction at once",
            ),
        ),
    ];
    let upto = whole.map_or(events.len(), |at| at + 1);
    let [ratio, length]: [Vec<f64>; 2] = [
        events[..upto]
            .iter()
            .map(|event| mu_static * event.mu_star_before)
            .collect(),
        events[..upto]
            .iter()
            .map(|event| event.blocks as f64 / BLOCKS as f64)
            .collect(),
    ];
    Ok(Chapter {
        title: "Plate pushed at its side",
        name: "side",
        text: include_str!("text/rupture_side.md"),
        answers,
        picture: Some((
            "Fraction of the interface that slips in a precursor, against F_T/F_N at the start of the precursor, up to the first event that \
             crosses the interface.",
            Responses {
                x_title: "F_T/F_N".to_owned(),
                y_title: "fraction of the interface".to_owned(),
                curves: vec![Response::of_values("precursors", &ratio, &length)],
                ..Responses::default()
            },
        )),
    })
}
