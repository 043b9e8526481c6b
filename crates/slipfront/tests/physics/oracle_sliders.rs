//! The model of heterogeneous blocks, outlines and viscosity implemented again, in the fewest lines: every
//! pair of blocks is examined.

use proptest::prelude::*;
use slipfront::communicator::Alone;
use slipfront::surface::{Coefficients, Contact, Load};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Outline, Slider, State, Surface, VectorField};

use crate::common::from_state;

/// Values for every block, and for the whole slider.
#[derive(Clone, Debug)]
struct Case {
    size: [usize; 2],
    periodic: [bool; 2],
    exists: Vec<bool>,
    stiffness: Vec<f64>,
    mass: Vec<f64>,
    mu: Vec<[f64; 2]>,
    start: Vec<[f64; 4]>,
    viscosity: f64,
    damping: f64,
    epsilon: f64,
    velocity: [f64; 2],
}

const DT: f64 = 0.1;

impl Case {
    fn at(&self, b: usize) -> [f64; 2] {
        [(b % self.size[0]) as f64, (b / self.size[0]) as f64]
    }

    /// Vector from site b to site c, the shortest one for periodic edges.
    fn between(&self, b: usize, c: usize) -> [f64; 2] {
        let (b, c) = (self.at(b), self.at(c));
        [0, 1].map(|axis| {
            let (d, n) = (c[axis] - b[axis], self.size[axis] as f64);
            let wraps = self.periodic[axis] && d.abs() > 1.5;
            if wraps { d - n * d.signum() } else { d }
        })
    }

    /// Displacements after some steps.
    fn run(&self, steps: u32) -> Vec<[f64; 2]> {
        let n = self.mass.len();
        let blocks: Vec<usize> = (0..n).filter(|&b| self.exists[b]).collect();
        let (mut u, mut v): (Vec<[f64; 2]>, Vec<[f64; 2]>) =
            self.start.iter().map(|s| ([s[0], s[1]], [s[2], s[3]])).unzip();
        for step in 0..=steps {
            let mut after = v.clone();
            for &b in &blocks {
                let pull = 0.375 * self.stiffness[b];
                let time = f64::from(step) * DT;
                let mut force = [0, 1].map(|axis| pull * (self.velocity[axis] * time - u[b][axis]));
                for &c in blocks.iter().filter(|&&c| c != b) {
                    let site = self.between(b, c);
                    let d = site[0].hypot(site[1]);
                    if d > 1.5 {
                        continue;
                    }
                    let mean = 1.0 / (0.5 / self.stiffness[b] + 0.5 / self.stiffness[c]);
                    let k = mean * if d > 1.2 { 0.375 } else { 0.75 };
                    let r = [0, 1].map(|axis| site[axis] + self.epsilon * (u[c][axis] - u[b][axis]));
                    let length = r[0].hypot(r[1]);
                    let e = [r[0] / length, r[1] / length];
                    let dot = |w: [f64; 2]| e[0] * w[0] + e[1] * w[1];
                    let stretch = (length - d) / self.epsilon;
                    let rate = dot([v[c][0] - v[b][0], v[c][1] - v[b][1]]);
                    for axis in 0..2 {
                        force[axis] += k * (stretch + self.viscosity * rate) * e[axis];
                    }
                }
                let [limit, kinetic] = self.mu[b];
                if v[b] == [0.0; 2] && force[0].hypot(force[1]) <= limit {
                    continue;
                }
                let m = self.mass[b];
                let (before, behind) = (1.0 - 0.5 * self.damping * DT, 1.0 + 0.5 * self.damping * DT);
                let free = [0, 1].map(|axis| (before * v[b][axis] + DT * force[axis] / m) / behind);
                let (speed, lost) = (free[0].hypot(free[1]), DT * kinetic / (m * behind));
                after[b] = free.map(|w| {
                    if speed > lost {
                        w * (1.0 - lost / speed)
                    } else {
                        0.0
                    }
                });
            }
            v = after;
            if step < steps {
                for &b in &blocks {
                    (0..2).for_each(|axis| u[b][axis] += DT * v[b][axis]);
                }
            }
        }
        u
    }

