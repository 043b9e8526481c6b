//! Warnings about a case before it runs.

use std::path::Path;

use slipfront::Edges;

use super::inputs::is_array;
use super::runnable::Case;
use super::textures::arrays;
use super::topography::Topography;
use crate::case_file::{
    Count, DEFAULT_THRESHOLD, DriveSpeed, Law, Mask, Outlined, Pattern, Pitch, Shape, Texture,
    friction_warning,
};
use slipfront_base::number_format::{are, count, four_digits, with_si_prefix};

/// Blocks by which a pattern may fall short of a periodic edge without a warning.
const LARGE_SEAM: f64 = 0.5;
/// Difference between the size of a height map and the size of the blocks that it covers, relative to the
/// latter, above which there is a warning.
const LARGE_SCALE: f64 = 0.01;
/// Difference between the requested and the meshed texture, relative to the requested one, above which there
/// is a warning.
const LARGE_MISFIT: f64 = 0.25;
/// Coverage, in percent, below which the user may have meant a fraction of 1.
const SMALL_COVERAGE: f64 = 1.0;
/// Relative difference between `mu_static` and the mean of given coefficients above which there is a warning.
const LARGE_MISMATCH: f64 = 0.1;
/// Standard deviation of the mean of a surface between seeds, relative to that of the coefficients, above
/// which there is a warning.
const LARGE_COMMON_SHARE: f64 = 0.5;
/// Strain of the load above which geometric nonlinearity of the springs shows in the third digit.
const LARGE_EPSILON: f64 = 1e-2;
/// Number of steps of a constant speed, from no load to the strength, from which on the error of a reduction
/// of the strength of a bulk body is at most 1 %.
const MANY_LOADING_STEPS: f64 = 16_000.0;
/// Speed above which loading is faster than the slip front.
const LARGE_V_STAR: f64 = 0.2;
/// Ratio of the drag of the damping to kinetic friction above which there is a warning: three times the
/// standard deviation of mu_k* between surfaces, 0.3 % on 25 x 25 blocks.
const LARGE_DRAG: f64 = 0.01;
/// Ratio of the drag to the static strength of the blocks below which there is no warning, however small
/// kinetic friction is.
const SMALL_DRAG: f64 = 0.001;
/// Rise of mu* in a step of a held drive above which there is a warning: twice the rise at V* = 0.03 in steps
/// of 0.1.
const LARGE_INCREMENT: f64 = 2.25e-3;
/// Least number of blocks for which the paper calls edge effects small.
const FEW_BLOCKS: usize = 625;

impl Case {
    /// Note on speeds of a program that begin when the run has ended.
    fn program_after_the_end(&self) -> Option<String> {
        let DriveSpeed::Program(segments) = &self.file.drive.speed else {
            return None;
        };
        let end_star = self.time_plan.end_star();
        let begins = segments.iter().filter_map(|segment| segment.until_star);
        let late: Vec<f64> = begins.filter(|begin_star| *begin_star >= end_star).collect();
        let (first, n) = (late.first()?, late.len());
        Some(format!(
            "the run ends at t* = {end_star:.4}, before the last {} of `drive.program` begin{}, the first at t* = {first}: lengthen \
             `time.duration_star`",
            count(n, "speed"),
            if n == 1 { "s" } else { "" }
        ))
    }

    /// Warnings about a case outside the range in which the model is valid, or different from what was
    /// requested.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.texture_warnings();
        warnings.extend(self.friction_warnings());
        warnings.extend(self.level_warnings());
        warnings.extend(self.program_after_the_end());

