//! 2D lattice spring-block model.
