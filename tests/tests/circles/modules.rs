//! All files of a crate, and which of them import which.

use super::paths::Module;
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// Files by where their modules are (`["rays", "tree"]`; none: the crate itself).
#[derive(Default)]
pub(super) struct Modules(BTreeMap<Vec<String>, Module>);

/// Which files each file imports.
pub(super) type Imports = BTreeMap<String, BTreeSet<String>>;

impl Modules {
    /// Reads the file of the module `at` and of those below it, by what `read` gives for a file's name, if there is one.
    pub(super) fn add(&mut self, at: &[String], read: &impl Fn(&str) -> Option<String>) {
        let names = match at {
            [] => vec!["lib.rs".into()],
            _ => vec![format!("{}.rs", at.join("/")), format!("{}/mod.rs", at.join("/"))],
        };
        let (file, text) = names.iter().find_map(|n| Some((n.clone(), read(n)?))).expect("a module has a file");
        let module = Module::read(file, &text);
        for child in &module.children {
            self.add(&[at, std::slice::from_ref(child)].concat(), read);
        }
        self.0.insert(at.to_vec(), module);
    }

    /// Which files each file imports.
    pub(super) fn imports(&self) -> Imports {
        let mut imports = Imports::new();
        for (at, module) in &self.0 {
            let to = imports.entry(module.file.clone()).or_default();
            for mention in &module.paths {
                let way = Way { modules: self, import: mention.import, been: RefCell::default() };
                let homes = way.homes(at, &mention.path, false);
                let others = homes.iter().filter(|h| *h != at && !(mention.export && h.starts_with(at)));
                to.extend(others.map(|home| self.0[home].file.clone()));
            }
        }
        imports
    }
}

/// A path that is followed.
struct Way<'a> {
    modules: &'a Modules,
    /// In a `use` line, where it may lead to a module.
    import: bool,
    /// From where which path was followed already: names can stand for themselves.
    been: RefCell<BTreeSet<(Vec<String>, Vec<String>)>>,
}

impl Way<'_> {
    /// The modules whose files define what `path` leads to from the module `at`, which, if
    /// `within`, a path has led into: what it does not list then, a macro of its own defines.
    fn homes(&self, at: &[String], path: &[String], within: bool) -> BTreeSet<Vec<String>> {
        let here = || BTreeSet::from([at.to_vec()]);
        let Some((first, rest)) = path.split_first() else {
            return if self.import { here() } else { BTreeSet::new() };
        };
        let module = &self.modules.0[at];
        let child = [at, std::slice::from_ref(first)].concat();
        let is_child = self.modules.0.contains_key(&child);
        match first.as_str() {
            "crate" => return self.homes(&[], rest, true),
            "self" => return self.homes(at, rest, true),
            "super" => return self.homes(&at[..at.len() - 1], rest, true),
            _ if is_child && !rest.is_empty() => return self.homes(&child, rest, true),
            _ if !self.been.borrow_mut().insert((at.to_vec(), path.to_vec())) => return BTreeSet::new(),
            _ => {}
        }
        let uses: Vec<_> = module.uses.iter().filter(|(name, _)| name == first).collect();
        let item = module.items.contains(first);
        let mut found: BTreeSet<_> =
            uses.iter().flat_map(|(_, to)| self.homes(at, &[to, rest].concat(), false)).collect();
        if item || (within && uses.is_empty() && !is_child) {
            found.extend(here());
        }
        if found.is_empty() && is_child {
            found = self.homes(&child, rest, true);
        }
        found
    }
}
