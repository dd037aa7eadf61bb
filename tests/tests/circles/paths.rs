//! What a file says: which names it defines and imports, and which paths its code goes.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeSet;
use syn::visit::{self, Visit};
use syn::{
    Attribute, Block, ImplItem, ImplItemFn, Item, ItemFn, ItemUse, Macro, PatIdent, Signature, TraitItemFn, UseTree,
    Visibility,
};

/// What a file says.
#[derive(Default)]
pub(super) struct Module {
    /// The file.
    pub(super) file: String,
    /// Child modules.
    pub(super) children: Vec<String>,
    /// Names that it defines, without child modules.
    pub(super) items: BTreeSet<String>,
    /// Names that it imports, and what they stand for.
    pub(super) uses: Vec<(String, Vec<String>)>,
    /// Paths that its code goes, its imports' included.
    pub(super) paths: Vec<Mention>,
    /// Names that the functions around bind themselves: what they name is not what the file imports by that name.
    bound: Vec<BTreeSet<String>>,
}

/// Whether a name in a pattern is that of a constant, and not bound there: only case tells.
fn is_constant(pattern: &PatIdent) -> bool {
    pattern.ident.to_string().starts_with(char::is_uppercase)
}

/// The names that patterns bind.
#[derive(Default)]
struct Bound(BTreeSet<String>);

impl<'a> Visit<'a> for Bound {
    fn visit_pat_ident(&mut self, pattern: &'a PatIdent) {
        if !is_constant(pattern) {
            self.0.insert(pattern.ident.to_string());
        }
        visit::visit_pat_ident(self, pattern);
    }
}

/// A path in code.
pub(super) struct Mention {
    pub(super) path: Vec<String>,
    /// In a `use` line, where a module is a thing to name.
    pub(super) import: bool,
    /// In a `use` line that others see.
    pub(super) export: bool,
}

/// Whether what has these attributes is compiled for tests alone: `cfg(test)`, `cfg(all(test, ..))`.
fn test_only(attributes: &[Attribute]) -> bool {
    attributes.iter().filter(|a| a.path().is_ident("cfg")).any(|a| {
        let mut found = false;
        a.parse_nested_meta(|meta| {
            found |= meta.path.is_ident("test");
            if meta.path.is_ident("all") {
                meta.parse_nested_meta(|inner| {
                    found |= inner.path.is_ident("test");
                    skip(&inner)
                })
            } else {
                skip(&meta)
            }
        })
        .expect("cfg has a list");
        found
    })
}

/// Goes past a predicate's value or list.
fn skip(meta: &syn::meta::ParseNestedMeta) -> syn::Result<()> {
    if meta.input.peek(syn::Token![=]) {
        meta.value()?.parse::<syn::Lit>()?;
    } else if meta.input.peek(syn::token::Paren) {
        let list;
        syn::parenthesized!(list in meta.input);
        list.parse::<TokenStream>()?;
    }
    Ok(())
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(i) => &i.attrs,
        Item::Enum(i) => &i.attrs,
        Item::Fn(i) => &i.attrs,
        Item::Impl(i) => &i.attrs,
        Item::Macro(i) => &i.attrs,
        Item::Mod(i) => &i.attrs,
        Item::Static(i) => &i.attrs,
        Item::Struct(i) => &i.attrs,
        Item::Trait(i) => &i.attrs,
        Item::Type(i) => &i.attrs,
        Item::Use(i) => &i.attrs,
        _ => &[],
    }
}

fn name(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(i) => &i.ident,
        Item::Enum(i) => &i.ident,
        Item::Fn(i) => &i.sig.ident,
        Item::Macro(i) => i.ident.as_ref()?,
        Item::Static(i) => &i.ident,
        Item::Struct(i) => &i.ident,
        Item::Trait(i) => &i.ident,
        Item::Type(i) => &i.ident,
        _ => return None,
    };
    Some(ident.to_string())
}

impl Module {
    /// Reads a file's text.
    pub(super) fn read(file: String, text: &str) -> Self {
        let parsed = syn::parse_file(text).unwrap_or_else(|e| panic!("{file}: {e}"));
        let mut module = Self { file, ..Self::default() };
        for item in parsed.items.iter().filter(|item| !test_only(attributes(item))) {
            module.items.extend(name(item));
            if let Item::Mod(child) = item {
                assert!(child.content.is_none(), "{}: this test does not know of modules within files", module.file);
                module.children.push(child.ident.to_string());
            }
        }
        module.visit_file(&parsed);
        module
    }

