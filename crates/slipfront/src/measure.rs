//! Measures at one instant of a run: the friction coefficient mu* (Eq. 9), the percentage of sliding blocks
//! N*, the largest mu* and the first peak of mu*.

use serde::{Deserialize, Serialize};

use crate::clock::Clock;
use crate::drive::Loading;
use crate::model::Model;
use crate::totals::Totals;
use crate::vector_field::dot;

/// The whole slider at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// mu*, the force of drive springs and dead load along the sliding direction over the load; it can be
    /// negative.
    pub mu_star: f64,
    /// The force of drive springs and dead load across the sliding direction, to the left of it, over the
    /// load.
    pub mu_lateral_star: f64,
    /// Number of blocks that slide, textured ones included.
    pub n_sliding: usize,
    /// N*, the sliding blocks in % of all existing blocks; for an upright sheet, the sliding blocks in
    /// contact in % of the lowest row.
    pub sliding_percent: f64,
}

impl CurvePoint {
    /// Computes Eq. 9 over mu_s at a time t* of the drive: the force of the [drive springs](pull_of_springs),
    /// with the dead load,
    ///
    /// ```text
    /// mu* = (1/N) sum_i (F_s,i + F_0,i) . d
    /// ```
    pub(crate) fn measure(model: &Model, totals: &Totals, drive_time_star: f64) -> Self {
        let [along, across] = pull_of_springs(model, totals, drive_time_star);
        let [dead_along, dead_across] = model.mean_dead_load();
        let (sliding, blocks) = match model.friction.interface() {
            Some(_) => (totals.n_slipping, model.surface.n_facing()),
            None => (totals.n_sliding, model.n_blocks()),
        };
        Self {
            mu_star: along + dead_along,
            mu_lateral_star: across + dead_across,
            n_sliding: totals.n_sliding,
            sliding_percent: 100.0 * sliding as f64 / blocks as f64,
        }
    }
}

/// Force of the drive springs along the sliding direction and to the left of it, over the load, from the mean
/// displacement, with the relative stiffness w of the drive springs and N existing blocks:
///
/// ```text
/// (1/N) sum_i F_s,i . d = k_s (mean(w) V* t* - mean(w u . d))
/// ```
///
/// If the drive springs differ, with relative stiffness `w_i`, and for a rotation, with
/// `g_i = z x r_i/r_max`:
///
/// ```text
/// (k_s/N) (X sum_i w_i - sum_i w_i u_i . d)
/// (k_s r_max/sum_i r_i) (X sum_i w_i g_i^2 - sum_i w_i u_i . g_i)
/// ```
pub(crate) fn pull_of_springs(model: &Model, totals: &Totals, drive_time_star: f64) -> [f64; 2] {
    let (drive, divisor) = (&model.drive, model.mu_star_divisor());
    let mean = totals.displacement.map(|sum| sum / divisor);
    // For a rotation the sums are along and across its direction at each block.
    let (position, [dx, dy]) = match drive.rotation {
        None => (drive.position(drive_time_star), drive.direction),
        Some(_) => ([drive.path(drive_time_star), 0.0], [1.0, 0.0]),
    };
    let share = model.driven_share();
    let pull = [0, 1].map(|axis| drive.k_drive * (position[axis] * share - mean[axis]));
    [dot(pull, [dx, dy]), dot(pull, [-dy, dx])]
}

/// The largest mu* until the drive has moved by a given path.
///
/// Unlike a first peak, it cannot be a mere ripple: a later, higher mu* counts until the end of the path.
///
/// ```
/// use slipfront::observe::Largest;
/// let mut largest = Largest::until(5.0);
/// for (path, mu_star) in [(1.0, 0.50), (2.0, 0.49), (4.0, 0.68), (6.0, 0.70)] {
///     largest.update(path, path / 0.03, mu_star, 0.0);
/// }
/// assert_eq!((largest.mu_star, largest.time_star), (0.68, 4.0 / 0.03));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Largest {
    /// Largest mu*; minus infinity before the first step.
    pub mu_star: f64,
    /// Friction across the drive at the time of the largest mu*.
    pub mu_lateral_star: f64,
    /// Time of the drive at the largest mu*, the first if it occurs several times.
    pub time_star: f64,
    until_path: f64,
    is_complete: bool,
}

