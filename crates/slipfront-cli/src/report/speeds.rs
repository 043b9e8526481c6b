//! Drive speeds at which a case can be loaded, with the time of each and what it adds to friction.

use serde_json::{Value, json};
use slipfront::lattice::K_DRIVE;
use slipfront_base::number_format::{exact, four_digits, with_si_prefix};
use slipfront_case::case::{Case, LoadingSpeed};
use slipfront_case::case_file::{Attached, AttachedEdge, AutoOr, DriveSpeed, RunTime};
use slipfront_run::estimate_cost::StepTime;
use slipfront_study::text_table::table;

use super::times::duration;

/// Speeds in the table, relative to the speed that is slow enough.
const LISTED: [f64; 4] = [100.0, 10.0, 1.0, 0.1];
/// Largest ratio of the time in which a front crosses the slider to the loading time for which a speed is
/// listed; above it mu_s* depends only on the speed.
const FASTEST: f64 = 3.0;
/// Rise of mu* per step of a held drive that is proposed.
const HELD_RISE: f64 = 1e-3;
/// Smallest ratio of the steps of a drive of constant speed to the steps in which a held drive moves, for
/// which the held drive is proposed: it is at rest for some thirty times as many steps as it moves.
const HELD_IS_CHEAPER: f64 = 50.0;

/// The speeds of a case, including the slow one, and a held drive if that is even cheaper.
pub(super) struct Speeds {
    given: LoadingSpeed,
    slow: LoadingSpeed,
    /// Factor of the speed of a held drive, and the number of steps in which it moves.
    held: Option<(f64, f64)>,
}

impl Speeds {
    /// The speeds of a case; none if its speed is part of its physics.
    pub(super) fn new(case: &Case) -> Option<Self> {
        let given = case.loading_speed()?;
        let slow = given.times(rounded_down(case, given.factor_to_slow()));
        let held = rounded_down(case, HELD_RISE / case.rise_per_step());
        let steps = given.times(held).steps.steps[1];
        let is_cheaper = can_be_held(case) && steps * HELD_IS_CHEAPER < slow.steps.steps[1];
        Some(Self {
            given,
            slow,
            held: is_cheaper.then_some((held, steps)),
        })
    }

    /// All speeds of the table, the fastest first.
    fn all(&self) -> Vec<LoadingSpeed> {
        let is_listed = |speed: &LoadingSpeed| {
            let is_given = (speed.over_given - 1.0).abs() < 1e-6;
            speed.steps.front_ratio <= FASTEST && !is_given
        };
        let mut all = vec![self.given];
        all.extend(
            LISTED
                .map(|factor| self.slow.times(factor))
                .into_iter()
                .filter(is_listed),
        );
        all.sort_by(|a, b| b.over_given.total_cmp(&a.over_given));
        all
    }

    /// The table, and the line that names the slow speed; `per_step` is the time of a step.
    pub(super) fn text(&self, case: &Case, per_step: &StepTime) -> String {
        let rows: Vec<Vec<String>> = self
            .all()
            .iter()
            .map(|speed| self.row(case, speed, per_step))
            .collect();
        let (symbol, _) = case.blocks_along_drive();
        let ratio = format!("V* {symbol}");
        let header = [
            key_and_unit(case).0,
            &ratio,
            "mu_s* error",
            "drag",
            "steps",
            "time",
        ];
        let slow = &self.slow;
        let mut text = table(&header, &rows);
        text += &format!(
            "slow loading      `{}`: {}; mean mu_s* over surfaces within {} of its slow limit, drag {} of {}\n",
            self.setting(case, slow.over_given),
            duration(per_step.of_steps(&slow.steps)),
            two_digits(slow.static_bound()),
            percent(slow.drag_share),
            if slow.is_share_of_static {
                "a tenth of static friction"
            } else {
                "kinetic friction"
            }
        );
        if let Some((factor, steps)) = self.held {
            text += &format!(
                "held drive        `drive.loading = \"held\"`, `{}`: equally slow, in {} steps, not counting steps in which the drive stops\n",
                self.setting(case, factor),
                steps_in_words(steps)
            );
        }
        text
    }

