//! Curves and fields that look like those of runs.

use slipfront_plot::{
    CellMeans, DrawnLattice, FrictionCurve, FrontMap, Instant, KineticLine, SnapshotMap, SnapshotMaps,
    SpaceTime,
};

/// A smooth curve through points, as rows of t*, mu*, N*.
fn through(points: &[(f64, f64)]) -> Vec<[f64; 3]> {
    const STEPS: usize = 100;
    let between = |pair: &[(f64, f64)]| {
        let [(start, from), (end, to)] = [pair[0], pair[1]];
        let row = |step: usize| {
            let share = step as f64 / STEPS as f64;
            let risen = 0.5 - 0.5 * (std::f64::consts::PI * share).cos();
            let sliding = if to < from { 90.0 * (1.0 - share) } else { 5.0 };
            [start + share * (end - start), from + risen * (to - from), sliding]
        };
        (0..STEPS).map(row).collect::<Vec<_>>()
    };
    points.windows(2).flat_map(between).collect()
}

/// A run through these points, with the highest of its rows as the peak, and with first slip, instants and
/// the kinetic window from there on.
pub(crate) fn run(
    points: &[(f64, f64)],
    first_slip: f64,
    instants: &[(char, f64)],
    from: f64,
) -> FrictionCurve {
    let rows = through(points);
    let column = |k: usize| rows.iter().map(|row| row[k]).collect::<Vec<f64>>();
    let (x, friction) = (column(0), column(1));
    let at = |time: f64| {
        let index = x.partition_point(|other| *other < time).min(x.len() - 1);
        (x[index], friction[index])
    };
    let peak = x.iter().copied().zip(friction.iter().copied());
    let peak = peak.take_while(|(time, _)| *time < from);
    let peak = peak.fold(
        (0.0, f64::MIN),
        |best, point| if point.1 > best.1 { point } else { best },
    );
    let window = x.iter().zip(&friction).filter(|(time, _)| **time >= from);
    let (sum, count) = window.fold((0.0, 0.0), |(sum, count), (_, mu)| (sum + mu, count + 1.0));
    let instant = |&(letter, time): &(char, f64)| {
        let (x, friction) = if letter == 'C' { peak } else { at(time) };
        Instant { letter, x, friction }
    };
    FrictionCurve {
        label: "run".to_owned(),
        first_slip: Some(first_slip),
        peak: Some(peak),
        kinetic: Some(KineticLine {
            from,
            to: x[x.len() - 1],
            mean: sum / count,
            uncertainty: None,
        }),
        instants: instants.iter().map(instant).collect(),
        sliding_percent: column(2),
        x,
        friction,
        ..FrictionCurve::default()
    }
}

/// The baseline: a ramp, a peak, a fall, sliding.
pub(crate) fn baseline() -> FrictionCurve {
    let mut points = vec![
        (0.0, 0.0),
        (79.0, 0.876),
        (89.0, 0.227),
        (130.0, 0.61),
        (150.0, 0.47),
    ];
    points.extend((0..12).map(|k| (158.0 + 9.0 * f64::from(k), 0.533 + 0.012 * f64::from(k % 3 - 1))));
    let instants = [
        ('A', 17.0),
        ('B', 73.0),
        ('C', 79.0),
        ('D', 84.0),
        ('E', 89.0),
        ('F', 214.0),
    ];
    run(&points, 73.0, &instants, 163.0)
}

/// One block: stick and slip.
pub(crate) fn single_block(period: f64) -> FrictionCurve {
    let teeth = (0..6).flat_map(|k| {
        let start = period * f64::from(k);
        [(start, 0.0), (start + 0.944 * period, 1.0)]
    });
    let teeth: Vec<_> = teeth.collect();
    let (first, end) = (0.944 * period, period);
    let instants = [
        ('A', 0.18 * period),
        ('B', first),
        ('C', first),
        ('D', first),
        ('E', end),
        ('F', 4.1 * period),
    ];
    run(&teeth, first, &instants, 1.8 * period)
}

/// A fast drive, V* = 0.5.
pub(crate) fn fast() -> FrictionCurve {
    let points = [(0.0, 0.0), (6.2, 1.076), (11.2, 0.117), (16.0, 0.863)];
    let instants = [
        ('A', 1.0),
        ('B', 4.5),
        ('C', 6.2),
        ('D', 6.2),
        ('E', 11.1),
        ('F', 13.6),
    ];
    run(&points, 4.5, &instants, 11.2)
}

/// The curve of another drive speed, slower or faster than the baseline.
pub(crate) fn at_speed(label: &str, speed: f64) -> FrictionCurve {
    let mut curve = baseline();
    for mu in &mut curve.friction {
        *mu *= 0.7 + speed;
    }
    let peak = curve.peak.map(|(x, mu)| (x, mu * (0.7 + speed)));
    FrictionCurve {
        label: label.to_owned(),
        peak,
        ..curve
    }
}

