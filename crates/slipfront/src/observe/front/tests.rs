//! Tests of the slip front: its speed and its sites of nucleation, from times of slip that are known.

use super::*;
use crate::lattice::Edges;

/// Times of blocks (i, j) of a lattice.
fn times_of(lattice: &Lattice, time: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let blocks = 0..lattice.n_blocks();
    let at = |b| {
        let (i, j) = lattice.column_row(b);
        time(i as f64, j as f64)
    };
    blocks.map(at).collect()
}

fn front(lattice: &Lattice, times: &[f64]) -> Front {
    Front::find(lattice, times, lattice.n_blocks()).unwrap()
}

/// A plain generator of uniform numbers in [0, 1) (Knuth's MMIX constants).
fn uniform(state: &mut u64) -> f64 {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}

#[test]
fn quantiles_are_interpolated() {
    let of = |values: &[f64]| Quantiles::new(values.to_vec());
    assert_eq!(of(&[]), None);
    let one = of(&[3.0]).unwrap();
    assert_eq!([one.low, one.median, one.high], [3.0; 3]);
    // 5 and 95 % of 20 are integer positions, up to rounding.
    let reversed: Vec<f64> = (0..=20).rev().map(f64::from).collect();
    let many = of(&reversed).unwrap();
    for (found, exact) in [(many.low, 1.0), (many.median, 10.0), (many.high, 19.0)] {
        assert!((found - exact).abs() < 1e-12, "{found} for {exact}");
    }
    assert_eq!(of(&[8.0, 0.0, 4.0, 2.0]).unwrap().median, 3.0);
}

/// Planes fit exactly, up to rounding, at the edges too.
#[test]
fn a_straight_front_has_its_speed_everywhere() {
    for (nx, ny) in [(30, 30), (40, 4), (3, 40), (2, 15), (60, 1), (1, 60), (7, 1)] {
        for degrees in [0.0, 25.0, 90.0, 161.0] {
            let lattice = Lattice::free(nx, ny);
            let [dx, dy] = crate::vector_field::unit_vector(degrees);
            let times = times_of(&lattice, |x, y| 50.0 + (dx * x + dy * y) / 1.7);
            let front = front(&lattice, &times);
            // Nothing nucleates on a chain along the front, which slips all at once.
            let at_once = times.iter().all(|time| *time == times[0]);
            assert_eq!(front.nucleations.len(), usize::from(!at_once));
            // On a chain that the front crosses at an angle, the speed of its trace along the chain is
            // measured.
            let seen = match (nx, ny) {
                (_, 1) => 1.7 / dx.abs(),
                (1, _) => 1.7 / dy.abs(),
                _ => 1.7,
            };
            // A chain of 7 has room for a single window, which contains the nucleation.
            let Some(speed) = front.speed.filter(|_| seen < 1e3) else {
                assert!(seen >= 1e3 || nx == 7, "{nx} x {ny} at {degrees}");
                continue;
            };
            for found in [speed.low, speed.median, speed.high] {
                assert!(
                    (found / seen - 1.0).abs() < 1e-9,
                    "{nx} x {ny} at {degrees}: {found}"
                );
            }
        }
    }
}

/// A circle is curved within a window: at the distance R the mean slope is reduced by the mean square of the
/// distance across the front, 4, over 2 R^2. Half of the windows lie beyond R = 20, where this is 0.5 %.
#[test]
fn a_round_front_has_its_speed() {
    let lattice = Lattice::free(61, 61);
    let times = times_of(&lattice, |x, y| {
        ((x - 30.0) * (x - 30.0) + (y - 30.0) * (y - 30.0)).sqrt() / 0.6
    });
    let front = front(&lattice, &times);
    assert_eq!(front.nucleations, [lattice.block(30, 30)]);
    let speed = front.speed.unwrap();
    assert!(
        (0.0..0.005).contains(&(speed.median / 0.6 - 1.0)),
        "{}",
        speed.median / 0.6
    );
    assert!(speed.low >= 0.6 && speed.high < 1.2 * 0.6, "{speed:?}");
}

