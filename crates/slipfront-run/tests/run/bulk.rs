//! Dimples in a bulk body, against solvers that know neither sheets nor steps.

use slipfront_case::case::Case;
use slipfront_run::run_summary::run_summary;

/// A square array of dimples half a pitch wide, R* = 0.5, in a deep body of nu = 1/4 whose load is shared by
/// all blocks in contact: `w p (1 - nu)/G` with `w = (mu_s - mu_k) p_c/D_c` and the pressure `p_c` of these
/// blocks, and the reductions of static friction in % by a quasi-static spectral solver of the half-space. A
/// lattice of springs in three dimensions with inertia found 6.33 for the second and 25.64 for the fourth.
const REDUCTIONS: [(f64, f64); 5] = [(1.0, 3.05), (2.0, 6.48), (5.0, 15.2), (10.0, 25.5), (20.0, 34.1)];

/// Reduction of static friction in %, where blocks in contact carry the load of textured ones within so far.
fn reduction(weakening: f64, within: &str) -> f64 {
    let (pitch, drop) = (160e-6, 0.3);
    let modulus = 2.6e6 / (2.0 * 1.25 * 0.75);
    // As meshed, a dimple has 52 of the 256 blocks of a pitch.
    let of_contact = 256.0 / 204.0;
    let length = drop * of_contact * pitch / (weakening * modulus);
    let text = format!(
        "slider = {{ blocks = [32, 32], block_size = '10 um', young_modulus = '2.6 MPa', density = '1 g/cm^3', edges = 'periodic',\n\
         body = 'bulk', poisson = 0.25, omega_star = 0.1 }}\nload = {{ pressure = '1 Pa', redistribute = {{ within = '{within}' }} }}\n\
         drive.v_star = 0.002\ntime.stop = 'after_onset'\nfriction = {{ mu_static = 0.6, r_star = 0.5, sigma_static_star = 0, \
         sigma_kinetic_star = 0, slip_weakening.length = '{length:e} m' }}\ntexture = [{{ shape = 'cavity', lambda = '40 um', array = [2, 2], \
         pitch = '160 um' }}]"
    );
    let case = Case::parse(&text, "body", "", &[]).unwrap();
    assert_eq!(case.model.surface.n_contact(), 4 * 204);
    let summary = run_summary(&case).unwrap();
    100.0 * (1.0 - summary.static_friction_star)
}

/// Two sheets find the reductions of the body within 8 %, and up to a fifth more where load is shared within
/// a pitch, which loads the rims of the dimples.
#[test]
fn dimples_in_a_body_reduce_friction_as_they_do_in_a_half_space() {
    for (weakening, expected) in REDUCTIONS {
        let [by_all, by_near] = ["1 m", "160 um"].map(|within| reduction(weakening, within));
        println!("w p (1 - nu)/G = {weakening}: {by_all:.2} and {by_near:.2} % for {expected} %");
        assert!((by_all / expected - 1.0).abs() < 0.08, "{weakening}: {by_all} %");
        assert!(
            (1.0..1.2).contains(&(by_near / by_all)),
            "{weakening}: {by_near} %"
        );
    }
}
