//! Puts the memory map where the linker looks for it.
use std::path::PathBuf;

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    if std::env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo gives it"));
        std::fs::copy("memory.x", folder.join("memory.x")).expect("the build folder can be written");
        println!("cargo:rustc-link-search={}", folder.display());
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
    }
}