    fn row(&self, case: &Case, speed: &LoadingSpeed, per_step: &StepTime) -> Vec<String> {
        let mut row = vec![
            value(case, speed.over_given),
            two_digits(speed.steps.front_ratio),
            format!("<{}", two_digits(speed.static_bound())),
            percent(speed.drag_share),
            steps_in_words(speed.steps.steps[1]),
            duration(per_step.of_steps(&speed.steps)),
        ];
        if speed == &self.given {
            row.push("as given".to_owned());
        } else if speed == &self.slow {
            row.push("slow enough".to_owned());
        }
        row
    }

    /// Keys that set a speed, and the duration if it is given as a time and not as a path.
    fn setting(&self, case: &Case, factor: f64) -> String {
        let (key, _) = key_and_unit(case);
        let mut text = match case.file.drive.speed {
            DriveSpeed::Speed(_) => format!("{key} = {:?}", value(case, factor)),
            _ => format!("{key} = {}", value(case, factor)),
        };
        if case.file.time.duration != RunTime::Star(AutoOr::Auto) {
            text += &format!(
                "`, `time.duration_star = {}",
                four_digits(case.time_plan.end_star() / factor)
            );
        }
        text
    }

    /// The speeds as JSON.
    pub(super) fn json(&self, case: &Case, per_step: &StepTime) -> Value {
        let speed = |speed: &LoadingSpeed| {
            json!({
                "v_star": speed.over_given * case.groups.v_star,
                "front_ratio": speed.steps.front_ratio,
                "static_friction_star_bound": speed.static_bound(),
                "drag_over_kinetic": (!speed.is_share_of_static).then_some(speed.drag_share),
                "steps": speed.steps.steps[1],
                "seconds": per_step.of_steps(&speed.steps),
            })
        };
        let all: Vec<Value> = self.all().iter().map(speed).collect();
        json!({
            "all": all,
            "slow": speed(&self.slow),
            "held": self.held.map(|(factor, steps)| json!({ "v_star": factor * case.groups.v_star, "steps": steps })),
        })
    }
}

/// Whether a held drive is possible: not on soft springs or where slip is stable, because slip then continues
/// while the drive is at rest.
fn can_be_held(case: &Case) -> bool {
    let friction = &case.file.friction;
    let drives_all = case.file.drive.attached == Attached::At(AttachedEdge::All);
    let is_stiff = case.model.drive.k_drive >= 0.5 * K_DRIVE;
    drives_all && is_stiff && friction.can_be_held() && case.model.weakening().is_none()
}

/// The key that sets the speed in the case, and its value in the unit of that key.
fn key_and_unit(case: &Case) -> (&'static str, f64) {
    match &case.file.drive.speed {
        DriveSpeed::Speed(speed) => ("drive.speed", speed.si()),
        DriveSpeed::VStar(_) | DriveSpeed::Program(_) => ("drive.v_star", case.groups.v_star),
    }
}

/// A multiple of the speed of the case, in the format of its key.
fn value(case: &Case, factor: f64) -> String {
    match key_and_unit(case) {
        ("drive.speed", speed) => with_si_prefix(factor * speed, "m/s"),
        (_, v_star) => exact(to_digits(factor * v_star, 5)),
    }
}

/// A factor of the speed, rounded down so that the value of the speed in its key has one digit.
fn rounded_down(case: &Case, factor: f64) -> f64 {
    let (_, given) = key_and_unit(case);
    // A value just below a digit because of rounding counts as that digit.
    let text = format!("{:e}", factor * given * (1.0 + 1e-9));
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let first = digits.chars().next().unwrap_or('1');
    let speed = format!("{first}e{exponent}").parse().unwrap_or(factor * given);
    speed / given
}

/// Rounds a number to its first digit and `after` more.
fn to_digits(number: f64, after: usize) -> f64 {
    format!("{number:.after$e}").parse().unwrap_or(number)
}

fn steps_in_words(steps: f64) -> String {
    exact(to_digits(steps, 2))
}

fn percent(share: f64) -> String {
    format!("{} %", two_digits(100.0 * share))
}

fn two_digits(number: f64) -> String {
    exact(to_digits(number, 1))
}
