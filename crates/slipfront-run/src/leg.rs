//! A run that continues under another case: a new leg of the same slider.

use std::sync::Arc;

use slipfront::observe::{CurveRow, Scheduled};
use slipfront::{Execution, RunError, State, Stop, VectorField};
use slipfront_case::case::Case;
use thiserror::Error;

use crate::running::Running;

/// Result of a [change](Running::change) of the case.
pub struct Leg {
    /// The run under the new case, at t* = 0.
    pub running: Running,
    /// Steps of the previous leg, including the one in progress.
    pub steps: u64,
    /// t* of the drive in these steps.
    pub drive_time_star: f64,
    /// Duration of these steps, s.
    pub time_s: f64,
    /// Displacement of the driven ends of the drive springs, block by block, m: the difference between
    /// displacements of the previous leg and of the new leg.
    pub drive_m: VectorField,
}

/// Reason why a change is refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[expect(missing_docs, reason = "the sentence of each variant tells what it is")]
pub enum ChangeError {
    #[error(
        "a change cannot alter the blocks: the moving slider has {}, not {}; start such a run from rest",
        blocks(*.moving),
        blocks(*.wanted)
    )]
    OtherBlocks {
        moving: ([usize; 2], f64),
        wanted: ([usize; 2], f64),
    },
    #[error("a change cannot alter the outline of the moving slider; start such a run from rest")]
    OtherOutline,
    #[error(
        "contacts under this law of friction have a state in addition to displacement and velocity; start such a run from rest"
    )]
    Memory,
    #[error(
        "a displacement or a velocity is not finite in the units of the new case: the run diverges, or a unit is too small; start such a run from rest"
    )]
    NotFinite,
}

fn blocks(([nx, ny], size): ([usize; 2], f64)) -> String {
    format!("{nx} x {ny} of {size} m")
}

impl Running {
    /// Continues under another case from the present state, on at most `threads` threads.
    ///
    /// Displacements in m and velocities in m/s are kept. The step in progress is completed, because
    /// velocities are known half a step after displacements; the new leg begins when both are known at the
    /// same time. Its drive begins at the position of the drive of this leg, and its displacements count from
    /// there:
    ///
    /// ```text
    /// u' = (u + dt v - X) U/U'    with U = P mu_s l^2/(E h)
    /// v' = v W/W'                 with W = P mu_s l/(h sqrt(E rho))
    /// ```
    ///
    /// where X is the displacement of the driven end over each block, and a prime marks the new case. Scales,
    /// load and the state of stuck blocks follow the new case. This run does not change.
    ///
    /// # Errors
    /// [`ChangeError`] when the cases have different blocks, contacts of one of them have more memory than a
    /// state holds, or the run diverges.
    ///
    /// # Panics
    /// If several ranks share the lattice.
    pub fn change(&self, case: &Arc<Case>, threads: usize) -> Result<Leg, ChangeError> {
        let before = self.case();
        let (old, new) = (&before.model, &case.model);
        assert_eq!(
            old.rows.len(),
            old.lattice.ny,
            "a change is that of a run on one rank"
        );
        let of = |case: &Case| {
            let lattice = &case.model.lattice;
            ([lattice.nx, lattice.ny], case.scales.block_size)
        };
        let (moving, wanted) = (of(before), of(case));
        if moving != wanted {
            return Err(ChangeError::OtherBlocks { moving, wanted });
        }
        if old.slider().outline != new.slider().outline {
            return Err(ChangeError::OtherOutline);
        }
        if [old, new].iter().any(|model| model.friction.n_columns() > 0) {
            return Err(ChangeError::Memory);
        }
        let steps = self.snapshot().step + 1;
        let time_star = steps as f64 * before.time_plan.dt_star;
        let unit = before.scales.displacement();
        let per_displacement = unit / case.scales.displacement();
        let per_speed = before.scales.speed() / case.scales.speed();
        let (state, mut drive) = self.end_of_step([per_displacement, per_speed]);
        for x in drive.x.iter_mut().chain(&mut drive.y) {
            *x *= unit;
        }
        if !state.is_finite() {
            return Err(ChangeError::NotFinite);
        }
        Ok(Leg {
            running: Self::start(case, Some(state), Execution::on_threads(threads)),
            steps,
            drive_time_star: self.snapshot().next_drive_time_star(),
            time_s: time_star * before.scales.time(),
            drive_m: drive,
        })
    }

