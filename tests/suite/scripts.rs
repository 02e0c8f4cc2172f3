//! The shipped scripts.

use crate::shipped;
use gapilib::source::SourceMap;
use gapilib::syntax;

#[test]
fn every_script_parses_and_says_first_what_it_shows() {
    for path in shipped::files("scripts", "mos") {
        let text = std::fs::read_to_string(&path).unwrap();
        let runs_only = text.starts_with("// ");
        assert!(runs_only, "{} does not begin with `// what it shows`", path.display());
        let mut sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.clone());
        if let Err(diagnostic) = syntax::parse_script(source, &text) {
            panic!("{}: {diagnostic}", sources.location(diagnostic.span()));
        }
    }
}
