//! The slip front of a run, from first slips that may be distributed over several ranks.

use std::ops::RangeInclusive;

use slipfront::communicator::Communicator;
use slipfront::lattice::shear_wave_speed;
use slipfront::observe::frames::kept;
use slipfront::observe::{Front, Quantiles};
use slipfront::{Edges, Lattice};
use slipfront_case::case::Case;

use crate::summary::{NucleationSummary, Summary};

/// Largest number of blocks from which the front is found; of a larger lattice, every n-th block along each
/// axis is used. The first rank holds the times of all these blocks.
const MAX_BLOCKS: usize = 1 << 22;

/// Number of values that ranks exchange at once.
const PART: usize = 1 << 17;

/// Marks a block without contact, in place of its time.
const NO_CONTACT: f64 = f64::INFINITY;

/// Adds the front to a summary on the first rank, from the first slips of the blocks that each rank holds;
/// the summary stays as it is if nothing has slipped. The front passes in the range `during` of t*. For a
/// slider driven at an edge, this is a single event, because between two events slip spreads as fast as the
/// drive loads the slider. All ranks must call this together.
pub(crate) fn add_front(
    summary: &mut Summary,
    case: &Case,
    first_slips: &[f64],
    during: RangeInclusive<f64>,
    communicator: &dyn Communicator,
) {
    // Without a front, there is nothing to add.
    let _ = add_thinned(summary, case, first_slips, during, communicator, MAX_BLOCKS);
}

/// Adds the front as it follows from at most `most` blocks; none if nothing has slipped, and on ranks other
/// than the first.
fn add_thinned(
    summary: &mut Summary,
    case: &Case,
    first_slips: &[f64],
    during: RangeInclusive<f64>,
    communicator: &dyn Communicator,
    most: usize,
) -> Option<()> {
    let lattice = &case.model.lattice;
    let counts = |stride: usize| [lattice.nx, lattice.ny].map(|count| kept(0..count, stride).len());
    let stride = (1..).find(|&stride| counts(stride).iter().product::<usize>() <= most)?;
    let [nx, ny] = counts(stride);
    let mut times = gather(case, first_slips, stride, [nx, ny], communicator);
    if communicator.rank() > 0 {
        return None;
    }
    let mut n_contact = 0;
    for time in &mut times {
        if *time == NO_CONTACT {
            *time = f64::NAN;
        } else {
            n_contact += 1;
        }
    }
    // An axis with too few remaining blocks cannot be periodic.
    let edges = |axis: usize| {
        if [nx, ny][axis] < Lattice::MIN_PERIODIC {
            Edges::Free
        } else {
            lattice.edges[axis]
        }
    };
    let looked_at = Lattice::with_edges(nx, ny, [edges(0), edges(1)]);
    let whole = Front::find(&looked_at, &times, n_contact)?;
    let scales = &case.scales;
    let nucleation = |&block: &usize| {
        let (i, j) = looked_at.column_row(block);
        // The middle of the first block.
        let [x_m, y_m] = [i, j].map(|index| ((index * stride) as f64 + 0.5) * scales.block_size);
        NucleationSummary {
            x_m,
            y_m,
            time_star: times[block],
        }
    };
    summary.nucleations = whole.nucleations.iter().map(nucleation).collect();
    summary.nucleation_sites = Some(summary.nucleations.len());
    let first = summary.nucleations.first();
    summary.nucleation_x_m = first.map(|nucleation| nucleation.x_m);
    summary.nucleation_y_m = first.map(|nucleation| nucleation.y_m);
    let is_other = |time: &f64| !time.is_nan() && !during.contains(time);
    let front = if times.iter().any(is_other) {
        for time in times.iter_mut().filter(|time| is_other(time)) {
            *time = f64::NAN;
        }
        Front::find(&looked_at, &times, n_contact)
    } else {
        Some(whole)
    };
    let front = front?;
    let speeds = |unit: f64| {
        let speed = |of: fn(Quantiles) -> f64| front.speed.map(|speed| of(speed) * stride as f64 * unit);
        [speed(|s| s.median), speed(|s| s.low), speed(|s| s.high)]
    };
    [
        summary.front_speed_c_s,
        summary.front_speed_low_c_s,
        summary.front_speed_high_c_s,
    ] = speeds(1.0 / shear_wave_speed());
    [
        summary.front_speed_m_s,
        summary.front_speed_low_m_s,
        summary.front_speed_high_m_s,
    ] = speeds(scales.block_size / scales.time());
    summary.front_share = front.share;
    summary.front_duration_star = Some(front.duration);
    summary.front_duration_s = Some(front.duration * scales.time());
    Some(())
}

