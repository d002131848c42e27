//! Generates the C++ half of the bridge; its header is found by the plugin's build under `OUT_DIR`.

fn main() {
    cxx_build::bridges(["src/lib.rs", "src/surface.rs"])
        .std("c++17")
        .flag_if_supported("-fvisibility=hidden")
        .compile("prob_water_bridge");
    println!("cargo:rerun-if-changed=src/lib.rs");
    println!("cargo:rerun-if-changed=src/surface.rs");
}
