//! Functions of the core fit a screen: none is longer than so many lines, from its name to its last brace.

use std::fs;
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Block, ImplItemFn, ItemFn, Signature, TraitItemFn};

/// Lines of the longest.
const MOST: usize = 60;

/// Collects the functions of a file that are longer than that.
#[derive(Default)]
struct TooLong(Vec<String>);

impl TooLong {
    fn look(&mut self, signature: &Signature, block: &Block) {
        let [first, last] = [signature.fn_token.span.start(), block.brace_token.span.close().end()];
        let lines = last.line - first.line + 1;
        if lines > MOST {
            self.0.push(format!("{}: {}, {lines} lines", first.line, signature.ident));
        }
    }

    fn of(text: &str) -> Vec<String> {
        let mut found = Self::default();
        found.visit_file(&syn::parse_file(text).expect("code"));
        found.0
    }
}

impl<'a> Visit<'a> for TooLong {
    fn visit_item_fn(&mut self, function: &'a ItemFn) {
        self.look(&function.sig, &function.block);
        visit::visit_item_fn(self, function);
    }

    fn visit_impl_item_fn(&mut self, function: &'a ImplItemFn) {
        self.look(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'a TraitItemFn) {
        if let Some(block) = &function.default {
            self.look(&function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
    }
}

/// All files of Rust in a folder and in those below it.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let (folders, files): (Vec<_>, Vec<_>) = entries.partition(|path| path.is_dir());
    let code = files.into_iter().filter(|file| file.extension().is_some_and(|extension| extension == "rs"));
    code.chain(folders.iter().flat_map(|folder| self::files(folder))).collect()
}

#[test]
fn functions_of_the_core_fit_a_screen() {
    let files = files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/src"));
    assert!(files.len() > 300, "{}", files.len());
    let text = |file: &PathBuf| fs::read_to_string(file).expect("a file");
    let found = files.iter().flat_map(|file| {
        let name = file.display().to_string();
        TooLong::of(&text(file)).into_iter().map(move |function| format!("{name}:{function}"))
    });
    let found: Vec<_> = found.collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn lines_are_counted_from_the_name_to_the_last_brace() {
    let body = |lines: usize| format!("{{\n{}}}", "    a();\n".repeat(lines - 2));
    for (lines, want) in [(MOST, 0), (MOST + 1, 1)] {
        let (body, name) = (body(lines), format!("a, {lines} lines"));
        for (text, at) in [
            (format!("/// What it does.\n#[inline]\nfn a() {body}"), 3),
            (format!("impl A {{\npub fn a(\n) {body}}}"), 2),
            (format!("trait A {{\nfn b();\n\nfn a() {body}}}"), 4),
            (format!("fn b() {{\nfn a() {body}}}"), 2),
            (format!("mod b {{\nconst C: u32 = {{ fn a() {body} 1 }};}}"), 2),
        ] {
            let found = TooLong::of(&text);
            let own = found.iter().filter(|found| found.contains(": a, ")).collect::<Vec<_>>();
            let more = usize::from(text.contains("a(\n)"));
            let (want, name) = if more == 1 { (1, format!("a, {} lines", lines + 1)) } else { (want, name.clone()) };
            assert_eq!(own.len(), want, "{text}");
            assert!(own.iter().all(|own| **own == format!("{at}: {name}")), "{own:?}");
        }
    }
}
