//! Lengths of a case in blocks, and the one that determines the mesh error of an answer.
//!
//! The sufficient number of blocks for each length was measured on a sheet of 1 mm with square and round
//! cavities of 50 to 400 um, on 20 to 320 blocks along a side, with everything else constant in metres,
//! seconds and pascals. With at least this number, the reduction of static friction by the cavity is within 2
//! % of that on the finest mesh (`docs/validation/measures.md`, "Blocks that a length needs").

use slipfront::surface::{Clearance, clearance};

use super::runnable::Case;
use super::textures::outlines_in_blocks;
use crate::case_file::{
    Attached, AttachedEdge, AutoOrStiffness, Body, CaseFile, DriveStiffness, LengthOfABlock, Motion, Texture,
};
use slipfront_base::number_format::{four_digits, with_si_prefix};

/// Sufficient number of blocks in the critical size of slip.
const OF_CRITICAL_SIZE: f64 = 5.0;
/// Sufficient number of blocks in the critical size of a bulk body. For dimples four times as wide as this
/// size, the reduction on 1.9 blocks differs by 6 % from that on 5.6, and on 2.8 blocks by 1.5 %.
const OF_CRITICAL_SIZE_OF_BULK: f64 = 2.0;
/// Sufficient number of blocks in the screening length along the drive, where it is the shorter length.
const OF_SCREENING: f64 = 3.0;
/// Ratio of critical size to screening length above which slip is stable or nearly so on this mount, and the
/// screening length counts.
const NEARLY_STABLE: f64 = 4.0;
/// Relative difference of the two bounds of the critical size below which only one is reported: where nearly
/// all blocks touch, both are within the error of the formula.
const NEARLY_ALL_TOUCH: f64 = 0.1;
/// Sufficient number of blocks in the correlation length: coefficients are exact means over blocks.
const OF_CORRELATION: f64 = 0.5;
/// Sufficient number of blocks across the smallest feature: the meshed area is then accurate to 2 % in root
/// mean square over positions on the mesh.
const ACROSS_A_FEATURE: f64 = 5.0;
/// Sufficient number of blocks across the smallest gap: one of them is then in contact for any position on
/// the mesh.
const ACROSS_A_GAP: f64 = 2.0;

/// A length of a case, and the number of blocks that an answer needs in it.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseLength {
    /// Name of the length, such as "critical size".
    pub name: String,
    /// The length in blocks; infinite for the critical size of slip that is stable at any size.
    pub blocks: f64,
    /// The length in m.
    pub metres: f64,
    /// Least number of blocks for which a reduction of static friction is within 2 % of its limit; none where
    /// the length sets no bound.
    pub enough: Option<f64>,
}

impl CaseFile {
    /// Lengths of the material that equal the block length because no key gives them. They change with the
    /// blocks.
    pub fn lengths_of_a_block(&self) -> Vec<LengthOfABlock> {
        if self.slider.body == Body::Bulk {
            return self.friction.lengths_of_a_block().collect();
        }
        let thickness = self.slider.thickness_is_a_block().then_some(LengthOfABlock {
            length: "the thickness of the sheet",
            key: "slider.thickness",
        });
        let mount =
            (self.drive.stiffness == DriveStiffness::Each(AutoOrStiffness::Auto)).then_some(LengthOfABlock {
                length: "the screening length of the mount",
                key: "drive.stiffness_per_area",
            });
        let of_friction = self.friction.lengths_of_a_block();
        thickness.into_iter().chain(mount).chain(of_friction).collect()
    }
}

impl Case {
    /// The block, the screening lengths of the mount, the critical sizes of slip in this sheet and in a bulk
    /// body on a rigid base, the correlation length of the coefficients, and the smallest feature and gap of
    /// the texture, as far as the case has them.
    pub fn lengths(&self) -> Vec<CaseLength> {
        let mut lengths = self.material_lengths();
        lengths.extend(self.smallest_lengths());
        lengths
    }

    /// All lengths except those of the texture.
    fn material_lengths(&self) -> Vec<CaseLength> {
        let model = &self.model;
        let critical_size = self.expected.critical_size;
        let mut lengths = vec![self.length("block", 1.0, None)];
        if self.has_spring_on_every_block() {
            let [along, across] = model.drive.screening_lengths(&model.lattice);
            let counts = critical_size.is_some_and(|[least, _]| least > NEARLY_STABLE * along);
            lengths.push(self.length("screening length along", along, counts.then_some(OF_SCREENING)));
            lengths.push(self.length("screening length across", across, None));
        }
        if let Some([least, most]) = critical_size {
            let enough = least.is_finite().then_some(OF_CRITICAL_SIZE);
            lengths.push(self.length("critical size", least, enough));
            if most > (1.0 + NEARLY_ALL_TOUCH) * least {
                lengths.push(self.length("critical size, at most", most, None));
            }
        }
        if let Some(blocks) = self.critical_size_of_bulk() {
            let is_of_slider = blocks.is_finite() && self.model.body().is_some();
            let enough = is_of_slider.then_some(OF_CRITICAL_SIZE_OF_BULK);
            lengths.push(self.length("critical size, bulk body", blocks, enough));
        }
        if let Some(field) = self.correlated_field() {
            lengths.push(self.length("correlation length", field.length(), Some(OF_CORRELATION)));
        }
        lengths
    }