    /// State of the blocks of these rows from which another run can start, in metres and metres per second:
    /// the state at the end of the step in progress, with displacements relative to the driven ends.
    pub(crate) fn final_state(&self) -> State {
        let scales = &self.case().scales;
        let (mut state, _) = self.end_of_step([scales.displacement(), scales.speed()]);
        let slider = self.case().model.slider();
        for b in (0..state.displacement.x.len()).filter(|&b| !slider.exists(b)) {
            (state.displacement.x[b], state.displacement.y[b]) = (0.0, 0.0);
        }
        state
    }

    /// State at the end of the step in progress, with displacements relative to the driven ends, times
    /// factors for displacements and velocities; and the displacements of these ends in units of this run.
    fn end_of_step(&self, [per_displacement, per_speed]: [f64; 2]) -> (State, VectorField) {
        let (model, dt_star) = (&self.case().model, self.case().time_plan.dt_star);
        let path = self.snapshot().next_path();
        let State {
            mut displacement,
            mut velocity,
        } = self.motion();
        let mut drive = VectorField::zeros(displacement.x.len());
        let first = model.lattice.blocks_of(&model.rows).start;
        for b in 0..displacement.x.len() {
            let [along_x, along_y] = model.drive.direction_at(&model.lattice, first + b);
            (drive.x[b], drive.y[b]) = (along_x * path, along_y * path);
        }
        let axes = [
            (&mut displacement.x, &mut velocity.x, &drive.x),
            (&mut displacement.y, &mut velocity.y, &drive.y),
        ];
        for (displacement, velocity, drive) in axes {
            for ((u, v), x) in displacement.iter_mut().zip(velocity).zip(drive) {
                *u = (*u + dt_star * *v - *x) * per_displacement;
                *v *= per_speed;
            }
        }
        let state = State {
            displacement,
            velocity,
        };
        (state, drive)
    }

    /// Completes the step in progress, at the end of which the next leg begins, also after the last step of
    /// the case. Returns the row of the curve there without the energies that are stored in blocks and
    /// springs.
    ///
    /// # Errors
    /// [`RunError`] when the run diverges in this step.
    pub fn end_of_leg(&mut self) -> Result<CurveRow, RunError> {
        let curve = &mut self.observers.summary.curve;
        let mut observers = [Scheduled::always(&mut *curve)];
        self.simulation.advance(Stop::never(), 1, &mut observers)?;
        Ok(curve.counts(&self.simulation.snapshot()))
    }
}

#[cfg(test)]
mod tests {
    use slipfront::StoredEnergy;

    use super::*;

    const SMALL: &str = "slider.blocks = [20, 20]\n[[texture]]\nshape = 'cavity'\ncoverage = 10\n";

    fn case_of(overrides: &[&str]) -> Arc<Case> {
        let overrides: Vec<String> = overrides.iter().map(|&text| text.to_owned()).collect();
        Arc::new(Case::parse(SMALL, "case", "", &overrides).unwrap())
    }

    fn started(case: &Arc<Case>, steps: u64) -> Running {
        let mut running = Running::start(case, None, Execution::default());
        running.advance(steps).unwrap();
        running
    }

    /// Displacements since rest, m.
    fn displacement_m(running: &Running, drive_m: &VectorField) -> Vec<f64> {
        let (unit, moved) = (
            running.case().scales.displacement(),
            running.motion().displacement,
        );
        let axes = [(moved.x, &drive_m.x), (moved.y, &drive_m.y)];
        let metres = axes.into_iter().flat_map(|(u, x)| {
            u.into_iter()
                .zip(x)
                .map(|(u, x)| u * unit + x)
                .collect::<Vec<_>>()
        });
        metres.collect()
    }

