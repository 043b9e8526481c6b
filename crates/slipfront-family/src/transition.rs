//! The distance at which a rupture along an edge becomes faster than shear waves.

use rayon::prelude::*;
use slipfront::Simulation;
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::rupture::{C_S_SQUARE, Place, Rupture, STEP};

/// Fall of strength per slip `W`, for a cohesive zone of `mu*/W`, some 20 blocks with `mu* = 1.1`.
const WEAKENING: f64 = 0.055;
/// Number of blocks over which a speed is averaged.
const WINDOW: usize = 20;
/// Largest distance of a front from the middle, over L_c.
const FARTHEST: f64 = 40.0;
/// Distance over which a front must stay faster than shear waves, over L_c.
const SUSTAINED: f64 = 3.0;
/// Speed of P waves in units of `sqrt(E/rho)`, squared.
const C_P_SQUARE: f64 = 9.0 / 8.0;

/// The front of a rupture to the right of its weak patch.
struct Front {
    /// For every block, the first time at which it or a block farther from the middle has slipped.
    reached: Vec<f64>,
    /// Distance of the first of these blocks from the middle.
    from: usize,
}

impl Front {
    fn from_simulation(simulation: &Simulation, rupture: &Rupture) -> Self {
        let first = simulation.snapshot().first_slip_time_star();
        let (nx, from) = (rupture.blocks[0], rupture.half_patch() as usize + 5);
        let mut reached = first[nx / 2 + from..nx - 20].to_vec();
        let mut earliest = f64::INFINITY;
        for time in reached.iter_mut().rev() {
            earliest = earliest.min(*time);
            *time = earliest;
        }
        reached.truncate(reached.partition_point(|time| time.is_finite()));
        Self { reached, from }
    }

    /// Distance of the farthest block that has slipped.
    fn distance(&self) -> usize {
        self.from + self.reached.len()
    }

    /// Distances, and the speeds from there on over that of shear waves.
    fn speeds(&self) -> impl DoubleEndedIterator<Item = (usize, f64)> {
        let windows = self.reached.windows(WINDOW + 1).enumerate();
        let speed = |times: &[f64]| WINDOW as f64 / (times[WINDOW] - times[0]).max(STEP) / C_S_SQUARE.sqrt();
        windows.map(move |(at, times)| (self.from + at, speed(times)))
    }

    /// Distance at which the front becomes faster than shear waves, if it stays faster over this many blocks.
    fn transition(&self, sustained: usize) -> Option<usize> {
        let faster: Vec<usize> = self
            .speeds()
            .rev()
            .take_while(|(_, speed)| *speed > 1.0)
            .map(|(at, _)| at)
            .collect();
        faster.last().copied().filter(|_| faster.len() >= sustained)
    }
}

/// Runs a rupture until it is faster than shear waves, or 40 L_c from the middle.
fn run(strength_excess: f64) -> Result<(Rupture, Front), FamilyError> {
    let mut rupture = Rupture {
        place: Place::Edge,
        blocks: [0, 0],
        weakening: WEAKENING,
        strength_excess,
    };
    let way = FARTHEST * rupture.critical_length();
    // Time of a front at 0.8 c_S; waves that the edges reflect must not reach it earlier.
    let time = way / (0.8 * C_S_SQUARE.sqrt());
    let waves = C_P_SQUARE.sqrt() * time;
    rupture.blocks = [(way + waves) as usize + 100, (0.5 * waves) as usize];
    let mut simulation = rupture.experiment()?.begin();
    loop {
        for _ in 0..400 {
            simulation.step();
        }
        let front = Front::from_simulation(&simulation, &rupture);
        let sustained = (SUSTAINED * rupture.critical_length()) as usize;
        let is_far = front.distance() as f64 >= way || simulation.time_star() > time;
        if is_far || front.transition(sustained).is_some() {
            return Ok((rupture, front));
        }
    }
}

/// Values of S, all below the limit of 1.77.
const EXCESSES: [f64; 3] = [0.5, 0.8, 1.2];

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let found: Vec<(Rupture, Front)> = EXCESSES
        .par_iter()
        .map(|&excess| run(excess))
        .collect::<Result<_, _>>()?;
    let mut curves = Vec::new();
    for (rupture, front) in &found {
        let (excess, length) = (rupture.strength_excess, rupture.critical_length());
        let transition = front.transition((SUSTAINED * length) as usize);
        let distance = transition.map_or(f64::INFINITY, |at| at as f64 / length);
        let answer = chapter.add(
            format!("S = {excess}: distance over L_c at which the front speed exceeds c_S, at most 40"),
            [FARTHEST, distance],
            0.0,
            "any shorter distance passes",
        );
        answer.tolerance_below = f64::INFINITY;
        let every = front.speeds().step_by((0.25 * length) as usize);
        let (x, y): (Vec<f64>, Vec<f64>) = every
            .map(|(at, speed)| (at as f64 / length, speed.min(2.0)))
            .unzip();
        curves.push(Response {
            line: true,
            ..Response::of_values(&format!("S = {excess}"), &x, &y)
        });
    }
    chapter.draw(
        "Front speed relative to shear waves, averaged over 20 blocks, against distance over L_c. Curves end once it has exceeded c_S for 3 L_c.",
        ["distance/L_c", "front speed v/c_S"],
        curves,
    );
    Ok(())
}
