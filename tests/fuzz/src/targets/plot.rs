//! Pictures from the files of a run folder.

use slipfront_case::results::{draw, draw_friction, summary_json};

use super::json::summary;
use super::{fields, series};
use crate::checks::readable;
use crate::{Memory, Target, scratch};

/// Summary, series and fields one after the other, each but the last ended by [`END`].
pub(crate) const PLOT: Target = Target {
    name: "plot",
    check: plot,
    made,
    files: &[],
    dictionary: Some("plot.dict"),
    longest: 16384,
    // Canvas and pixels of two pictures: see `budget.rs`.
    memory: Memory {
        bytes: 256 << 20,
        per_byte: 1024,
    },
    mutations: 10,
    repetitions: 0,
};

const END: &[u8] = b"\n==\n";

fn made() -> Vec<Vec<u8>> {
    let whole = |rows, fields: Vec<u8>| {
        let summary = summary_json(&summary()).into_bytes();
        [summary, END.to_vec(), series::csv(rows), END.to_vec(), fields].concat()
    };
    vec![
        whole(3, fields::file(4, 3, 1, 2)),
        whole(1, fields::file(3, 2, 1, 0)),
    ]
}

fn plot(input: &[u8]) {
    let mut rest = input;
    for name in ["summary.json", "series.csv"] {
        let end = rest.windows(END.len()).position(|bytes| bytes == END);
        let at = end.unwrap_or(rest.len());
        scratch::file(&format!("plot/{name}"), &rest[..at]);
        rest = &rest[(at + END.len()).min(rest.len())..];
    }
    let fields = scratch::file("plot/fields.nc", rest);
    let folder = fields.parent().unwrap();
    match draw(folder) {
        Err(error) => readable(&error),
        Ok(pictures) => {
            for (name, picture) in pictures {
                assert!(
                    picture.svg.ends_with("</svg>\n") || picture.svg.ends_with("</svg>"),
                    "{name}"
                );
                let odd = ["NaN", "inf"]
                    .into_iter()
                    .find(|word| number_of(&picture.svg, word));
                assert!(odd.is_none(), "{name}.svg has a number {odd:?}");
            }
            if input.len() % 2 == 1 {
                draw_friction(&[folder.to_owned(), folder.to_owned()]).unwrap();
            }
        }
    }
}

/// Whether a coordinate is this word.
fn number_of(svg: &str, word: &str) -> bool {
    svg.contains(&format!("\"{word}\""))
        || svg.contains(&format!("\"-{word}\""))
        || svg.contains(&format!(" {word} "))
}
