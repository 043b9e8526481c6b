//! The resolved physics of a case.

use slipfront::surface::Clearance;
use slipfront::{Face, Loading};
use slipfront_base::number_format::{count, four_digits, with_si_prefix};
use slipfront_case::case::{Case, Topography};
use slipfront_case::case_file::{
    Attached, AttachedEdge, AutoOrStiffness, DriveStiffness, Grade, Motion, Outline,
};

use crate::wrap::notes;

/// The resolved physics of a case, as a tree.
pub fn physics(case: &Case) -> String {
    let mut branches = vec![("slider", slider(case))];
    branches.extend(body(case).map(|body| ("body", body)));
    branches.extend([
        ("material", material(case)),
        ("load", load(case)),
        ("drive", drive(case)),
        ("friction", case.file.friction.in_words(&case.model.friction)),
        ("texture", texture(case)),
        ("time", time(case)),
    ]);
    let mut text = format!("{}\n", case.name);
    for (number, (name, value)) in branches.iter().enumerate() {
        let branch = if number + 1 < branches.len() {
            "\u{251c}\u{2500}"
        } else {
            "\u{2514}\u{2500}"
        };
        text += &format!("{branch} {name:<9} {value}\n");
    }
    text
}

fn slider(case: &Case) -> String {
    let lattice = &case.model.lattice;
    let [edges_x, edges_y] = lattice.edges.map(|edges| format!("{edges:?}").to_lowercase());
    let edges = if edges_x == edges_y {
        edges_x
    } else {
        format!("{edges_x} in x, {edges_y} in y")
    };
    let size = with_si_prefix(case.scales.block_size, "m");
    let (nx, ny) = (lattice.nx, lattice.ny);
    let blocks = if nx * ny == 1 { "block" } else { "blocks" };
    let file = &case.file.slider;
    let within = |outline: &str| format!("{} within {outline} on ", case.model.n_blocks());
    let outline = match (file.outline, &file.outline_file) {
        (Outline::Rectangle, _) => String::new(),
        (Outline::Mask, Some(name)) => within(name),
        (Outline::Disc | Outline::Mask, _) => within("a disc"),
    };
    let thickness = file.thickness.as_ref().map_or(String::new(), |thickness| {
        format!(", {} thick", with_si_prefix(thickness.si(), "m"))
    });
    format!("{outline}{nx} x {ny} {blocks} of {size}{thickness}, {edges} edges")
}

/// Height, Poisson's ratio and contact face of a bulk body.
fn body(case: &Case) -> Option<String> {
    let body = case.model.body()?;
    let height = if body.height.is_finite() {
        format!(
            "{} high",
            with_si_prefix(body.height * case.scales.block_size, "m")
        )
    } else {
        "deep".to_owned()
    };
    let face = match body.face {
        Face::Pressure => "under a prescribed pressure",
        Face::Flat => "held flat",
    };
    Some(format!(
        "{height}, nu = {}, its face {face}",
        four_digits(body.poisson)
    ))
}

/// Remark on a property of the material that is not uniform.
fn local(field: &Option<String>, grade: &Option<Grade>) -> String {
    match (field, grade) {
        (Some(file), _) => format!(" times {file}"),
        (None, Some(Grade { along, from, to })) => {
            let axis = format!("{along:?}").to_lowercase();
            format!(" times {from} to {to} along {axis}")
        }
        (None, None) => String::new(),
    }
}

fn material(case: &Case) -> String {
    let slider = &case.file.slider;
    let viscosity = if slider.viscosity_time_star > 0.0 {
        format!(", tau_v* = {}", four_digits(slider.viscosity_time_star))
    } else {
        String::new()
    };
    if slider.rigid {
        let scales = &case.scales;
        let mass = scales.density * scales.block_size.powi(2) * scales.thickness;
        return format!(
            "rigid, mass {}, Omega* = {}{viscosity}",
            with_si_prefix(1e3 * mass, "g"),
            four_digits(case.groups.omega_star)
        );
    }
    format!(
        "E = {}{}, rho = {} kg/m^3{}, Omega* = {}{viscosity}",
        with_si_prefix(case.scales.young_modulus, "Pa"),
        local(&slider.stiffness_field, &slider.stiffness_grade),
        four_digits(case.scales.density),
        local(&slider.density_field, &slider.density_grade),
        four_digits(case.groups.omega_star)
    )
}

fn load(case: &Case) -> String {
    let pressure = with_si_prefix(case.scales.pressure, "Pa");
    let within = case.load_distance().map_or(String::new(), |distance| {
        format!(
            ", load of textured blocks on blocks within {}",
            with_si_prefix(distance, "m")
        )
    });
    format!(
        "P = {pressure}, strain {:.2e}{within}{}",
        case.strain_of_load(),
        shear(case)
    )
}

/// The dead shear load, and its share of static friction.
fn shear(case: &Case) -> String {
    let [along, _] = case.model.mean_dead_load();
    let share = case.share_of_shear().map_or(String::new(), |share| {
        format!(
            ", {} % of the static friction of the blocks",
            four_digits(100.0 * share)
        )
    });
    if case.model.dead_load().acts() {
        let stress = with_si_prefix(along * case.scales.stress(), "Pa");
        format!(", shear {stress} (mu* = {}{share})", four_digits(along))
    } else {
        String::new()
    }
}

