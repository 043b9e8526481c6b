//! `report.html`: a single file that can be opened from disk, printed, and read on a phone.

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD as BASE64;
use horrorshow::helper::doctype;
use horrorshow::{Raw, Template, html};

use super::symbols::greek;
use crate::claims::{ClaimResult, ClaimVerdict, NUMBERING, REVISED};
use crate::figure_data::{FigureData, Panel, Table};
use crate::figures::{FIGURES, Figure};
use crate::paper::Paper;
use crate::step_rule::StepRule;
use slipfront_base::number_format::count;
use slipfront_plot::Picture;

const STYLE: &str = include_str!("style.css");

/// The whole page; `drawn` contains the pictures of each figure.
pub(super) fn page(paper: &Paper, drawn: &[Vec<Picture>]) -> String {
    let page = html! {
        : doctype::HTML;
        html(lang="en") {
            head {
                meta(charset="utf-8");
                meta(name="viewport", content="width=device-width, initial-scale=1");
                title : "The paper, run again";
                style : Raw(STYLE);
            }
            body {
                : header(paper);
                main {
                    section {
                        h2 : "Claims";
                        p {
                            : "Intervals are 95 % confidence intervals of the mean over random surfaces. Numbers D1 to D12 are \
                               the deviations from the printed paper; the documentation of the model explains them. ";
                            : NUMBERING; : " "; : REVISED;
                            @ if !paper.results_by_paper_step.is_empty() {
                                : " Each claim was measured twice: with "; : text(StepRule::Auto.formula());
                                : ", and with the paper's "; : text(StepRule::Paper.formula()); : " (Eq. 13).";
                            }
                        }
                        : claims_table(paper);
                    }
                    nav { h2 : "Figures"; ul { @ for (figure, _) in &paper.figures {
                        li { a(href=format_args!("#{}", figure.name)) : figure.title; }
                    } } }
                    @ for ((figure, data), pictures) in paper.figures.iter().zip(drawn) {
                        : section(paper, figure, data, pictures);
                    }
                }
            }
        }
    };
    written(page)
}

/// The text of a template.
fn written(template: impl Template) -> String {
    template.into_string().expect("writing to memory does not fail")
}

/// The title, the paper, and the number of claims that hold.
fn header(paper: &Paper) -> Raw<String> {
    let unexpected = paper.unexpected_verdicts().count();
    Raw(written(html! {
        header {
            h1 : "The paper, run again";
            p {
                : contents(paper); : " of "; cite : "2D Spring-block model to study the transition from static \
                to kinetic friction of complex-micro-textured contact surfaces"; : ", Tribology International 2023, ";
                a(href="https://doi.org/10.1016/j.triboint.2023.108866") : "doi 10.1016/j.triboint.2023.108866";
                : ", measured with slipfront "; : env!("CARGO_PKG_VERSION"); : ".";
            }
            p(class="count") {
                : paper.tally(); : ". ";
                @ if unexpected == 0 { : "Every verdict is as expected." }
                else { strong { : unexpected; : " verdicts are not as expected."; } }
            }
            @ if paper.reduced { p : "Reduced version: two random surfaces, one time step."; }
        }
    }))
}

/// The figures and claims of the report, in words.
fn contents(paper: &Paper) -> String {
    if paper.figures.len() == FIGURES.len() {
        return "Every figure and claim".to_owned();
    }
    let titles: Vec<&str> = paper
        .figures
        .iter()
        .map(|(figure, _)| figure.title.split(':').next().unwrap_or_default())
        .collect();
    format!(
        "{}, and {} about them,",
        titles.join(", "),
        count(paper.results.len(), "claim")
    )
}

fn claims_table(paper: &Paper) -> Raw<String> {
    let is_measured_twice = !paper.results_by_paper_step.is_empty();
    Raw(written(html! {
        table(class="claims") {
            thead { tr {
                th; th : "Claim"; th : "Verdict"; th : "Measured"; th : "Holds if";
                @ if is_measured_twice { th : "With the paper's step"; }
            } }
            tbody { @ for (k, result) in paper.results.iter().enumerate() {
                : claim_row(result, paper.results_by_paper_step.get(k));
            } }
        }
    }))
}

