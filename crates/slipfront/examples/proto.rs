use slipfront::surface::{Coefficients, Distribution, Load};
use slipfront::*;
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let threads: usize = std::env::args().nth(2).map_or(1, |t| t.parse().unwrap());
    let lattice = Lattice::free(n, n);
    let gauss = |mean: f64| Distribution {
        mean,
        deviation: 0.05 * mean,
    };
    let drawn = Coefficients::draw(n * n, gauss(1.0), gauss(0.5), 1);
    let surface = Surface::new(drawn, vec![false; n * n], Load::Redistributed, 1.0).unwrap();
    let model = Model::new(
        lattice,
        surface,
        Drive::along_x(0.03),
        scales::damping(0.1),
        1e-6,
        FrictionLaw::Projection,
    );
    let run = |e: Execution| Simulation::executed(&model, 0.1, None, e);
    let mut fast = run(Execution {
        skips: false,
        threads,
        ..Execution::default()
    });
    let mut skip = run(Execution::default());
    let mut slow = run(Execution {
        kernel: Kernel::Reference,
        ..Execution::default()
    });
    if n <= 200 && std::env::var("ONLY").is_err() {
        for s in 0..1500 {
            fast.step();
            slow.step();
            skip.step();
            if s % 100 == 99 {
                let (a, b, c) = (fast.state(), slow.state(), skip.state());
                let d = (0..n * n)
                    .map(|k| {
                        (a.displacement.x[k] - b.displacement.x[k])
                            .abs()
                            .max((a.velocity.y[k] - b.velocity.y[k]).abs())
                    })
                    .fold(0.0, f64::max);
                println!(
                    "{s} {d:e} {} {} same {}",
                    fast.snapshot().totals.n_sliding,
                    slow.snapshot().totals.n_sliding,
                    a == c
                );
                let (x, y) = (fast.snapshot().totals, slow.snapshot().totals);
                if s % 500 == 499 {
                    println!("{x:?}\n{y:?}");
                }
            }
        }
        println!(
            "{} {} {}",
            fast.contact_stress_max(),
            slow.contact_stress_max(),
            skip.contact_stress_max()
        );
    } else {
        for _ in 0..(if n < 300 { 1200 } else { 10 }) {
            fast.step();
        }
    }
    let (mut best, mut reference) = (f64::INFINITY, f64::INFINITY);
    let reps = (400_000 / (n * n)).max(1);
    let per = 1e9 / (reps * n * n) as f64;
    for _ in 0..if n > 2000 {
        10
    } else if n > 300 {
        60
    } else {
        600
    } {
        let t = std::time::Instant::now();
        for _ in 0..reps {
            fast.step();
        }
        best = best.min(t.elapsed().as_secs_f64() * per);
        if n < 2000 && std::env::var("ONLY").is_err() {
            let t = std::time::Instant::now();
            for _ in 0..reps {
                slow.step();
            }
            reference = reference.min(t.elapsed().as_secs_f64() * per);
        }
    }
    println!(
        "{n} reference {reference:.3} fused {best:.3} ratio {:.3}",
        reference / best
    );
}
