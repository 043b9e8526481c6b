//! What the quantities of a case and of its summary are called along an axis.

/// What a key stands for: its key in a case file or a summary, words, symbol, unit.
type Name = (&'static str, &'static str, &'static str, &'static str);

/// Subscripts are Unicode's subscript letters.
#[rustfmt::skip]
const NAMES: [Name; 52] = [
    ("static_friction_star", "static friction", "\u{3bc}\u{209b}*", ""),
    ("static_friction", "static friction coefficient", "\u{3bc}\u{209b}", ""),
    ("static_reduction_percent", "reduction of \u{3bc}\u{209b}*", "", "%"),
    ("kinetic_friction_star", "kinetic friction", "\u{3bc}\u{2096}*", ""),
    ("kinetic_friction_star_uncertainty", "standard error of \u{3bc}\u{2096}*", "", ""),
    ("kinetic_friction", "kinetic friction coefficient", "\u{3bc}\u{2096}", ""),
    ("onset_time_star", "onset time", "t\u{209b}*", ""),
    ("onset_time_s", "onset time", "t\u{209b}", "s"),
    ("first_slip_time_star", "time of first slip", "t*", ""),
    ("first_slip_time_s", "time of first slip", "t", "s"),
    ("sliding_percent_kinetic", "mean sliding in kinetic friction", "N*", "%"),
    ("sliding_percent_max", "largest sliding", "N*", "%"),
    ("mu_star_max", "largest friction", "\u{3bc}*", ""),
    ("v_star", "drive speed", "V*", ""),
    ("drive.v_star", "drive speed", "V*", ""),
    ("drive.speed", "drive speed", "V", "m/s"),
    ("drive.direction", "direction of the drive", "\u{3b8}", "\u{b0}"),
    ("r_star", "friction ratio", "R*", ""),
    ("friction.r_star", "friction ratio", "R*", ""),
    ("omega_star", "damping", "\u{3a9}*", ""),
    ("slider.omega_star", "damping", "\u{3a9}*", ""),
    ("slider.damping_rate", "damping", "\u{3a9}", "1/s"),
    ("sigma_static_star", "spread of static coefficients", "\u{3c3}\u{209b}*", ""),
    ("friction.sigma_static_star", "spread of static coefficients", "\u{3c3}\u{209b}*", ""),
    ("sigma_kinetic_star", "spread of kinetic coefficients", "\u{3c3}\u{2096}*", ""),
    ("friction.sigma_kinetic_star", "spread of kinetic coefficients", "\u{3c3}\u{2096}*", ""),
    ("friction.mu_static", "mean static coefficient", "\u{3bc}\u{209b}", ""),
    ("friction.mu_kinetic", "mean kinetic coefficient", "\u{3bc}\u{2096}", ""),
    ("friction.seed", "seed", "", ""),
    ("seed", "seed", "", ""),
    ("epsilon", "load", "\u{3b5}", ""),
    ("load.pressure", "pressure", "P", "Pa"),
    ("n_blocks", "number of blocks", "N", ""),
    ("slider.blocks", "blocks along a side", "", ""),
    ("slider.block_size", "block size", "l", "m"),
    ("slider.young_modulus", "Young's modulus", "E", "Pa"),
    ("slider.density", "density", "\u{3c1}", "kg/m\u{b3}"),
    ("texture_percent", "texture coverage", "A*", "%"),
    ("texture_percent_asked", "texture coverage asked for", "A*", "%"),
    ("texture.coverage", "texture coverage", "A*", "%"),
    ("texture.s", "cavity shape", "s", ""),
    ("texture.w", "cavity shape", "w", ""),
    ("texture.lambda", "cavity size", "\u{3bb}", "m"),
    ("texture.width", "groove width", "", "m"),
    ("texture.offset", "groove offset", "", "m"),
    ("texture.rotate", "rotation of the texture", "", "\u{b0}"),
    ("time.duration_star", "duration", "t*", ""),
    ("time.duration", "duration", "t", "s"),
    ("dt_star", "time step", "\u{394}t*", ""),
    ("time.step", "time step", "\u{394}t*", ""),
    ("steps", "steps", "", ""),
    ("energy_error", "relative error of energy", "", ""),
];

