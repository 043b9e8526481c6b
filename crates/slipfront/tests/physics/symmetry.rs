//! Quarter turns and reflections of lattice, drive, surface and texture together transform the motion in the
//! same way, to the last bit, through onset and far beyond.

use slipfront::communicator::Alone;
use slipfront::surface::{Coefficients, Contact, Load, Shape, Texture, mesh};
use slipfront::{Drive, Edges, FrictionLaw, Lattice, Model, Outline, Surface, scales};
use test_case::{test_case, test_matrix};

use crate::common::{Slider, at_rest, cavity, varied};

/// A symmetry of the square: first a reflection in the x axis, if any, then quarter turns to the left.
#[derive(Clone, Copy, Debug)]
struct Operation {
    mirror: bool,
    quarters: usize,
}

impl Operation {
    fn vector(self, [x, y]: [f64; 2]) -> [f64; 2] {
        let mut v = if self.mirror { [x, -y] } else { [x, y] };
        for _ in 0..self.quarters {
            v = [-v[1], v[0]];
        }
        v
    }

    fn blocks(self, [nx, ny]: [usize; 2]) -> [usize; 2] {
        if self.quarters % 2 == 1 {
            [ny, nx]
        } else {
            [nx, ny]
        }
    }

    fn edges(self, [x, y]: [Edges; 2]) -> [Edges; 2] {
        if self.quarters % 2 == 1 { [y, x] } else { [x, y] }
    }

    /// Position to which block (i, j) of a lattice of nx x ny blocks moves.
    fn place(self, [nx, ny]: [usize; 2], i: usize, j: usize) -> [usize; 2] {
        let (mut size, mut at) = ([nx, ny], if self.mirror { [i, ny - 1 - j] } else { [i, j] });
        for _ in 0..self.quarters {
            at = [size[1] - 1 - at[1], at[0]];
            size = [size[1], size[0]];
        }
        at
    }
}

/// A surface with scatter and an unsymmetric texture, and its image under the operation.
fn models(slider: &Slider, operation: Operation) -> [Model; 2] {
    let lattice = slider.lattice();
    let turned = {
        let [nx, ny] = operation.blocks(slider.blocks);
        Lattice::with_edges(nx, ny, operation.edges(slider.edges))
    };
    let n = lattice.n_blocks();
    let drawn = slider.coefficients();
    let textured = mesh(&lattice, &slider.textures).textured;
    let (mut mu_static, mut mu_kinetic, mut cut) = (vec![0.0; n], vec![0.0; n], vec![false; n]);
    for (b, &over) in textured.iter().enumerate() {
        let to = image(operation, slider.blocks, &turned, &lattice, b);
        (mu_static[to], mu_kinetic[to], cut[to]) = (drawn.mu_static[b], drawn.mu_kinetic[b], over);
    }
    let images: Vec<usize> = (0..n)
        .map(|b| image(operation, slider.blocks, &turned, &lattice, b))
        .collect();
    let drive = Drive::at_angle(slider.v_star, slider.degrees);
    let turned_drive = Drive {
        direction: operation.vector(drive.direction),
        ..drive.clone()
    };
    let model = |lattice, body: slipfront::Slider, coefficients, textured, drive| {
        let contact = Contact::new(Load::Redistributed, 1.0);
        let surface = Surface::of_ranks(coefficients, textured, contact, &body, &Alone).unwrap();
        let damping = scales::damping(slider.omega_star);
        Model::new(lattice, surface, drive, damping, slider.epsilon, slider.law).with_slider(body)
    };
    [
        model(lattice, slider.body.clone(), drawn, textured, drive),
        model(
            turned,
            moved(&slider.body, &images),
            Coefficients::given(mu_static, mu_kinetic),
            cut,
            turned_drive,
        ),
    ]
}

