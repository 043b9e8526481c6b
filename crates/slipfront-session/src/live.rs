//! The run on the page: its legs, its curve and its first peak.

use std::sync::Arc;

use slipfront::{Execution, StopReason};
use slipfront_case::case::Case;
use slipfront_run::running::Running;
use slipfront_run::summary::Summary;

use crate::protocol::PeakReply;
use crate::sentence::sentence;

/// A run from rest, with the legs begun by changes of its case.
pub(crate) struct LiveRun {
    running: Running,
    /// Number of the present leg; 0 for the leg that begins at rest.
    pub(crate) leg: usize,
    /// Steps and time of the legs before the present one.
    pub(crate) before: Elapsed,
    /// Position of the drive at the start of the present leg, m, block by block; none for a leg from rest.
    origin: Option<Vec<[f32; 2]>>,
    /// Number of points of the present leg's curve that were sent to the page.
    n_sent: usize,
    /// Whether every block in contact has slipped since rest; always false in a later leg.
    pub(crate) crossed: bool,
    /// The reason why the run ended, if it has.
    pub(crate) ended: Option<StopReason>,
}

/// Steps and times that have passed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Elapsed {
    steps: u64,
    pub(crate) time_star: f64,
    /// t* of the drive, which stops while a held drive is held.
    pub(crate) drive_time_star: f64,
    pub(crate) time_s: f64,
}

/// Points of a curve: t* of the drive, mu* and the share of sliding blocks.
#[derive(Default)]
pub(crate) struct CurvePoints {
    pub(crate) time_star: Vec<f64>,
    pub(crate) mu_star: Vec<f64>,
    pub(crate) sliding_percent: Vec<f64>,
}

impl LiveRun {
    /// Starts a run of a case from rest.
    pub(crate) fn from_rest(case: &Arc<Case>, threads: usize) -> Self {
        Self {
            running: Running::start(case, None, Execution::on_threads(threads)),
            leg: 0,
            before: Elapsed::default(),
            origin: None,
            n_sent: 0,
            crossed: false,
            ended: None,
        }
    }

    /// Continues the run with another case, as its next leg.
    ///
    /// # Errors
    /// A sentence, if a run cannot continue with that case.
    pub(crate) fn change(&mut self, case: &Arc<Case>) -> Result<(), String> {
        let dt_star = self.case().time_plan.dt_star;
        let leg = self
            .running
            .change(case, self.running.threads())
            .map_err(sentence)?;
        let drive = leg.drive_m.x.iter().zip(&leg.drive_m.y);
        let mut origin: Vec<[f32; 2]> = drive.map(|(x, y)| [*x as f32, *y as f32]).collect();
        for (origin, before) in origin.iter_mut().zip(self.origin.iter().flatten()) {
            origin[0] += before[0];
            origin[1] += before[1];
        }
        self.before = Elapsed {
            steps: self.before.steps + leg.steps,
            time_star: self.before.time_star + leg.steps as f64 * dt_star,
            drive_time_star: self.before.drive_time_star + leg.drive_time_star,
            time_s: self.before.time_s + leg.time_s,
        };
        self.origin = Some(origin);
        self.running = leg.running;
        self.leg += 1;
        self.n_sent = 0;
        self.crossed = false;
        self.ended = None;
        Ok(())
    }

    pub(crate) fn case(&self) -> &Arc<Case> {
        self.running.case()
    }

    pub(crate) fn running(&self) -> &Running {
        &self.running
    }

    pub(crate) fn origin(&self) -> Option<&[[f32; 2]]> {
        self.origin.as_deref()
    }

    /// Whether the friction law has state variables besides displacement and velocity.
    pub(crate) fn has_memory(&self) -> bool {
        self.case().model.friction.n_columns() > 0
    }

    /// Whether a block in contact has slipped in this or a previous leg: the instant B of a run from rest.
    pub(crate) fn has_slipped(&self) -> bool {
        self.leg > 0 || self.running.instants().any(|(letter, _)| letter == 'B')
    }

    /// Takes at most `steps` steps.
    ///
    /// # Errors
    /// A sentence, when the run diverges.
    pub(crate) fn advance(&mut self, steps: u64) -> Result<(), String> {
        if self.ended.is_none() {
            self.ended = self.running.advance(steps).map_err(sentence)?;
        }
        Ok(())
    }

    /// Number of stages seen of a transition from rest: the first slip, the first peak, and the slip of every
    /// block in contact. Checks every block.
    pub(crate) fn look_for_stages(&mut self) -> usize {
        if self.leg == 0 && !self.crossed && self.has_slipped() {
            let first_slips = self.running.snapshot().first_slip_time_star();
            let slipped = first_slips.iter().filter(|time| !time.is_nan()).count();
            self.crossed = slipped == self.case().model.surface.n_contact();
        }
        let has_peak = self.peak().is_some_and(|peak| peak.certain);
        [self.leg == 0 && self.has_slipped(), has_peak, self.crossed]
            .into_iter()
            .filter(|is_seen| *is_seen)
            .count()
    }

    /// Steps since rest.
    pub(crate) fn step(&self) -> u64 {
        self.before.steps + self.running.snapshot().step
    }

    /// t* since rest.
    pub(crate) fn time_star(&self) -> f64 {
        self.before.time_star + self.running.snapshot().time_star
    }

    /// Time since rest, s.
    pub(crate) fn time_s(&self) -> f64 {
        self.before.time_s + self.running.snapshot().time_star * self.case().scales.time()
    }

    /// Returns the points of the curve that were not sent to the page yet, and marks them as sent.
    pub(crate) fn take_unsent_points(&mut self) -> CurvePoints {
        let rows = &self.running.rows()[self.n_sent..];
        self.n_sent += rows.len();
        let before = self.before.drive_time_star;
        CurvePoints {
            time_star: rows.iter().map(|row| before + row.drive_time_star).collect(),
            mu_star: rows.iter().map(|row| row.point.mu_star).collect(),
            sliding_percent: rows.iter().map(|row| row.point.sliding_percent).collect(),
        }
    }

    /// The first peak of mu* since rest; none for a later leg, which does not begin at rest.
    pub(crate) fn peak(&self) -> Option<PeakReply> {
        let now = self.running.snapshot();
        (self.leg == 0 && now.step > 0).then_some(PeakReply {
            t_star: now.peak.drive_time_star,
            mu_star: now.peak.mu_star,
            certain: now.peak.ended,
        })
    }

    /// The summary of a run from rest that has ended.
    pub(crate) fn summary(&self) -> Option<Summary> {
        let reason = self.ended.filter(|_| self.leg == 0)?;
        Some(self.running.summary(reason))
    }
}
