//! Gives the module the stack that the library counts on: the linker's default is 1 MB.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rustc-link-arg-cdylib=-zstack-size={}", 16 << 20);
}