/// The slider after its blocks have moved to these places.
fn moved(body: &slipfront::Slider, to: &[usize]) -> slipfront::Slider {
    fn moved<T: Copy + Default>(values: &[T], to: &[usize]) -> Vec<T> {
        let mut moved = vec![T::default(); to.len()];
        for (value, &to) in values.iter().zip(to) {
            moved[to] = *value;
        }
        moved
    }
    let moved_field = |field: &Option<Vec<f64>>| field.as_ref().map(|values| moved(values, to));
    let outline = body.outline.as_ref();
    let outline = outline.map(|outline| Outline::new(moved(&outline.exists, to), &Alone));
    slipfront::Slider {
        viscosity_time: body.viscosity_time,
        ..slipfront::Slider::new(
            moved_field(&body.stiffness),
            moved_field(&body.density),
            outline,
            &Alone,
        )
    }
}

fn image(operation: Operation, blocks: [usize; 2], turned: &Lattice, lattice: &Lattice, b: usize) -> usize {
    let (i, j) = lattice.column_row(b);
    let [i, j] = operation.place(blocks, i, j);
    turned.block(i, j)
}

fn assert_turns_exactly(slider: &Slider, operation: Operation, steps: usize) {
    let [model, turned] = models(slider, operation);
    let mut one = at_rest(&model, slider.dt_star);
    let mut other = at_rest(&turned, slider.dt_star);
    for step in 0..steps {
        one.step();
        other.step();
        if step % 50 != 0 && step + 1 != steps {
            continue;
        }
        let (here, there) = (one.snapshot(), other.snapshot());
        for b in 0..model.lattice.n_blocks() {
            let to = image(operation, slider.blocks, &turned.lattice, &model.lattice, b);
            let turn = |v| operation.vector(v);
            let (here, there) = (here.block(b), there.block(to));
            assert_eq!(
                turn(here.displacement),
                there.displacement,
                "step {step}, block {b}"
            );
            assert_eq!(turn(here.force_friction), there.force_friction);
            assert_eq!(turn(here.velocity), there.velocity);
            assert_eq!(here.slides, there.slides);
        }
        // Means are summed in another order.
        assert!((here.point.mu_star - there.point.mu_star).abs() < 1e-13);
        assert_eq!(here.point.n_sliding, there.point.n_sliding);
        let handed = if operation.mirror { -1.0 } else { 1.0 };
        assert!((handed * here.point.mu_lateral_star - there.point.mu_lateral_star).abs() < 1e-13);
    }
    assert!(one.peak().ended, "the comparison reaches beyond the transition");
    assert_eq!(one.peak().step, other.peak().step);
}

/// An off-centre elongated cavity, so that nothing is symmetric by itself.
fn off_centre(blocks: [usize; 2]) -> Texture {
    let Shape::Cavity(mut found) = cavity(blocks, 8.0, 1, 0.4, false).shape else {
        unreachable!("a cavity is a cavity")
    };
    found.center = [0.3 * blocks[0] as f64, 0.6 * blocks[1] as f64];
    found.rotate = 20.0;
    Shape::Cavity(found).into()
}

#[test_matrix(
    [(false, 1), (false, 2), (false, 3), (true, 0), (true, 1), (true, 2), (true, 3)],
    [[12, 12], [8, 13]],
    [[Edges::Free, Edges::Free], [Edges::Periodic, Edges::Free], [Edges::Periodic, Edges::Periodic]],
    [0.0, 30.0]
)]
fn every_symmetry_of_the_square_is_exact(
    (mirror, quarters): (bool, usize),
    blocks: [usize; 2],
    edges: [Edges; 2],
    degrees: f64,
) {
    let slider = Slider {
        blocks,
        edges,
        degrees,
        textures: vec![off_centre(blocks)],
        ..Slider::default()
    };
    assert_turns_exactly(
        &slider,
        Operation { mirror, quarters },
        slider.steps(5.0) as usize,
    );
}

/// Symmetry holds for heterogeneous sliders with missing blocks and with dampers in parallel with their
/// springs.
#[test_matrix([(false, 1), (false, 2), (true, 0), (true, 1)], [0.0, 0.3], [true, false])]
fn sliders_of_unequal_blocks_too((mirror, quarters): (bool, usize), viscosity_time: f64, has_outline: bool) {
    let blocks = [8, 13];
    let edges = if has_outline {
        [Edges::Free; 2]
    } else {
        [Edges::Periodic, Edges::Free]
    };
    let slider = Slider {
        blocks,
        edges,
        degrees: 30.0,
        textures: vec![off_centre(blocks)],
        body: slipfront::Slider {
            viscosity_time,
            ..varied(104, has_outline)
        },
        ..Slider::default()
    };
    assert_turns_exactly(
        &slider,
        Operation { mirror, quarters },
        slider.steps(5.0) as usize,
    );
}

