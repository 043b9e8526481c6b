//! Files that are added to the page or to the cases are embedded at the next build.

fn main() {
    println!("cargo:rerun-if-changed=web");
    println!("cargo:rerun-if-changed=cases");
}
