//! Pictures from the files of a run folder.

use slipfront_plot::PictureLook;
use slipfront_run::pictures::draw;
use slipfront_run::pictures::friction::{Against, AxisUnits, FrictionLook, overlay};
use slipfront_run::run_files::RunFiles;
use slipfront_run::summary::summary_json;

use super::json::summary;
use super::{fields, series};
use crate::checks::readable;
use crate::scratch;
use crate::target::{Memory, Target, Time};

/// Summary, series, both tables of events of slip, and fields of a run in one input, separated by [`END`];
/// the case is one of two, by the length of the input.
pub(crate) const PLOT: Target = Target {
    name: "plot",
    check: plot,
    generated,
    files: &[],
    dictionary: Some("plot.dict"),
    max_bytes: 16384,
    // Canvas and pixels of two pictures: see `pictures/` of slipfront-run.
    memory: Memory {
        bytes: 256 << 20,
        per_byte: 1024,
    },
    // Drawing takes the most.
    time: Time::DRAWN,
    mutations: 5,
    repetitions: 0,
    long: Vec::new,
};

/// A slider that is driven as a whole, and a chain that is pushed at its end.
const CASES: [&str; 2] = [
    "",
    "slider.blocks = [12, 1]\ndrive.attach = 'left'\nfriction = { sigma_static_star = 0, sigma_kinetic_star = 0 }",
];

const END: &[u8] = b"\n==\n";

fn generated() -> Vec<Vec<u8>> {
    let whole = |summary: &str, series: Vec<u8>, fields: Vec<u8>| {
        let (precursors, events) = (series::precursors_csv(3), series::events_csv(3));
        [summary.as_bytes(), &series, &precursors, &events, &fields].join(END)
    };
    let plain = summary_json(&summary());
    let mut seeds = vec![
        whole(&plain, series::csv(3), fields::file([4, 3], 1, 2, 1e-6)),
        whole(&plain, series::csv(1), fields::file([3, 2], 1, 0, 1e-6)),
    ];
    // Values near the limits of what a float can represent.
    for (odd, block_size) in [
        ("1e99", 5e-324),
        ("1e308", 9e8),
        ("5e-324", 1e-308),
        ("-1e300", 1e-150),
    ] {
        let numbers = plain
            .replace(": 0.5", &format!(": {odd}"))
            .replace(": 30.5", &format!(": {odd}"));
        let rows = String::from_utf8(series::csv(3))
            .unwrap()
            .replace("16.0", odd)
            .replace("0.3,", &format!("{odd},"));
        seeds.push(whole(
            &numbers,
            rows.into_bytes(),
            fields::file([4, 3], 1, 2, block_size),
        ));
    }
    seeds
}

fn plot(input: &[u8]) {
    let mut rest = input;
    for name in ["summary.json", "series.csv", "precursors.csv", "events.csv"] {
        let end = rest.windows(END.len()).position(|bytes| bytes == END);
        let at = end.unwrap_or(rest.len());
        scratch::file(&format!("plot/{name}"), &rest[..at]);
        rest = &rest[(at + END.len()).min(rest.len())..];
    }
    let fields = scratch::file("plot/fields.nc", rest);
    let folder = fields.parent().unwrap();
    let case = CASES[input.len() / 2 % 2];
    scratch::file("plot/case.toml", case.as_bytes());
    match draw(RunFiles::Folder(folder), &PictureLook::default()) {
        Err(error) => readable(&error),
        Ok(pictures) => {
            for (name, picture) in pictures {
                assert!(
                    picture.svg.ends_with("</svg>\n") || picture.svg.ends_with("</svg>"),
                    "{name}"
                );
                let odd = tags(&picture.svg).find(|tag| tag.contains("NaN") || tag.contains("inf"));
                assert!(
                    odd.is_none(),
                    "{name}.svg has a number that is not finite: {odd:?}"
                );
            }
            if input.len() % 2 == 1 {
                let (one, two) = ([folder.to_owned()], [folder.to_owned(), folder.to_owned()]);
                overlay(&two, AxisUnits::Star, None, &FrictionLook::default()).unwrap();
                for against in [Against::Time, Against::Displacement] {
                    for units in [AxisUnits::Star, AxisUnits::Si] {
                        // A summary may lack its units.
                        if let Err(error) = overlay(&one, units, Some(against), &FrictionLook::default()) {
                            readable(&error);
                        }
                    }
                }
            }
        }
    }
}

/// The tags of a document except images, whose encoded bytes may contain any word.
fn tags(svg: &str) -> impl Iterator<Item = &str> {
    let tags = svg.split('<').filter_map(|piece| piece.split('>').next());
    tags.filter(|tag| !tag.starts_with("image"))
}
