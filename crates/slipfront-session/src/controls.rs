//! Quantities that the page offers to change, as dimensionless groups and in units.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use serde_json::Value;
use slipfront_base::ordered::map_of;
use slipfront_case::case::Case;

/// A quantity with a slider.
#[derive(Debug, Serialize)]
pub(crate) struct Control {
    id: &'static str,
    /// The key that holds the quantity as a number.
    key: &'static str,
    /// The key that holds the quantity with its unit, if there is one.
    si_key: Option<&'static str>,
    unit: &'static str,
    /// The range of the slider, of the number where it has one; the key may hold more.
    min: f64,
    max: f64,
    logarithmic: bool,
    whole: bool,
}

/// A quantity as a dimensionless group and with its unit.
#[derive(Debug, Serialize)]
pub(crate) struct ControlValue {
    pub(crate) star: f64,
    pub(crate) si: Option<f64>,
}

const fn group(id: &'static str, key: &'static str, [min, max]: [f64; 2]) -> Control {
    Control {
        id,
        key,
        si_key: None,
        unit: "",
        min,
        max,
        logarithmic: false,
        whole: false,
    }
}

/// The quantities with a slider.
pub(crate) static CONTROLS: [Control; 8] = [
    Control {
        si_key: Some("drive.speed"),
        unit: "m/s",
        logarithmic: true,
        ..group("speed", "drive.v_star", [0.003, 0.3])
    },
    Control {
        si_key: Some("load.pressure"),
        unit: "Pa",
        logarithmic: true,
        ..group("load", "load.pressure", [1e3, 1e8])
    },
    group("r_star", "friction.r_star", [0.0, 1.0]),
    Control {
        si_key: Some("slider.damping_rate"),
        unit: "1/s",
        logarithmic: true,
        ..group("omega_star", "slider.omega_star", [0.01, 2.0])
    },
    group("sigma", "friction.sigma_static_star", [0.0, 0.3]),
    group("sigma_kinetic", "friction.sigma_kinetic_star", [0.0, 0.3]),
    Control {
        whole: true,
        ..group("seed", "friction.seed", [0.0, 100.0])
    },
    Control {
        unit: "\u{b0}",
        ..group("direction", "drive.direction", [-180.0, 180.0])
    },
];

/// Values in a case of the quantities with a slider, by their ids.
pub(crate) fn values(case: &Case) -> BTreeMap<&'static str, ControlValue> {
    let (groups, scales, file) = (&case.groups, &case.scales, &case.file);
    let value = |star, si| ControlValue { star, si };
    map_of([
        (
            "speed",
            value(groups.v_star, Some(groups.v_star * scales.speed())),
        ),
        ("load", value(groups.epsilon, Some(scales.pressure))),
        ("r_star", value(groups.r_star, None)),
        (
            "omega_star",
            value(groups.omega_star, Some(scales.damping_rate(groups.omega_star))),
        ),
        ("sigma", value(groups.sigma_static_star, None)),
        ("sigma_kinetic", value(groups.sigma_kinetic_star, None)),
        ("seed", value(file.friction.seed as f64, None)),
        ("direction", value(file.drive.direction, None)),
    ])
}

/// Change of a quantity for its effect on static friction: share of the range of a linear slider, and share
/// of the value of a logarithmic one.
const CHANGE: [f64; 2] = [0.05, 0.1];

/// Two values of the quantity of a slider.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct TwoValues {
    pub(crate) control: String,
    pub(crate) key: String,
    /// The present value and the other one, in the unit of the slider.
    pub(crate) values: [f64; 2],
    /// Both values, as the key takes them.
    pub(crate) set_to: [Value; 2],
}

/// Returns the present value of the quantity of a slider, and one that is larger: by a tenth, or by a
/// twentieth of the range for a linear slider. It is smaller instead if the range ends before that.
///
/// # Errors
/// A sentence, if there is no such quantity, or it is an integer such as the seed.
pub(crate) fn two_values(case: &Case, id: &str) -> Result<TwoValues, String> {
    let control = CONTROLS.iter().find(|control| control.id == id && !control.whole);
    let control =
        control.ok_or_else(|| format!("there is no slider {id:?} with a quantity that changes friction"))?;
    let has_unit = control.si_key == Some(control.key);
    let present = &values(case)[control.id];
    let value = match present.si {
        Some(si) if has_unit => si,
        _ => present.star,
    };
    let [of_range, of_value] = CHANGE;
    let change = match control.logarithmic {
        true => of_value * value,
        false => of_range * (control.max - control.min),
    };
    let other = if value + change <= control.max {
        value + change
    } else {
        value - change
    };
    let set = |value: f64| match has_unit {
        true => Value::from(format!("{value} {}", control.unit)),
        false => Value::from(value),
    };
    Ok(TwoValues {
        control: control.id.to_owned(),
        key: control.key.to_owned(),
        values: [value, other],
        set_to: [value, other].map(set),
    })
}
