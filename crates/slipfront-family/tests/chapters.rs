//! Every exact answer of the models around the paper's, and the page of the documentation that shows them.

use std::path::Path;

#[test]
fn all_answers_are_within_their_tolerance_and_stand_in_the_book() {
    let chapters = slipfront_family::chapters().unwrap();
    let summary = slipfront_family::summary(&chapters);
    let answers = || chapters.iter().flat_map(|chapter| &chapter.answers);
    assert!(answers().all(slipfront_family::Answer::holds), "{summary}");
    assert!(answers().count() > 80, "{summary}");
    // The same bits on every machine, and so the same page.
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation/family.md");
    let page = std::fs::read_to_string(book).unwrap();
    assert!(
        page == slipfront_family::docs_page(&chapters),
        "docs/validation/family.md is not of this version: slipfront family --docs docs/validation"
    );
}
