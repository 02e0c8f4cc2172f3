//! The sources as syntax trees, with the modules that each file names.

use proc_macro2::{LineColumn, TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{Attribute, ImplItemFn, Item, ItemFn, ItemMod, ItemUse, TraitItemFn, UseTree};

/// A path of names, `crate` left out.
pub(super) type Names = Vec<String>;

/// Crates whose root is a module of their name, each with the modules in it that are not parts of
/// that one. The other crates are nothing but their modules.
const ROOTS: &[(&str, &[&str])] = &[
    ("fmi", &[]),
    ("fmu", &[]),
    ("exchange", &[]),
    ("identify", &[]),
    ("script", &["lessons", "packages", "teach"]),
    ("cli", &["lsp"]),
];

/// A source file.
pub(super) struct Source {
    /// Below `src`.
    pub(super) path: PathBuf,
    pub(super) text: String,
    /// The module that it is: `["sim", "event"]`, with nothing for `lib.rs`.
    pub(super) module: Names,
    /// Absolute paths that its code names (not that of its tests), with their lines.
    pub(super) named: Vec<(usize, Names)>,
    /// What it makes visible under a name of its own: `pub use a::b` is `b` for `a::b`.
    exports: BTreeMap<String, Names>,
    /// Functions with their lengths in lines, without those of tests.
    pub(super) functions: Vec<(String, usize)>,
    /// Methods, and the calls of methods on `self` and on its fields, by the type of the `impl` in which
    /// they stand.
    pub(super) methods: Vec<(String, String)>,
    pub(super) own_calls: BTreeSet<(String, String)>,
    /// Constants that are tables: slices that other modules see.
    pub(super) tables: Vec<String>,
    /// All identifiers of its code.
    pub(super) identifiers: BTreeMap<String, usize>,
    /// Paths of the standard library and macros that it uses, with their lines.
    pub(super) outside: Vec<(usize, String)>,
    /// Whether it is the face of a folder.
    pub(super) is_door: bool,
}

/// All files below `src`, in order.
pub(super) fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    collect(&root, &mut paths);
    paths.retain(|path| !path.ends_with("build.rs"));
    paths.sort();
    assert!(paths.len() > 20, "the sources were not found");
    let paths = paths.iter().map(|path| path.strip_prefix(&root).expect("below the root"));
    let inner = paths
        .clone()
        .filter_map(within_crate)
        .filter_map(|(owner, inner)| Some((owner.to_owned(), inner.first()?.clone())));
    let modules = inner.collect();
    paths.map(|path| read(&root, path, &modules)).collect()
}

/// All files of code below a folder, with their texts.
pub(super) fn files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut paths = Vec::new();
    collect(folder, &mut paths);
    paths.sort();
    let text = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a readable source");
        (path, text)
    };
    paths.into_iter().map(text).collect()
}

/// The string literals of a file: their lines, their values, and over how many lines they go.
pub(super) fn literals(text: &str) -> Vec<(usize, String, usize)> {
    let mut found = Vec::new();
    add_literals(text.parse().expect("Rust"), &mut found);
    found
}

fn add_literals(tokens: TokenStream, found: &mut Vec<(usize, String, usize)>) {
    for tree in tokens {
        match tree {
            TokenTree::Group(group) => add_literals(group.stream(), found),
            TokenTree::Literal(literal) => {
                let (start, end) = (literal.span().start().line, literal.span().end().line);
                if let syn::Lit::Str(text) = syn::Lit::new(literal) {
                    found.push((start, text.value(), end + 1 - start));
                }
            }
            TokenTree::Ident(_) | TokenTree::Punct(_) => {}
        }
    }
}

/// The crate of a file, and the path of its module there; `None` for the facade and the program.
fn within_crate(path: &Path) -> Option<(&str, Names)> {
    let mut names: Names =
        path.with_extension("").iter().map(|name| name.to_string_lossy().into_owned()).collect();
    names.pop_if(|last| last == "mod" || last == "lib");
    let owner = path.iter().next()?.to_str()?;
    path.parent()?.parent().map(|_| (owner, names.split_off(1)))
}

