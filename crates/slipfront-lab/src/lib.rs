//! The laboratory: a page in the browser on which a surface slides live.