/// Noise as large as the time between neighbours: differences of neighbours are far off, planes are not. The
/// slope of a plane over 49 blocks has a standard error of (1/sqrt(12))/sqrt(49 * 4) = 2 % of 1/c per
/// component; across the front it adds (2 %)^2/2 to the mean, and the error of the median over windows is ten
/// times smaller than that of one window.
#[test]
fn noise_does_not_hide_the_speed() {
    let lattice = Lattice::free(60, 60);
    let mut state = 1;
    let noise: Vec<f64> = (0..lattice.n_blocks()).map(|_| uniform(&mut state)).collect();
    let planned = times_of(&lattice, |x, _| x);
    let times: Vec<f64> = planned
        .iter()
        .zip(&noise)
        .map(|(time, more)| time + more)
        .collect();
    let found = front(&lattice, &times).speed.unwrap();
    assert!((found.median - 1.0).abs() < 0.01, "{found:?}");
    assert!(
        (found.low - 1.0).abs() < 0.06 && (found.high - 1.0).abs() < 0.06,
        "{found:?}"
    );

    let difference = |b: usize| {
        let [gx, gy] = [b + 1, b + 60].map(|other| times[other] - times[b]);
        1.0 / (gx * gx + gy * gy).sqrt()
    };
    let inner = (0..lattice.n_blocks() - 60).filter(|b| b % 60 < 59);
    let of_neighbours = Quantiles::new(inner.map(difference).collect()).unwrap();
    assert!((of_neighbours.median - 1.0).abs() > 0.05, "{of_neighbours:?}");
    assert!(of_neighbours.high > 2.0, "{of_neighbours:?}");
}

#[test]
fn two_fronts_begin_at_two_sites() {
    let lattice = Lattice::free(50, 40);
    let from = |x: f64, y: f64, i: f64, j: f64| ((x - i) * (x - i) + (y - j) * (y - j)).sqrt();
    let mut times = times_of(&lattice, |x, y| {
        from(x, y, 10.0, 12.0).min(4.0 + from(x, y, 38.0, 30.0))
    });
    let sites = [lattice.block(10, 12), lattice.block(38, 30)];
    assert_eq!(front(&lattice, &times).nucleations, sites);
    // Blocks that slip alone and early are no sites, here one of them before all other blocks.
    times[lattice.block(14, 12)] = 1.0;
    times[lattice.block(45, 3)] = -1.0;
    assert_eq!(front(&lattice, &times).nucleations, sites);
}

/// On a chain a cluster grows by one block after the other: the younger cluster has reached 9 blocks when
/// both meet, or 8.
#[test]
fn a_site_has_nine_blocks_or_one_in_a_hundred() {
    let sites = |n: usize, second: usize, blocks: f64| {
        let lattice = Lattice::free(n, 1);
        // From the first block on to the right, and from `second` on to the left, over `blocks` blocks; then
        // the remaining blocks.
        let times = times_of(&lattice, |x, _| {
            let back = second as f64 - x;
            if (0.0..blocks).contains(&back) {
                0.5 + 0.001 * back
            } else {
                x
            }
        });
        front(&lattice, &times).nucleations
    };
    assert_eq!(sites(100, 50, 9.0), [0, 50]);
    assert_eq!(sites(100, 50, 8.0), [0, 50][..1]);
    // One in a hundred of 2000 is 20. The clusters meet in the blocks next to the younger one, which absorbs
    // none of them before.
    assert_eq!(sites(2000, 1000, 20.0), [0, 1000]);
    assert_eq!(sites(2000, 1000, 19.0), [0]);
}

#[test]
fn what_slips_at_once_has_no_site_and_no_speed() {
    for (nx, ny) in [(20, 20), (1, 1), (2, 2), (30, 1)] {
        let lattice = Lattice::free(nx, ny);
        // A time that is not a sum of few powers of two.
        let front = front(&lattice, &vec![0.1; nx * ny]);
        let has_windows = nx >= 20;
        let expected = Front {
            nucleations: Vec::new(),
            speed: None,
            share: has_windows.then_some(0.0),
            duration: 0.0,
        };
        assert_eq!(front, expected);
    }
    assert_eq!(Front::find(&Lattice::free(3, 3), &[f64::NAN; 9], 9), None);

    // A column that slips at once becomes a site when the next one follows.
    let lattice = Lattice::free(20, 20);
    let times = times_of(&lattice, |x, _| x.max(4.0));
    assert_eq!(front(&lattice, &times).nucleations, [0]);
}

/// Mean of the values of `size` x `size` blocks around each block, with periodic edges.
fn smoothed(values: &[f64], n: usize, size: usize) -> Vec<f64> {
    let mean = |b: usize| {
        let (i, j) = (b % n, b / n);
        let blocks = (0..size * size).map(|k| values[(j + k / size) % n * n + (i + k % size) % n]);
        blocks.sum::<f64>() / (size * size) as f64
    };
    (0..values.len()).map(mean).collect()
}