/// The module that a path in a crate stands for.
fn module_of(owner: &str, inner: &[String]) -> Names {
    let root = ROOTS.iter().find(|(name, others)| {
        *name == owner && !inner.first().is_some_and(|first| others.contains(&first.as_str()))
    });
    root.map(|(name, _)| (*name).to_owned()).into_iter().chain(inner.iter().cloned()).collect()
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a readable folder") {
        let path = entry.expect("a readable entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

fn read(root: &Path, path: &Path, modules: &BTreeSet<(String, String)>) -> Source {
    let text = fs::read_to_string(root.join(path)).expect("a readable source");
    let file = syn::parse_file(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let path = path.to_owned();
    let (owner, module) = match within_crate(&path) {
        Some((owner, inner)) => (owner.to_owned(), module_of(owner, &inner)),
        None if path.ends_with("lib.rs") => (String::new(), Vec::new()),
        None => (String::new(), vec!["main".to_owned()]),
    };
    // `library.rs` is the face of the folder `library`.
    let is_door = path.ends_with("mod.rs")
        || path.ends_with("lib.rs")
        || root.join(path.with_extension("")).is_dir();
    let mut reader = Reader {
        here: module.clone(),
        implemented: None,
        owner,
        modules,
        source: Source {
            path,
            text,
            module,
            named: Vec::new(),
            exports: BTreeMap::new(),
            functions: Vec::new(),
            methods: Vec::new(),
            own_calls: BTreeSet::new(),
            tables: Vec::new(),
            identifiers: BTreeMap::new(),
            outside: Vec::new(),
            is_door,
        },
    };
    reader.visit_file(&file);
    reader.source
}

/// Reads one file; items of tests are passed over.
struct Reader<'a> {
    /// The module at hand, inline modules included.
    here: Names,
    /// The type of the `impl` at hand.
    implemented: Option<String>,
    /// The crate.
    owner: String,
    /// Crates with the modules that lie in them.
    modules: &'a BTreeSet<(String, String)>,
    source: Source,
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || attribute.path().is_ident("cfg")
                && attribute.parse_args::<syn::Path>().is_ok_and(|path| path.is_ident("test"))
    })
}

fn attributes(item: &Item) -> &[Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Mod(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}

impl Reader<'_> {
    /// The absolute path of a written one; `None` for those of other crates and of locals.
    fn absolute(&self, written: &[String]) -> Option<Names> {
        let mut base = self.here.clone();
        let mut rest = written;
        match written.first()?.as_str() {
            "crate" => return Some(self.in_crate(&written[1..])),
            other if other.starts_with("gapilib_") => {
                return Some(module_of(&other["gapilib_".len()..], &written[1..]));
            }
            "self" => rest = &written[1..],
            "super" => {
                while rest.first().is_some_and(|name| name == "super") {
                    base.pop();
                    rest = &rest[1..];
                }
            }
            _ => return None,
        }
        base.extend(rest.iter().cloned());
        Some(base)
    }

    /// What a path from the root of the crate stands for: the roots name modules of lower crates.
    fn in_crate(&self, inner: &[String]) -> Names {
        // The macros of `diag`.
        if matches!(inner, [name] if ["bail", "codes", "fault"].contains(&name.as_str())) {
            return inner.to_vec();
        }
        let first = inner.first().cloned().unwrap_or_default();
        let is_own = self.modules.contains(&(self.owner.clone(), first.clone()));
        let is_lower = ROOTS.iter().any(|(root, _)| *root == first)
            || self.modules.iter().any(|(owner, module)| {
                *module == first && module_of(owner, std::slice::from_ref(module)).len() == 1
            });
        if is_own || !is_lower { module_of(&self.owner, inner) } else { inner.to_vec() }
    }

    fn name(&mut self, line: usize, written: &[String]) {
        match self.absolute(written) {
            Some(path) => self.source.named.push((line, path)),
            None => {
                self.source.outside.push((line, written.join("::")));
                // A module of its own, such as `child::Item` in the face of a folder.
                let own: Names = self.here.iter().chain(written).cloned().collect();
                self.source.named.push((line, own));
            }
        }
    }

    fn functions(&mut self, name: &str, from: LineColumn, to: LineColumn) {
        self.source.functions.push((name.to_owned(), to.line + 1 - from.line));
    }

    fn tokens(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.tokens(group.stream()),
                TokenTree::Ident(ident) => self.identifier(ident.to_string()),
                _ => {}
            }
        }
    }

    fn identifier(&mut self, name: String) {
        *self.source.identifiers.entry(name).or_default() += 1;
    }
}

/// The last name of a type, references left out.
fn name_of(of: &syn::Type) -> String {
    match of {
        syn::Type::Reference(inner) => name_of(&inner.elem),
        syn::Type::Path(path) => {
            path.path.segments.last().map(|part| part.ident.to_string()).unwrap_or_default()
        }
        _ => String::new(),
    }
}

/// Whether it is `self` or a field of it.
fn is_own(receiver: &syn::Expr) -> bool {
    match receiver {
        syn::Expr::Path(path) => path.path.is_ident("self"),
        syn::Expr::Field(field) => {
            matches!(&*field.base, syn::Expr::Path(path) if path.path.is_ident("self"))
        }
        _ => false,
    }
}

