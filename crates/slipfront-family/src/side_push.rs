//! An upright plate that is pushed at its side, near the interface.

use slipfront_case::case::FilesInMemory;
use slipfront_plot::Response;

use crate::chapter::Chapter;
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

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let files = FilesInMemory::from([(PUSHED_NAME.to_owned(), PUSHED.into())]);
    let (experiment, last_step) = Experiment::of_case_with("vertical_slider", CASE, &files)?;
    let events = experiment.events("vertical_slider", last_step)?;
    let [mu_static, mu_kinetic] = COEFFICIENTS;
    let whole = events.iter().position(|event| event.blocks == BLOCKS);
    let precursors = &events[..whole.unwrap_or(events.len())];
    let grow = precursors
        .windows(2)
        .filter(|pair| pair[1].blocks > pair[0].blocks);
    let first = &events[0];
    let drive = &experiment.model.drive;
    let rise = drive.k_drive * drive.v_star * experiment.dt_star / BLOCKS as f64;
    let loads = events.iter().map(|event| event.mu_star_before);
    let largest = loads.fold(0.0, f64::max);
    chapter.add(
        "\u{3bc}* at the first slip",
        [FIRST_SLIP.0, first.mu_star_before],
        rise,
        "increase of the drive force in one step",
    );
    chapter.add(
        "column of the first block to slip",
        [FIRST_SLIP.1, f64::from(first.nucleation[0])],
        0.0,
        "a whole number, no error",
    );
    chapter.add(
        "number of precursors longer than the one before, without the first",
        [(precursors.len().max(1) - 1) as f64, grow.count() as f64],
        0.0,
        "every precursor must be longer",
    );
    chapter.add(
        "largest F_T/F_N, compared with (\u{3bc}_s + \u{3bc}_k)/2",
        [0.5 * (mu_static + mu_kinetic), mu_static * largest],
        0.5 * (mu_static - mu_kinetic),
        "(\u{3bc}_s - \u{3bc}_k)/2, since not all blocks carry static friction at once",
    );
    let upto = &events[..whole.map_or(events.len(), |at| at + 1)];
    let ratios: Vec<f64> = upto
        .iter()
        .map(|event| mu_static * event.mu_star_before)
        .collect();
    let lengths: Vec<f64> = upto
        .iter()
        .map(|event| event.blocks as f64 / BLOCKS as f64)
        .collect();
    chapter.draw(
        "Fraction of the interface that slips in a precursor, against F_T/F_N at the start of the precursor, up to the first event that \
         crosses the interface.",
        ["F_T/F_N", "fraction of the interface"],
        vec![Response::of_values("precursors", &ratios, &lengths)],
    );
    Ok(())
}
