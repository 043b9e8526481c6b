//! Slip events: of one block compared with the closed form, at an edge compared with the precursors, and of
//! any slider compared with displacements and velocities read block by block.

use std::f64::consts::PI;

use slipfront::communicator::Alone;
use slipfront::exact_solutions::SlipCycle;
use slipfront::observe::{Event, Events, Observer, Precursors, Scheduled};
use slipfront::{
    Coulomb, Drive, Edge, Friction, FrictionLaw, Interface, Lattice, Loading, Model, RateAndState, Rotation,
    RunError, Simulation, Snapshot, Stop, Surface,
};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, cavity};

fn events_of(model: &Model, dt_star: f64, steps: u64) -> Vec<Event> {
    let mut events = Events::new(model);
    let mut simulation = at_rest(model, dt_star);
    let seen = &mut [Scheduled::always(&mut events)];
    simulation.run(Stop::at_step(steps), seen).unwrap();
    assert!(events.is_consistent_with(&Events::new(model), simulation.time_star()));
    assert_eq!(events.unlisted(), 0);
    events.events().to_vec()
}

/// One block without damping at R* = 1/2 slips from the force 1 to the force 0, by the path of the drive in a
/// period, V T, with a speed of at most `V + sqrt(V^2 + (1 - R)^2/k_s)`, and again after every period.
///
/// A slip begins up to a step late, so that the force is up to k_s V dt too large, and stops up to a step
/// late: the n-th slip is late by the sum of these steps. The drive moves by V dt in a step, and the force of
/// the next slip differs accordingly. The error of leapfrog is of second order, far below.
#[test_matrix([0.03, 0.1], [[1, 1], [7, 5]], [0.0, 77.0])]
fn slips_of_one_block_are_those_of_the_closed_form(v_star: f64, blocks: [usize; 2], degrees: f64) {
    let dt = 1e-3;
    let slider = Slider {
        blocks,
        degrees,
        omega_star: 0.0,
        v_star,
        dt_star: dt,
        ..Slider::default().uniform()
    };
    let (r, k): (f64, f64) = (0.5, 0.375);
    let cycle = SlipCycle::new(0.0, r, v_star);
    // Ends in the stick phase after the fourth slip.
    let end = cycle.onset_time_star() + 3.9 * cycle.period();
    let events = events_of(&slider.model(), dt, (end / dt) as u64);
    assert_eq!(events.len(), 4);
    let n = (blocks[0] * blocks[1]) as f64;
    let fastest = v_star + (v_star * v_star + (1.0 - r).powi(2) / k).sqrt();
    for (number, event) in events.iter().enumerate() {
        let steps = 2.0 * number as f64 + 1.0;
        let begin = cycle.onset_time_star() + number as f64 * cycle.period();
        let late = event.from_star - begin;
        assert!(late.abs() < steps * dt, "event {number} begins {late} late");
        assert_eq!(event.drive_from_star, event.from_star);
        let (until, mu_star) = event.after.unwrap();
        let duration = until - event.from_star;
        assert!((duration - cycle.slip_duration()).abs() < 2.0 * dt);
        let reach = k * v_star * dt * (1.0 + 1e-6);
        assert!((event.mu_star_before - 1.0).abs() < reach && event.mu_star_before >= 1.0);
        assert!((mu_star - (2.0 * r - 1.0)).abs() < 2.0 * reach);
        let slip = event.moment / n;
        assert!(
            (slip - v_star * cycle.period()).abs() < 3.0 * v_star * dt,
            "{slip}"
        );
        // The force at the beginning is too large by up to `reach`, and the speed by this over sqrt(k).
        let faster = event.speed_max - fastest;
        assert!(faster.abs() < 2.0 * reach / k.sqrt() + dt * dt, "{faster}");
        assert_eq!((event.nucleation, event.blocks), ([0, 0], blocks[0] * blocks[1]));
    }
}

/// While the drive stands still the block jumps by `2 (1 - R)/k_s` in half a period, `pi/sqrt(k_s)`. In the
/// time of the drive, the interval between events is the time that it takes to load the block again. The
/// force is up to k_s V dt too large when a slip begins.
#[test]
fn slips_under_a_held_drive_are_half_swings() {
    let (v_star, dt, k): (f64, f64, f64) = (0.05, 1e-3, 0.375);
    let slider = Slider {
        blocks: [1, 1],
        omega_star: 0.0,
        loading: Loading::Held { onset_steps: 1 },
        v_star,
        dt_star: dt,
        ..Slider::default().uniform()
    };
    let steps = (3.5 / (k * v_star) / dt) as u64;
    let events = events_of(&slider.model(), dt, steps);
    assert_eq!(events.len(), 3);
    for (number, event) in events.iter().enumerate() {
        // The block is loaded from 0 to 1 every time, and half of this energy is lost.
        let loads = (number + 1) as f64 / (k * v_star);
        assert!((event.drive_from_star - loads).abs() < 2.0 * (number + 1) as f64 * dt);
        let (until, mu_star) = event.after.unwrap();
        assert!((until - event.from_star - PI / k.sqrt()).abs() < 2.0 * dt);
        assert!(mu_star.abs() < 2.0 * k * v_star * dt);
        assert!((event.moment - 1.0 / k).abs() < 2.0 * v_star * dt);
    }
    let slips: f64 = events
        .iter()
        .map(|event| event.after.unwrap().0 - event.from_star)
        .sum();
    let last = events.last().unwrap();
    let standing = events[0].from_star - events[0].drive_from_star;
    // Both times are equal up to the first event, and later differ by the duration of the slips.
    assert!(standing.abs() < 1e-9);
    let stood = last.from_star - last.drive_from_star;
    let before_last = slips - (last.after.unwrap().0 - last.from_star);
    assert!((stood - before_last).abs() < 3.0 * dt, "{stood} {before_last}");
}