    fn largest(values: &[f64]) -> f64 {
        values.iter().fold(0.0, |most, value| most.max(value.abs()))
    }

    /// Compares a leg that begins after `steps` under `after` with a run under `case` alone: difference of
    /// mu* at the beginning, and of displacements 200 steps later, over the largest.
    fn differences(case: &Arc<Case>, after: &Arc<Case>, steps: u64) -> [f64; 2] {
        let (mut plain, before) = (started(case, steps), started(case, steps - 1));
        let mut leg = before.change(after, 1).unwrap();
        assert_eq!((leg.steps, leg.running.snapshot().step), (steps, 0));
        let mu_star = [&plain, &leg.running].map(|running| running.snapshot().point.mu_star);
        for running in [&mut plain, &mut leg.running] {
            running.advance(200).unwrap();
        }
        let whole = displacement_m(&plain, &VectorField::zeros(400));
        let in_legs = displacement_m(&leg.running, &leg.drive_m);
        let apart: Vec<f64> = whole
            .iter()
            .zip(&in_legs)
            .map(|(one, other)| one - other)
            .collect();
        [
            (mu_star[1] / mu_star[0] - 1.0).abs(),
            largest(&apart) / largest(&whole),
        ]
    }

    #[test]
    fn under_the_same_case_the_trajectory_is_the_same() {
        let case = case_of(&[]);
        let [mu_star, displacement] = differences(&case, &case, 700);
        // Rounding of displacements relative to the drive: some roundings in mu*, and in displacements one
        // per step, which springs pass on.
        assert!(
            mu_star < 1e-14 && displacement < 1e-13,
            "{mu_star:e} {displacement:e}"
        );
    }

    #[test]
    fn a_program_goes_on_from_where_the_drive_stands() {
        let program = "drive.program = [{ v_star = 0.03, until_star = 40 }, { v_star = 0.01 }]";
        let (case, slow) = (case_of(&[program]), case_of(&["drive.v_star = 0.01"]));
        let steps = (60.0 / case.time_plan.dt_star).round() as u64;
        assert_eq!(case.time_plan.dt_star, slow.time_plan.dt_star);
        let [mu_star, displacement] = differences(&case, &slow, steps);
        // As accurate as under the same case.
        assert!(
            mu_star < 1e-14 && displacement < 1e-13,
            "{mu_star:e} {displacement:e}"
        );
    }

    #[test]
    fn the_time_of_a_held_drive_goes_on_from_where_it_stands() {
        let case = case_of(&["drive.loading = 'held'"]);
        let running = started(&case, 1500);
        let leg = running.change(&case, 1).unwrap();
        let (now, path) = (running.snapshot(), running.snapshot().next_path());
        assert!(now.drive_steps + 100 < now.step, "the drive has hardly stood");
        // A quotient and a product of the same numbers.
        let time_star = path / case.model.drive.v_star;
        assert!(
            (leg.drive_time_star / time_star - 1.0).abs() < 1e-15,
            "{time_star}"
        );
    }

    #[test]
    fn a_leg_counts_up_to_where_the_next_one_begins_even_after_its_end() {
        let (case, short) = (
            case_of(&["output.series = 0.1"]),
            case_of(&["output.series = 0.1", "time.duration_star = 60"]),
        );
        let mut leg = started(&short, u64::MAX);
        let plain = started(&case, leg.snapshot().step + 1);
        let (found, last) = (leg.end_of_leg().unwrap(), plain.rows().last().unwrap());
        let mut wanted = *last;
        wanted.energies.stored = StoredEnergy::default();
        assert!(wanted.energies.friction_loss > 0.0);
        assert_eq!(format!("{found:?}"), format!("{wanted:?}"));
    }

    #[test]
    fn a_rotation_goes_on_from_where_the_drive_stands() {
        let case = case_of(&["drive.motion = 'rotation'", "load.pressure = '100 Pa'"]);
        let [mu_star, displacement] = differences(&case, &case, 700);
        // Displacements relative to the drive turn springs back by eps X/r_max, and their forces with them,
        // here by 1e-9 times 2.1/14.
        assert!(
            mu_star < 1e-14 && displacement < 2e-10,
            "{mu_star:e} {displacement:e}"
        );
    }

