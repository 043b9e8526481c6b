//! Hashes the sources, for the identity of the build.

mod hash_sources;

fn main() -> std::io::Result<()> {
    hash_sources::hash_sources()
}
