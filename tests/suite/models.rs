//! The shipped models.

use crate::shipped;
use gapilib::source::SourceMap;
use gapilib::syntax;

#[test]
fn every_model_parses() {
    for path in shipped::files("models", "mo") {
        let text = std::fs::read_to_string(&path).unwrap();
        let sources = SourceMap::default();
        let source = sources.add(path.display().to_string(), text.clone());
        if let Err(diagnostic) = syntax::parse_stored_definition(source, &text) {
            panic!("{}: {diagnostic}", sources.location(diagnostic.span()));
        }
    }
}

/// Every model of `models/CaseStudies` says how long it is to be simulated, and can be.
#[test]
fn case_studies_simulate_as_they_say() {
    for model in
        ["CaseStudies.PolarizationCurve", "CaseStudies.PolarizationCurve(Ilim = 2, i_max = 1.46)"]
    {
        let script = format!(
            "openModel(\"models/CaseStudies/package.mo\");\nok := simulateModel(\"{model}\");\n"
        );
        let run = shipped::run("test.mos", &script);
        assert_eq!(run.errors, "", "{model}");
        assert_eq!(run.session.variable("ok"), Some(&true.into()), "{model}");
    }
}
