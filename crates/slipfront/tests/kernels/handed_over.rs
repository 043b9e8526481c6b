//! The columns of a checkpoint, which are passed in parts.

use std::convert::Infallible;

use slipfront::checkpoint::BlockColumn;
use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::{
    AfterBreak, ContactSprings, Drive, Edges, Execution, Friction, FrictionLaw, Kernel, Lattice, Model,
    Simulation, Surface, scales,
};
use test_case::test_matrix;

use crate::bits;

/// The bits of all columns.
fn columns(simulation: &Simulation) -> Vec<Vec<u64>> {
    crate::columns(simulation)
        .iter()
        .map(|column| bits(column))
        .collect()
}

/// Blocks that slip one after the other.
fn model(lattice: Lattice) -> Model {
    let n = lattice.n_blocks();
    let [mu_static, mu_kinetic] = [1.0, 0.5].map(|mean| Distribution { mean, deviation: 0.3 });
    let drawn = Coefficients::draw(n, mu_static, mu_kinetic, 7);
    let surface = Surface::new(drawn, vec![false; n], Load::Redistributed, 1.0).unwrap();
    let (drive, law) = (Drive::at_angle(0.5, 25.0), FrictionLaw::Projection);
    Model::new(lattice, surface, drive, scales::damping(0.1), 1e-6, law)
}

/// More blocks than are passed at once, in parts that end within rows and at their ends, and within bands.
#[test_matrix(
    [(300, 300, Edges::Free), (1, 70_000, Edges::Free), (70_001, 3, Edges::Periodic)],
    [
        (Kernel::Fused, 1, false), (Kernel::Fused, 3, false), (Kernel::General, 1, false),
        (Kernel::General, 1, true)
    ]
)]
fn columns_of_many_blocks_are_handed_over(
    (nx, ny, edges): (usize, usize, Edges),
    (kernel, threads, has_springs): (Kernel, usize, bool),
) {
    let execution = Execution {
        kernel,
        threads,
        ..Execution::default()
    };
    let mut model = model(Lattice::with_edges(nx, ny, [edges; 2]));
    if has_springs {
        model.friction = Friction::ContactSprings(ContactSprings {
            stiffness: 0.3,
            after_break: AfterBreak::FormsAgain { redraw: None },
        });
    }
    let mut plain = Simulation::new(model.clone(), 0.1, None, execution.clone());
    let mut slips = 0;
    while slips < 100 {
        plain.step();
        slips += plain.snapshot().totals.n_slipping;
    }
    let saved = columns(&plain);
    let read = |column: usize, first: usize, values: &mut [f64]| {
        for (value, bits) in values.iter_mut().zip(&saved[column][first..]) {
            *value = f64::from_bits(*bits);
        }
        Ok::<(), Infallible>(())
    };
    let Ok(resumed) = Simulation::resume(model, 0.1, &plain.checkpoint(), execution, read);
    let mut resumed = resumed.unwrap();
    assert!(columns(&resumed) == saved, "before the next step");
    for _ in 0..3 {
        plain.step();
        resumed.step();
        assert!(
            columns(&resumed) == columns(&plain),
            "step {}",
            plain.checkpoint().step
        );
        assert_eq!(resumed.checkpoint(), plain.checkpoint());
    }
}

#[test]
fn an_error_of_the_reader_ends_it_at_once() {
    let model = model(Lattice::free(6, 5));
    for kernel in [Kernel::Fused, Kernel::General] {
        let execution = Execution {
            kernel,
            ..Execution::default()
        };
        let simulation = Simulation::new(model.clone(), 0.1, None, execution.clone());
        let mut calls = 0;
        let resumed = Simulation::resume(
            model.clone(),
            0.1,
            &simulation.checkpoint(),
            execution,
            |column, _, _| {
                calls += 1;
                if BlockColumn::ALL[column] == BlockColumn::VelocityX {
                    return Err("the disk fails");
                }
                Ok(())
            },
        );
        assert_eq!((resumed.err(), calls), (Some("the disk fails"), 3));
    }
}
