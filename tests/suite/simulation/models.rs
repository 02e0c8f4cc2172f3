//! The shipped models.

use crate::support::shipped;
use std::collections::BTreeSet;

/// `package.order` names what is there, and all of it.
#[test]
fn packages_list_their_classes() {
    for path in shipped::files("models", "order") {
        let folder = path.parent().unwrap();
        let order = std::fs::read_to_string(&path).unwrap();
        let listed: BTreeSet<&str> = order.lines().collect();
        for entry in std::fs::read_dir(folder).unwrap() {
            let entry = entry.unwrap().path();
            let class = entry.file_stem().unwrap().to_str().unwrap();
            let is_package = entry.join("package.mo").exists();
            let is_class = is_package || entry.extension().is_some_and(|e| e == "mo");
            let is_listed = class == "package" || listed.contains(class);
            assert!(!is_class || is_listed, "{} does not name {class}", path.display());
        }
    }
}

/// Every model of `models/CaseStudies` says how long it is to be simulated, and can be.
#[test]
fn case_studies_simulate_as_they_say() {
    for model in [
        "CaseStudies.PolarizationCurve",
        "CaseStudies.PolarizationCurve(Ilim = 2, i_max = 1.46)",
        "CaseStudies.Stack",
    ] {
        let script = format!(
            "openModel(\"models/CaseStudies/package.mo\");\nok := simulateModel(\"{model}\");\n"
        );
        let run = shipped::run("test.mos", &script);
        assert_eq!(run.errors, "", "{model}");
        assert_eq!(run.session.variable("ok"), Some(&true.into()), "{model}");
    }
}