fn drive(case: &Case) -> String {
    let (keys, drive) = (&case.file.drive, &case.model.drive);
    let v_star = case.groups.v_star;
    let speed = format!(
        "V* = {} ({})",
        four_digits(v_star),
        with_si_prefix(v_star * case.scales.speed(), "m/s")
    );
    let segments = drive.program.as_ref().map(|program| program.segments().len());
    let speed = segments.map_or(speed.clone(), |count| {
        format!("a program of {count} speeds up to {speed}")
    });
    let motion = match keys.motion {
        Motion::Translation => format!("at {} degrees", keys.direction),
        Motion::Rotation => "at the largest radius, rotating about the centroid".to_owned(),
    };
    let at = match &keys.attached {
        Attached::At(AttachedEdge::All) => String::new(),
        Attached::At(edge) => format!(", attached at the {} edge", format!("{edge:?}").to_lowercase()),
        Attached::File(file) => format!(", attached by {file}"),
    };
    let (slider, k_drive) = (case.model.slider(), four_digits(drive.k_drive));
    let springs = slider.sum_of_drive_springs(&case.model.lattice);
    let stiffness = match (&keys.stiffness, &slider.stiffness) {
        (DriveStiffness::Each(AutoOrStiffness::Auto), _) => String::new(),
        (_, None) if springs == 1.0 => format!(", a spring of k_s* = {k_drive}"),
        (_, None) => format!(", {} springs of k_s* = {k_drive}", four_digits(springs)),
        (_, Some(_)) => format!(
            ", springs of k_s* = {k_drive} times the modulus of their blocks, {} together",
            four_digits(springs * drive.k_drive)
        ),
    };
    if case.model.rests_by_excess() {
        return format!("slow {motion}{stiffness}, in increments that become finer before the onset");
    }
    let held = if drive.is_held() {
        ", stopped while a block in contact slides"
    } else {
        ""
    };
    format!("{speed} {motion}{at}{stiffness}{held}")
}

/// Percentage of textured blocks, the requested percentage, and the roughness of height maps.
pub(crate) fn texture(case: &Case) -> String {
    if case.file.texture.is_empty() {
        return "none".to_owned();
    }
    let asked = case
        .texture
        .asked_percent
        .map_or(String::new(), |asked| format!(", {} % asked", four_digits(asked)));
    let topographies: String = case.texture.topographies.iter().map(topography).collect();
    format!(
        "{} % of the blocks{asked}{topographies}",
        four_digits(case.texture.meshed_percent)
    )
}

/// Size and roughness of a height map, and its height of contact.
fn topography(topography: &Topography) -> String {
    let in_metres = |length: f64| with_si_prefix(length, "m");
    let roughness = &topography.roughness;
    let of_shape = |name: &str, value: Option<f64>| {
        value.map_or(String::new(), |value| {
            format!(", {name} = {}", four_digits(value))
        })
    };
    format!(
        "; {} {} x {}: Sa = {}, Sq = {}{}{}, contact from {} up",
        topography.file,
        in_metres(topography.size[0]),
        in_metres(topography.size[1]),
        in_metres(roughness.sa),
        in_metres(roughness.sq),
        of_shape("Ssk", roughness.ssk),
        of_shape("Sku", roughness.sku),
        in_metres(topography.contact_height)
    )
}

/// The smallest lengths of the texture, each on its own line with remarks, and with the remarks `said` on a
/// file.
pub(crate) fn smallest(case: &Case, smallest: Clearance, said: &[String]) -> String {
    let mut lines = String::new();
    for (name, length) in [("feature", smallest.feature), ("gap", smallest.gap)] {
        let Some(blocks) = length else { continue };
        let length = with_si_prefix(blocks * case.scales.block_size, "m");
        lines += &format!("\nsmallest {name} {length}");
    }
    let warnings = case.too_coarse().into_iter().chain(said.iter().cloned());
    for note in notes(warnings).lines() {
        lines += &format!("\n{note}");
    }
    lines
}

fn time(case: &Case) -> String {
    let time_plan = &case.time_plan;
    let end_star = time_plan.end_star();
    let held = match time_plan.loading {
        Loading::Constant => String::new(),
        Loading::Held { .. } if case.model.rests_by_excess() => {
            return format!(
                "to the rest after each increment, in steps of dt* = {}",
                four_digits(time_plan.dt_star)
            );
        }
        Loading::Held { onset_steps } => format!(
            " of the drive, not counting steps in which it stops; mu_s* is the largest mu* up to t* = {} of the drive",
            four_digits(onset_steps as f64 * time_plan.dt_star)
        ),
    };
    format!(
        "to t* = {} ({}) in {} of dt* = {}",
        four_digits(end_star),
        with_si_prefix(end_star * case.scales.time(), "s"),
        count(time_plan.last_step as usize, "step"),
        four_digits(time_plan.dt_star)
    ) + &held
}