/// White noise, and noise correlated over 3, 5 and 7 blocks, as many as a window has. Planes explain half of
/// it by chance, more often the longer the correlation, but in less than half as many windows as a speed
/// requires.
#[test]
fn no_front_passes_through_noise() {
    let n = 60;
    let lattice = Lattice::free(n, n);
    let mut state = 5;
    for size in [1, 3, 5, 7] {
        for _ in 0..20 {
            let noise: Vec<f64> = (0..n * n).map(|_| uniform(&mut state)).collect();
            let found = front(&lattice, &smoothed(&noise, n, size));
            let share = found.share.unwrap();
            assert!(
                share < 0.5 * LEAST_SHARE && found.speed.is_none(),
                "{share} of {size} blocks"
            );
        }
    }
}

/// Where fronts meet, a plane through both is too level. With those windows the median of two fronts would be
/// right, but the fastest 5 % more than twice too fast. A circle of radius R is curved by 4/(2 R^2): 1 %
/// half-way to where fronts meet.
#[test]
fn windows_in_which_fronts_meet_are_left_out() {
    let speed = 1.633;
    for sites in [
        &[(12.0, 20.0), (45.0, 41.0)][..],
        &[(5.0, 30.0), (55.0, 30.0)],
        &[(10.0, 10.0), (49.0, 12.0), (12.0, 47.0), (45.0, 45.0)],
    ] {
        let lattice = Lattice::free(60, 60);
        let from =
            |x: f64, y: f64, (i, j): &(f64, f64)| ((x - i) * (x - i) + (y - j) * (y - j)).sqrt() / speed;
        let times = times_of(&lattice, |x, y| {
            sites
                .iter()
                .map(|site| from(x, y, site))
                .fold(f64::INFINITY, f64::min)
        });
        let found = front(&lattice, &times);
        assert_eq!(found.nucleations.len(), sites.len());
        let of = found.speed.unwrap();
        assert!(
            (of.median / speed - 1.0).abs() < 0.02 && of.high < 1.3 * speed,
            "{of:?}"
        );
    }
}

#[test]
fn cavities_are_left_out_and_part_the_slider() {
    let lattice = Lattice::free(40, 40);
    let mut times = times_of(&lattice, |x, y| (x + 0.5 * y) / 0.8);
    let exact = 0.8 / 1.25_f64.sqrt();
    // A round cavity, and a mask of scattered holes.
    for (b, time) in times.iter_mut().enumerate() {
        let (i, j) = lattice.column_row(b);
        if i.abs_diff(25).pow(2) + j.abs_diff(20).pow(2) < 30 || (i * 7 + j * 5) % 11 == 0 {
            *time = f64::NAN;
        }
    }
    let in_contact = times.iter().filter(|time| !time.is_nan()).count();
    let front = Front::find(&lattice, &times, in_contact).unwrap();
    let speed = front.speed.unwrap();
    assert!((speed.low / exact - 1.0).abs() < 1e-9 && (speed.high / exact - 1.0).abs() < 1e-9);
    assert_eq!(front.nucleations.len(), 1);

    // A groove divides the slider: slip nucleates on either side.
    let mut times = times_of(&lattice, |x, y| x + 0.01 * y);
    for j in 0..40 {
        times[lattice.block(20, j)] = f64::NAN;
    }
    let front = Front::find(&lattice, &times, 39 * 40).unwrap();
    assert_eq!(front.nucleations, [0, 21]);
}

/// Too few blocks around each block for a plane: rows of contact, one block wide, between grooves.
#[test]
fn strips_between_grooves_have_no_planes() {
    let lattice = Lattice::free(40, 40);
    let times = times_of(&lattice, |x, y| if y % 3.0 == 0.0 { x } else { f64::NAN });
    let front = Front::find(&lattice, &times, 14 * 40).unwrap();
    assert_eq!((front.nucleations.len(), front.speed), (14, None));
}