    fn mention(&mut self, path: Vec<String>) {
        self.paths.push(Mention { path, import: false, export: false });
    }

    /// Visits a function, whose own names count for nothing.
    fn function(&mut self, head: &Signature, body: Option<&Block>, visit: impl FnOnce(&mut Self)) {
        let mut bound = Bound::default();
        bound.visit_signature(head);
        body.into_iter().for_each(|body| bound.visit_block(body));
        self.bound.push(bound.0);
        visit(self);
        self.bound.pop();
    }

    /// Takes what a `use` line says after the path `before`.
    fn import(&mut self, before: &[String], tree: &UseTree, export: bool) {
        let with = |last: &syn::Ident| [before, &[last.to_string()]].concat();
        let (name, path) = match tree {
            UseTree::Path(p) => return self.import(&with(&p.ident), &p.tree, export),
            UseTree::Group(g) => return g.items.iter().for_each(|tree| self.import(before, tree, export)),
            UseTree::Name(n) if n.ident == "self" => (before.last().cloned().unwrap_or_default(), before.to_vec()),
            UseTree::Name(n) => (n.ident.to_string(), with(&n.ident)),
            UseTree::Rename(r) if r.ident == "self" => (r.rename.to_string(), before.to_vec()),
            UseTree::Rename(r) => (r.rename.to_string(), with(&r.ident)),
            _ => ("*".into(), before.to_vec()),
        };
        self.uses.push((name, path.clone()));
        self.paths.push(Mention { path, import: true, export });
    }

    /// Takes paths out of what a macro is given or made of, where they have more than one part.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut colons) = (Vec::new(), 0);
        for token in tokens {
            match token {
                TokenTree::Punct(p) if p.as_char() == ':' => {
                    colons += 1;
                    continue;
                }
                TokenTree::Ident(i) if colons == 2 && !path.is_empty() => path.push(i.to_string()),
                TokenTree::Ident(i) => self.take(&mut path, Some(i.to_string())),
                TokenTree::Group(g) => {
                    self.take(&mut path, None);
                    self.tokens(g.stream());
                }
                _ => self.take(&mut path, None),
            }
            colons = 0;
        }
        self.take(&mut path, None);
    }

    /// Takes a path that has ended, and begins the next one.
    fn take(&mut self, path: &mut Vec<String>, next: Option<String>) {
        let whole = std::mem::replace(path, next.into_iter().collect());
        if whole.len() > 1 {
            self.mention(whole);
        }
    }
}

impl<'a> Visit<'a> for Module {
    fn visit_item(&mut self, item: &'a Item) {
        if !test_only(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item(&mut self, item: &'a ImplItem) {
        if !matches!(item, ImplItem::Fn(f) if test_only(&f.attrs)) {
            visit::visit_impl_item(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'a ItemFn) {
        self.function(&item.sig, Some(&item.block), |this| visit::visit_item_fn(this, item));
    }

    fn visit_impl_item_fn(&mut self, item: &'a ImplItemFn) {
        self.function(&item.sig, Some(&item.block), |this| visit::visit_impl_item_fn(this, item));
    }

    fn visit_trait_item_fn(&mut self, item: &'a TraitItemFn) {
        self.function(&item.sig, item.default.as_ref(), |this| visit::visit_trait_item_fn(this, item));
    }

    fn visit_item_use(&mut self, item: &'a ItemUse) {
        if item.leading_colon.is_none() {
            self.import(&[], &item.tree, !matches!(item.vis, Visibility::Inherited));
        }
    }

    fn visit_path(&mut self, path: &'a syn::Path) {
        let is_bound = |name: &syn::Ident| self.bound.iter().any(|names| names.contains(&name.to_string()));
        if path.leading_colon.is_none() && !path.get_ident().is_some_and(is_bound) {
            self.mention(path.segments.iter().map(|s| s.ident.to_string()).collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_pat_ident(&mut self, pattern: &'a PatIdent) {
        if is_constant(pattern) {
            self.mention(vec![pattern.ident.to_string()]);
        }
        visit::visit_pat_ident(self, pattern);
    }

    fn visit_macro(&mut self, code: &'a Macro) {
        self.visit_path(&code.path);
        self.tokens(code.tokens.clone());
    }

    fn visit_visibility(&mut self, _: &'a Visibility) {}

    fn visit_attribute(&mut self, _: &'a Attribute) {}
}