fn driven_at_the_left(slider: &Slider, total: f64) -> Model {
    let lattice = slider.lattice();
    let mut body = slider.body.clone();
    body.attach_edge(&lattice, &(0..lattice.ny), Edge::Left, &Alone);
    let mut model = Slider {
        body,
        ..slider.clone()
    }
    .model();
    model.drive.k_drive = total / lattice.ny as f64;
    model
}

/// In a chain driven at its edge the events are those that precursors have, and slip begins at the driven
/// block. In a precursor that is the longest so far, all its blocks have slid.
#[test]
fn at_an_edge_the_events_are_the_precursors() {
    let slider = Slider {
        blocks: [100, 1],
        v_star: 1.0,
        r_star: 0.45 / 0.7,
        dt_star: 0.4,
        ..Slider::default().uniform()
    };
    let model = driven_at_the_left(&slider, 0.242 / 100.0);
    let (mut events, mut precursors) = (Events::new(&model), Precursors::new(Edge::Left));
    let mut simulation = at_rest(&model, slider.dt_star);
    let seen = &mut [Scheduled::always(&mut events), Scheduled::always(&mut precursors)];
    simulation.run(Stop::at_step(60_000), seen).unwrap();
    let (events, precursors) = (events.events(), precursors.events());
    assert!(events.len() > 10 && events.len() == precursors.len());
    let mut longest = 0.0;
    for (event, precursor) in events.iter().zip(precursors) {
        assert_eq!(
            (event.from_star, event.mu_star_before, event.after),
            (precursor.from_star, precursor.mu_star_before, precursor.after)
        );
        if precursor.length > longest {
            longest = precursor.length;
            assert_eq!(
                (event.nucleation, event.blocks as f64),
                ([0, 0], (100.0 * longest).round())
            );
        }
        assert!(event.moment > 0.0 && event.speed_max > 0.0);
    }
}

/// Reads every block at every step.
#[derive(Default)]
struct ByBlock {
    events: Vec<Event>,
    /// Whether motion along y is no slip.
    along_x_alone: bool,
    /// Displacements at the beginning of the event, and the blocks that slide in it.
    event: Option<(Vec<[f64; 2]>, Vec<usize>)>,
}

impl Observer for ByBlock {
    fn observe(&mut self, now: &Snapshot) -> Result<(), RunError> {
        let model = now.model;
        let n = model.lattice.n_blocks();
        let blocks: Vec<_> = (0..n).map(|b| now.block(b)).collect();
        let slips = |b: &usize| blocks[*b].slides && !model.surface.textured[*b];
        let slipping: Vec<usize> = (0..n).filter(slips).collect();
        if let (Some(first), None) = (slipping.first(), &self.event) {
            let (i, j) = model.lattice.column_row(*first);
            self.event = Some((
                blocks.iter().map(|block| block.displacement).collect(),
                Vec::new(),
            ));
            self.events.push(Event {
                from_star: now.time_star,
                drive_from_star: now.drive_time_star,
                nucleation: [i as u32, j as u32],
                blocks: 0,
                moment: 0.0,
                speed_max: 0.0,
                mu_star_before: now.point.mu_star,
                after: None,
            });
        }
        let Some((before, slid)) = &mut self.event else {
            return Ok(());
        };
        slid.extend(&slipping);
        slid.sort_unstable();
        slid.dedup();
        let event = self.events.last_mut().unwrap();
        for b in &slipping {
            let [x, mut y] = blocks[*b].velocity;
            if self.along_x_alone {
                y = 0.0;
            }
            event.speed_max = event.speed_max.max((x * x + y * y).sqrt());
        }
        event.blocks = slid.len();
        event.moment = 0.0;
        for b in slid {
            let direction = model.drive.direction_at(&model.lattice, *b);
            for axis in 0..2 {
                event.moment += (blocks[*b].displacement[axis] - before[*b][axis]) * direction[axis];
            }
        }
        if slipping.is_empty() {
            event.after = Some((now.time_star, now.point.mu_star));
            self.event = None;
        }
        Ok(())
    }
}