/// The leaves of a `use`, and the name that each has here.
fn leaves(tree: &UseTree, before: &[String], found: &mut Vec<(Names, String)>) {
    let with = |name: String| before.iter().cloned().chain([name]).collect::<Names>();
    match tree {
        UseTree::Path(path) => leaves(&path.tree, &with(path.ident.to_string()), found),
        UseTree::Name(name) if name.ident == "self" => {
            found.push((before.to_vec(), before.last().cloned().unwrap_or_default()));
        }
        UseTree::Name(name) => found.push((with(name.ident.to_string()), name.ident.to_string())),
        UseTree::Rename(name) => {
            found.push((with(name.ident.to_string()), name.rename.to_string()));
        }
        UseTree::Glob(_) => found.push((with("*".into()), "*".into())),
        UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, before, found)),
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if !is_test(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        self.here.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.here.pop();
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let mut found = Vec::new();
        leaves(&item.tree, &[], &mut found);
        let is_export = !matches!(item.vis, syn::Visibility::Inherited);
        for (written, name) in found {
            let line = item.span().start().line;
            let own = self.here.iter().chain(&written).cloned().collect();
            let path = self.absolute(&written).unwrap_or(own);
            if is_export {
                self.source.exports.insert(name, path);
            } else {
                self.name(line, &written);
            }
        }
    }

    fn visit_item_fn(&mut self, function: &'ast ItemFn) {
        let span = function.block.span();
        let from = function.sig.span().start();
        self.functions(&function.sig.ident.to_string(), from, span.end());
        visit::visit_item_fn(self, function);
    }

    fn visit_item_impl(&mut self, item: &'ast syn::ItemImpl) {
        let outer = self.implemented.replace(name_of(&item.self_ty));
        visit::visit_item_impl(self, item);
        self.implemented = outer;
    }

    fn visit_expr_method_call(&mut self, call: &'ast syn::ExprMethodCall) {
        if let (Some(of), true) = (&self.implemented, is_own(&call.receiver)) {
            self.source.own_calls.insert((of.clone(), call.method.to_string()));
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_impl_item_fn(&mut self, function: &'ast ImplItemFn) {
        if is_test(&function.attrs) {
            return;
        }
        let method = self.implemented.clone().map(|of| (of, function.sig.ident.to_string()));
        self.source.methods.extend(method);
        let from = function.sig.span().start();
        self.functions(&function.sig.ident.to_string(), from, function.block.span().end());
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'ast TraitItemFn) {
        if let Some(block) = &function.default {
            let from = function.sig.span().start();
            self.functions(&function.sig.ident.to_string(), from, block.span().end());
        }
        visit::visit_trait_item_fn(self, function);
    }

    fn visit_item_const(&mut self, item: &'ast syn::ItemConst) {
        let is_seen = !matches!(item.vis, syn::Visibility::Inherited);
        let is_slice = matches!(&*item.ty, syn::Type::Reference(of)
            if matches!(&*of.elem, syn::Type::Slice(_)));
        if is_seen && is_slice {
            self.source.tables.push(item.ident.to_string());
        }
        visit::visit_item_const(self, item);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Names = path.segments.iter().map(|part| part.ident.to_string()).collect();
        if names.len() > 1 {
            self.name(path.span().start().line, &names);
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        let name = called.path.segments.last().map(|part| part.ident.to_string());
        let line = called.span().start().line;
        self.source.outside.push((line, name.unwrap_or_default() + "!"));
        self.tokens(called.tokens.clone());
        // Arguments of macros are expressions where they are read as such.
        let parser = syn::punctuated::Punctuated::<syn::Expr, syn::Token![,]>::parse_terminated;
        if let Ok(arguments) = called.parse_body_with(parser) {
            arguments.iter().for_each(|argument| self.visit_expr(argument));
        }
        visit::visit_macro(self, called);
    }

    fn visit_ident(&mut self, ident: &'ast proc_macro2::Ident) {
        self.identifier(ident.to_string());
    }
}

/// Which file stands for a path: that of its longest beginning that is a module, through the names
/// that faces of folders make visible.
pub(super) struct Modules<'a> {
    by_name: BTreeMap<&'a [String], usize>,
    sources: &'a [Source],
}

impl<'a> Modules<'a> {
    pub(super) fn new(sources: &'a [Source]) -> Modules<'a> {
        let numbered = sources.iter().enumerate();
        let by_name = numbered.map(|(at, source)| (source.module.as_slice(), at)).collect();
        Modules { by_name, sources }
    }

    pub(super) fn file(&self, path: &[String]) -> Option<usize> {
        self.followed(path, 0)
    }

    fn followed(&self, path: &[String], depth: usize) -> Option<usize> {
        let (length, at) =
            (1..=path.len()).rev().find_map(|n| self.by_name.get(&path[..n]).map(|at| (n, *at)))?;
        let exports = &self.sources[at].exports;
        let Some(name) = path.get(length) else { return Some(at) };
        match exports.get(name) {
            Some(target) if depth < 8 => {
                let target: Names = target.iter().chain(&path[length + 1..]).cloned().collect();
                self.followed(&target, depth + 1).or(Some(at))
            }
            _ => Some(at),
        }
    }

    /// The files that a file names. The face of a folder may name what lies in it.
    pub(super) fn successors(&self, at: usize) -> Vec<usize> {
        let source = &self.sources[at];
        let named = source.named.iter().filter_map(|(_, path)| self.file(path));
        let is_inner =
            |of: &usize| source.is_door && self.sources[*of].module.starts_with(&source.module);
        let found: BTreeSet<usize> = named.filter(|of| *of != at && !is_inner(of)).collect();
        found.into_iter().collect()
    }
}