    #[test]
    fn under_another_load_metres_are_kept() {
        let (case, loaded) = (case_of(&[]), case_of(&["load.pressure = '200 kPa'"]));
        assert_eq!(loaded.scales.pressure, 2.0 * case.scales.pressure);
        let running = started(&case, 700);
        let leg = running.change(&loaded, 1).unwrap();
        let dt = case.time_plan.dt_star * case.scales.time();
        assert_eq!(leg.time_s, 701.0 * case.time_plan.dt_star * case.scales.time());
        let speeds = |running: &Running| {
            let (unit, speed) = (running.case().scales.speed(), running.motion().velocity);
            [speed.x, speed.y]
                .concat()
                .into_iter()
                .map(|v| v * unit)
                .collect::<Vec<_>>()
        };
        // The first step of the new leg is computed at once. In it, friction changes velocities by at most an
        // impulse of the threshold, twice the mean load.
        let (before, after) = (speeds(&running), speeds(&leg.running));
        let impulse = 4.0 * case.time_plan.dt_star * loaded.scales.speed();
        assert!(largest(&before) > 0.0);
        assert!(
            before
                .iter()
                .zip(&after)
                .all(|(one, other)| (one - other).abs() <= impulse)
        );
        let begun = displacement_m(&running, &VectorField::zeros(400));
        let moved: Vec<f64> = begun.iter().zip(&before).map(|(u, v)| u + dt * v).collect();
        let kept = displacement_m(&leg.running, &leg.drive_m);
        let apart: Vec<f64> = moved.iter().zip(&kept).map(|(one, other)| one - other).collect();
        // Some roundings of numbers as large as the path of the drive.
        assert!(
            largest(&apart) < 1e-14 * largest(&leg.drive_m.x),
            "{:e}",
            largest(&apart)
        );
        // Half of mu*, which is relative to the load, except for the motion within the step.
        let mu_star = [&running, &leg.running].map(|running| running.snapshot().point.mu_star);
        assert!((mu_star[1] / mu_star[0] - 0.5).abs() < 0.01, "{mu_star:?}");
    }

    #[test]
    fn what_has_no_meaning_is_refused() {
        let case = case_of(&[]);
        let running = started(&case, 10);
        let refused = |overrides: &[&str]| running.change(&case_of(overrides), 1).err().unwrap().to_string();
        let said = refused(&["slider.blocks = [21, 20]"]);
        assert!(said.contains("20 x 20 of 0.000001 m, not 21 x 20"), "{said}");
        assert!(refused(&["slider.block_size = '2 um'"]).contains("of 0.000002 m"));
        assert!(refused(&["slider.outline = 'disc'"]).contains("cannot alter the outline"));
        let ageing = "friction.ageing = { law = 'logarithmic', beta = 0.02, time_star = 1 }";
        let springs = [
            "friction.contact = 'springs'",
            "friction.contact_stiffness_star = 1",
        ];
        for law in [&[ageing][..], &springs] {
            assert!(
                refused(law).contains("have a state in addition to displacement and velocity"),
                "{law:?}"
            );
            let remembering = started(&case_of(law), 10);
            assert_eq!(remembering.change(&case, 1).err(), Some(ChangeError::Memory));
        }
    }

    /// A block has a displacement that overflows under a thousandth of the load.
    #[test]
    fn numbers_beyond_all_bounds_are_refused() {
        let (case, unloaded) = (case_of(&[]), case_of(&["load.pressure = '100 Pa'"]));
        let mut state = State::at_rest(400);
        state.displacement.x[210] = 1e306;
        let mut running = Running::start(&case, Some(state), Execution::default());
        assert!(running.advance(10).is_err());
        assert_eq!(running.change(&unloaded, 1).err(), Some(ChangeError::NotFinite));
    }
}