    /// Displacements after some steps, computed by the kernels.
    fn simulate(&self, steps: u32) -> Vec<[f64; 2]> {
        let n = self.mass.len();
        let edges = self
            .periodic
            .map(|periodic| if periodic { Edges::Periodic } else { Edges::Free });
        let lattice = Lattice::with_edges(self.size[0], self.size[1], edges);
        let outline = self
            .exists
            .contains(&false)
            .then(|| Outline::new(self.exists.clone(), &Alone));
        let slider = Slider {
            viscosity_time: self.viscosity,
            ..Slider::new(
                Some(self.stiffness.clone()),
                Some(self.mass.clone()),
                outline,
                &Alone,
            )
        };
        let [mu_static, mu_kinetic] = [0, 1].map(|k| self.mu.iter().map(|mu| mu[k]).collect());
        let coefficients = Coefficients::given(mu_static, mu_kinetic);
        let contact = Contact::new(Load::Redistributed, 1.0);
        let surface = Surface::of_ranks(coefficients, vec![false; n], contact, &slider, &Alone).unwrap();
        let speed = self.velocity[0].hypot(self.velocity[1]);
        let drive = Drive {
            direction: self.velocity.map(|component| component / speed),
            ..Drive::along_x(speed)
        };
        let plain = Model::new(
            lattice,
            surface,
            drive,
            self.damping,
            self.epsilon,
            FrictionLaw::Projection,
        );
        let component = |k: usize| self.start.iter().map(|s| s[k]).collect();
        let [x, y, vx, vy] = [0, 1, 2, 3].map(component);
        let state = State {
            displacement: VectorField { x, y },
            velocity: VectorField { x: vx, y: vy },
        };
        let mut simulation = from_state(&plain.with_slider(slider), DT, state);
        (0..steps).for_each(|_| simulation.step());
        let found = simulation.state().displacement;
        (0..n).map(|b| found.at(b)).collect()
    }
}

fn case() -> impl Strategy<Value = Case> {
    let size = (1..6_usize, 1..6_usize, any::<[bool; 2]>());
    size.prop_flat_map(|(nx, ny, wraps)| {
        let n = nx * ny;
        let has_outline = any::<bool>();
        let block = (
            0.2..3.0,
            0.3..3.0,
            [0.5..2.0, 0.1..0.5],
            [-1.0..1.0, -1.0..1.0],
            prop::bool::weighted(0.8),
        );
        let blocks = prop::collection::vec(block, n);
        let all = (0.0..0.3, 0.0..2.0, 1e-3..0.05, [0.05..0.4, -0.4..0.4]);
        (blocks, all, has_outline).prop_map(
            move |(blocks, (viscosity, damping, epsilon, velocity), has_outline)| {
                let mut exists: Vec<bool> = blocks.iter().map(|block| !has_outline || block.4).collect();
                exists[0] = true;
                // Missing blocks may have any values.
                let number = |b: usize, number: f64| if exists[b] { number } else { 0.0 };
                let start = blocks.iter().zip(&exists).map(|(block, exists)| {
                    let [x, y] = if *exists { block.3 } else { [0.0; 2] };
                    [x, y, 0.0, 0.0]
                });
                Case {
                    size: [nx, ny],
                    // A periodic axis has at least three blocks; with four, the nearest image is the only
                    // neighbour.
                    periodic: [
                        wraps[0] && nx > 3 && !has_outline,
                        wraps[1] && ny > 3 && !has_outline,
                    ],
                    stiffness: blocks
                        .iter()
                        .enumerate()
                        .map(|(b, block)| number(b, block.0))
                        .collect(),
                    mass: blocks
                        .iter()
                        .enumerate()
                        .map(|(b, block)| number(b, block.1))
                        .collect(),
                    mu: blocks.iter().map(|block| block.2).collect(),
                    start: start.collect(),
                    exists,
                    viscosity,
                    damping,
                    epsilon,
                    velocity,
                }
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// The tolerance is for rounding: 1e-16 per operation, times the 1e3 lost in differences of lengths over
    /// the strain of 1e-3. It grows little in 40 steps.
    #[test]
    fn an_independent_program_agrees(case in case()) {
        let (found, expected) = (case.simulate(40), case.run(40));
        for (found, expected) in found.iter().zip(&expected) {
            for axis in 0..2 {
                prop_assert!((found[axis] - expected[axis]).abs() < 1e-9, "{:?}, expected {:?}", found, expected);
            }
        }
    }
}
