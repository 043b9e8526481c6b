//! Names of the fields that a run records.

use serde::{Deserialize, Serialize};
use slipfront::observe::Field;

/// A field that changes with time, named as in `output.fields` of a case file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, PartialOrd, Ord)]
#[serde(rename_all = "snake_case")]
pub enum FieldName {
    /// Contact stress over its maximum.
    ContactStressStar,
    /// Friction force over the block's area, in Pa; NaN in cavities.
    Traction,
    /// Displacement along x, in m.
    DisplacementX,
    /// Displacement along y, in m.
    DisplacementY,
    /// Velocity along x, in m/s.
    VelocityX,
    /// Velocity along y, in m/s.
    VelocityY,
    /// 1 where the block slides, 0 where it sticks.
    Sliding,
}

impl FieldName {
    /// Every field, in the order of the documentation.
    pub const ALL: [FieldName; 7] = [
        FieldName::ContactStressStar,
        FieldName::Traction,
        FieldName::DisplacementX,
        FieldName::DisplacementY,
        FieldName::VelocityX,
        FieldName::VelocityY,
        FieldName::Sliding,
    ];

    /// The name in the case file and in `fields.nc`.
    pub fn as_str(self) -> &'static str {
        match self {
            FieldName::ContactStressStar => "contact_stress_star",
            FieldName::Traction => "traction",
            FieldName::DisplacementX => "displacement_x",
            FieldName::DisplacementY => "displacement_y",
            FieldName::VelocityX => "velocity_x",
            FieldName::VelocityY => "velocity_y",
            FieldName::Sliding => "sliding",
        }
    }

    /// What is observed in a run to fill it.
    pub fn observed(self) -> Field {
        match self {
            FieldName::ContactStressStar => Field::ContactStress,
            FieldName::Traction => Field::Traction,
            FieldName::DisplacementX => Field::DisplacementX,
            FieldName::DisplacementY => Field::DisplacementY,
            FieldName::VelocityX => Field::VelocityX,
            FieldName::VelocityY => Field::VelocityY,
            FieldName::Sliding => Field::Sliding,
        }
    }

    /// The field of that name, if there is one.
    pub fn from_name(name: &str) -> Option<FieldName> {
        FieldName::ALL.into_iter().find(|field| field.as_str() == name)
    }

    /// The unit as CF writes it; `1` for a number without unit.
    pub fn unit(self) -> &'static str {
        match self {
            FieldName::ContactStressStar | FieldName::Sliding => "1",
            FieldName::Traction => "Pa",
            FieldName::DisplacementX | FieldName::DisplacementY => "m",
            FieldName::VelocityX | FieldName::VelocityY => "m s-1",
        }
    }

    /// What the field is, for the axis of a picture.
    pub fn long_name(self) -> &'static str {
        match self {
            FieldName::ContactStressStar => "contact stress over its maximum",
            FieldName::Traction => "friction force over block area",
            FieldName::DisplacementX => "displacement along x from rest",
            FieldName::DisplacementY => "displacement along y from rest",
            FieldName::VelocityX => "velocity along x",
            FieldName::VelocityY => "velocity along y",
            FieldName::Sliding => "state of the block",
        }
    }
}
