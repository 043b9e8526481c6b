//! The files of the page.

use axum::http::{StatusCode, Uri, header};
use axum::response::{IntoResponse, Response};
use include_dir::{Dir, File, include_dir};

static WEB: Dir = include_dir!("$CARGO_MANIFEST_DIR/web");

/// The media type of a file, by its ending.
fn content_type(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("json") => "application/json",
        Some("svg") => "image/svg+xml",
        _ => "text/plain; charset=utf-8",
    }
}

/// All files of the page, by their paths.
pub(crate) fn all() -> impl Iterator<Item = (String, &'static [u8])> {
    let mut folders = vec![&WEB];
    let mut files = Vec::new();
    while let Some(folder) = folders.pop() {
        folders.extend(folder.dirs());
        files.extend(folder.files());
    }
    let with_name = |file: &'static File| Some((file.path().to_str()?.to_owned(), file.contents()));
    files.into_iter().filter_map(with_name)
}

/// The file that an address names.
pub(crate) async fn serve(uri: Uri) -> Response {
    let path = match uri.path().trim_start_matches('/') {
        "" => "index.html",
        path => path,
    };
    match WEB.get_file(path) {
        Some(file) => ([(header::CONTENT_TYPE, content_type(path))], file.contents()).into_response(),
        None => (StatusCode::NOT_FOUND, "the laboratory has no such file\n").into_response(),
    }
}
