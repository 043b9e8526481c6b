//! Warnings before a case is run.

use std::path::Path;

use slipfront::FrictionLaw;

use super::runnable::Case;
use super::textures::is_array;
use crate::case_file::{DEFAULT_THRESHOLD, Mask, Texture};
use crate::number_format::{are, count};

/// Difference between the texture as asked and as meshed, relative to what was asked, above which there is a warning.
const LARGE_MISFIT: f64 = 0.25;
/// Relative difference between `mu_static` and the mean of given coefficients above which there is a warning.
const LARGE_MISMATCH: f64 = 0.1;
/// Strain of the load above which geometric nonlinearity of the springs shows in the third digit.
const LARGE_EPSILON: f64 = 1e-2;
/// Speed above which loading is faster than the slip front.
const LARGE_V_STAR: f64 = 0.2;
/// Fewest blocks for which the paper calls edge effects small.
const FEW_BLOCKS: usize = 625;

impl Case {
    /// Warnings about a case outside the range in which the model is valid, or that differs from what was asked.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let mut warn = |is_wrong: bool, sentence: String| {
            if is_wrong {
                warnings.push(sentence);
            }
        };
        for texture in &self.texture.clipped {
            let sentence = format!(
                "texture {} reaches over a free edge and is clipped there",
                texture + 1
            );
            warn(true, sentence);
        }
        for (texture, number) in self.file.texture.iter().zip(1..) {
            let Texture::Mask(Mask { file, threshold }) = texture else {
                continue;
            };
            warn(
                *threshold != DEFAULT_THRESHOLD && is_array(Path::new(file)),
                format!(
                    "`threshold` = {threshold} of texture {number} is for images: an array says by 0 or 1 what is textured"
                ),
            );
        }
        let meshed = self.texture.meshed_percent;
        match self.texture.asked_percent {
            Some(asked) => warn(
                (meshed - asked).abs() > LARGE_MISFIT * asked,
                format!(
                    "the texture covers {meshed:.2} % of the blocks instead of {asked:.2} %: it is clipped, overlaps, or is \
                     too fine for the blocks"
                ),
            ),
            None => warn(meshed == 0.0, "the texture covers no block".to_owned()),
        }

        let negative = self.negative_draws;
        warn(
            negative > 0,
            format!(
                "{} of the friction coefficients {} set to 0",
                count(negative, "negative draw"),
                if negative == 1 { "was" } else { "were" }
            ),
        );
        let surface = &self.model.surface;
        let mean = surface.mu_static.iter().sum::<f64>() / surface.n_contact() as f64;
        let mu_static = self.scales.mu_static_mean;
        warn(
            self.file.friction.mu_static_field.is_some() && (mean / mu_static - 1.0).abs() > LARGE_MISMATCH,
            format!(
                "the given static coefficients have a mean of {mean:.4}, mu_static is {mu_static}: what is starred is \
                 relative to mu_static"
            ),
        );

        let (epsilon, v_star, dt_star) = (self.groups.epsilon, self.groups.v_star, self.time_plan.dt_star);
        warn(
            epsilon > LARGE_EPSILON,
            format!(
                "the load strains the slider by {epsilon:.3}, more than {LARGE_EPSILON}: results depend on it"
            ),
        );
        warn(
            v_star > LARGE_V_STAR,
            format!(
                "V* = {v_star} is above {LARGE_V_STAR}: the slider slips as a whole before any front can cross it"
            ),
        );
        warn(
            self.model.law == FrictionLaw::Literal,
            "law = \"literal\" is for comparison only: its results depend on the time step".to_owned(),
        );
        warn(
            dt_star > 0.5,
            format!("dt* = {dt_star} is stable but coarse: with 0.1, mu_s* is good to 1e-3"),
        );
        let n_blocks = self.model.lattice.n_blocks();
        warn(
            n_blocks < FEW_BLOCKS,
            format!(
                "{} few: edges weigh heavily below {FEW_BLOCKS} (Fig. 5 of the paper)",
                are(n_blocks, "block")
            ),
        );
        warnings
    }
}
