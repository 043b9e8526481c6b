//! Laws of friction compared with a second implementation, written block by block from the equations, over
//! random small lattices.

use slipfront::surface::{Coefficients, Load};
use slipfront::{
    AfterBreak, Ageing, ContactSprings, Coulomb, Drive, Friction, FrictionLaw, Lattice, Model, RateAndState,
    Surface, Weakening,
};
use test_case::test_matrix;

use crate::common::at_rest;

/// Reproducible uniform numbers from 0 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// A single block.
#[derive(Clone, Copy)]
struct Body {
    site: [i64; 2],
    u: [f64; 2],
    v: [f64; 2],
    mu_s: f64,
    mu_k: f64,
    /// Time of the last stop of the block, followed by its anchor and state.
    stopped: f64,
    anchor: [f64; 2],
    theta: f64,
    slides: bool,
}

struct World {
    bodies: Vec<Body>,
    friction: Friction,
    velocity: [f64; 2],
    omega: f64,
    epsilon: f64,
    dt: f64,
}

fn norm(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

impl World {
    /// Force of all springs on a body: the pull of its drive spring, and k (r - d) along each spring to a
    /// neighbour.
    fn force(&self, body: &Body, t: f64) -> [f64; 2] {
        let mut force = [0, 1].map(|axis| 0.375 * (self.velocity[axis] * t - body.u[axis]));
        for other in &self.bodies {
            let d = [0, 1].map(|axis| (other.site[axis] - body.site[axis]) as f64);
            if d == [0.0, 0.0] || d[0].abs() > 1.0 || d[1].abs() > 1.0 {
                continue;
            }
            let stiffness = if d[0] * d[1] == 0.0 { 0.75 } else { 0.375 };
            let r = [0, 1].map(|axis| d[axis] + self.epsilon * (other.u[axis] - body.u[axis]));
            let tension = stiffness * (norm(r) - norm(d)) / self.epsilon;
            for axis in 0..2 {
                force[axis] += tension * r[axis] / norm(r);
            }
        }
        force
    }

    /// Computes the velocities half a step after t_n.
    fn evaluate(&mut self, t: f64) {
        let (dt, half) = (self.dt, 0.5 * self.omega * self.dt);
        let forces: Vec<[f64; 2]> = self.bodies.iter().map(|body| self.force(body, t)).collect();
        for (body, force) in self.bodies.iter_mut().zip(forces) {
            let free = |force: [f64; 2]| {
                [0, 1].map(|axis| ((1.0 - half) * body.v[axis] + dt * force[axis]) / (1.0 + half))
            };
            match self.friction {
                Friction::Coulomb(law) => {
                    let speed = norm(body.v);
                    let age = t - body.stopped;
                    let mu_s = law.ageing.map_or(body.mu_s, |a| {
                        body.mu_s * (1.0 + a.beta * (1.0 + age / a.time).ln())
                    });
                    let mu_k = law.weakening.map_or(body.mu_k, |w| {
                        body.mu_k * (w.ratio + (1.0 - w.ratio) / (1.0 + speed / w.critical_speed))
                    });
                    let (free, most) = (free(force), dt * mu_k / (1.0 + half));
                    let stays = speed == 0.0 && norm(force) <= mu_s;
                    body.slides = !stays && norm(free) > most;
                    let share = if body.slides { 1.0 - most / norm(free) } else { 0.0 };
                    body.v = free.map(|v| share * v);
                    if speed > 0.0 && !body.slides {
                        body.stopped = t;
                    }
                }
                Friction::ContactSprings(law) => {
                    let pull = [0, 1].map(|axis| law.stiffness * (body.u[axis] - body.anchor[axis]));
                    let slid = law.slides() && body.slides;
                    let most = if law.slides() {
                        body.mu_s.max(body.mu_k)
                    } else {
                        body.mu_s
                    };
                    body.slides = norm(pull) > if slid { body.mu_k } else { most };
                    let left = if law.slides() { body.mu_k / norm(pull) } else { 0.0 };
                    let share = match (body.slides, slid) {
                        (false, _) => 1.0,
                        (true, false) => 0.5 * (1.0 + left),
                        (true, true) => left,
                    };
                    body.v = free([0, 1].map(|axis| force[axis] - share * pull[axis]));
                    if body.slides {
                        body.anchor = [0, 1].map(|axis| body.u[axis] - left * pull[axis] / law.stiffness);
                    }
                }
                Friction::RateAndState(law) => {
                    let free = free(force);
                    let friction = |speed: f64| {
                        let rate = speed / (2.0 * law.v_0);
                        law.a
                            * (rate
                                * ((law.mu_0 + law.b * (law.v_0 * body.theta / law.d_c).ln()) / law.a).exp())
                            .asinh()
                    };
                    let (mut low, mut high) = (0.0, norm(free));
                    for _ in 0..200 {
                        let middle = 0.5 * (low + high);
                        if middle + dt / (1.0 + half) * friction(middle) < norm(free) {
                            low = middle;
                        } else {
                            high = middle;
                        }
                    }
                    body.v = free.map(|v| {
                        if norm(free) > 0.0 {
                            high * v / norm(free)
                        } else {
                            0.0
                        }
                    });
                    body.slides = high > law.slip_speed;
                    // Solves the linear equation for theta; d_c/speed alone would be huge where the block
                    // creeps.
                    let x = high * dt / law.d_c;
                    let time = if x > 0.0 { -dt * (-x).exp_m1() / x } else { dt };
                    body.theta = body.theta * (-x).exp() + time;
                }
            }
        }
    }

    fn advance(&mut self) {
        for body in &mut self.bodies {
            for axis in 0..2 {
                body.u[axis] += self.dt * body.v[axis];
            }
        }
    }
}

fn coulomb(weakening: Option<Weakening>, ageing: Option<Ageing>) -> Friction {
    Friction::Coulomb(Coulomb {
        weakening,
        ageing,
        ..FrictionLaw::Projection.into()
    })
}

const WEAKENING: Weakening = Weakening {
    critical_speed: 0.08,
    ratio: 0.3,
};

const AGEING: Ageing = Ageing { beta: 0.1, time: 2.0 };

const SPRINGS: Friction = Friction::ContactSprings(ContactSprings {
    stiffness: 0.4,
    after_break: AfterBreak::FormsAgain { redraw: None },
});

const SLIDING_SPRINGS: Friction = Friction::ContactSprings(ContactSprings {
    stiffness: 0.4,
    after_break: AfterBreak::Slides,
});

const RATE_AND_STATE: Friction = Friction::RateAndState(RateAndState {
    a: 0.03,
    b: 0.05,
    d_c: 0.3,
    v_0: 0.05,
    mu_0: 0.7,
    theta_0: 4.0,
    slip_speed: 0.02,
});

/// The extension of a spring is computed as the difference of nearly equal lengths over epsilon, 1e-3: with
/// an error of 1e-13 of the unit. Over some hundred steps of motion that is sensitive to its initial state,
/// the difference stays below 1e-8.
#[test_matrix(
    [
        coulomb(Some(WEAKENING), None), coulomb(None, Some(AGEING)), coulomb(Some(WEAKENING), Some(AGEING)),
        SPRINGS, SLIDING_SPRINGS, RATE_AND_STATE
    ],
    [1, 2, 3, 4, 5, 6]
)]
fn a_second_implementation_agrees(friction: Friction, seed: u64) {
    let mut numbers = Numbers(seed);
    let [nx, ny] = [0; 2].map(|_| 1 + (numbers.next() * 5.0) as usize);
    let lattice = Lattice::free(nx, ny);
    let n = lattice.n_blocks();
    let mu_static: Vec<f64> = (0..n).map(|_| numbers.within(0.8, 1.2)).collect();
    let mu_kinetic: Vec<f64> = (0..n).map(|_| numbers.within(0.4, 0.6)).collect();
    let given = Coefficients::given(mu_static.clone(), mu_kinetic.clone());
    let surface = Surface::new(given, vec![false; n], Load::Redistributed, 1.0).unwrap();
    let drive = Drive::at_angle(numbers.within(0.05, 0.2), numbers.within(0.0, 360.0));
    let (omega, epsilon, dt) = (numbers.within(0.0, 0.5), 1e-3, 0.1);
    let theta = match friction {
        Friction::RateAndState(law) => law.theta_0,
        _ => 0.0,
    };
    let body = |b: usize| Body {
        site: [(b % nx) as i64, (b / nx) as i64],
        u: [0.0; 2],
        v: [0.0; 2],
        mu_s: mu_static[b],
        mu_k: mu_kinetic[b],
        stopped: 0.0,
        anchor: [0.0; 2],
        theta,
        slides: false,
    };
    let mut world = World {
        bodies: (0..n).map(body).collect(),
        friction,
        velocity: drive.direction.map(|d| d * drive.v_star),
        omega,
        epsilon,
        dt,
    };
    let model = Model::new(lattice, surface, drive, omega, epsilon, friction);
    let mut simulation = at_rest(&model, dt);
    let mut changes = 0;
    for step in 0..1500 {
        let before: Vec<bool> = world.bodies.iter().map(|body| body.slides).collect();
        world.evaluate(f64::from(step) * dt);
        let now = simulation.snapshot();
        assert_eq!(now.step, step as u64);
        let sliding = world.bodies.iter().filter(|body| body.slides).count();
        assert_eq!(now.totals.n_slipping, sliding, "step {step}");
        for (b, body) in world.bodies.iter().enumerate() {
            let block = now.block(b);
            for axis in 0..2 {
                let [off_u, off_v] = [
                    block.displacement[axis] - body.u[axis],
                    block.velocity[axis] - body.v[axis],
                ];
                assert!(
                    off_u.abs() < 1e-8 && off_v.abs() < 1e-8,
                    "step {step}, block {b}: {off_u} {off_v}"
                );
            }
            changes += usize::from(before[b] != body.slides);
        }
        world.advance();
        simulation.step();
    }
    assert!(changes > 0, "nothing happens");
}