        let mut warn = |is_wrong: bool, sentence: &dyn Fn() -> String| {
            if is_wrong {
                warnings.push(sentence());
            }
        };
        let is_rigid = self.file.slider.rigid;
        let (epsilon, v_star, dt_star) = (self.strain_of_load(), self.groups.v_star, self.time_plan.dt_star);
        warn(epsilon > LARGE_EPSILON && !is_rigid, &|| {
            format!(
                "the load strains the slider by {epsilon:.3}, more than {LARGE_EPSILON}: results depend on it"
            )
        });
        let against_front = self.model.speed_against_front();
        let is_held = self.model.drive.is_held();
        warn(against_front > LARGE_V_STAR && !is_held && !is_rigid, &|| {
            // Equal up to rounding.
            if (against_front / v_star - 1.0).abs() < 1e-9 {
                return format!(
                    "V* = {} is above {LARGE_V_STAR}: the slider slips as a whole before a front can cross it",
                    four_digits(v_star)
                );
            }
            format!(
                "V* = {} loads this slider as fast as V* = {} loads equal blocks on the paper's springs, above {LARGE_V_STAR}: \
                 loading is faster than a slip front",
                four_digits(v_star),
                four_digits(against_front)
            )
        });
        warn(self.file.friction.law == Law::Literal, &|| {
            "law = \"literal\" is for comparison only: its results depend on the time step".to_owned()
        });
        let is_bulk = self.model.body().is_some();
        warn(is_bulk, &|| {
            "a bulk body is a periodic piece of a larger part: edges, at which a part of its own loses strength, are not computed"
                .to_owned()
        });
        warn(dt_star > 0.5 && !is_bulk, &|| {
            format!(
                "dt* = {} is stable but coarse: with 0.1, mu_s* is accurate to 1e-3",
                four_digits(dt_star)
            )
        });
        let increment = self.rise_per_step();
        let (loading_steps, weakens) = (1.0 / increment, self.model.weakening().is_some());
        warn(
            is_bulk && weakens && !is_held && loading_steps < MANY_LOADING_STEPS,
            &|| {
                format!(
                    "a constant speed loads this body in {} steps, and the reduction of mu_s* by a texture is too small by 5 % in 4000, by 2 % \
                 in 8000, by 1 % in 16000: use `drive.loading` = \"held\", or reduce the speed",
                    four_digits(loading_steps)
                )
            },
        );
        warn(is_held && !is_bulk && increment > LARGE_INCREMENT, &|| {
            format!(
                "mu* rises by up to {} in a step of the held drive, which is the resolution of mu_s*: reduce `drive.v_star` or `time.step`",
                four_digits(increment)
            )
        });
        let n_blocks = self.model.n_blocks();
        warn(n_blocks < FEW_BLOCKS && !is_rigid, &|| {
            format!(
                "{} few: edge effects are large below {FEW_BLOCKS} (Fig. 5 of the paper)",
                are(n_blocks, "block")
            )
        });
        warnings
    }

    /// Whether steady sliding takes less force than the static strength of the blocks. If not, friction loses
    /// nothing when they slip, and no drop of mu* is a transition. A law without thresholds has no static
    /// strength for this comparison.
    pub fn can_have_transition(&self) -> bool {
        !self.model.friction.has_thresholds()
            || self.expected.steady_level < self.model.surface.mean_static_force()
    }

    /// Warnings if sliding takes as much force as its start, and if damping contributes to the measured
    /// kinetic friction.
    fn level_warnings(&self) -> Vec<String> {
        let (level, drag) = (self.expected.steady_level, self.expected.steady_drag);
        let (kinetic, v_star) = (level - drag, self.groups.v_star);
        let held = self.model.surface.mean_static_force();
        let mut warnings = Vec::new();
        let limit = (LARGE_DRAG * kinetic).max(SMALL_DRAG * held);
        if drag > limit {
            // The drag is proportional to the speed.
            warnings.push(format!(
                "damping drag at V* = {} adds {} to the kinetic friction of {}, and is included in mu_k*; up to V* = {} it is \
                 less than the scatter between surfaces",
                four_digits(v_star),
                four_digits(drag),
                four_digits(kinetic),
                four_digits(limit / drag * v_star)
            ));
        }
        if kinetic < held && !self.can_have_transition() {
            warnings.push(format!(
                "no transition is possible: steady sliding at V* = {} needs mu* = {}, including a damping drag of {}, but \
                 static friction holds only {}. A first peak of mu* is then not static friction; use a lower speed or less \
                 damping",
                four_digits(v_star),
                four_digits(level),
                four_digits(drag),
                four_digits(held)
            ));
        }
        warnings
    }

    fn texture_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let report = &self.texture;
        for texture in &report.clipped {
            if !report.empty.contains(texture) {
                warnings.push(format!(
                    "texture {} extends beyond a free edge and is clipped there",
                    texture + 1
                ));
            }
        }
        for &texture in &report.empty {
            warnings.push(format!(
                "texture {} covers no block: {}",
                texture + 1,
                why_empty(&self.file.texture[texture])
            ));
        }
        for (texture, number) in self.file.texture.iter().zip(1..) {
            if let Some(percent) = texture.shape.outline().and_then(Outlined::coverage)
                && percent < SMALL_COVERAGE
            {
                warnings.push(format!(
                    "`coverage` = {percent} of texture {number} means {percent} percent of the area; for {} percent write `coverage` = {}",
                    four_digits(100.0 * percent),
                    four_digits(100.0 * percent)
                ));
            }
            if let Shape::Mask(Mask { file, threshold }) = &texture.shape
                && *threshold != DEFAULT_THRESHOLD
                && is_array(Path::new(file))
            {
                warnings.push(format!(
                    "`threshold` = {threshold} of texture {number} applies to images only: an array has 0 or 1 for each block"
                ));
            }
        }
        warnings.extend(report.notes.iter().cloned());
        for topography in &report.topographies {
            warnings.extend(self.other_scale(topography));
            let notes = topography.notes.iter();
            warnings.extend(notes.map(|note| format!("{}: {note}", topography.file)));
        }
        for (texture, number) in self.file.texture.iter().zip(1..) {
            warnings.extend(self.broken_pattern_warning(&texture.pattern, number));
        }
        let meshed = report.meshed_percent;
        if let Some(asked) = report.asked_percent
            && meshed > 0.0
            && (meshed - asked).abs() > LARGE_MISFIT * asked
        {
            let textures = &self.file.texture;
            let is_map = |texture: &Texture| matches!(texture.shape, Shape::HeightMap(_));
            let is_repeated = |texture: &Texture| texture.pattern.arrays().any(|(_, array)| array.is_array());
            let is_alone = textures.len() == 1 && !textures.iter().any(is_repeated);
            let why = match (textures.iter().all(is_map), is_alone) {
                (true, true) => "blocks of equal height are in contact together",
                (true, false) => {
                    "blocks of equal height are in contact together, or maps are clipped or overlap"
                }
                (false, _) => "it is clipped, overlaps, or is too fine for the blocks",
            };
            warnings.push(format!(
                "the texture covers {meshed:.2} % of the blocks instead of {asked:.2} %: {why}"
            ));
        }
        warnings.extend(self.too_coarse());
        warnings.extend(self.thick_for_texture());
        warnings
    }

    /// A warning if a height map differs in size from the blocks that it covers, or has fewer points than
    /// there are blocks.
    fn other_scale(&self, topography: &Topography) -> Option<String> {
        let Topography {
            file,
            points,
            size,
            blocks,
            ..
        } = topography;
        let length = |axis: usize| blocks[axis] as f64 * self.scales.block_size;
        let in_metres = |[x, y]: [f64; 2]| format!("{} x {}", with_si_prefix(x, "m"), with_si_prefix(y, "m"));
        let scale = length(0) / size[0];
        if (scale - 1.0).abs() > LARGE_SCALE {
            let arrays = self.file.texture[topography.texture].pattern.arrays();
            let innermost = arrays.filter(|(_, array)| array.is_array()).last();
            let [x, y] = size.map(|length| format!("{:?}", with_si_prefix(length, "m")));
            // If the size of a place is given, it does not depend on the blocks.
            let own = match innermost.and_then(|(before, array)| Some((before, array.pitch?))) {
                Some((before, Pitch::Equal(_))) => format!("`{before}pitch` = {x}"),
                Some((before, Pitch::Each(_))) => format!("`{before}pitch` = [{x}, {y}]"),
                None => format!(
                    "`block_size` = {:?}",
                    with_si_prefix(size[0] / blocks[0] as f64, "m")
                ),
            };
            return Some(format!(
                "{file} is {} and is stretched over {} of the slider, {} times its size; with {own} it keeps its size",
                in_metres(*size),
                in_metres([length(0), length(1)]),
                four_digits(scale)
            ));
        }
        let [few, many] = [points, blocks];
        (few[0] < many[0] || few[1] < many[1]).then(|| {
            format!(
                "{file} has {} x {} points for {} x {} blocks: several blocks share a height",
                few[0], few[1], many[0], many[1]
            )
        })
    }

    /// A warning if a pattern that fills the slider is not continuous across a periodic edge.
    fn broken_pattern_warning(&self, pattern: &Pattern, number: usize) -> Option<String> {
        let lattice = &self.model.lattice;
        let arrays = arrays(pattern, &self.scales, lattice).ok()?;
        let (array, (_, keys)) = arrays
            .first()
            .zip(pattern.arrays().find(|(_, keys)| keys.is_array()))?;
        // A given number of copies at a given pitch need not fill the slider.
        if keys.pitch.is_some() && keys.array != Count::Auto {
            return None;
        }
        let sizes = [lattice.nx, lattice.ny];
        (0..2).filter(|&axis| lattice.edges[axis] == Edges::Periodic).find_map(|axis| {
            let (name, rest) = (["x", "y"][axis], sizes[axis] as f64 - array.spacing[axis] * array.count[axis] as f64);
            if rest.abs() > LARGE_SEAM {
                return Some(format!(
                    "the pattern of texture {number} leaves {rest:.2} blocks free at the periodic edges that bound {name}, so \
                     it is not periodic there"
                ));
            }
            let is_odd = axis == 1 && array.staggered && array.count[1] % 2 == 1;
            is_odd.then(|| {
                format!(
                    "the pattern of texture {number} has an odd number of rows, {}, so rows at the periodic edges are not shifted",
                    array.count[1]
                )
            })
        })
    }

    /// A warning if most of the spread is between surfaces of different seeds, and little within one surface.
    fn correlation_warning(&self) -> Option<String> {
        let share = libm::sqrt(self.correlated_field()?.variance_of_slider());
        let is_random = self.groups.sigma_static_star > 0.0 || self.groups.sigma_kinetic_star > 0.0;
        (is_random && share > LARGE_COMMON_SHARE).then(|| {
            format!(
                "random coefficients are correlated over much of the slider: the mean of a surface varies between seeds by {} \
                 of the spread, and starred quantities are relative to `mu_static`; use several seeds, or a shorter \
                 `friction.correlation_length`",
                four_digits(share)
            )
        })
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
                    "the given static coefficients have a mean of {:.4}, but mu_static is {mu_static}: starred quantities are \
                     relative to mu_static",
                    means[0]
                ));
            }
        }
        if friction.mu_kinetic_field.is_some() {
            let expected = means[1];
            means[1] = surface.mean_kinetic_coefficient();
            if differs(means[1], expected) {
                warnings.push(format!(
                    "the given kinetic coefficients have a mean of {:.4}, but R* mu_static is {expected:.4}: the run uses the \
                     given coefficients, and R* = {} has no effect",
                    means[1],
                    four_digits(r_star)
                ));
            }
        }
        warnings.extend(self.correlation_warning());
        warnings.extend(self.few_random_blocks());
        let mean = surface.mean_pressure();
        if self.file.load.pressure_field.is_some() && differs(mean, 1.0) {
            warnings.push(format!(
                "the given pressures have a mean of {mean:.4} times `pressure`: starred quantities are relative to `pressure`"
            ));
        }
        let pressure = &self.file.load.pressure;
        if pressure.si() < 1.0 {
            warnings.push(format!(
                "`load.pressure` is \"{pressure}\", less than 1 Pa: if megapascals were meant, write \"MPa\""
            ));
        }
        warnings.extend(friction_warning(&self.model));
        warnings.extend(self.expected.at_once.warning());
        warnings.extend(self.coarse_for_stick_slip());
        warnings.extend(self.unresolved_lengths());
        let [mean_static, mean_kinetic] = means;
        if mean_kinetic >= mean_static {
            warnings.push(format!(
                "the mean kinetic coefficient, {mean_kinetic:.4}, is not below the static one, {mean_static:.4}: friction does \
                 not drop when blocks slip, so a first peak of mu* is not a transition, even if `transition` is true"
            ));
        }
        warnings
    }
}

/// Reason why a texture covers no block, with the keys to check.
fn why_empty(texture: &Texture) -> &'static str {
    if texture.pattern.invert {
        "the inside of its shapes, which `invert` keeps in contact, covers all blocks"
    } else {
        texture.shape.why_empty()
    }
}
