//! A slider that is driven at an edge: precursors.

use rayon::prelude::*;
use slipfront::exact_solutions::precursor_load;
use slipfront::lattice::K_STRAIGHT;
use slipfront::observe::{Precursors, Scheduled};
use slipfront::{Edge, Stop};
use slipfront_plot::Response;

use crate::chapter::Chapter;
use crate::error::FamilyError;
use crate::runs::Experiment;

const STATIC: f64 = 0.7;
const KINETIC: f64 = 0.45;
/// Stiffness of the drive times the number of blocks.
const KAPPA: f64 = 0.242;
const SLOPES: [f64; 3] = [-0.833, 0.0, 0.833];

/// A chain, and the time steps of its runs, the finest last.
struct Chain {
    blocks: u32,
    v_star: f64,
    steps: &'static [f64],
}

const CHAINS: [Chain; 2] = [
    Chain {
        blocks: 100,
        v_star: 1.0,
        steps: &[0.4, 0.2, 0.1],
    },
    Chain {
        blocks: 400,
        v_star: 2.0,
        steps: &[0.6, 0.3],
    },
];

/// An event that is longer than all earlier ones, but does not cross the chain.
struct Longer {
    length: f64,
    /// Load `F_T/F_N` after the event.
    load: f64,
    /// Largest allowed distance of the load from the exact one if the drive adds little load during the
    /// event.
    bound: f64,
    /// Load that the drive has added during the event.
    added: f64,
}

/// Events that are longer than all earlier ones, and the largest load of a run.
type Events = (Vec<Longer>, f64);

impl Longer {
    /// Relative error of the load, and its largest allowed values without and with the load that the drive
    /// has added.
    fn error(&self, slope: f64) -> [f64; 3] {
        let exact = precursor_load(self.length, KINETIC, slope);
        [self.load - exact, self.bound, self.bound + self.added].map(|load| load.abs() / exact)
    }
}

impl Chain {
    /// Events that are longer than all earlier ones, and the largest load, of a run that ends when an event
    /// has crossed the chain; the load is infinite if none crosses it.
    fn precursors(&self, slope: f64, dt_star: f64) -> Result<Events, FamilyError> {
        let (n, v_star) = (f64::from(self.blocks), self.v_star);
        // Until the drive force would be 1.3 times the kinetic friction of the whole chain if the chain
        // stayed at rest.
        let duration = 1.3 * KINETIC / STATIC * n * n / (KAPPA * v_star);
        let text = format!(
            "[slider]\nblocks = [{n}, 1]\nomega_star = 0\nviscosity_time_star = 0.365\n\
             [load]\nprofile = {{ along = \"x\", relative_slope = {slope} }}\n\
             [drive]\nv_star = {v_star}\nattach = \"left\"\ntotal_stiffness_star = {}\n\
             [friction]\nmu_static = {STATIC}\nmu_kinetic = {KINETIC}\nsigma_static_star = 0\nsigma_kinetic_star = 0\n\
             [time]\nstep = {dt_star}\nduration_star = {duration}",
            KAPPA / n
        );
        let (experiment, last_step) = Experiment::of_case("precursors", &text)?;
        let mut observer = Precursors::new(Edge::Left);
        let mut simulation = experiment.begin();
        let has_crossed =
            |observer: &Precursors| observer.crossing().is_some_and(|event| event.after.is_some());
        while !has_crossed(&observer) {
            let observers = &mut [Scheduled::always(&mut observer)];
            let ended = simulation.advance(Stop::at_step(last_step), 10_000, observers);
            if ended.map_err(FamilyError::of_run("precursors"))?.is_some() {
                break;
            }
        }
        let mut longest = 0.0;
        let mut longer = Vec::new();
        for event in observer.events() {
            if let Some((until, mu_star)) = event.after
                && event.length > longest
                && event.length < 1.0
            {
                longest = event.length;
                let [at_drive, at_tip] = [0.0, longest].map(|x| 1.0 + slope * (2.0 * x - 1.0));
                longer.push(Longer {
                    length: longest,
                    load: STATIC * mu_star,
                    bound: (STATIC * at_tip + (STATIC - KINETIC) * at_drive) / n,
                    added: STATIC * KAPPA * v_star * (until - event.from_star) / (n * n),
                });
            }
        }
        let largest = STATIC * simulation.peak().largest.mu_star;
        let crossing = observer.crossing();
        Ok((longer, crossing.map_or(f64::INFINITY, |_| largest)))
    }

