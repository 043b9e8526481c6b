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
        let mut warnings = self.texture_warnings();
        warnings.extend(self.friction_warnings());

        let mut warn = |is_wrong: bool, sentence: &dyn Fn() -> String| {
            if is_wrong {
                warnings.push(sentence());
            }
        };
        let (epsilon, v_star, dt_star) = (self.groups.epsilon, self.groups.v_star, self.time_plan.dt_star);
        warn(epsilon > LARGE_EPSILON, &|| {
            format!(
                "the load strains the slider by {epsilon:.3}, more than {LARGE_EPSILON}: results depend on it"
            )
        });
        warn(self.model.loading_speed() > LARGE_V_STAR, &|| {
            format!(
                "V* = {v_star} is above {LARGE_V_STAR}: the slider slips as a whole before any front can cross it"
            )
        });
        warn(self.file.friction.law == FrictionLaw::Literal, &|| {
            "law = \"literal\" is for comparison only: its results depend on the time step".to_owned()
        });
        warn(dt_star > 0.5, &|| {
            format!("dt* = {dt_star} is stable but coarse: with 0.1, mu_s* is good to 1e-3")
        });
        let n_blocks = self.model.n_blocks();
        warn(n_blocks < FEW_BLOCKS, &|| {
            format!(
                "{} few: edges weigh heavily below {FEW_BLOCKS} (Fig. 5 of the paper)",
                are(n_blocks, "block")
            )
        });
        warnings
    }

    fn texture_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let report = &self.texture;
        for texture in &report.clipped {
            if !report.empty.contains(texture) {
                warnings.push(format!(
                    "texture {} reaches over a free edge and is clipped there",
                    texture + 1
                ));
            }
        }
        for texture in &report.empty {
            warnings.push(format!(
                "texture {} covers no block: it lies off the slider, or between the centres of blocks; look at its size and place",
                texture + 1
            ));
        }
        for (texture, number) in self.file.texture.iter().zip(1..) {
            if let Texture::Mask(Mask { file, threshold }) = texture
                && *threshold != DEFAULT_THRESHOLD
                && is_array(Path::new(file))
            {
                warnings.push(format!(
                    "`threshold` = {threshold} of texture {number} is for images: an array says by 0 or 1 what is textured"
                ));
            }
        }
        let meshed = report.meshed_percent;
        if let Some(asked) = report.asked_percent
            && meshed > 0.0
            && (meshed - asked).abs() > LARGE_MISFIT * asked
        {
            warnings.push(format!(
                "the texture covers {meshed:.2} % of the blocks instead of {asked:.2} %: it is clipped, overlaps, or is too fine \
                 for the blocks"
            ));
        }
        warnings
    }

    fn friction_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let negative = self.model.surface.negative_draws();
        if negative > 0 {
            warnings.push(format!(
                "{} of the friction coefficients {} set to 0",
                count(negative, "negative draw"),
                if negative == 1 { "was" } else { "were" }
            ));
        }
        let (friction, surface) = (&self.file.friction, &self.model.surface);
        let (mu_static, r_star) = (self.scales.mu_static_mean, self.groups.r_star);
        let mut means = [mu_static, r_star * mu_static];
        let differs = |mean: f64, expected: f64| (mean - expected).abs() > LARGE_MISMATCH * expected;
        if friction.mu_static_field.is_some() {
            means[0] = surface.mean_static_coefficient();
            if differs(means[0], mu_static) {
                warnings.push(format!(
                    "the given static coefficients have a mean of {:.4}, mu_static is {mu_static}: what is starred is relative to \
                     mu_static",
                    means[0]
                ));
            }
        }
        if friction.mu_kinetic_field.is_some() {
            let expected = means[1];
            means[1] = surface.mean_kinetic_coefficient();
            if differs(means[1], expected) {
                warnings.push(format!(
                    "the given kinetic coefficients have a mean of {:.4}, R* mu_static is {expected:.4}: the run takes the given \
                     ones, and R* = {r_star} says nothing of it",
                    means[1]
                ));
            }
        }
        let mean = surface.mean_pressure();
        if self.file.load.pressure_field.is_some() && differs(mean, 1.0) {
            warnings.push(format!(
                "the given pressures have a mean of {mean:.4} times `pressure`: what is starred is relative to `pressure`"
            ));
        }
        let [mean_static, mean_kinetic] = means;
        if mean_kinetic >= mean_static {
            warnings.push(format!(
                "the mean kinetic coefficient, {mean_kinetic:.4}, is not below the static one, {mean_static:.4}: blocks do not \
                 lose friction when they slip, and a first peak of mu* is no transition, whatever `transition` says"
            ));
        }
        warnings
    }
}