/// Numbers that look random.
fn scatter(index: usize) -> f64 {
    (index * index * 7919 % 1009) as f64 / 1009.0
}

/// Function that returns whether a block of a lattice is textured.
pub(crate) type Texture = fn(usize, usize) -> bool;

/// A lattice without texture.
pub(crate) const SMOOTH: Texture = |_, _| false;
/// Dimples of 8 blocks, every 10.
pub(crate) const DIMPLES: Texture = |i, j| (i % 10).abs_diff(5).pow(2) + (j % 10).abs_diff(5).pow(2) < 16;
/// Dimples of 20 blocks, every 50.
pub(crate) const LARGE_DIMPLES: Texture =
    |i, j| (i % 50).abs_diff(25).pow(2) + (j % 50).abs_diff(25).pow(2) < 100;
/// Herringbones.
pub(crate) const HERRINGBONE: Texture = |i, j| (j + (i % 26).abs_diff(13)) % 12 < 3;
/// A circle in a lattice of 50 x 50 blocks.
pub(crate) const CIRCLE: Texture = |i, j| i.abs_diff(25).pow(2) + j.abs_diff(25).pow(2) < 81;

/// Means over the cells of a lattice, row by row.
fn means(nx: usize, ny: usize, value: impl Fn(usize, usize) -> f32) -> Vec<f32> {
    let mut means = CellMeans::new(nx, ny);
    for j in 0..ny {
        means.add((0..nx).map(|i| value(i, j)));
    }
    means.finish()
}

fn lattice(nx: usize, ny: usize, block_size: f64, texture: Texture) -> DrawnLattice {
    let shares = means(nx, ny, |i, j| if texture(i, j) { 1.0 } else { 0.0 });
    DrawnLattice {
        nx,
        ny,
        block_size,
        textured: shares.into_iter().map(|share| share > 0.5).collect(),
    }
}

/// Maps of the contact stress at these instants.
pub(crate) fn stress_maps(
    nx: usize,
    ny: usize,
    block_size: f64,
    texture: Texture,
    labels: &[&str],
) -> SnapshotMaps {
    let map = |(index, label): (usize, &&str)| {
        let level = [0.19, 0.82, 0.75, 0.5, 0.25, 0.5][index % 6];
        let value = |i: usize, j: usize| {
            if texture(i, j) {
                0.0
            } else {
                (level + 0.1 * index as f64 * (scatter(i + nx * j) - 0.5)) as f32
            }
        };
        SnapshotMap {
            label: (*label).to_owned(),
            time_star: 16.7 + 40.0 * index as f64,
            mu_star: 0.188,
            values: means(nx, ny, value),
        }
    };
    SnapshotMaps {
        lattice: lattice(nx, ny, block_size, texture),
        maps: labels.iter().enumerate().map(map).collect(),
        value_title: "contact stress \u{3c4}_c*".to_owned(),
        range: [0.0, 1.0],
    }
}

/// First slips that spread from these blocks, and the blocks that slide meanwhile.
pub(crate) fn front_of(
    nx: usize,
    ny: usize,
    block_size: f64,
    texture: Texture,
    origins: usize,
) -> (FrontMap, SpaceTime) {
    let origin = |k: usize| [scatter(3 * k + 5) * nx as f64, scatter(7 * k + 11) * ny as f64];
    let origins: Vec<[f64; 2]> = (0..origins).map(origin).collect();
    let first_slip = |i: usize, j: usize| {
        let distance = |[x, y]: &[f64; 2]| (i as f64 - x).hypot(j as f64 - y);
        74.0 + 0.3 * origins.iter().map(distance).fold(f64::INFINITY, f64::min) + scatter(i + nx * j)
    };
    let value = |i, j| {
        if texture(i, j) {
            f32::NAN
        } else {
            first_slip(i, j) as f32
        }
    };
    let map = FrontMap {
        lattice: lattice(nx, ny, block_size, texture),
        first_slips: means(nx, ny, value),
        nucleations: origins
            .iter()
            .map(|at| at.map(|blocks| blocks * block_size))
            .collect(),
    };
    let columns = nx.min(1024);
    let share = |k: usize| {
        let (row, column) = (k / columns, k % columns);
        let arrival = first_slip(column * nx / columns, ny / 2) - 72.0;
        let late = 0.2 * row as f64 - arrival;
        if (0.0..6.0).contains(&late) {
            (1.0 - late / 12.0) as f32
        } else {
            0.0
        }
    };
    let space_time = SpaceTime {
        place: "position along drive".to_owned(),
        places: [0.0, nx as f64 * block_size],
        times: [72.0, 90.0],
        columns,
        shares: (0..90 * columns).map(share).collect(),
    };
    (map, space_time)
}