    /// Compares the chain's runs under one pressure profile, one for each step.
    fn compare(&self, slope: f64, runs: &[Events], chapter: &mut Chapter) {
        let n = self.blocks;
        let (mut largest, mut highest) = ([0.0; 3], KINETIC);
        for (dt_star, (longer, peak)) in self.steps.iter().zip(runs) {
            let beyond = longer.iter().filter(|event| event.length > 0.2);
            let errors: Vec<[f64; 3]> = beyond.map(|event| event.error(slope)).collect();
            let count = errors.len();
            let rms = |k: usize| {
                let squares: f64 = errors.iter().map(|error| error[k] * error[k]).sum();
                (squares / count as f64).sqrt()
            };
            chapter.add(
                format!(
                    "{n} blocks, θ = {slope}, Δt* = {dt_star}: relative error of F_T, rms over {count} events"
                ),
                [0.0, rms(0)],
                rms(1),
                "force of the block ahead of the tip, and reloading of the driven block",
            );
            for error in errors {
                // An error that exceeds its own bound takes precedence over the largest error.
                if (error[0] > error[2], error[0]) > (largest[0] > largest[2], largest[0]) {
                    largest = error;
                }
            }
            if (peak - KINETIC).abs() > f64::abs(highest - KINETIC) {
                highest = *peak;
            }
        }
        chapter.add(
            format!("{n} blocks, θ = {slope}: largest relative error of F_T in all runs"),
            [0.0, largest[0]],
            largest[2],
            "force of the same two blocks, and motion of the drive during the event",
        );
        let [first, last] = [1.0 - slope, 1.0 + slope];
        let crossing = 2.0 * KAPPA * self.v_star / K_STRAIGHT.sqrt();
        chapter.add(
            format!("{n} blocks, θ = {slope}: largest F_T/F_N, in the run with the largest error"),
            [KINETIC, highest],
            (STATIC * (last + crossing) + (STATIC - KINETIC) * first) / f64::from(n),
            "force of the same two blocks, and motion of the drive while sound crosses the chain and returns",
        );
    }
}

pub(crate) fn compare(chapter: &mut Chapter) -> Result<(), FamilyError> {
    let pairs = SLOPES.map(|slope| CHAINS.each_ref().map(|chain| (slope, chain)));
    let runs_of = |&(slope, chain): &(f64, &Chain)| {
        let runs = chain
            .steps
            .par_iter()
            .map(|dt_star| chain.precursors(slope, *dt_star));
        runs.collect::<Result<Vec<Events>, FamilyError>>()
    };
    let found = pairs.as_flattened().par_iter().map(runs_of);
    let found: Vec<_> = found.collect::<Result<_, _>>()?;
    let mut curves = Vec::new();
    let lengths: Vec<f64> = (1..=50).map(|k| 0.02 * f64::from(k)).collect();
    for (&(slope, chain), runs) in pairs.as_flattened().iter().zip(found) {
        chain.compare(slope, &runs, chapter);
        // Four times as many points would hide the lines.
        let Some((finest, _)) = runs.last().filter(|_| chain.blocks == CHAINS[0].blocks) else {
            continue;
        };
        let load = |length| precursor_load(length, KINETIC, slope);
        curves.push(Response::of_formula(
            &format!("\u{3b8} = {slope}, exact"),
            &lengths,
            load,
        ));
        let x: Vec<f64> = finest.iter().map(|event| event.length).collect();
        let loads: Vec<f64> = finest.iter().map(|event| event.load).collect();
        curves.push(Response::of_values(&format!("\u{3b8} = {slope}"), &x, &loads));
    }
    chapter.draw(
        "Load after each event that is longer than all earlier ones, against its length, for 100 blocks and three pressure profiles.",
        ["event length over chain length", "load F_T/F_N"],
        curves,
    );
    Ok(())
}