fn claim_row(result: &ClaimResult, other: Option<&ClaimResult>) -> Raw<String> {
    let claim = &result.claim;
    Raw(written(html! {
        tr(id=format_args!("claim-{}", claim.number)) {
            td(class="number") : claim.number;
            td {
                : text(&claim.claim); : " ";
                a(class="place", href=format_args!("#{}", claim.figure())) : &claim.place;
                @ if !claim.remark.is_empty() { p(class="remark") : text(&claim.remark); }
                @ if !claim.revised.is_empty() { p(class="remark") { : "Revised: "; : text(&claim.revised); } }
            }
            td(class=class(result.verdict)) {
                : text(&result.verdict_in_full());
                @ if !result.as_expected() { strong : " not as expected"; }
            }
            td(data-label="measured") { span(class="value") : result.measured(); : " "; span(class="what") : text(&claim.measured); }
            td(data-label="holds if") : claim.criterion();
            @ if let Some(other) = other {
                td(data-label="with the paper's step") {
                    span(class="value") : other.measured();
                    @ if other.verdict == result.verdict { : ", same verdict" }
                    else { strong { : ", "; : other.verdict.words(); } }
                }
            }
        }
    }))
}

/// Text with Greek letters in place of their names, and the characters after an underscore as subscripts.
fn text(text: &str) -> Raw<String> {
    let text = greek(text);
    let mut parts = text.split('_');
    let first = parts.next().unwrap_or_default();
    let parts =
        parts.map(|part| part.split_at(part.find(|c: char| !c.is_ascii_lowercase()).unwrap_or(part.len())));
    Raw(written(html! {
        : first;
        @ for (subscript, rest) in parts { sub : subscript; : rest; }
    }))
}

fn class(verdict: ClaimVerdict) -> &'static str {
    match verdict {
        ClaimVerdict::Holds => "verdict holds",
        ClaimVerdict::HoldsWithCondition => "verdict conditioned",
        ClaimVerdict::NotAsStated => "verdict restated",
        ClaimVerdict::Misprint => "verdict misprint",
        ClaimVerdict::DoesNotHold => "verdict fails",
    }
}

fn section(paper: &Paper, figure: &Figure, data: &FigureData, pictures: &[Picture]) -> Raw<String> {
    let of_figure = |result: &&ClaimResult| result.claim.figure() == figure.name;
    let claims: Vec<_> = paper.results.iter().filter(of_figure).collect();
    Raw(written(html! {
        section(id=figure.name) {
            h2 : figure.title;
            @ for (Panel { name, caption, .. }, picture) in data.panels.iter().zip(pictures) {
                figure {
                    img(
                        src=format_args!("data:image/png;base64,{}", BASE64.encode(&picture.png)),
                        alt=caption,
                        style=width(&picture.svg)
                    );
                    figcaption { : text(caption); : " Numbers: "; : name; : ".csv."; }
                }
            }
            @ for table in &data.tables { : plain_table(table); }
            @ if !claims.is_empty() {
                ul(class="verdicts") { @ for result in &claims {
                    li {
                        a(href=format_args!("#claim-{}", result.claim.number)) { : "Claim "; : result.claim.number; }
                        : ": "; : text(&result.claim.claim); : " ";
                        span(class=class(result.verdict)) : result.verdict.words();
                    }
                } }
            }
        }
    }))
}

/// The physical width of the picture.
fn width(svg: &str) -> String {
    let begin = svg.split_once("width=\"");
    let width = begin.and_then(|(_, rest)| rest.split_once('"'));
    width.map_or(String::new(), |(width, _)| format!("width:{width}"))
}

fn plain_table(table: &Table) -> Raw<String> {
    Raw(written(html! {
        div(class="wide") { table {
            caption : text(&table.caption);
            thead { tr { @ for name in &table.header { th : text(name); } } }
            tbody { @ for row in &table.rows { tr { @ for cell in row { td : text(cell); } } } }
        } }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subscripts_are_lowered_and_markup_is_escaped() {
        let seen = text("mu_s* < 1 at sigma_s* & t_s*").0;
        assert_eq!(
            seen,
            "\u{3bc}<sub>s</sub>* &lt; 1 at \u{3c3}<sub>s</sub>* &amp; t<sub>s</sub>*"
        );
    }
}
