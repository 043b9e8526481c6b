//! A step allocates nothing, and observers allocate only what they keep.

#![allow(clippy::unwrap_used)] // A helper that cannot do its work fails its test.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use slipfront::observe::frames::Selection;
use slipfront::observe::{Curve, Field, Instants, KineticHistory, KineticStart, Schedule, Scheduled};
use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::{
    Body, Drive, Edges, Execution, Face, FrictionLaw, Kernel, Lattice, Model, Simulation, Stop, Surface,
};

/// The system's allocator, with a count of calls per thread.
struct Counting;

thread_local! {
    static CALLS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // A thread that ends may allocate after its counter is gone.
    let _ = CALLS.try_with(|calls| calls.set(calls.get() + 1));
}

#[allow(unsafe_code)] // A global allocator cannot be written otherwise; all work is the system's.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(block, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations(work: impl FnOnce()) -> u64 {
    let before = CALLS.with(Cell::get);
    work();
    CALLS.with(Cell::get) - before
}

/// The baseline of Fig. 3, textured by hand so that every branch of the kernel is taken.
fn model(law: FrictionLaw) -> Model {
    let lattice = Lattice::free(25, 25);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let mut textured = vec![false; 625];
    textured[300..310].fill(true);
    let drawn = Coefficients::draw(625, gauss(1.0), gauss(0.5), 1);
    let surface = Surface::new(drawn, textured, Load::Redistributed, 1.0).unwrap();
    Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        0.1 * 0.75_f64.sqrt(),
        1e-6,
        law,
    )
}

#[test]
fn the_counter_counts() {
    let calls = allocations(|| {
        std::hint::black_box(vec![1_u8; 100]);
    });
    assert_eq!(calls, 1);
}

#[test]
fn a_step_allocates_nothing() {
    for law in [
        FrictionLaw::Projection,
        FrictionLaw::Reversal,
        FrictionLaw::Literal,
    ] {
        let body = Body {
            height: 5.0,
            poisson: 0.3,
            face: Face::Pressure,
        };
        let mut periodic = model(law);
        periodic.lattice.edges = [Edges::Periodic; 2];
        for model in [model(law), periodic.with_body(body)] {
            for kernel in [Kernel::General, Kernel::Fused] {
                let execution = Execution {
                    kernel,
                    ..Execution::default()
                };
                let mut simulation = Simulation::new(model.clone(), 0.1, None, execution);
                let calls = allocations(|| (0..1000).for_each(|_| simulation.step()));
                assert_eq!(calls, 0, "{law:?} {kernel:?}");
                // 1000 steps pass the onset, which comes at t* = 82 here.
                assert!(law == FrictionLaw::Literal || simulation.peak().ended);
            }
        }
    }
}

/// Sliding counts, sums, means and maxima do not grow; the curve grows by doubling (16 times for 2670 rows
/// and more); A-F allocate once per field when first kept.
#[test]
fn watching_allocates_only_what_is_kept() {
    let model = model(FrictionLaw::Projection);
    let steps = 2670;
    let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
    let fields = vec![Field::ContactStress, Field::Traction, Field::Sliding];
    let n_fields = fields.len() as u64;
    let selection = Selection { fields, stride: 1 };
    let mut instants = Instants::new(selection, KineticStart::Auto, 267.0);
    let mut history = KineticHistory::new(steps);
    let (mut every_step, mut sparse) = (Curve::every(1), Curve::every(10));
    let mut observers = [Scheduled::always(&mut history)];
    let none = allocations(|| {
        simulation.run(Stop::at_step(steps), &mut observers).unwrap();
        assert!(simulation.contact_stress_max() > 1.0);
    });
    assert_eq!(none, 0);

    let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
    let mut observers = [
        Scheduled::always(&mut every_step),
        Scheduled::new(Schedule::Every(10), &mut sparse),
    ];
    let curves = allocations(|| {
        simulation.run(Stop::at_step(steps), &mut observers).unwrap();
    });
    assert!(curves <= 2 * 16, "{curves} allocations for two curves");

    let mut simulation = Simulation::new(model.clone(), 0.1, None, Execution::default());
    let mut observers = [Scheduled::always(&mut instants)];
    let captures = allocations(|| {
        simulation.run(Stop::at_step(steps), &mut observers).unwrap();
    });
    // Six instants, one array each for the list of fields and for every field.
    assert!(
        captures <= 6 * (1 + n_fields),
        "{captures} allocations for six instants"
    );
}
