//! Few blocks whose coefficients are random though no key asks for it: a slider of one block has another
//! coefficient than the mean that its file gives.

use super::runnable::Case;
use slipfront_base::number_format::{count, four_digits};

/// Fewest blocks in contact that draw their coefficients without a note: the mean of 25 draws of the default
/// spread of 5 % scatters by 1 %.
const FEW_IN_CONTACT: usize = 25;

impl Case {
    /// A sentence on few blocks in contact whose coefficients are drawn with the default spread: by how much
    /// the mean of the slider scatters from seed to seed, a standard deviation of
    ///
    /// ```text
    /// sigma*/sqrt(n)
    /// ```
    ///
    /// and the keys that make blocks equal. Another spread, or a correlation length, is one that was meant.
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
