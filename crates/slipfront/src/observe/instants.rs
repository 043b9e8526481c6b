//! The instants A-F of Fig. 4, found during the run.
//!
//! A: t* = 0.5/V*. B: first slip of a block in contact. C: the peak of mu*. D: the largest N* in
//! [t_s*, t_s* + 2.5/V*]. E: the smallest mu* from D to the start of the kinetic window. F: the middle of
//! that window. An instant that a later step may replace is kept as a candidate and overwritten. V* is the
//! [loading speed](crate::Model::loading_speed).

use serde::{Deserialize, Serialize};

use super::frames::{Frame, Selection};
use super::kinetic_friction::KineticStart;
use super::observer::Observer;
use crate::error::RunError;
use crate::model::ONSET_PATH;
use crate::snapshot::Snapshot;

/// Letters of the instants.
const LETTERS: [char; 6] = ['A', 'B', 'C', 'D', 'E', 'F'];
const A: usize = 0;
const B: usize = 1;
const C: usize = 2;
const D: usize = 3;
const E: usize = 4;
const F: usize = 5;

/// Fields at A-F. The observer must be called at every step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instants {
    selection: Selection,
    kinetic: KineticStart,
    end_time_star: f64,
    frames: [Option<Frame>; 6],
    /// Valid frames of `frames`; the memory of the others is reused.
    valid: [bool; 6],
    ended: bool,
    /// Whether the run has gone on long enough for D, and for E, to be known.
    known: [bool; 2],
}

impl Instants {
    /// The recording of a run that will end at `end_time_star`, with nothing found yet.
    pub fn new(selection: Selection, kinetic: KineticStart, end_time_star: f64) -> Self {
        Self {
            selection,
            kinetic,
            end_time_star,
            frames: Default::default(),
            valid: [false; 6],
            ended: false,
            known: [false; 2],
        }
    }

    /// Whether the recording can have begun as `new` and been called up to `step`.
    pub fn is_consistent_with(&self, new: &Self, step: u64) -> bool {
        let same_settings = self.selection == new.selection
            && self.kinetic == new.kinetic
            && self.end_time_star == new.end_time_star;
        same_settings && self.frames().all(|frame| frame.step <= step)
    }

    /// The frames held at present, candidates included.
    pub fn frames(&self) -> impl Iterator<Item = &Frame> {
        self.frames.iter().flatten()
    }

    /// The frames held at present, to be filled again.
    pub fn frames_mut(&mut self) -> impl Iterator<Item = &mut Frame> {
        self.frames.iter_mut().flatten()
    }

    /// The instants of the run, in the order of their letters. D and E are missing without a transition, or
    /// if the run ends before the times among which they are chosen.
    pub fn found(mut self) -> Vec<(char, Frame)> {
        let shown = self.shown();
        // In reverse order: a frame is moved to the first instant that it shows, after the others have copied
        // it.
        let mut found: Vec<(char, Frame)> = (A..=F)
            .rev()
            .filter_map(|instant| {
                let kept = &mut self.frames[shown[instant]?];
                let frame = if shown[instant] == Some(instant) {
                    kept.take()
                } else {
                    kept.clone()
                };
                Some((LETTERS[instant], frame?))
            })
            .collect();
        found.reverse();
        found
    }

    /// The instants that the run would have if it ended now, and t* of the drive at each. C and F are
    /// candidates until mu* has fallen far enough.
    pub fn by_now(&self) -> impl Iterator<Item = (char, f64)> {
        let shown = LETTERS.into_iter().zip(self.shown());
        shown.filter_map(|(letter, frame)| Some((letter, self.frames[frame?].as_ref()?.drive_time_star)))
    }

    /// The frame of each instant that the run has had.
    fn shown(&self) -> [Option<usize>; 6] {
        let mut shown = std::array::from_fn(|instant| self.valid[instant].then_some(instant));
        for (instant, known) in [(D, self.known[0]), (E, self.known[1])] {
            if !(self.ended && known) {
                shown[instant] = None;
            } else if shown[instant].is_none() {
                // An instant that coincides with the one before it has no frame of its own.
                shown[instant] = shown[instant - 1];
            }
        }
        shown
    }

    fn keep(&mut self, instant: usize, now: &Snapshot) {
        self.valid[instant] = true;
        match &mut self.frames[instant] {
            Some(frame) => self.selection.capture_into(now, frame),
            none => *none = Some(self.selection.capture(now)),
        }
    }

    /// The first valid frame of these instants.
    fn first_valid(&self, instants: &[usize]) -> Option<&Frame> {
        instants
            .iter()
            .filter(|&&instant| self.valid[instant])
            .find_map(|&instant| self.frames[instant].as_ref())
    }
}

impl Observer for Instants {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let v_star = now.model.loading_speed();
        // Time of the drive one step before, as a product of its own: n dt - dt may differ from (n - 1) dt in
        // the last bit.
        let before = (now.drive_steps as f64 - 1.0) * now.dt_star;
        let passes = |time: f64| now.clock.drive_moved() && now.drive_time_star >= time && before < time;
        if passes(0.5 / v_star) {
            self.keep(A, now);
        }
        if !self.valid[B] && now.totals.n_slipping > 0 {
            self.keep(B, now);
        }
        let kinetic_from = self.kinetic.time_star(&now.peak, v_star);
        let middle = 0.5 * (kinetic_from + self.end_time_star);
        if now.peak.ended && !self.ended && middle > now.drive_time_star {
            // The end of the peak moves the kinetic window: until then F was the middle of the window of a
            // run without a transition.
            self.valid[F] = false;
        }
        self.ended = now.peak.ended;
        // D and E follow the present peak as if it had ended already.
        let mut ended = now.peak;
        ended.ended = true;
        let fall_until = self.kinetic.time_star(&ended, v_star);
        let most_until = now.peak.drive_time_star + ONSET_PATH / v_star;
        self.known = [most_until, fall_until].map(|until| now.drive_time_star >= until);
        if now.peak.step == now.step {
            // While mu* still rises the peak lies ahead, as at every step before the first slip.
            if (self.valid[B] && !now.mu_star_rises()) || now.last {
                self.keep(C, now);
            }
            self.valid[D] = false;
            self.valid[E] = false;
        } else {
            let most = self
                .first_valid(&[D, C])
                .map_or(0.0, |frame| frame.point.sliding_percent);
            let least = self
                .first_valid(&[E, D, C])
                .map_or(f64::INFINITY, |frame| frame.point.mu_star);
            if now.drive_time_star <= most_until && now.point.sliding_percent > most {
                self.keep(D, now);
                self.valid[E] = false;
            } else if now.drive_time_star <= fall_until && now.point.mu_star < least {
                let still_falls = now.mu_star_falls() && now.next_clock().drive_time_star() <= fall_until;
                if !still_falls || now.last {
                    self.keep(E, now);
                }
            }
        }
        if passes(middle) {
            self.keep(F, now);
        }
        Ok(())
    }
}
