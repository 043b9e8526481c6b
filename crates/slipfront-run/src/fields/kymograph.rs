//! The file `kymograph.nc`: the share of the blocks that slide, against place along the drive and time, in
//! the format of `fields.nc`.

use slipfront::PositionBins;
use slipfront::observe::Kymograph;
use slipfront_case::case::Case;

use super::frame::{BLOCK_SIZE, FieldsError, TIME, TIME_STAR, TIME_UNIT};
use super::netcdf3::{ExternalType, StoredNumber};
use super::netcdf3_header::{Attribute, Definition, Variable};
use super::netcdf3_reader::{NetCdf3Reader, NetCdfError, broken};
use super::read::{WHOLE, open};
use crate::run_files::RunFile;

const PLACE: &str = "place";
const IN_CONTACT: &str = "blocks_in_contact";
const SLIDING: &str = "sliding_share";
const BIN_WIDTH: &str = "bin_width_m";

/// The bytes of the file of a run.
pub fn kymograph_bytes(kymograph: &Kymograph, case: &Case) -> Vec<u8> {
    let (model, scales) = (&case.model, &case.scales);
    let bins = PositionBins::new(&model.lattice, &model.drive);
    let data = KymographData::new(kymograph, case);
    let place = match model.drive.rotation {
        None => "distance along the drive",
        Some(_) => "distance from the axis of the rotation",
    };
    let definition = Definition {
        records: 0,
        dimensions: vec![(TIME, data.time_star.len()), (PLACE, bins.count)],
        attributes: vec![
            Attribute::text("Conventions", "CF-1.8"),
            Attribute::text("title", "Sliding blocks of a spring-block model of friction"),
            Attribute::text("source", concat!("slipfront ", env!("CARGO_PKG_VERSION"))),
            Attribute::numbers(BLOCK_SIZE, &[scales.block_size]),
            Attribute::numbers(BIN_WIDTH, &[bins.width as f64 * scales.block_size]),
            Attribute::numbers(TIME_UNIT, &[scales.time()]),
        ],
        variables: vec![
            Variable::doubles(TIME, &[TIME], "time since the start of the drive", "s"),
            Variable::doubles(TIME_STAR, &[TIME], "dimensionless time t*", "1"),
            Variable::doubles(PLACE, &[PLACE], place, "m"),
            Variable::doubles(IN_CONTACT, &[PLACE], "blocks in contact", "1"),
            Variable::new(
                SLIDING,
                &[TIME, PLACE],
                ExternalType::Float,
                "share of the blocks in contact that slide",
            )
            .with_text("units", "1"),
        ],
    };
    let mut bytes = definition.header().bytes;
    // The size of every variable is a multiple of four bytes, and they are written in this order.
    append(&mut bytes, data.time_star.iter().map(|time| time * scales.time()));
    append(&mut bytes, data.time_star.iter().copied());
    append(
        &mut bytes,
        (0..bins.count).map(|bin| bins.middle(bin) * scales.block_size),
    );
    append(
        &mut bytes,
        kymograph.in_contact().iter().map(|blocks| *blocks as f64),
    );
    // All NaN become the same one, because sign and payload depend on the machine.
    let one_nan = |share: f32| if share.is_nan() { f32::NAN } else { share };
    append(&mut bytes, data.sliding_share.into_iter().map(one_nan));
    bytes
}

fn append<T: StoredNumber>(bytes: &mut Vec<u8>, values: impl Iterator<Item = T>) {
    values.for_each(|value| bytes.extend(value.encode().as_ref()));
}

/// The content of the file of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KymographData {
    /// Time t* of every row.
    pub time_star: Vec<f64>,
    /// Places where the first bin begins and the last one ends, in m.
    pub places: [f64; 2],
    /// Share of the blocks in contact that slide, for every bin, row after row; NaN for a bin without
    /// contact.
    pub sliding_share: Vec<f32>,
}

impl KymographData {
    /// The content of the file of this run.
    pub fn new(kymograph: &Kymograph, case: &Case) -> Self {
        let bins = PositionBins::new(&case.model.lattice, &case.model.drive);
        let (steps, shares): (Vec<f64>, Vec<Vec<f32>>) = kymograph.rows().unzip();
        let (size, half) = (
            case.scales.block_size,
            0.5 * bins.width as f64 * case.scales.block_size,
        );
        let [first, last] = [0, bins.count - 1].map(|bin| bins.middle(bin) * size);
        Self {
            time_star: steps.iter().map(|step| step * case.time_plan.dt_star).collect(),
            places: [first - half, last + half],
            sliding_share: shares.into_iter().flatten().collect(),
        }
    }

    /// Number of bins.
    pub fn columns(&self) -> usize {
        self.sliding_share
            .len()
            .checked_div(self.time_star.len())
            .unwrap_or(0)
    }
}

/// Reads the file of a run.
pub fn read_kymograph<'f>(file: impl Into<RunFile<'f>>) -> Result<KymographData, FieldsError> {
    open(&file.into(), read)
}

fn read(file: &mut NetCdf3Reader<'_>) -> Result<KymographData, NetCdfError> {
    for (name, most) in [(TIME, Kymograph::MAX_ROWS), (PLACE, PositionBins::MAX)] {
        let length = file.dimension(name)?;
        if !(1..=most).contains(&length) {
            return broken(format!(
                "`{name}` has the length {length} where 1 to {most} are wanted"
            ));
        }
    }
    let time_star = file.values(TIME_STAR, &[TIME], 0, WHOLE)?;
    let middles = file.values(PLACE, &[PLACE], 0, WHOLE)?;
    let width = match file.attribute(BIN_WIDTH)? {
        [width] if width.is_finite() && *width > 0.0 => *width,
        _ => return broken(format!("the attribute `{BIN_WIDTH}` is no length")),
    };
    let is_rising = |values: &[f64]| values.iter().all(|value| value.is_finite()) && values.is_sorted();
    if !is_rising(&time_star) || !is_rising(&middles) {
        return broken(format!("`{TIME_STAR}` or `{PLACE}` does not rise"));
    }
    let shares = file.values(SLIDING, &[TIME, PLACE], 0, WHOLE)?;
    if shares
        .iter()
        .any(|share| !share.is_nan() && !(0.0..=1.0).contains(share))
    {
        return broken(format!("`{SLIDING}` is no share"));
    }
    let [first, last] = [middles.first(), middles.last()].map(|middle| middle.copied().unwrap_or_default());
    Ok(KymographData {
        time_star,
        places: [first - 0.5 * width, last + 0.5 * width],
        sliding_share: shares.into_iter().map(|share| share as f32).collect(),
    })
}
