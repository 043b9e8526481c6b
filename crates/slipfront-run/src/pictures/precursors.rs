//! The picture of the events of slip that precede the sliding of a slider driven at an edge.

use slipfront::exact_solutions::precursor_load;
use slipfront::{Edge, Edges};
use slipfront_case::case_file::{CaseFile, KineticFriction};
use slipfront_plot::{self as plot, Picture, PictureSize, Response, Responses};

use super::error::{RunPictureError, drawn};
use super::files::case_of;
use crate::observers::precursors::{FILE, PrecursorRow, read_csv};
use crate::run_files::RunFiles;

/// Draws the reach of the events of slip of a slider driven at an edge, against the load after them; none for
/// other runs. An event counts if it is longer than all earlier ones: a shorter one slips over a part that
/// has already slipped.
pub(super) fn of_run(run: RunFiles, size: PictureSize) -> Result<Option<Picture>, RunPictureError> {
    let Some(file) = run.found(FILE)? else {
        return Ok(None);
    };
    let mut longest = 0.0;
    let mut is_longer = |row: &PrecursorRow| {
        let is_longer = row.length > longest;
        longest = row.length.max(longest);
        is_longer
    };
    let rows = read_csv(file)?;
    let longer = rows.into_iter().filter(|row| is_longer(row));
    let points = longer.filter_map(|row| Some((row.friction_coefficient_after?, row.length)));
    let curve = |label: &str, points: Vec<(f64, f64)>, line: bool| {
        let (x, mean): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        Response {
            line,
            ..Response::of_values(label, &x, &mean)
        }
    };
    let mut curves = vec![curve("events", points.collect(), false)];
    let case = case_of(run)?;
    if let Some((mu_kinetic, slope)) = case.as_ref().and_then(equal_chain) {
        let lengths = (0..=100).map(|percent| f64::from(percent) / 100.0);
        let points = lengths.map(|length| (precursor_load(length, mu_kinetic, slope), length));
        curves.push(curve("exact", points.collect(), true));
    }
    let responses = Responses {
        x_title: "tangential/normal force F\u{209c}/F\u{2099} after the event".to_owned(),
        y_title: "relative length L\u{209a}/L".to_owned(),
        curves,
        ..Responses::default()
    };
    drawn("precursors", plot::response(&responses, size)).map(Some)
}

/// Kinetic coefficient and slope of the pressure from the driven end, for a chain of equal thresholds that is
/// pulled along its axis.
fn equal_chain(case: &CaseFile) -> Option<(f64, f64)> {
    let (slider, load, friction) = (&case.slider, &case.load, &case.friction);
    let edge = case.drive.edge()?;
    let axis = edge.axis();
    let is_chain = slider.blocks[1 - axis] == 1 && slider.edges[1 - axis] == Edges::Free;
    let is_pulled_along = case.drive.direction.rem_euclid(180.0) == [0.0, 90.0][axis];
    let is_equal = friction.sigma_static_star == 0.0
        && friction.sigma_kinetic_star == 0.0
        && friction.mu_static_field.is_none()
        && friction.mu_kinetic_field.is_none()
        && friction.adhesion_kinetic.si() == 0.0
        && load.pressure_field.is_none()
        && case.texture.is_empty();
    let slope = match &load.profile {
        None => 0.0,
        Some(profile) if profile.along as usize == axis => profile.relative_slope,
        Some(_) => return None,
    };
    let slope = match edge {
        Edge::Left | Edge::Bottom => slope,
        Edge::Right | Edge::Top => -slope,
    };
    let mu_kinetic = match friction.kinetic {
        KineticFriction::RStar(r_star) => r_star * friction.mu_static,
        KineticFriction::MuKinetic(mu_kinetic) => mu_kinetic,
    };
    (is_chain && is_pulled_along && is_equal).then_some((mu_kinetic, slope))
}
