//! `pointmass-glue MODULE FOLDER`: what wasm-bindgen's own program does, without the servers and test runners that it is installed with. The
//! lock file keeps it at the version that the module is built with, as it has to be.

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
        .and_then(|bindgen| bindgen.generate(folder));
    match made {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pointmass-glue: {module}: {error:#}");
            ExitCode::FAILURE
        }
    }
}
