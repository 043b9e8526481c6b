//! Every exact answer of the models beyond the paper's, and the page of the documentation that shows them.

use std::path::Path;

#[test]
fn all_answers_are_within_their_tolerance_and_stand_in_the_book() {
    let books = slipfront_family::books(false).unwrap();
    let summary = slipfront_family::summary(&books);
    let answers = || {
        let chapters = books.iter().flat_map(|book| &book.chapters);
        chapters.flat_map(|chapter| &chapter.answers)
    };
    assert!(answers().all(slipfront_family::Answer::holds), "{summary}");
    assert!(answers().count() > 160, "{summary}");
    // The results have the same bits on every machine, and so the page is the same.
    for book in &books {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/validation");
        let page = std::fs::read_to_string(folder.join(book.file())).unwrap();
        assert!(
            page == book.text(),
            "docs/validation/{} is not of this version: slipfront family --docs docs/validation",
            book.file()
        );
    }
}
