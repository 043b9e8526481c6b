//! Note on few blocks with random coefficients that no key asks for: the coefficient of a slider of one block
//! then differs from the mean that its file gives.

use super::runnable::Case;
use slipfront_base::number_format::{count, four_digits};

/// Least number of blocks in contact that draw their coefficients without a note: the mean of 25 draws with
/// the default spread of 5 % scatters by 1 %.
const FEW_IN_CONTACT: usize = 25;

impl Case {
    /// A sentence on few blocks in contact that draw their coefficients with the default spread. It gives the
    /// scatter of the slider's mean from seed to seed, a standard deviation of
    ///
    /// ```text
    /// sigma*/sqrt(n)
    /// ```
    ///
    /// and the keys that make the blocks equal. There is no note for another spread or a correlation length,
    /// because these are deliberate.
    pub fn few_random_blocks(&self) -> Option<String> {
        let n = self.model.surface.n_contact();
        let spreads = self.file.friction.default_spreads();
        let [(first, sigma_star), ..] = spreads[..] else {
            return None;
        };
        if n == 0 || n >= FEW_IN_CONTACT {
            return None;
        }
        let named = |name: &dyn Fn(&str) -> String, between: &str| {
            let names: Vec<String> = spreads.iter().map(|(which, _)| name(which)).collect();
            names.join(between)
        };
        let [draw, their, blocks] = match n {
            1 => ["draws its", "the mean", "the block"],
            _ => ["draw their", "their mean", "all blocks"],
        };
        let mean = match (n, spreads.len()) {
            (1, 1) => format!("the {first} coefficient of the slider scatters"),
            (1, _) => "the coefficients of the slider scatter".to_owned(),
            (_, 1) => format!("the mean {first} coefficient of the slider scatters"),
            _ => "the mean coefficients of the slider scatter".to_owned(),
        };
        Some(format!(
            "{} in contact {draw} {} coefficients at random, with the default spread of {sigma_star} about {their}: {mean} by about {} % from \
             seed to seed; {} {} {blocks} the mean",
            count(n, "block"),
            named(&str::to_owned, " and "),
            four_digits(100.0 * sigma_star / (n as f64).sqrt()),
            named(&|which| format!("`friction.sigma_{which}_star = 0`"), " and "),
            if spreads.len() == 1 { "gives" } else { "give" },
        ))
    }
}
