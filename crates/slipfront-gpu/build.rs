//! Compiles the kernels for the CPU (feature `emulated`), and includes the PTX of the kernels for a GPU
//! (feature `cuda`).

fn main() {
    println!("cargo::rerun-if-changed=kernels");
    #[cfg(feature = "cuda")]
    {
        let out = std::env::var("OUT_DIR").expect("cargo sets OUT_DIR");
        // If `ptx.py` has not written this file, the program compiles the kernels with NVRTC at run time.
        let ptx = std::fs::read("kernels/kernels.ptx").unwrap_or_default();
        std::fs::write(format!("{out}/kernels.ptx"), ptx).expect("OUT_DIR can be written");
    }
    #[cfg(feature = "emulated")]
    emulated();
}

/// Compiles the kernels for the CPU. If `tests/sanitizers.sh` names a sanitizer, threads of the GPU are
/// threads of the CPU, and the sanitizer watches them.
#[cfg(feature = "emulated")]
fn emulated() {
    println!("cargo::rerun-if-env-changed=SLIPFRONT_SANITIZER");
    let mut build = cc::Build::new();
    build
        .cpp(true)
        .std("c++20")
        .file("kernels/emulated.cpp")
        // No contraction: a product and a sum are two operations with two roundings, as everywhere in
        // slipfront.
        .flag("-ffp-contract=off")
        .flag("-Wno-unknown-pragmas")
        .warnings_into_errors(true)
        .opt_level(2);
    match std::env::var("SLIPFRONT_SANITIZER") {
        Ok(sanitizer) => {
            println!("cargo::rustc-link-arg-tests=-l{}san", &sanitizer[..1]);
            build
                .flag(format!("-fsanitize={sanitizer}"))
                .define("THREADS", None);
        }
        // Undefined behaviour ends the test.
        Err(_) => {
            build
                .flag("-fsanitize=undefined")
                .flag("-fsanitize-undefined-trap-on-error");
        }
    }
    build.compile("slipfront_kernels");
}
