//! Damage (soon).
