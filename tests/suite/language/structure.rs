//! The sorted system of every model in `tests/structure`.

use crate::support::flat_class::flat;
use crate::support::shipped::{project, world};
use gapilib::Diagnostic;
use gapilib::Session;
use gapilib::internals::causalize::{PASSES, Pass, causalize, check, dump, report, sizes};
use gapilib::internals::codegen::Program;
use gapilib::internals::flatten::FlatModel;
use gapilib::internals::script::models::simulation::flat_model;
use gapilib::internals::sim::{Residual, Settings, Simulator, Trajectory};
use std::path::Path;

#[test]
fn sorted_systems() {
    shown("", |flat| causalize(flat).map(|sorted| report(&sorted)));
}

#[test]
fn sizes_after_every_pass() {
    shown(".sizes", sizes);
}

/// Editors check a model without solving it, with the errors of a simulation.
#[test]
fn a_check_finds_what_causalization_finds() {
    // Wrong between events, at events, and at the start.
    let wrong = [
        "model Twice Real x; Real y; equation x = 1; x = 2; y*0 = time; end Twice;",
        "model Whole Integer i; Integer j; equation i + j = 3; i - j = 1; end Whole;",
        "model Free parameter Real p(fixed = false); Real x; equation x = p; end Free;",
    ];
    let entries = std::fs::read_dir(project("tests/structure")).expect("a folder");
    let files = entries.map(|entry| entry.expect("an entry").path());
    let models = files.filter(|path| path.extension().is_some_and(|extension| extension == "mo"));
    let models = models.map(|path| std::fs::read_to_string(path).expect("a model"));
    let mut count = 0;
    for text in models.chain(wrong.map(str::to_owned)) {
        let flat = flat(&text);
        let (found, expected) = (check(&flat).err(), causalize(&flat).err());
        count += usize::from(expected.is_some());
        assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{text}");
    }
    assert!(count > wrong.len(), "{count}");
}

#[test]
fn every_pass_can_be_shown() {
    let root = env!("CARGO_MANIFEST_DIR");
    let text = std::fs::read_to_string(format!("{root}/tests/structure/Gear.mo")).expect("a model");
    let flat = flat(&text);
    let shown = |pass: &str| dump(&flat, pass).expect("the model can be sorted");
    for Pass { name: pass, .. } in PASSES {
        assert!(shown(pass).is_some(), "{pass}");
    }
    assert_eq!(shown("nothing"), None);
    let (before, after) = (shown("build").unwrap(), shown("eliminate_aliases").unwrap());
    assert!(!before.contains("\nalias ") && after.contains("\nalias "), "{after}");
}

#[test]
fn sizes_of_the_shipped_models_after_every_pass() {
    let mut session = Session::new(Box::new(world()));
    for model in [
        "FuelCellLib.casestudies.FC2Layer",
        "FuelCellLib.casestudies.FC3Layer",
        "CaseStudies.LoadSteps",
        "CaseStudies.WaterEffect",
    ] {
        let flat = flat_model(&mut session, model)
            .unwrap_or_else(|errors| panic!("{model}: {}", errors[0].message));
        let (_, name) = model.rsplit_once('.').expect("a class of a package");
        let folder = project("tests/structure");
        snapshot(&folder, &format!("{name}.sizes"), sizes(&flat).expect("it can be sorted"));
    }
}

/// A loop through all control volumes would fill the Jacobian; unknowns of it that the integrator
/// holds besides keep it a band with a border, and nobody sees them.
#[test]
fn nonzeros_of_the_jacobian_grow_with_the_control_volumes() {
    let mut session = Session::new(Box::new(world()));
    let mut cost = |n: u32| {
        let class = format!("CaseStudies.LoadSteps(n = {n})");
        let flat = flat_model(&mut session, &class).expect("a model");
        let program = Program::compile(causalize(&flat).expect("it can be sorted")).expect("code");
        let mut system = program.system();
        let settings = Settings { stop: 25.0, tolerance: 1e-6, ..Settings::default() };
        let mut trajectory = Trajectory::default();
        let ran = Simulator::new().run(&mut system, &settings, &mut trajectory);
        let steps = ran.expect("it can be simulated").steps as usize;
        (system.n_auxiliary(), system.pattern().rows.len(), steps)
    };
    let [(few, nonzeros, steps), (many, twice, as_many)] = [100, 200].map(&mut cost);
    assert!(few > 0 && many > few, "{few} and {many} unknowns besides");
    assert!(10 * twice < 22 * nonzeros, "{nonzeros} and {twice} nonzeros");
    assert!(4 * as_many < 5 * steps, "{steps} and {as_many} steps");
}

/// What a view shows of every model in `tests/structure`, as snapshots.
fn shown(suffix: &str, view: impl Fn(&FlatModel) -> Result<String, Diagnostic>) {
    insta::glob!("../../structure", "*.mo", |path| {
        let text = std::fs::read_to_string(path).expect("the model can be read");
        let shown = view(&flat(&text)).unwrap_or_else(|diagnostic| {
            format!(
                "error[{}]: {}\n{}",
                diagnostic.code.slug,
                diagnostic.message,
                diagnostic.helps.join("\n")
            )
        });
        let name = path.file_stem().expect("a file has a name").to_string_lossy();
        snapshot(
            path.parent().expect("a file lies in a folder"),
            &format!("{name}{suffix}"),
            shown,
        );
    });
}

fn snapshot(folder: &Path, name: &str, text: String) {
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_snapshot_suffix("");
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!(name, text));
}
