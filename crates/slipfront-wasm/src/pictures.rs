//! Functions of the module that draws pictures.

use slipfront_run::pictures;

use crate::given;
use crate::imports::{Saying, tell};

/// Draws the pictures of a run. The Worker has given the files of the run, and whether it has a movie; it is
/// told the files of the pictures, or why they cannot be drawn.
pub(crate) fn draw() {
    let files: Result<(Vec<(String, Vec<u8>)>, bool), _> = postcard::from_bytes(&given::take());
    let drawn = files
        .map_err(|error| error.to_string())
        .and_then(|(files, with_movie)| {
            pictures::in_memory(&files, with_movie).map_err(|error| error.to_string())
        });
    // Texts and bytes: serialisation cannot fail.
    let drawn = postcard::to_stdvec(&drawn).expect("pictures can be told");
    tell(Saying::Pictures, 0, &drawn);
}
