//! Drives computed independently, from the equations and without any code of the crate: springs at an edge, a
//! program of speeds and a rotation on small random sliders.

use std::sync::Arc;

use proptest::prelude::*;
use slipfront::communicator::Alone;
use slipfront::{Edge, Program, Rotation, Stop};

use crate::common::{Slider, at_rest};

/// Displacements after some steps, by Eqs. 2 to 8 in the order of the paper. `pull` returns the stiffness of
/// the drive spring of block (i, j) and the position of its far end after a path of the drive.
fn displacements(
    [nx, ny]: [usize; 2],
    thresholds: &[[f64; 2]],
    damping: f64,
    speeds: &[f64],
    pull: impl Fn(usize, usize, f64) -> (f64, [f64; 2]),
) -> Vec<[f64; 2]> {
    let dt = 0.1;
    let mut u = vec![[0.0; 2]; nx * ny];
    let mut v = u.clone();
    let mut path = 0.0;
    for step in 0..=speeds.len() {
        let mut new = v.clone();
        for b in 0..nx * ny {
            let (i, j) = (b % nx, b / nx);
            let (k, end) = pull(i, j, path);
            let mut force = [0, 1].map(|axis| k * (end[axis] - u[b][axis]));
            for (di, dj) in [
                (1, 0),
                (0, 1),
                (-1, 0),
                (0, -1),
                (1, 1),
                (-1, 1),
                (-1, -1),
                (1, -1),
            ] {
                let (p, q) = (i as i64 + di, j as i64 + dj);
                if p < 0 || q < 0 || p >= nx as i64 || q >= ny as i64 {
                    continue;
                }
                let other = u[q as usize * nx + p as usize];
                let length = ((di * di + dj * dj) as f64).sqrt();
                let stiffness = if length > 1.0 { 0.375 } else { 0.75 };
                let e = [di as f64 / length, dj as f64 / length];
                let stretch = e[0] * (other[0] - u[b][0]) + e[1] * (other[1] - u[b][1]);
                force = [
                    force[0] + stiffness * stretch * e[0],
                    force[1] + stiffness * stretch * e[1],
                ];
            }
            let [held, kinetic] = thresholds[b];
            let free = [0, 1].map(|axis| {
                ((1.0 - 0.5 * damping * dt) * v[b][axis] + dt * force[axis]) / (1.0 + 0.5 * damping * dt)
            });
            let speed = free[0].hypot(free[1]);
            let left = speed - dt * kinetic / (1.0 + 0.5 * damping * dt);
            let is_held = v[b] == [0.0, 0.0] && force[0].hypot(force[1]) <= held;
            new[b] = if is_held || left <= 0.0 {
                [0.0; 2]
            } else {
                free.map(|component| component * left / speed)
            };
        }
        v = new;
        if step < speeds.len() {
            path += dt * speeds[step];
            for (u, v) in u.iter_mut().zip(&v) {
                *u = [u[0] + dt * v[0], u[1] + dt * v[1]];
            }
        }
    }
    u
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Sums in another order differ by rounding. In a few hundred steps, the motion amplifies this to at most
    /// 1e-9 of displacements.
    #[test]
    fn drives_agree_with_the_equations(
        blocks in (2..7_usize, 2..7_usize),
        seed in 0..1000_u64,
        edge in prop::option::of(prop::sample::select(vec![Edge::Left, Edge::Right, Edge::Bottom, Edge::Top])),
        turns in any::<bool>(),
        degrees in 0.0..360.0,
        speeds in prop::collection::vec((-0.5..1.0, 1..100_usize), 1..5),
        k_drive in 0.1..0.6,
    ) {
        let slider = Slider {
            blocks: [blocks.0, blocks.1],
            degrees,
            seed,
            sigma_static_star: 0.2,
            epsilon: 0.0,
            ..Slider::default()
        };
        let lattice = slider.lattice();
        let mut body = slipfront::Slider::default();
        if let Some(edge) = edge {
            body.attach_edge(&lattice, &(0..lattice.ny), edge, &Alone);
        }
        let mut model = Slider { body, ..slider.clone() }.model();
        model.drive.k_drive = k_drive;
        let mut from = 0;
        let segments = speeds.iter().map(|&(speed, steps)| {
            from += steps;
            (speed, from as f64 * 0.1)
        });
        model.drive.program = Some(Arc::new(Program::new(segments)));
        if turns {
            let rotation = Rotation::about_centroid(&lattice, &model.rows, model.slider(), &Alone);
            model.drive.rotation = Some(rotation);
        }
        let thresholds: Vec<_> = (0..lattice.n_blocks())
            .map(|b| [model.surface.static_limit(b), model.surface.kinetic_force(b)])
            .collect();
        let each: Vec<f64> = speeds.iter().flat_map(|&(speed, steps)| vec![speed; steps]).collect();
        let [cx, cy] = [blocks.0 as f64 / 2.0, blocks.1 as f64 / 2.0];
        let radius = (cx - 0.5).hypot(cy - 0.5);
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        let expected = displacements([blocks.0, blocks.1], &thresholds, model.damping, &each, |i, j, path| {
            let is_driven = match edge {
                None => true,
                Some(Edge::Left) => i == 0,
                Some(Edge::Right) => i + 1 == blocks.0,
                Some(Edge::Bottom) => j == 0,
                Some(Edge::Top) => j + 1 == blocks.1,
            };
            let end = if turns {
                [
                    -path * (j as f64 + 0.5 - cy) / radius,
                    path * (i as f64 + 0.5 - cx) / radius,
                ]
            } else {
                [path * cos, path * sin]
            };
            (if is_driven { k_drive } else { 0.0 }, end)
        });
        let mut simulation = at_rest(&model, 0.1);
        simulation.run(Stop::at_step(each.len() as u64), &mut []).unwrap();
        let found = simulation.state().displacement;
        for (b, expected) in expected.iter().enumerate() {
            let [x, y] = found.at(b);
            let far = (x - expected[0]).abs().max((y - expected[1]).abs());
            prop_assert!(far < 1e-9 * (1.0 + x.abs().max(y.abs())), "block {b}: {x} {y}, {expected:?}");
        }
    }
}
