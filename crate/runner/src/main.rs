//! wasm-bindgen's runner of tests, linked from its library: installed by cargo it would be compiled with all its
//! dependencies a second time. `cargo xtask test wasm` builds it.

fn main() -> anyhow::Result<()> {
    wasm_bindgen_cli::wasm_bindgen_test_runner::run_cli_with_args(std::env::args_os())
}