    /// The smallest feature and gap of the textures; none for masks and height maps, because their outlines
    /// are not known.
    pub(super) fn smallest_lengths(&self) -> Vec<CaseLength> {
        let Clearance { feature, gap } = self.clearance();
        let [feature_name, gap_name] = names(&self.file.texture);
        let found = [
            (feature_name, feature, ACROSS_A_FEATURE),
            (gap_name, gap, ACROSS_A_GAP),
        ];
        found
            .into_iter()
            .filter_map(|(name, blocks, enough)| {
                Some(self.length(&format!("smallest {name}"), blocks?, Some(enough)))
            })
            .collect()
    }

    /// The smallest feature and gap of the textures in blocks; none for masks and height maps, because their
    /// outlines are not known.
    pub(super) fn clearance(&self) -> Clearance {
        let lattice = &self.model.lattice;
        let outlines = outlines_in_blocks(&self.file, &self.scales, lattice, self.model.n_blocks());
        clearance(lattice, &outlines)
    }

    /// The length that determines the mesh error of an answer, in a sentence without a full stop.
    pub fn deciding_length(&self) -> String {
        if self.model.n_blocks() == 1 {
            return "a single block has no mesh error".to_owned();
        }
        let of_a_block = self.file.lengths_of_a_block();
        if !of_a_block.is_empty() {
            let keys = of_a_block.iter().map(|length| format!("`{}`", length.key));
            return format!(
                "the block size, {}, sets the resolution: it replaces {}, which this case does not give",
                with_si_prefix(self.scales.block_size, "m"),
                keys.collect::<Vec<_>>().join(", ")
            );
        }
        let lengths = self.lengths();
        let bounded = lengths.iter().filter_map(|length| Some((length, length.enough?)));
        let least = bounded.min_by(|(one, of_one), (other, of_other)| {
            (one.blocks / of_one).total_cmp(&(other.blocks / of_other))
        });
        least.map_or("no length needs smaller blocks".to_owned(), |(length, enough)| {
            format!(
                "the {} sets the resolution: {} blocks; {} are enough for 2 % of a reduction",
                length.name,
                four_digits(length.blocks),
                four_digits(enough)
            )
        })
    }

    /// Lengths of friction and mount that these blocks are too large to resolve.
    pub(super) fn unresolved_lengths(&self) -> Vec<String> {
        let lengths = self.material_lengths().into_iter();
        lengths
            .filter_map(|length| {
                let enough = length.enough.filter(|enough| length.blocks < *enough)?;
                Some(format!(
                    "the {} is {} blocks, and {} are enough: the effect of a texture on mu_s* still depends on the block size; \
                     use blocks of at most {}",
                    length.name,
                    four_digits(length.blocks),
                    four_digits(enough),
                    with_si_prefix(length.metres / enough, "m")
                ))
            })
            .collect()
    }

    /// Whether the slider is a single sheet of several blocks in translation, with a drive spring on each of
    /// them.
    fn has_spring_on_every_block(&self) -> bool {
        let drive = &self.file.drive;
        let is_on_all = matches!(drive.attached, Attached::At(AttachedEdge::All));
        let is_sheet = self.model.body().is_none();
        is_sheet && is_on_all && drive.motion != Motion::Rotation && self.model.n_blocks() > 1
    }

    fn length(&self, name: &str, blocks: f64, enough: Option<f64>) -> CaseLength {
        CaseLength {
            name: name.to_owned(),
            blocks,
            metres: blocks * self.scales.block_size,
            enough,
        }
    }
}

/// Names of the textured parts and of the parts between them, in the words of a user.
fn names(textures: &[Texture]) -> [&'static str; 2] {
    let drawn = |texture: &Texture| Some((texture.shape.outline()?.noun(), texture.pattern.invert));
    let drawn: Vec<(&str, bool)> = textures.iter().filter_map(drawn).collect();
    if drawn.iter().all(|(_, is_inverted)| *is_inverted) {
        return ["gap", "pillar"];
    }
    let is_alike = drawn.iter().all(|one| *one == (drawn[0].0, false));
    [if is_alike { drawn[0].0 } else { "feature" }, "gap"]
}
