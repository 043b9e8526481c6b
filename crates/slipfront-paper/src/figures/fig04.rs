//! Fig. 4: contact stress at the instants A-F, and the paper's interpretation.

use slipfront::observe::{Field, Frame};

use crate::drawing::stress_maps;
use crate::error::PaperError;
use crate::figure_data::FigureData;
use crate::run::{FigureRun, on_each, recorded_at};
use crate::runner::FigureRunner;
use crate::statistics::{largest, smallest};

/// The curve of Fig. 3 on which the instants are marked.
const CASE: &str = "table1/case8";

/// A measurement on a run, which may need further runs.
type Measure = fn(&FigureRunner, &FigureRun) -> Result<f64, PaperError>;

pub(super) fn measure(runner: &mut FigureRunner, data: &mut FigureData) -> Result<(), PaperError> {
    let runs = runner.run(runner.case_on_surfaces(CASE)?)?;
    let [main, ..] = &runs[..] else { return Ok(()) };
    let maps = ['A', 'B', 'C', 'D', 'E', 'F']
        .map(|letter| main.stress_map(main.instant(letter)?, &letter.to_string()));
    data.panel(
        "fig04",
        "Contact stress at the instants A-F of Fig. 3: loading, first slip, friction peak, most blocks sliding, lowest friction, \
         kinetic phase.",
        stress_maps(maps.into_iter().collect::<Result<_, _>>()?, 3),
    );
    before_slip(runner, main, data)?;
    data.value(
        "worst_rank_of_first_slip",
        largest(on_each(&runs, first_slip_rank)?),
    );
    let measures: [(&str, Measure); 7] = [
        ("fall_at_slip_over_rise", fall_over_rise),
        ("slipped_at_peak_percent", |_, run| Ok(slipped_at_peak(run))),
        ("rest_slips_within_percent", |_, run| rest_slips_within(run)),
        ("sliding_jump_percent", |_, run| {
            Ok(run.instant('D')?.point.sliding_percent)
        }),
        ("stress_falls_from_c_to_e_percent", |_, run| {
            falls_until_e(run, 'C')
        }),
        ("stress_falls_from_d_to_e_percent", |_, run| {
            falls_until_e(run, 'D')
        }),
        ("kinetic_minimum_over_e", |_, run| {
            let [from, until] = run.kinetic_window()?;
            Ok(smallest(run.friction_between(from, until)) - run.instant('E')?.point.mu_star)
        }),
    ];
    for (name, measure) in measures {
        data.values(name, &on_each(&runs, |run| measure(runner, run))?);
    }
    let sliding = |run: &FigureRun| run.record.summary.sliding_percent_kinetic;
    data.values(
        "kinetic_sliding_percent",
        &runs.iter().filter_map(sliding).collect::<Vec<_>>(),
    );
    Ok(())
}

/// Measures before the first slip: whether the stress is uniform and grows as k_s V* t*, and whether blocks
/// move.
fn before_slip(runner: &FigureRunner, main: &FigureRun, data: &mut FigureData) -> Result<(), PaperError> {
    let first = main.first_slip()?;
    let times: Vec<f64> = (1..=8).map(|k| first * f64::from(k) / 9.0).collect();
    let run = runner.run_one(recorded_at(runner.case(CASE, &[])?, &times))?;
    let drive = &run.case.model.drive;
    let (mut error, mut motion) = (0.0_f64, 0.0_f64);
    for (_, frame) in &run.record.frames {
        // In units of P mu_s, not yet divided by its maximum.
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
    data.value("stress_before_slip_error", error);
    data.value("motion_before_slip", motion);
    Ok(())
}

/// Rank of the block that slips first among all blocks, ordered by mu_si from the lowest.
fn first_slip_rank(run: &FigureRun) -> Result<f64, PaperError> {
    let first = run.first_block()?;
    let mu_static = &run.case.model.surface.mu_static;
    Ok(1.0 + mu_static.iter().filter(|&&mu| mu < mu_static[first]).count() as f64)
}

/// Fall of the contact stress of the first block to slip within 2 t* after its slip, over its rise within
/// 2 t* before. In that time, a wave travels only two blocks, so the fall is local, not that of the whole
/// slider.
fn fall_over_rise(runner: &FigureRunner, run: &FigureRun) -> Result<f64, PaperError> {
    let (first, block) = (run.first_slip()?, run.first_block()?);
    // The last step at which the block still sticks.
    let held = first - run.case.time_plan.dt_star;
    let mut times = vec![held - 2.0, held];
    times.extend((1..=4).map(|k| held + 0.5 * f64::from(k)));
    let seed = format!("friction.seed={}", run.case.file.friction.seed);
    let again = runner.run_one(recorded_at(runner.case(CASE, &[&seed])?, &times))?;
    let stress = |(_, frame): &(String, Frame)| -> Result<f64, PaperError> {
        Ok(f64::from(again.field(frame, Field::ContactStress)?[block]))
    };
    let stresses = again.record.frames.iter().map(stress);
    let stresses = stresses.collect::<Result<Vec<f64>, _>>()?;
    let [before, at, after @ ..] = &stresses[..] else {
        return Ok(f64::NAN);
    };
    Ok((at - smallest(after.iter().copied())) / (at - before))
}

/// Blocks that have slipped by the time of the peak, %.
fn slipped_at_peak(run: &FigureRun) -> f64 {
    let onset = run.record.summary.onset_time_star;
    let times = run.slip_times();
    let slipped = times.iter().filter(|&&time| time <= onset).count();
    100.0 * slipped as f64 / run.case.model.surface.n_contact() as f64
}

/// Time from the peak until every block has slipped, % of t_s*.
fn rest_slips_within(run: &FigureRun) -> Result<f64, PaperError> {
    let onset = run.record.summary.onset_time_star;
    Ok(100.0 * (run.time_of_share(1.0)? - onset) / onset)
}

/// Blocks with a lower contact stress at E than at an earlier instant, %.
fn falls_until_e(run: &FigureRun, letter: char) -> Result<f64, PaperError> {
    let stress = |letter| run.field(run.instant(letter)?, Field::ContactStress);
    let (before, after) = (stress(letter)?, stress('E')?);
    let lower = before.iter().zip(after).filter(|(before, after)| after < before);
    Ok(100.0 * (lower.count() as f64 / before.len() as f64))
}
