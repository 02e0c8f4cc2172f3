//! The shipped models.

use crate::shipped;
use gapilib::source::SourceMap;
use gapilib::syntax;

#[test]
fn every_model_parses() {
    for path in shipped::files("models", "mo") {
        let text = std::fs::read_to_string(&path).unwrap();
        let mut sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.clone());
        if let Err(diagnostic) = syntax::parse_stored_definition(source, &text) {
            panic!("{}: {diagnostic}", sources.location(diagnostic.span()));
        }
    }
}