#[test_case(Slider { law: FrictionLaw::Reversal, ..Slider::default() }; "reversal")]
#[test_case(Slider { law: FrictionLaw::Literal, r_star: 0.9, omega_star: 0.3, ..Slider::default() }; "literal")]
#[test_case(Slider { epsilon: 0.05, ..Slider::default() }; "strained")]
#[test_case(Slider { epsilon: 0.0, ..Slider::default() }; "linear")]
#[test_case(Slider { blocks: [30, 1], textures: vec![], ..Slider::default() }; "chain")]
#[test_case(Slider { blocks: [2, 2], textures: vec![], ..Slider::default() }; "two by two")]
fn other_laws_strains_and_shapes_too(slider: Slider) {
    let slider = Slider {
        degrees: 15.0,
        ..slider
    };
    for quarters in 0..4 {
        for mirror in [false, true] {
            let operation = Operation { mirror, quarters };
            let [model, turned] = models(&slider, operation);
            let (mut one, mut other) = (at_rest(&model, slider.dt_star), at_rest(&turned, slider.dt_star));
            for _ in 0..1200 {
                one.step();
                other.step();
            }
            let (one, other) = (one.state().displacement, other.state().displacement);
            for b in 0..model.lattice.n_blocks() {
                let to = image(operation, slider.blocks, &turned.lattice, &model.lattice, b);
                assert_eq!(
                    operation.vector(one.at(b)),
                    other.at(to),
                    "{operation:?}, block {b}"
                );
            }
        }
    }
}

/// A shift along a periodic axis shifts the motion, to the last bit.
#[test]
fn shifts_along_periodic_axes_are_exact() {
    let slider = Slider {
        blocks: [12, 9],
        edges: [Edges::Periodic; 2],
        ..Slider::default()
    };
    let model = slider.model();
    let shifted_from = |b: usize| {
        let (i, j) = model.lattice.column_row(b);
        model.lattice.block((i + 5) % 12, (j + 2) % 9)
    };
    let mut shifted = model.clone();
    for b in 0..108 {
        shifted.surface.mu_static[shifted_from(b)] = model.surface.mu_static[b];
        shifted.surface.mu_kinetic[shifted_from(b)] = model.surface.mu_kinetic[b];
    }
    let (mut one, mut other) = (at_rest(&model, 0.1), at_rest(&shifted, 0.1));
    for _ in 0..2000 {
        one.step();
        other.step();
    }
    assert!(one.peak().ended);
    for b in 0..108 {
        assert_eq!(
            one.state().displacement.at(b),
            other.state().displacement.at(shifted_from(b))
        );
    }
}

/// On a symmetric surface the motion has the surface's symmetry: mirrored blocks move as mirrors.
#[test]
fn a_symmetric_surface_moves_symmetrically() {
    let slider = Slider {
        blocks: [20, 20],
        textures: vec![cavity([20, 20], 10.0, 1, 0.0, false)],
        ..Slider::default().uniform()
    };
    let model = slider.model();
    let mut simulation = at_rest(&model, 0.1);
    for _ in 0..slider.steps(5.0) {
        simulation.step();
    }
    let u = simulation.state().displacement;
    for b in 0..400 {
        let (i, j) = (b % 20, b / 20);
        let up = (19 - j) * 20 + i;
        assert_eq!((u.x[b], u.y[b]), (u.x[up], -u.y[up]), "block ({i}, {j})");
        let ([x, y], [other_x, other_y]) = (u.at(b), u.at(up));
        assert!(x.is_finite() && y.is_finite() && other_x.is_finite() && other_y.is_finite());
    }
    assert!(simulation.snapshot().point.mu_lateral_star.abs() < 1e-14);
    assert!(simulation.snapshot().totals.n_sliding > 0);
}
