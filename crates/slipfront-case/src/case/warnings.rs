//! Warnings before a case is run.

use std::path::Path;

use slipfront::FrictionLaw;

use super::runnable::Case;
use super::textures::is_array;
use crate::case_file::{DEFAULT_THRESHOLD, Texture};

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
        let mut warn = |wrong: bool, sentence: String| {
            if wrong {
                warnings.push(sentence);
            }
        };
        self.warn_of_texture(&mut warn);
        self.warn_of_coefficients(&mut warn);
        self.warn_of_model(&mut warn);
        warnings
    }

    fn warn_of_texture(&self, warn: &mut impl FnMut(bool, String)) {
        for texture in &self.texture.clipped {
            warn(
                true,
                format!(
                    "texture {} reaches over a free edge and is clipped there",
                    texture + 1
                ),
            );
        }
        for (index, texture) in self.file.texture.iter().enumerate() {
            if let Texture::Mask(mask) = texture {
                warn(
                    mask.threshold != DEFAULT_THRESHOLD && is_array(Path::new(&mask.file)),
                    format!(
                        "`threshold` = {} of texture {} is for images: an array says by 0 or 1 what is textured",
                        mask.threshold,
                        index + 1
                    ),
                );
            }
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
    }

    fn warn_of_coefficients(&self, warn: &mut impl FnMut(bool, String)) {
        warn(
            self.negative_draws > 0,
            format!(
                "{} negative draws of the friction coefficients were set to 0",
                self.negative_draws
            ),
        );
        let surface = &self.model.surface;
        let mean = surface.mu_static.iter().sum::<f64>() / surface.n_contact() as f64;
        let given = self.file.friction.mu_static_field.is_some();
        warn(
            given && (mean / self.scales.mu_static_mean - 1.0).abs() > LARGE_MISMATCH,
            format!(
                "the given static coefficients have a mean of {mean:.4}, mu_static is {}: what is starred is relative to \
                 mu_static",
                self.scales.mu_static_mean
            ),
        );
    }

    fn warn_of_model(&self, warn: &mut impl FnMut(bool, String)) {
        let groups = &self.groups;
        warn(
            groups.epsilon > LARGE_EPSILON,
            format!(
                "the load strains the slider by {:.3}, more than {LARGE_EPSILON}: results depend on it",
                groups.epsilon
            ),
        );
        warn(
            groups.v_star > LARGE_V_STAR,
            format!(
                "V* = {} is above {LARGE_V_STAR}: the slider slips as a whole before any front can cross it",
                groups.v_star
            ),
        );
        warn(
            self.model.law == FrictionLaw::Literal,
            "law = \"literal\" is for comparison only: its results depend on the time step".to_owned(),
        );
        warn(
            self.time_plan.dt_star > 0.5,
            format!(
                "dt* = {} is stable but coarse: with 0.1, mu_s* is good to 1e-3",
                self.time_plan.dt_star
            ),
        );
        warn(
            self.model.lattice.n_blocks() < FEW_BLOCKS,
            format!(
                "{} blocks are few: edges weigh heavily below {FEW_BLOCKS} (Fig. 5 of the paper)",
                self.model.lattice.n_blocks()
            ),
        );
    }
}
