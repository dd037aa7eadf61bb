//! `pointmass-glue MODULE FOLDER`: what wasm-bindgen's own program does, without the servers and test runners that it is installed with. The
//! lock file keeps it at the version that the module is built with, as it has to be. What is made then says in sentences what wasm-bindgen
//! leaves to the engine.

mod sentences;

use std::path::Path;
use std::process::ExitCode;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [module, folder] = arguments.as_slice() else {
        eprintln!("usage: pointmass-glue MODULE FOLDER");
        return ExitCode::from(2);
    };
    let mut bindgen = Bindgen::new();
    let made = bindgen
        .input_path(module)
        .out_name("pointmass")
        .typescript(true)
        .omit_default_module_path(false)
        .web(true)
        .and_then(|bindgen| bindgen.generate(folder))
        .map_err(|error| format!("{module}: {error:#}"));
    match made.and_then(|()| mended(&Path::new(folder).join("pointmass.js"))) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pointmass-glue: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Puts the sentences into a file.
fn mended(path: &Path) -> Result<(), String> {
    let told = |error: std::io::Error| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(path).map_err(told)?;
    std::fs::write(path, sentences::told(&text)?).map_err(told)
}