impl Largest {
    /// The state before the first step. Steps do not count after the drive has moved further than
    /// `until_path`, in units of displacement; [`f64::INFINITY`] includes the whole run.
    pub fn until(until_path: f64) -> Self {
        Self {
            mu_star: f64::NEG_INFINITY,
            mu_lateral_star: 0.0,
            time_star: 0.0,
            until_path,
            is_complete: false,
        }
    }

    /// Includes the next step, at which the drive has moved by `path` in the time `time_star`.
    pub fn update(&mut self, path: f64, time_star: f64, mu_star: f64, mu_lateral_star: f64) {
        self.is_complete |= path > self.until_path;
        if !self.is_complete && mu_star > self.mu_star {
            (self.mu_star, self.mu_lateral_star, self.time_star) = (mu_star, mu_lateral_star, time_star);
        }
    }

    /// Whether the drive has moved further than the given path: the largest mu* is final.
    pub fn is_complete(&self) -> bool {
        self.is_complete
    }
}

/// Least fall of friction in a transition, as a share of the largest fall S - L. Ripples in sliding just
/// above L are smaller; the fall is larger even for a texture that lowers mu_s* nearly to L.
const LEAST_FALL: f64 = 0.05;

/// The first peak of mu* that is followed, within the longest time that a transition takes, by a fall of at
/// least half-way to the steady level L and of at least (S - L)/20. S is the share of the load that blocks in
/// contact bear: 1 unless the load of textured blocks is lost. The peak is found during the run: until such a
/// fall occurs it is the largest mu* so far. It stays the largest mu* if the first fall comes too late, as in
/// a slider that creeps.
///
/// Under a held drive it is the largest mu* until the drive has moved in a given number of steps, if such a
/// fall follows it by then, in the time of the drive: otherwise a ripple just above L would count as the
/// first peak.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// mu* at the peak: mu_s* once `ended`.
    pub mu_star: f64,
    /// Friction across the drive at the peak.
    pub mu_lateral_star: f64,
    /// Step of the peak.
    pub step: u64,
    /// Time of the peak: t_s* once `ended`.
    pub time_star: f64,
    /// Time of the drive at the peak.
    pub drive_time_star: f64,
    /// Whether the fall has occurred; under a held drive only once the largest mu* is known.
    pub ended: bool,
    /// Largest mu* of the whole run so far.
    pub largest: Largest,
    /// Time of the drive at the first step after which a block in contact slid.
    pub first_slip_drive_time_star: Option<f64>,
    steady_level: f64,
    share_of_load: f64,
    longest_fall: f64,
    /// Whether mu* fell by the least amount too late for a transition; under a held drive, whether it did not
    /// fall.
    crept: bool,
    /// Peak under a held drive.
    held: Option<HeldPeak>,
}

/// State of the search for the peak under a held drive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct HeldPeak {
    /// Number of steps of the drive after which the peak is final.
    onset_steps: u64,
    /// Whether the fall that follows the last of these steps but one ends the search for the peak, as a bulk
    /// body's does: its increments of the drive lead to the onset.
    ends_with_fall: bool,
    /// Whether the fall after the largest mu* so far has occurred.
    has_fallen: bool,
}

impl HeldPeak {
    fn is_final(&self, clock: &Clock, has_fallen: bool) -> bool {
        let ends_with_fall = self.ends_with_fall && has_fallen;
        clock.drive_steps + u64::from(ends_with_fall) >= self.onset_steps
    }
}

impl Peak {
    /// The peak before the first step; `steady_level` is L, see [`Model::steady_level`].
    pub(crate) fn new(model: &Model, steady_level: f64) -> Self {
        let held = match model.drive.loading {
            Loading::Constant => None,
            Loading::Held { onset_steps } => Some(HeldPeak {
                onset_steps,
                ends_with_fall: model.rests_by_excess(),
                has_fallen: false,
            }),
        };
        Self {
            held,
            ..Self::within(model.longest_fall(), steady_level, model.share_of_load())
        }
    }

