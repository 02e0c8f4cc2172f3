//! Structs whose methods lie in layers over the files of a folder: those of a file call none of a file
//! above it.

use super::all;
use gapilib::internals::graph::strongly_connected;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{Expr, ExprMethodCall, ImplItem, Item, ItemImpl, Type};

/// The folder below `src`, and the struct.
const LAYERED: &[(&str, &str)] = &[
    ("modelica/runtime", "System"),
    ("numerics/sim", "Run"),
    ("numerics/sim", "Sliding"),
    ("numerics/sim", "SystemWithin"),
];

/// Methods of a struct in a file, and those that they call on `self`.
#[derive(Default)]
struct Methods {
    defined: BTreeSet<String>,
    called: BTreeSet<String>,
}

impl Visit<'_> for Methods {
    fn visit_expr_method_call(&mut self, call: &ExprMethodCall) {
        if matches!(&*call.receiver, Expr::Path(path) if path.path.is_ident("self")) {
            self.called.insert(call.method.to_string());
        }
        visit::visit_expr_method_call(self, call);
    }
}

fn is_of(block: &ItemImpl, name: &str) -> bool {
    match &*block.self_ty {
        Type::Path(path) => path.path.segments.last().is_some_and(|last| last.ident == name),
        _ => false,
    }
}

/// The methods of a struct by file.
fn methods_by_file<'a>(folder: &Path, name: &str) -> Vec<(&'a Path, Methods)> {
    let mut found = Vec::new();
    for source in all().iter().filter(|source| source.path.starts_with(folder)) {
        let mut methods = Methods::default();
        for item in syn::parse_file(&source.text).expect("Rust").items {
            let Item::Impl(block) = item else { continue };
            if !is_of(&block, name) {
                continue;
            }
            for item in &block.items {
                if let ImplItem::Fn(function) = item {
                    methods.defined.insert(function.sig.ident.to_string());
                }
            }
            methods.visit_item_impl(&block);
        }
        if !methods.defined.is_empty() {
            found.push((&*source.path, methods));
        }
    }
    found
}

#[test]
fn methods_of_a_file_call_none_of_a_file_above_it() {
    for (folder, name) in LAYERED {
        let files = methods_by_file(Path::new(folder), name);
        assert!(files.len() > 1, "`{name}` is not spread over files of `{folder}`");
        let mut homes: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (at, (_, methods)) in files.iter().enumerate() {
            methods.defined.iter().for_each(|method| homes.entry(method).or_default().push(at));
        }
        let edges: Vec<Vec<usize>> = files
            .iter()
            .map(|(_, methods)| {
                let others = methods.called.difference(&methods.defined);
                others.filter_map(|method| homes.get(&**method)).flatten().copied().collect()
            })
            .collect();
        let cycles = strongly_connected(files.len(), |at| &edges[at]);
        let cycle = cycles.iter().find(|cycle| cycle.len() > 1);
        let paths = cycle.map(|cycle| cycle.iter().map(|at| files[*at].0).collect::<Vec<_>>());
        assert_eq!(paths, None, "methods of `{name}` call each other");
    }
}
