//! The law of friction of a case.

use slipfront::{Ageing, ContactSprings, Coulomb, Friction, FrictionLaw, RateAndState, Weakening};

use super::groups::Groups;
use crate::case_file::{CaseFile, Law};

/// The law that a case file asks for; its keys fit each other.
pub(super) fn law(file: &CaseFile, groups: &Groups) -> Friction {
    let keys = &file.friction;
    if let Some(stiffness) = keys.contact_stiffness_star {
        return Friction::ContactSprings(ContactSprings {
            stiffness,
            redraw: keys.redraw.then_some(keys.seed),
        });
    }
    let reading = match keys.law {
        Law::Projection => FrictionLaw::Projection,
        Law::Reversal => FrictionLaw::Reversal,
        Law::Literal => FrictionLaw::Literal,
        Law::RateAndState => return Friction::RateAndState(rate_and_state(file, groups)),
    };
    Friction::Coulomb(Coulomb {
        law: reading,
        weakening: keys.velocity.map(|velocity| Weakening {
            critical_speed: velocity.v_c_star,
            ratio: velocity.ratio,
        }),
        ageing: keys.ageing.map(|ageing| Ageing {
            beta: ageing.beta,
            time: ageing.time_star,
        }),
    })
}

/// Coefficients over `mu_static`. The file has the keys without a default, or it would not have been read.
fn rate_and_state(file: &CaseFile, groups: &Groups) -> RateAndState {
    let keys = &file.friction;
    let given = |key: Option<f64>| key.unwrap_or(f64::NAN);
    let (d_c, v_0) = (given(keys.d_c_star), given(keys.v_0_star));
    RateAndState {
        a: given(keys.a) / keys.mu_static,
        b: given(keys.b) / keys.mu_static,
        d_c,
        v_0,
        mu_0: keys.mu_0.map_or(1.0, |mu_0| mu_0 / keys.mu_static),
        theta_0: keys.theta_0_star.unwrap_or(d_c / v_0),
        slip_speed: keys.slip_speed_star.unwrap_or(0.1 * groups.v_star),
    }
}