    /// The peak under a drive at constant speed; `longest_fall` comes from [`Model::longest_fall`].
    fn within(longest_fall: f64, steady_level: f64, share_of_load: f64) -> Self {
        Self {
            mu_star: f64::NEG_INFINITY,
            mu_lateral_star: 0.0,
            step: 0,
            time_star: 0.0,
            drive_time_star: 0.0,
            ended: false,
            largest: Largest::until(f64::INFINITY),
            first_slip_drive_time_star: None,
            steady_level,
            share_of_load,
            longest_fall,
            crept: false,
            held: None,
        }
    }

    /// Whether a run that stops after the onset would end at this instant with `mu_star`.
    pub(crate) fn ends_at(&self, clock: &Clock, mu_star: f64) -> bool {
        match &self.held {
            None => !self.crept && self.is_transition_to(clock, mu_star),
            Some(held) => held.is_final(clock, held.has_fallen || self.is_transition_to(clock, mu_star)),
        }
    }

    /// Whether a run that stops after the onset ends now: the fall has occurred, or did not occur under a
    /// held drive.
    pub(crate) fn is_final(&self) -> bool {
        self.ended || (self.held.is_some() && self.crept)
    }

    /// Whether the fall to `mu_star` at this instant is as fast as a transition.
    fn is_transition_to(&self, clock: &Clock, mu_star: f64) -> bool {
        self.is_fall_to(mu_star) && clock.drive_time_star() - self.drive_time_star <= self.longest_fall
    }

    pub(crate) fn is_fall_to(&self, mu_star: f64) -> bool {
        let half_way = 0.5 * (self.mu_star + self.steady_level);
        self.mu_star > self.steady_level && mu_star <= half_way && self.is_above(mu_star)
    }

    /// Whether the peak exceeds this mean of mu* in sliding by at least the least fall of friction in a
    /// transition, (S - L)/20.
    pub fn is_above(&self, sliding: f64) -> bool {
        self.mu_star - sliding >= LEAST_FALL * (self.share_of_load - self.steady_level).max(0.0)
    }