/// A front that runs round both periodic axes gives the same result wherever it begins.
#[test]
fn periodic_edges_are_no_edges() {
    for n in [4, 5, 24] {
        let lattice = Lattice::with_edges(24, n, [Edges::Periodic; 2]);
        let round = |x: f64, from: f64, count: f64| {
            let distance = (x - from).abs();
            distance.min(count - distance)
        };
        let from = |i: usize, j: usize| {
            let times = times_of(&lattice, |x, y| {
                let (dx, dy) = (round(x, i as f64, 24.0), round(y, j as f64, n as f64));
                (dx * dx + dy * dy).sqrt()
            });
            front(&lattice, &times)
        };
        let inside = from(12, n / 2);
        assert!(inside.speed.is_some());
        for (i, j) in [(0, 0), (23, 1), (5, n - 1)] {
            let other = from(i, j);
            assert_eq!(other.nucleations, [lattice.block(i, j)]);
            let [one, other] = [&inside, &other].map(|front| front.speed.unwrap());
            // Sums are in another order.
            assert!((one.median - other.median).abs() < 1e-12 && (one.high - other.high).abs() < 1e-12);
        }
    }
}

/// Sites agree with those of clusters that are coloured anew at every meeting, over random times with ties
/// and holes.
#[test]
fn sites_are_those_of_a_plain_search() {
    let mut state = 7;
    let mut several = 0;
    for round in 0..300 {
        let (nx, ny) = (1 + round % 7, 1 + round / 7 % 13);
        let lattice = Lattice::free(nx, ny);
        let mut time = || match uniform(&mut state) {
            share if share < 0.15 => f64::NAN,
            share => (share * 12.0).floor(),
        };
        let times: Vec<f64> = (0..nx * ny).map(|_| time()).collect();
        for least in 1..5 {
            let sites = plain_search(&lattice, &times, least);
            several += usize::from(sites.len() > 1);
            assert_eq!(
                nucleations(&lattice, &times, least),
                sites,
                "{nx} x {ny}, {least}"
            );
        }
    }
    assert!(several > 300);
}

fn plain_search(lattice: &Lattice, times: &[f64], least: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (0..times.len()).filter(|&b| !times[b].is_nan()).collect();
    order.sort_by(|&one, &other| times[one].total_cmp(&times[other]));
    let place = |b: usize| order.iter().position(|&other| other == b).unwrap();
    // The name of every cluster is the position of its first block in that order.
    let is_site = |cluster: &[usize], name: usize| {
        let blocks: Vec<usize> = (0..cluster.len())
            .filter(|&other| cluster[other] == name)
            .collect();
        blocks.len() >= least && blocks.iter().any(|&other| times[other] > times[order[name]])
    };
    let mut cluster = vec![usize::MAX; times.len()];
    let mut sites = Vec::new();
    for &b in &order {
        let (i, j) = lattice.column_row(b);
        let mut met = Vec::new();
        for (other, &name) in cluster.iter().enumerate() {
            let (x, y) = lattice.column_row(other);
            if x.abs_diff(i) <= 1 && y.abs_diff(j) <= 1 && name != usize::MAX {
                met.push(name);
            }
        }
        met.sort_unstable();
        met.dedup();
        let mut reached = met.iter().copied().filter(|&name| is_site(&cluster, name));
        let oldest = reached
            .next()
            .or(met.first().copied())
            .unwrap_or_else(|| place(b));
        sites.extend(reached);
        for other in cluster.iter_mut().filter(|other| met.contains(other)) {
            *other = oldest;
        }
        cluster[b] = oldest;
    }
    for place in 0..order.len() {
        if is_site(&cluster, place) {
            sites.push(place);
        }
    }
    sites.sort_unstable();
    sites.into_iter().map(|place| order[place]).collect()
}

/// On a line of contacts slip runs as on a chain, along either axis.
#[test]
fn a_line_of_contacts_has_the_speed_of_a_chain() {
    let (lattice, chain) = (Lattice::free(40, 30), Lattice::free(30, 1));
    let time = |place: f64| 3.0 + (place - 12.0).abs() / 0.8;
    let of_chain = front(&chain, &times_of(&chain, |x, _| time(x)));
    let speed = of_chain.speed.unwrap();
    assert!((speed.median - 0.8).abs() < 1e-12);
    let along_x = times_of(
        &lattice,
        |x, y| if y == 7.0 && x < 30.0 { time(x) } else { f64::NAN },
    );
    let along_y = times_of(&lattice, |x, y| if x == 39.0 { time(y) } else { f64::NAN });
    for times in [along_x, along_y] {
        let of_line = Front::find(&lattice, &times, 30).unwrap();
        assert_eq!((of_line.speed, of_line.share), (of_chain.speed, of_chain.share));
        assert_eq!(
            (of_line.nucleations.len(), of_line.duration),
            (1, of_chain.duration)
        );
    }
}
