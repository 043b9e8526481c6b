//! `[initial]`: the state in which a run begins.

use serde::{Deserialize, Serialize};

use super::check::{Check, Checked};
use super::error::CaseError;
use super::friction::ContactModel;
use super::key::{ARRAY, KeyKind, above, key, quantity};
use crate::key_rows;
use crate::quantity::{Length, Speed};

key_rows! {
    /// `[initial]`: displacements and velocities at the start, unless the blocks begin at rest at their rest
    /// sites.
    #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    pub struct Initial checked {
        /// Final state of another run, `state.npy` in its folder, instead of the files below. That run needs
        /// `output.final_state` and the same number of blocks. The drive continues from its position.
        pub state_file: Option<String> = key("", KeyKind::File(&["npy"])),
        /// Displacements along x at t = 0, block by block.
        pub displacement_x: Option<String> = key("", ARRAY).without("0"),
        /// Displacements along y at t = 0, block by block.
        pub displacement_y: Option<String> = key("", ARRAY).without("0"),
        /// Displacement of a value of 1 in these files.
        pub displacement_unit: Option<Length> = key("", quantity("m", above(0.0, 1e9)))
            .without("that of u\\*, P mu_s l^2/(E h)"),
        /// Velocities along x half a step before t = 0, block by block.
        pub velocity_x: Option<String> = key("", ARRAY).without("0"),
        /// Velocities along y half a step before t = 0, block by block.
        pub velocity_y: Option<String> = key("", ARRAY).without("0"),
        /// Velocity of a value of 1 in these files.
        pub velocity_unit: Option<Speed> = key("", quantity("m/s", above(0.0, 1e9)))
            .without("that of V\\*, P mu_s l/(h sqrt(E rho))"),
    }
}

impl Initial {
    /// Whether no key is given.
    pub(super) fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether no file is given, so that the blocks begin at rest at their rest sites.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.state_file.is_none() && self.files().into_iter().flatten().all(|(_, name)| name.is_none())
    }

    /// The files of displacements and of velocities, along x and y, with their keys.
    pub(crate) fn files(&self) -> [[(&'static str, &Option<String>); 2]; 2] {
        [
            [
                ("displacement_x", &self.displacement_x),
                ("displacement_y", &self.displacement_y),
            ],
            [("velocity_x", &self.velocity_x), ("velocity_y", &self.velocity_y)],
        ]
    }

    pub(super) fn check(&self, check: &Check, contact: ContactModel) -> Result<(), CaseError> {
        self.check_values(check)?;
        let units = [
            ("displacement_unit", self.displacement_unit.is_some()),
            ("velocity_unit", self.velocity_unit.is_some()),
        ];
        for (files, (unit, has_unit)) in self.files().into_iter().zip(units) {
            if has_unit && files.iter().all(|(_, name)| name.is_none()) {
                let [(x, _), (y, _)] = files;
                return check.refuse(unit, |key| {
                    format!("`{key}` is not read: it belongs to `initial.{x}` and `initial.{y}`; give one of them, or leave it out")
                });
            }
        }
        let [displacements, velocities] = self.files().map(|files| {
            let given = files.into_iter().find(|(_, name)| name.is_some());
            given.map(|(key, _)| key)
        });
        let state = self.state_file.as_ref().map(|_| "state_file");
        if let Some(key) = state.and(displacements.or(velocities)) {
            return check.refuse(key, |key| {
                format!("`{key}` cannot be combined with `initial.state_file`, which has displacements and velocities: leave one of them out")
            });
        }
        if contact == ContactModel::Springs
            && let Some(key) = displacements.or(state)
        {
            return check.refuse(key, |key| {
                format!("`{key}` cannot be combined with `friction.contact` = \"springs\": the attachment points of the springs of displaced blocks are unknown; leave it out, or use \"rigid\"")
            });
        }
        Ok(())
    }
}