    /// Includes the next step; `counts` says whether it can be the peak, as only instants at rest can be
    /// under slow loading of a bulk body.
    pub(crate) fn update(&mut self, clock: &Clock, point: &CurvePoint, counts: bool) {
        let (mu_star, time_star) = (point.mu_star, clock.time_star());
        if counts {
            // The whole run counts, at any path: 0 is below infinity.
            self.largest
                .update(0.0, clock.drive_time_star(), mu_star, point.mu_lateral_star);
        }
        if self.is_final() {
            return;
        }
        let is_higher = counts && mu_star > self.mu_star;
        if is_higher {
            (self.mu_star, self.step, self.time_star) = (mu_star, clock.step, time_star);
            self.mu_lateral_star = point.mu_lateral_star;
            self.drive_time_star = clock.drive_time_star();
        }
        let falls = !is_higher && self.is_transition_to(clock, mu_star);
        match &mut self.held {
            None if is_higher => {}
            None => {
                self.ended = !self.crept && falls;
                self.crept |= !self.ended && self.is_fall_to(mu_star);
            }
            Some(held) => {
                held.has_fallen = !is_higher && (held.has_fallen || falls);
                if held.is_final(clock, held.has_fallen) {
                    (self.ended, self.crept) = (held.has_fallen, !held.has_fallen);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peak_of(level: f64, curve: &[f64]) -> Peak {
        let long = curve.len() as f64;
        peak_within(long, level, curve)
    }

    fn peak_within(longest_fall: f64, level: f64, curve: &[f64]) -> Peak {
        let mut peak = Peak::within(longest_fall, level, 1.0);
        let mut clock = Clock::start(1.0);
        for &mu in curve {
            let point = CurvePoint {
                mu_star: mu,
                mu_lateral_star: -mu,
                ..CurvePoint::default()
            };
            peak.update(&clock, &point, true);
            clock = clock.next(true);
        }
        peak
    }

    #[test]
    fn the_first_peak_counts_even_if_a_later_one_is_higher() {
        let peak = peak_of(0.5, &[0.0, 0.4, 0.8, 1.0, 0.9, 0.75, 0.2, 0.9, 1.1, 0.1]);
        assert_eq!(
            (peak.mu_star, peak.step, peak.ended, peak.largest.mu_star),
            (1.0, 3, true, 1.1)
        );
        assert_eq!(
            (
                peak.mu_lateral_star,
                peak.largest.mu_lateral_star,
                peak.largest.time_star
            ),
            (-1.0, -1.1, 8.0)
        );
    }

    /// A fall of less than 0.025 makes no peak at L = 0.5, even if it is half-way to L; if L exceeds 1,
    /// half-way is enough.
    #[test]
    fn a_ripple_just_above_the_level_of_sliding_is_no_peak() {
        let curve = [0.0, 0.51, 0.5, 0.52, 0.497, 0.68, 0.55];
        assert_eq!((peak_of(0.5, &curve).step, peak_of(0.5, &curve).ended), (5, true));
        assert_eq!(peak_of(0.5, &[0.0, 0.53, 0.504]).step, 1);
        assert!(peak_of(0.5, &[0.0, 0.53, 0.504]).ended);
        assert!(peak_of(1.2, &[0.0, 1.21, 1.204]).ended);
    }

    #[test]
    fn a_transition_lowers_the_friction_by_a_twentieth_of_what_it_can_lose() {
        let peak = peak_of(0.5, &[0.0, 0.57, 0.53]);
        assert!(peak.ended && peak.is_above(0.544) && !peak.is_above(0.546));
    }

    #[test]
    fn a_dip_of_less_than_half_way_does_not_end_the_climb() {
        let peak = peak_of(0.5, &[0.0, 0.8, 0.7, 0.9, 0.6]);
        assert_eq!((peak.mu_star, peak.step, peak.ended), (0.9, 3, true));
    }

    #[test]
    fn of_equal_values_the_first_is_the_peak() {
        assert_eq!(peak_of(0.5, &[0.0, 1.0, 0.9, 1.0, 0.2]).step, 1);
    }

    /// The fall to 0.75 takes three steps from the peak at 1.
    #[test]
    fn a_fall_that_takes_too_long_is_creep() {
        let curve = [0.0, 1.0, 0.9, 0.8, 0.75];
        assert!(peak_within(3.0, 0.5, &curve).ended);
        assert!(!peak_within(2.5, 0.5, &curve).ended);
    }

    /// mu* of a slider that creeps rises and falls forever: in the end some fall would be fast enough.
    #[test]
    fn what_has_crept_once_has_no_transition_any_more() {
        let peak = peak_within(2.5, 0.5, &[0.0, 1.0, 0.9, 0.8, 0.75, 1.1, 0.3]);
        assert_eq!((peak.mu_star, peak.step, peak.ended), (1.1, 5, false));
    }

    #[test]
    fn what_comes_back_from_beyond_the_path_does_not_count() {
        let mut largest = Largest::until(2.0);
        for (n, (path, mu_star)) in [(1.0, 0.4), (2.0, 0.5), (2.5, 0.7), (1.5, 0.6)]
            .iter()
            .enumerate()
        {
            assert_eq!(largest.is_complete(), n == 3);
            largest.update(*path, n as f64, *mu_star, -mu_star);
        }
        assert_eq!(
            (largest.mu_star, largest.mu_lateral_star, largest.time_star),
            (0.5, -0.5, 1.0)
        );
    }

    #[test]
    fn without_a_fall_the_largest_value_is_taken() {
        let peak = peak_of(1.0, &[0.0, 0.5, 0.9, 0.95, 0.94]);
        assert_eq!((peak.mu_star, peak.ended), (0.95, false));
    }
}
