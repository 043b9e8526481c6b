//! Fig. 4: contact stress at the instants A-F, and what the paper reads from it.

use slipfront::observe::Frame;

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{Run, seen_at};
use crate::runner::FigureRunner;
use crate::statistics::{largest, mean, smallest};
use slipfront::observe::Field;

pub(super) fn measure(runner: &mut FigureRunner) -> Result<FigureData, PaperError> {
    let mut data = FigureData::default();
    let runs = runner.run(runner.case_on_surfaces("fig04")?)?;
    let [main, ..] = &runs[..] else { return Ok(data) };
    let maps = ['A', 'B', 'C', 'D', 'E', 'F']
        .map(|letter| main.stress_map(main.instant(letter)?, &letter.to_string()));
    data.panel(
        "fig04",
        "Contact stress at the instants A-F of Fig. 3: loading, first slip, peak, most blocks sliding, least friction, \
         kinetic phase.",
        stress_maps(maps.into_iter().collect::<Result<_, _>>()?, 3),
    );
    before_slip(runner, main, &mut data)?;
    let over = |value: &dyn Fn(&Run) -> Result<f64, PaperError>| -> Result<Vec<f64>, PaperError> {
        runs.iter().map(value).collect()
    };
    let ranks = over(&first_slip_rank)?;
    data.value("fig04.worst_rank_of_first_slip", largest(ranks));
    data.values(
        "fig04.stress_left_after_slip_percent",
        &over(&|run| stress_left(runner, run))?,
    );
    data.values("fig04.slipped_at_peak_percent", &over(&slipped_at_peak)?);
    data.values("fig04.rest_slips_within_percent", &over(&rest_slips_within)?);
    data.values(
        "fig04.sliding_jump_percent",
        &over(&|run| Ok(run.instant('D')?.point.sliding_percent))?,
    );
    data.values(
        "fig04.stress_falls_from_d_to_e_percent",
        &over(&falls_from_d_to_e)?,
    );
    data.values(
        "fig04.kinetic_minimum_over_e",
        &over(&|run| {
            let [from, until] = run.kinetic_window()?;
            Ok(smallest(run.friction_between(from, until)) - run.instant('E')?.point.mu_star)
        })?,
    );
    let sliding = |run: &Run| run.record.summary.sliding_percent_kinetic;
    data.values(
        "fig04.kinetic_sliding_percent",
        &runs.iter().filter_map(sliding).collect::<Vec<_>>(),
    );
    Ok(data)
}

/// Until the first slip: is the stress the same everywhere, does it grow as k_s V* t*, does nothing move?
fn before_slip(runner: &FigureRunner, main: &Run, data: &mut FigureData) -> Result<(), PaperError> {
    let first = main.first_slip()?;
    let times: Vec<f64> = (1..=8).map(|k| first * f64::from(k) / 9.0).collect();
    let run = runner.run_one(seen_at(runner.case("fig04", &[])?, &times))?;
    let drive = &run.case.model.drive;
    let (mut error, mut motion) = (0.0_f64, 0.0_f64);
    for (_, frame) in &run.record.frames {
        // In units of P mu_s, not yet over its maximum.
        let expected = drive.k_drive * drive.v_star * frame.time_star;
        for &stress in run.field(frame, Field::ContactStress)? {
            error = error.max((f64::from(stress) / expected - 1.0).abs());
        }
        for field in [Field::DisplacementX, Field::DisplacementY] {
            for &displacement in run.field(frame, field)? {
                motion = motion.max(f64::from(displacement).abs());
            }
        }
    }
    data.value("fig04.stress_before_slip_error", error);
    data.value("fig04.motion_before_slip", motion);
    Ok(())
}

/// The block that slips first: its place among all, ordered by mu_si from the lowest.
pub(super) fn first_slip_rank(run: &Run) -> Result<f64, PaperError> {
    let first = first_block(run)?;
    let mu_static = &run.case.model.surface.mu_static;
    Ok(1.0 + mu_static.iter().filter(|&&mu| mu < mu_static[first]).count() as f64)
}

/// The block that slips first.
pub(super) fn first_block(run: &Run) -> Result<usize, PaperError> {
    let earliest = run.first_slip()?;
    let times = &run.record.first_slip_time_star;
    let first = times.iter().position(|&time| time == earliest);
    first.ok_or_else(|| PaperError::Lacks {
        file: run.case.name.clone(),
        what: "slip".to_owned(),
    })
}

/// How much of the contact stress of the first block to slip is left soon after, %.
fn stress_left(runner: &FigureRunner, run: &Run) -> Result<f64, PaperError> {
    let (first, block) = (run.first_slip()?, first_block(run)?);
    let dt_star = run.case.time_plan.dt_star;
    // Just before the slip, and in steps of 0.5 after it for ten times the travel of a wave over a block.
    let mut times = vec![first - dt_star];
    times.extend((1..=20).map(|k| first + 0.5 * f64::from(k)));
    let seed = format!("friction.seed={}", run.case.file.friction.seed);
    let again = runner.run_one(seen_at(runner.case("fig04", &[&seed])?, &times))?;
    let stress = |(_, frame): &(String, Frame)| -> Result<f64, PaperError> {
        Ok(f64::from(again.field(frame, Field::ContactStress)?[block]))
    };
    let stresses = again
        .record
        .frames
        .iter()
        .map(stress)
        .collect::<Result<Vec<f64>, _>>()?;
    let [before, after @ ..] = &stresses[..] else {
        return Ok(f64::NAN);
    };
    Ok(100.0 * smallest(after.iter().copied()) / before)
}

/// Blocks that have slipped by the time of the peak, %.
fn slipped_at_peak(run: &Run) -> Result<f64, PaperError> {
    let onset = run.record.summary.onset_time_star;
    let times = run.slip_times();
    let slipped = times.iter().filter(|&&time| time <= onset).count();
    Ok(100.0 * slipped as f64 / run.case.model.surface.n_contact() as f64)
}

/// How long after the peak the last block slips for the first time, % of t_s*.
fn rest_slips_within(run: &Run) -> Result<f64, PaperError> {
    let onset = run.record.summary.onset_time_star;
    Ok(100.0 * (run.time_of_share(1.0)? - onset) / onset)
}

/// Blocks whose contact stress is lower at E than at D, %.
fn falls_from_d_to_e(run: &Run) -> Result<f64, PaperError> {
    let stress = |letter| run.field(run.instant(letter)?, Field::ContactStress);
    let (before, after) = (stress('D')?, stress('E')?);
    let lower: Vec<f64> = before
        .iter()
        .zip(after)
        .map(|(before, after)| f64::from(u8::from(after < before)))
        .collect();
    Ok(100.0 * mean(&lower))
}
