//! Every dimension, attribute and variable of a fields file.

use slipfront::observe::Field;
use slipfront_case::field_info::field_info;

use super::frame::*;
use super::netcdf3::ExternalType;
use super::netcdf3_header::{Attribute, Definition, Variable};

/// The dimensions, in the order of the header.
const DIMENSIONS: [&str; 4] = [Y, X, TIME, LABEL_LENGTH];

/// The definition of a fields file.
///
/// Missing values are NaN, which every reader knows, so there is no `_FillValue`. The coordinates x and y
/// have no `axis` attribute, because ParaView would take them for longitude and latitude.
pub(super) fn define(file: &FieldsFile) -> Definition {
    let mut variables = statics();
    // A record dimension without records makes ParaView crash.
    let has_records = !file.frames.is_empty();
    if has_records {
        variables.extend(of_time(file.names));
    }
    let lengths = [file.kept_rows(), file.kept_columns(), 0, file.label_length()];
    let dimensions = DIMENSIONS.into_iter().zip(lengths);
    Definition {
        records: file.frames.len(),
        dimensions: dimensions.take(if has_records { 4 } else { 2 }).collect(),
        attributes: vec![
            Attribute::text("Conventions", "CF-1.8"),
            Attribute::text("title", "Fields of a spring-block model of friction"),
            Attribute::text("source", concat!("slipfront ", env!("CARGO_PKG_VERSION"))),
            Attribute::numbers(BLOCKS, &[file.nx as i32, file.ny as i32]),
            Attribute::numbers(STRIDE, &[file.stride as i32]),
            Attribute::numbers(BLOCK_SIZE, &[file.block_size]),
            Attribute::numbers(TIME_UNIT, &[file.time_unit_s]),
        ],
        variables,
    }
}

/// Variables that never change.
fn statics() -> Vec<Variable> {
    let flags = [
        Attribute::numbers("flag_values", &[0i16, 1]),
        Attribute::text("flag_meanings", "contact cavity"),
    ];
    let blanks = [Attribute::text("comment", "NaN where a block never slips")];
    let coefficient = |name, long_name| variable(name, &[Y, X], ExternalType::Double, long_name, "1", []);
    vec![
        variable(Y, &[Y], ExternalType::Double, "y of the block centre", "m", []),
        variable(X, &[X], ExternalType::Double, "x of the block centre", "m", []),
        variable(TEXTURED, &[Y, X], ExternalType::Short, "texture", "1", flags),
        coefficient(MU_STATIC, "static friction coefficient"),
        coefficient(MU_KINETIC, "kinetic friction coefficient"),
        variable(
            FIRST_SLIP,
            &[Y, X],
            ExternalType::Double,
            "time t* of the first slip",
            "1",
            blanks,
        ),
    ]
}

/// Variables of every record: those of the instant itself, then the fields.
fn of_time(names: &[Field]) -> Vec<Variable> {
    let axis = [Attribute::text("axis", "T")];
    let of_instant = |name, long_name| variable(name, &[TIME], ExternalType::Double, long_name, "1", []);
    let mut variables = vec![
        variable(
            TIME,
            &[TIME],
            ExternalType::Double,
            "time since the start of the drive",
            "s",
            axis,
        ),
        of_instant(TIME_STAR, "dimensionless time t*"),
        of_instant(STEP, "number of the time step"),
        Variable {
            name: LABEL,
            dimensions: indices(&[TIME, LABEL_LENGTH]),
            kind: ExternalType::Char,
            attributes: vec![Attribute::text("long_name", "name of the instant")],
        },
    ];
    variables.extend(names.iter().map(|&field| {
        let info = field_info(field);
        let mut attributes = vec![Attribute::text("coordinates", "time_star instant")];
        match field {
            Field::Traction => attributes.push(Attribute::text("comment", "NaN in cavities")),
            Field::Sliding => {
                attributes.push(Attribute::numbers("flag_values", &[0.0f32, 1.0]));
                attributes.push(Attribute::text("flag_meanings", "stuck sliding"));
            }
            _ => {}
        }
        variable(
            info.name,
            &[TIME, Y, X],
            ExternalType::Float,
            info.long_name,
            info.unit,
            attributes,
        )
    }));
    variables
}

fn variable(
    name: &'static str,
    dimensions: &[&str],
    kind: ExternalType,
    long_name: &str,
    units: &str,
    attributes: impl IntoIterator<Item = Attribute>,
) -> Variable {
    let named = [
        Attribute::text("long_name", long_name),
        Attribute::text("units", units),
    ];
    Variable {
        name,
        dimensions: indices(dimensions),
        kind,
        attributes: named.into_iter().chain(attributes).collect(),
    }
}

fn indices(dimensions: &[&str]) -> Vec<usize> {
    let index = |name: &&str| DIMENSIONS.iter().position(|known| known == name);
    dimensions.iter().filter_map(index).collect()
}