/// The title of an axis for a key of a case file or a summary: words, symbol, unit.
///
/// Quantities that a case file writes with a unit are taken to be in SI units. The second and further textures
/// are numbered. A key without a title is shown as it is.
///
/// ```
/// use slipfront_plot::title;
///
/// assert_eq!(title("drive.v_star"), "drive speed V*");
/// assert_eq!(title("texture.0.coverage"), "texture coverage A* (%)");
/// assert_eq!(title("my_own_axis"), "my_own_axis");
/// ```
pub fn title(key: &str) -> String {
    let Some(((_, words, symbol, unit), texture)) = name(key) else {
        return key.to_string();
    };
    let mut title = words.to_string();
    if !symbol.is_empty() {
        title = format!("{title} {symbol}");
    }
    if let Some(texture) = texture {
        title = format!("{title} of texture {texture}");
    }
    if !unit.is_empty() {
        title = format!("{title} ({unit})");
    }
    title
}

/// What a legend calls a key: its symbol if it has one, else what [`title`] says.
///
/// ```
/// use slipfront_plot::symbol;
///
/// assert_eq!(symbol("slider.omega_star"), "\u{3a9}*");
/// assert_eq!(symbol("texture.0.coverage"), "A* (%)");
/// assert_eq!(symbol("shape"), "shape");
/// ```
pub fn symbol(key: &str) -> String {
    match name(key) {
        Some(((_, _, symbol, ""), None)) if !symbol.is_empty() => symbol.to_string(),
        Some(((_, _, symbol, unit), None)) if !symbol.is_empty() => format!("{symbol} ({unit})"),
        _ => title(key),
    }
}

/// The names of a key, and the number of its texture if there must be several.
fn name(key: &str) -> Option<(&'static Name, Option<usize>)> {
    let listed = |key: &str| NAMES.iter().find(|name| name.0 == key);
    let Some((index, rest)) = key
        .strip_prefix("texture.")
        .and_then(|rest| rest.split_once('.'))
        .and_then(|(index, rest)| Some((index.parse::<usize>().ok()?, rest)))
    else {
        return Some((listed(key)?, None));
    };
    let number = (index > 0).then(|| index.saturating_add(1));
    Some((listed(&format!("texture.{rest}"))?, number))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Text;

    #[test]
    fn every_key_has_one_title_that_the_font_can_write() {
        for (index, name) in NAMES.iter().enumerate() {
            assert!(NAMES[..index].iter().all(|other| other.0 != name.0), "{}", name.0);
            // A character of unknown width is taken to be as wide as the font is high.
            for run in Text::plain(&title(name.0), 100).runs {
                let widths = run.text.chars().map(crate::font::advance);
                assert!(widths.fold(0.0, f64::max) < 0.99, "{}", title(name.0));
            }
        }
    }

    #[test]
    fn textures_after_the_first_are_numbered() {
        assert_eq!(title("texture.0.w"), "cavity shape w");
        assert_eq!(
            title("texture.1.coverage"),
            "texture coverage A* of texture 2 (%)"
        );
        assert_eq!(symbol("texture.1.w"), "cavity shape w of texture 2");
        assert_eq!(title("texture.0.unknown"), "texture.0.unknown");
        assert_eq!(
            title("texture.18446744073709551615.w"),
            "cavity shape w of texture 18446744073709551615"
        );
    }

    #[test]
    fn a_legend_shows_the_symbol() {
        assert_eq!(symbol("friction.sigma_static_star"), "\u{3c3}\u{209b}*");
        assert_eq!(symbol("slider.blocks"), "blocks along a side");
    }
}
