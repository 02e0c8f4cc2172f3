//! Shipped models, compiled and evaluated without a script.

use crate::support::shipped;
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::{self, Library};
use gapilib::internals::ga::Genomes;
use gapilib::internals::identify::{CompiledModel, Evaluator, Question};
use gapilib::internals::source::SourceMap;
use gapilib::internals::{causalize, syntax};

fn polarization_curve(problem: &str) -> CompiledModel {
    let mut library = Library::new();
    let sources = SourceMap::default();
    for name in ["package.mo", "PolarizationCurve.mo"] {
        let path = shipped::project("models/CaseStudies").join(name);
        let text = std::fs::read_to_string(path).unwrap();
        let source = sources.add(name, text.clone());
        library.load(&syntax::parse_stored_definition(source, &text).unwrap()).unwrap();
    }
    let source = sources.add("problem", problem);
    let (class, modification) = syntax::parse_class_with_modification(source, problem).unwrap();
    let flat = flatten::flatten(&library, &class, &modification).unwrap();
    let program = Program::compile(causalize::causalize(&flat.model).unwrap()).unwrap();
    CompiledModel::new(problem, program)
}

fn question(x: &[f64]) -> Question {
    Question {
        parameters: Vec::new(),
        x_name: "i".to_owned(),
        y_name: String::new(),
        x: x.to_vec(),
    }
}

#[test]
fn polarization_curve_is_the_formula_at_exactly_the_measured_currents() {
    let model = polarization_curve("CaseStudies.PolarizationCurve(i_max = 1.46)");
    let x = [0.0, 0.0325, 0.107, 1.46];
    let evaluator = Evaluator::new(std::sync::Arc::new(model), question(&x), 2).unwrap();
    let names: Vec<&str> = evaluator.study().parameters.iter().map(|p| p.name.as_str()).collect();
    assert_eq!(names, ["A", "In", "Io", "B", "R", "Ilim"]);
    assert_eq!(evaluator.study().y.unit, "V");
    let genome = [0.02856, 0.01077, 2.338e-7, 0.1064, 0.2559, 2.028];
    let failing = [0.02856, 0.01077, 2.338e-7, 0.1064, 0.2559, 1.465];
    let genomes = Genomes::new(6, [genome, failing].concat()).unwrap();
    let simulated = evaluator.evaluate(&genomes).unwrap();
    let [a, i_n, io, b, r, ilim] = genome;
    for (found, i) in simulated.rows.iter().zip(x) {
        let total: f64 = i + i_n;
        let voltage = 1.2 - r * total - a * (total / io).ln() + b * (1.0 - total / ilim).ln();
        assert!((found - voltage).abs() < 2e-16 * 8.0, "{found} {voltage}");
    }
    let message = &simulated.messages()[1];
    assert!(message.starts_with("i + In < Ilim does not hold"), "{message}");
    assert!(simulated.rows[4..].iter().all(|value| value.is_nan()));
}
