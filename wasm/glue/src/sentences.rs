//! Sentences for what wasm-bindgen's glue would fail at in words of its own: a call before the module is there, or of what has been freed.

/// The functions that are added.
const HELPERS: &str = r#"
function alive(object, kind) {
    if (!(object instanceof kind)) {
        throw new TypeError(`this has to be a ${kind.name} of pointmass`);
    }
    if (!object.__wbg_ptr) {
        throw new Error(`this ${kind.name} has been freed`);
    }
    return object.__wbg_ptr;
}

function ready() {
    if (wasm === undefined) {
        throw new Error("pointmass is not loaded yet: call `await init()` first, its default export");
    }
}
"#;

/// The beginnings of what can be called before there is anything.
const ENTRIES: [&str; 2] = ["    constructor(", "export function "];

/// The glue with its sentences.
///
/// # Errors
/// If it does not look as expected: wasm-bindgen may write it otherwise some day.
pub(crate) fn told(glue: &str) -> Result<String, String> {
    let (mut text, mut kind) = (String::with_capacity(2 * glue.len()), "");
    let (mut entries, mut methods, mut frees) = (0, 0, 0);
    for line in glue.lines() {
        kind = line.strip_prefix("export class ").and_then(|rest| rest.strip_suffix(" {")).unwrap_or(kind);
        let line = if line.contains("= wasm.") && line.contains("(this.__wbg_ptr") {
            methods += 1;
            line.replacen("(this.__wbg_ptr", &format!("(alive(this, {kind})"), 1)
        } else if line.starts_with("        wasm.__wbg_") && line.ends_with("_free(ptr, 0);") {
            frees += 1;
            format!("        if (ptr) {}", line.trim_start())
        } else {
            line.to_owned()
        };
        text += &line;
        text.push('\n');
        if ENTRIES.iter().any(|entry| line.starts_with(entry)) {
            entries += 1;
            text += if line.starts_with(' ') { "        ready();\n" } else { "    ready();\n" };
        }
    }
    // Each class has a constructor and is freed, and there are functions besides.
    let is_unheeded = |line: &str| line.contains("wasm.") && line.contains("this.__wbg_ptr");
    if frees == 0 || entries <= frees || methods == 0 || text.lines().any(is_unheeded) {
        return Err(format!("the glue is not as expected: {frees} classes, {entries} entries, {methods} methods"));
    }
    Ok(text + HELPERS)
}

#[cfg(test)]
mod tests {
    use super::*;

    const GLUE: &str = "export class Box {
    free() {
        const ptr = this.__destroy_into_raw();
        wasm.__wbg_box_free(ptr, 0);
    }
    open(key) {
        const ret = wasm.box_open(this.__wbg_ptr, key);
        return ret;
    }
    constructor() {
        const ret = wasm.box_new();
    }
}
export function version() {
    return wasm.version();
}
";

    #[test]
    fn methods_look_who_calls_them() {
        let text = told(GLUE).expect("it is as expected");
        assert!(text.contains("wasm.box_open(alive(this, Box), key);"), "{text}");
        assert!(text.contains("        if (ptr) wasm.__wbg_box_free(ptr, 0);"), "{text}");
        assert!(text.contains("constructor() {\n        ready();\n"), "{text}");
        assert!(text.contains("version() {\n    ready();\n"), "{text}");
    }

    #[test]
    fn other_glue_is_refused() {
        for other in ["", "export function version() {\n}\n", &GLUE.replace("_free(ptr, 0)", "_free(ptr)")] {
            assert!(told(other).is_err(), "{other}");
        }
    }
}
