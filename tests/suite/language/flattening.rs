//! `tests/flattening/*.mo`: the flat model, or the errors. The class is the file's name, or `Main`
//! inside the package of that name.

use gapilib::internals::diag::render::render;
use gapilib::internals::flatten::{Library, flatten};
use gapilib::internals::name::{Ident, Name};
use gapilib::internals::source::SourceMap;
use gapilib::internals::syntax::parse_stored_definition;
use std::path::Path;

fn flattened(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a readable file");
    let stem = path.file_stem().expect("a file name").to_string_lossy().into_owned();
    let sources = SourceMap::default();
    let source = sources.add(format!("{stem}.mo"), text.as_str());
    let file = parse_stored_definition(source, &text).expect("Modelica");
    let mut library = Library::new();
    let names = library.load(&file).expect("a loadable file");
    let main = names[0].child(Ident::new("Main"));
    let class = if library.contains(&main) { main } else { names[0].clone() };
    match flatten(&library, &class, &[]) {
        Ok(flattened) => {
            let text = flattened.model.to_string();
            let source = sources.add("flat", text.as_str());
            if let Err(error) = parse_stored_definition(source, &text) {
                panic!("the flat text does not parse:\n{}", render(&error, &sources, false));
            }
            let warnings = flattened.warnings.into_iter().chain(library.take_warnings());
            let told: String =
                warnings.map(|one| format!("\n{}", render(&one, &sources, false))).collect();
            text + &told
        }
        Err(errors) => {
            errors.iter().map(|error| render(error, &sources, false)).collect::<Vec<_>>().join("\n")
        }
    }
}

#[test]
fn corpus() {
    insta::glob!("../../flattening", "*.mo", |path| {
        insta::with_settings!({
            snapshot_path => path.parent().expect("a folder"),
            prepend_module_to_snapshot => false,
            snapshot_suffix => "",
            omit_expression => true,
        }, {
            let stem = path.file_stem().expect("a file name").to_string_lossy().into_owned();
            insta::assert_snapshot!(stem, flattened(path));
        });
    });
}

#[test]
fn a_modification_from_outside_overrides_the_declaration() {
    let text = "model M parameter Real p = 1; Real x = p; end M;";
    let sources = SourceMap::default();
    let source = sources.add("M.mo", text);
    let mut library = Library::new();
    library.load(&parse_stored_definition(source, text).expect("Modelica")).expect("loads");
    let problem = "M(p = 2)";
    let source = sources.add("problem", problem);
    let (name, arguments) =
        gapilib::internals::syntax::parse_class_with_modification(source, problem)
            .expect("a problem");
    assert_eq!(name, Name::parse("M"));
    let flat = flatten(&library, &name, &arguments).expect("a model").model;
    assert!(flat.to_string().contains("p = 2;"), "{flat}");
}
