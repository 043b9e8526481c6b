//! Every dimension, attribute and variable of a fields file.

use slipfront::observe::Field;
use slipfront_case::field_info::field_info;

use super::frame::*;
use super::netcdf3::ExternalType;
use super::netcdf3_header::{Attribute, Definition, Variable};

/// The definition of a fields file.
///
/// Missing values are NaN, which every reader knows, so there is no `_FillValue`. The coordinates x and y
/// have no `axis` attribute, because ParaView would take them for longitude and latitude.
pub(super) fn define(file: &FieldsData) -> Definition {
    let mut dimensions = vec![(Y, file.rows()), (X, file.columns())];
    let mut variables = statics();
    // A record dimension without records makes ParaView crash.
    if !file.frames.is_empty() {
        dimensions.extend([(TIME, 0), (LABEL_LENGTH, file.label_length())]);
        variables.extend(of_time(&file.names));
    }
    Definition {
        records: file.frames.len(),
        dimensions,
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
    vec![
        Variable::doubles(Y, &[Y], "y of the block centre", "m"),
        Variable::doubles(X, &[X], "x of the block centre", "m"),
        Variable::new(TEXTURED, &[Y, X], ExternalType::Short, "texture")
            .with_text("units", "1")
            .with("flag_values", &[0i16, 1])
            .with_text("flag_meanings", "contact cavity"),
        Variable::doubles(MU_STATIC, &[Y, X], "static friction coefficient", "1"),
        Variable::doubles(MU_KINETIC, &[Y, X], "kinetic friction coefficient", "1"),
        Variable::doubles(FIRST_SLIP, &[Y, X], "time t* of the first slip", "1")
            .with_text("comment", "NaN where a block never slips"),
    ]
}

/// Variables of every record: those of the instant itself, then the fields.
fn of_time(names: &[Field]) -> Vec<Variable> {
    let mut variables = vec![
        Variable::doubles(TIME, &[TIME], "time since the start of the drive", "s").with_text("axis", "T"),
        Variable::doubles(TIME_STAR, &[TIME], "dimensionless time t*", "1"),
        Variable::doubles(STEP, &[TIME], "number of the time step", "1"),
        Variable::new(
            LABEL,
            &[TIME, LABEL_LENGTH],
            ExternalType::Char,
            "name of the instant",
        ),
    ];
    variables.extend(names.iter().map(|&field| {
        let info = field_info(field);
        let variable = Variable::new(info.name, &[TIME, Y, X], ExternalType::Float, info.long_name)
            .with_text("units", info.unit)
            .with_text("coordinates", "time_star instant");
        match field {
            Field::Traction => variable.with_text("comment", "NaN in cavities"),
            Field::Sliding => variable
                .with("flag_values", &[0.0f32, 1.0])
                .with_text("flag_meanings", "stuck sliding"),
            _ => variable,
        }
    }));
    variables
}