/// Drive of the slider, or its friction along x alone.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Plain,
    Turning,
    Held,
    Upright,
}

/// A rough slider with a cavity, in which blocks slip one after the other: driven at an angle, in rotation,
/// under a held drive, in a run that ends during its last event, and as an upright sheet. Sums of the moment
/// are rounded differently; everything else is equal.
#[test_case(25.0, Kind::Plain, 0.004, 6.0)]
#[test_case(0.0, Kind::Turning, 0.004, 6.0)]
#[test_case(180.0, Kind::Held, 0.05, 4.0)]
#[test_case(0.0, Kind::Plain, 0.1, 2.0)]
#[test_case(0.0, Kind::Upright, 0.004, 6.0)]
fn what_events_say_is_what_the_blocks_do(degrees: f64, kind: Kind, v_star: f64, until: f64) {
    let blocks = [12, 9];
    let slider = Slider {
        blocks,
        textures: vec![cavity(blocks, 12.0, 1, 0.3, true)],
        degrees,
        v_star,
        sigma_static_star: 0.2,
        omega_star: 0.3,
        dt_star: 0.2,
        loading: if kind == Kind::Held {
            Loading::Held { onset_steps: 1 }
        } else {
            Loading::Constant
        },
        ..Slider::default()
    };
    let mut model = slider.model();
    if kind == Kind::Turning {
        let lattice = &model.lattice;
        let rotation = Rotation::about_centroid(lattice, &model.rows, model.slider(), &Alone);
        model.drive.rotation = Some(rotation);
    }
    if kind == Kind::Upright {
        let interface = Some(Interface { foundation: 0.5 });
        model.friction = Friction::Coulomb(Coulomb {
            interface,
            ..FrictionLaw::Projection.into()
        });
    }
    let mut by_block = ByBlock {
        along_x_alone: kind == Kind::Upright,
        ..ByBlock::default()
    };
    let mut events = Events::new(&model);
    let mut simulation = at_rest(&model, slider.dt_star);
    let seen = &mut [Scheduled::always(&mut events), Scheduled::always(&mut by_block)];
    simulation.run(Stop::at_step(slider.steps(until)), seen).unwrap();
    let (found, expected) = (events.events(), by_block.events);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        // Displacements are of the order of V t*, up to 10, and a hundred of them are added.
        assert!(
            (found.moment - expected.moment).abs() < 1e-12,
            "{} {}",
            found.moment,
            expected.moment
        );
        let moment = expected.moment;
        assert_eq!(Event { moment, ..*found }, *expected);
    }
    let small = found.iter().filter(|event| event.blocks < 10).count();
    let goes_on = found.last().unwrap().after.is_none();
    assert!(
        if v_star < 0.1 { small > 5 } else { goes_on },
        "{small} of {}",
        found.len()
    );
}

/// Under rate and state nothing is ever stuck: an event lasts as long as the block is faster than the slip
/// speed, and its slip is the path of the block in this time.
#[test]
fn under_rate_and_state_an_event_is_what_exceeds_the_slip_speed() {
    let law = RateAndState {
        a: 0.01,
        b: 0.03,
        d_c: 0.05,
        v_0: 0.01,
        mu_0: 0.6,
        theta_0: 5.0,
        slip_speed: 0.1,
    };
    let lattice = Lattice::free(1, 1);
    let surface = Surface::uniform(&lattice, 1.0, 0.5);
    let drive = Drive {
        k_drive: 0.1,
        ..Drive::along_x(0.01)
    };
    let model = Model::new(lattice, surface, drive, 0.01, 0.0, Friction::RateAndState(law));
    let mut events = Events::new(&model);
    let mut simulation = at_rest(&model, 0.1);
    let (mut begin, mut expected) = (None, Vec::new());
    let block = |simulation: &Simulation| simulation.snapshot().block(0);
    for step in 1..=60_000 {
        let (block, time_star) = (block(&simulation), simulation.time_star());
        let (u, speed) = (block.displacement[0], block.velocity[0]);
        match begin {
            None if speed > law.slip_speed => begin = Some((time_star, u)),
            Some((from, before)) if speed <= law.slip_speed => {
                expected.push((from, time_star, u - before));
                begin = None;
            }
            _ => {}
        }
        let seen = &mut [Scheduled::always(&mut events)];
        simulation.run(Stop::at_step(step), seen).unwrap();
    }
    let found = events.events().iter().filter_map(|event| {
        let (until, _) = event.after?;
        assert!(event.blocks == 1 && event.speed_max > law.slip_speed);
        Some((event.from_star, until, event.moment))
    });
    let found: Vec<_> = found.collect();
    assert!(
        found.len() > 2 && found.len() == expected.len(),
        "{}",
        found.len()
    );
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!((found.0, found.1), (expected.0, expected.1));
        // A sum is a multiple of 2^-51 of a power of two above its largest term.
        assert!((found.2 / expected.2 - 1.0).abs() < 2.0 * f64::EPSILON);
    }
}