/// The times of every `stride`-th block of each axis, on the first rank; nothing on the others.
fn gather(
    case: &Case,
    first_slips: &[f64],
    stride: usize,
    [nx, ny]: [usize; 2],
    communicator: &dyn Communicator,
) -> Vec<f64> {
    let (model, own) = (&case.model, kept(case.model.rows.clone(), stride));
    let is_first = communicator.rank() == 0;
    let mut times = Vec::with_capacity(if is_first { nx * ny } else { 0 });
    let rows_at_once = (PART / nx).max(1);
    let mut words = Vec::new();
    for first in (0..ny).step_by(rows_at_once) {
        let rows = first..(first + rows_at_once).min(ny);
        words.clear();
        words.resize(rows.len() * nx, 0);
        for row in rows.start.max(own.start)..rows.end.min(own.end) {
            let before = (row * stride - model.rows.start) * model.lattice.nx;
            let blocks = (before..before + model.lattice.nx).step_by(stride);
            for (word, b) in words[(row - rows.start) * nx..].iter_mut().zip(blocks) {
                let time = if model.surface.textured[b] {
                    NO_CONTACT
                } else {
                    first_slips[b]
                };
                *word = time.to_bits().cast_signed();
            }
        }
        communicator.sum(&mut words);
        if is_first {
            times.extend(words.iter().map(|word| f64::from_bits(word.cast_unsigned())));
        }
    }
    times
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use slipfront::Execution;
    use slipfront::communicator::Alone;
    use slipfront::testing::Threads;
    use slipfront_case::case::Ranks;
    use slipfront_case::case_file::CaseFile;

    use super::*;
    use crate::running::{self, Running};

    const CASE: &str = "slider.blocks = [37, 29]\ndrive.v_star = 0.1\ntime.stop = 'after_onset'\n\
                        slider.edges = ['periodic', 'free']\n[[texture]]\nshape = 'cavity'\ncoverage = 12";

    /// Ranks find the front that one rank finds, though no rank holds all blocks.
    #[test]
    fn ranks_find_the_front_that_one_finds() {
        let case = Arc::new(Case::parse(CASE, "case", "", &[]).unwrap());
        let alone = running::run(&case, 1).unwrap().summary;
        assert!(alone.transition && alone.nucleation_sites > Some(0) && alone.front_speed_c_s.is_some());
        let summaries = Threads::run(3, |communicator| {
            let ranks = Ranks {
                communicator,
                on_node: 3,
            };
            let file = CaseFile::parse(CASE, "case", &[]).unwrap();
            let case = Case::to_run(file, "case", std::path::Path::new(""), &mut |_| true, ranks);
            let mut running = Running::start(
                &Arc::new(case.unwrap()),
                None,
                Execution {
                    communicator: Arc::new(communicator.clone()),
                    ..Execution::on_threads(1)
                },
            );
            let reason = loop {
                if let Some(reason) = running.advance(u64::MAX).unwrap() {
                    break reason;
                }
            };
            running.record(reason).summary
        });
        assert_eq!(summaries[0].nucleations, alone.nucleations);
        assert_eq!(summaries[0].front_speed_high_m_s, alone.front_speed_high_m_s);
        assert_eq!(summaries[0].front_duration_s, alone.front_duration_s);
    }

    /// Between the events of a slider driven at an edge slip spreads as fast as the drive loads the slider.
    /// The front of the event that crosses the slider moves at about the speed of waves, whatever the speed
    /// of the drive.
    #[test]
    fn of_a_slider_driven_at_an_edge_the_speed_is_that_of_the_event_that_crosses_it() {
        for v_star in [2.0, 1.0] {
            let text = format!(
                "slider.blocks = [80, 10]\nslider.omega_star = 0.001\nslider.viscosity_time_star = 0.3\n\
                 drive.attach = 'left'\ndrive.total_stiffness_star = 0.08\ndrive.v_star = {v_star}\n\
                 friction.r_star = 0.2\nfriction.sigma_static_star = 0\nfriction.sigma_kinetic_star = 0\n\
                 time.step = 0.2\ntime.duration_star = {}",
                6000.0 / v_star
            );
            let case = Arc::new(Case::parse(&text, "case", "", &[]).unwrap());
            let summary = running::run(&case, 1).unwrap().summary;
            let precursors = summary.precursors.unwrap();
            assert!(precursors.precursor_count > 3 && precursors.crossing_mu_star.is_some());
            let speed = summary.front_speed_c_s.unwrap();
            assert!((0.5..2.0).contains(&speed), "{speed} c_S at V* = {v_star}");
        }
    }

    /// A straight front over more blocks than are used to find a front.
    #[test]
    fn a_large_lattice_is_thinned() {
        let case = Case::parse("slider.blocks = [61, 40]", "case", "", &[]).unwrap();
        let times: Vec<f64> = (0..61 * 40).map(|b| f64::from(b % 61) / 0.7).collect();
        let unit = shear_wave_speed();
        let of = |most| {
            let mut summary = Summary::default();
            add_thinned(&mut summary, &case, &times, 0.0..=f64::INFINITY, &Alone, most).unwrap();
            summary
        };
        let whole = of(MAX_BLOCKS);
        for most in [61 * 40, 61 * 40 - 1, 300] {
            let front = of(most);
            for summary in [&whole, &front] {
                assert!((summary.front_speed_c_s.unwrap() * unit - 0.7).abs() < 1e-12);
            }
            assert_eq!(front.nucleations, whole.nucleations);
            assert_eq!(front.nucleations[0].x_m, 0.5 * case.scales.block_size);
        }
    }
}
