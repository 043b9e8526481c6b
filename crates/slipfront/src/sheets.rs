//! A slider made of a stack of sheets: lattices above the sheet in friction, coupled to it block by block.
//!
//! A bulk body responds to a traction of wave number q with a stiffness proportional to q. One sheet on a
//! mount does so only at one q, two or three sheets over a wide range of q. Sheets are counted from the
//! lowest, 0, which alone is in friction; the drive springs pull the highest. The displacements `u_k` of
//! sheet k obey
//!
//! ```text
//! h_k m u_k'' = h_k F_c(u_k) + g_k (u_k-1 - u_k) + g_k+1 (u_k+1 - u_k) - h_k m Omega u_k'
//! ```

pub use slipfront_kernel::Sheet;

/// Mass of the blocks of all sheets at one place, in units of that of the lowest sheet.
pub(crate) fn mass(sheets: &[Sheet]) -> f64 {
    sheets.iter().fold(1.0, |mass, sheet| mass + sheet.thickness)
}

/// Stiffness with which a drive spring of stiffness `k_drive` on the highest sheet pulls the lowest one, if
/// all blocks of a sheet move equally: `1/(1/k_s + sum 1/g_k)`.
pub(crate) fn stiffness_in_series(sheets: &[Sheet], k_drive: f64) -> f64 {
    sheets
        .iter()
        .fold(k_drive, |k, sheet| k * sheet.coupling / (k + sheet.coupling))
}

/// Largest eigenvalue, over the masses, of the springs between the sheets, to the drive, and of stiffness
/// `contact` to the substrate: the square of the highest frequency of a column of blocks.
pub(crate) fn largest_eigenvalue(sheets: &[Sheet], k_drive: f64, contact: f64) -> f64 {
    let mut masses = vec![1.0];
    let mut diagonal = vec![contact];
    for (below, sheet) in sheets.iter().enumerate() {
        diagonal[below] += sheet.coupling;
        diagonal.push(sheet.coupling);
        masses.push(sheet.thickness);
    }
    diagonal[sheets.len()] += k_drive;
    let entries = |k: usize| diagonal[k] / masses[k];
    let beside = |k: usize| sheets[k - 1].coupling.powi(2) / (masses[k - 1] * masses[k]);
    // The number of eigenvalues below x equals the number of negative pivots of the matrix less x
    // (Sylvester).
    let all_lie_below = |x: f64| {
        let mut pivot = entries(0) - x;
        (1..masses.len()).all(|k| {
            let is_negative = pivot < 0.0;
            pivot = entries(k) - x - beside(k) / pivot;
            is_negative
        }) && pivot < 0.0
    };
    // The trace is an upper bound, since no eigenvalue is negative.
    let (mut low, mut high) = (0.0, (0..masses.len()).map(entries).sum::<f64>());
    /// Number of bisections after which the ends are adjacent floating-point numbers.
    const HALVINGS: usize = 60;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if all_lie_below(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses on two springs: `x^2 - (g + (g + k)/h) x + g k/h = 0`.
    #[test]
    fn two_sheets_have_the_eigenvalues_of_two_masses() {
        for (thickness, coupling, k) in [(8.4, 2.4, 0.2), (0.3, 0.1, 3.0), (1.0, 1.0, 0.0)] {
            let sheets = [Sheet { thickness, coupling }];
            let half = 0.5 * (coupling + (coupling + k) / thickness);
            let exact = half + (half * half - coupling * k / thickness).sqrt();
            let found = largest_eigenvalue(&sheets, k, 0.0);
            assert!((found / exact - 1.0).abs() < 1e-14, "{found} {exact}");
        }
        assert!((largest_eigenvalue(&[], 0.3, 0.2) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn springs_in_series_yield_together() {
        let sheet = |coupling| Sheet {
            thickness: 1.0,
            coupling,
        };
        assert_eq!(stiffness_in_series(&[], 0.375), 0.375);
        assert!((stiffness_in_series(&[sheet(2.0), sheet(4.0)], 1.0) - 1.0 / 1.75).abs() < 1e-15);
        assert_eq!(mass(&[sheet(2.0), sheet(4.0)]), 3.0);
    }
}
