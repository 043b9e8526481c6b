//! Problems with exact solutions (model.md, section 6), shared by tests and benches.
