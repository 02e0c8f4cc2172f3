//! What becomes of a model: variables, structure and derivatives, and what is refused.

use super::*;

/// A parameter that follows from others cannot be set, and changes with them; so does a start value.
#[test]
fn what_follows_from_parameters_is_calculated() {
    let unit = export("Bound", Version::V3).unwrap();
    let part = |name: &str| {
        let own = unit.description.find(name).unwrap();
        (own.causality, own.initial)
    };
    let calculated = (Causality::CalculatedParameter, Some(Initial::Calculated));
    assert_eq!(part("a"), (Causality::Parameter, Some(Initial::Exact)));
    assert_eq!(["b", "c", "d", "e"].map(part), [calculated; 4]);
    assert_eq!(part("x"), (Causality::Local, Some(Initial::Calculated)));
    assert_eq!(part("z"), (Causality::Local, Some(Initial::Exact)));
    let unknowns = &unit.description.structure.initial_unknowns;
    for name in ["b", "c", "d", "e", "x"] {
        let place = unit.description.variables.iter().position(|own| own.name == name);
        assert!(unknowns.iter().any(|own| Some(own.variable) == place), "{name}");
    }
    let own = Instance::new(&unit, true);
    own.set("Float64", "a", 3.0);
    assert_eq!(own.try_set("Float64", own.reference("b"), 5.0), 3);
    own.begin();
    assert_eq!(
        ["b", "c", "d", "e", "x"].map(|name| own.get::<f64>("Float64", name)),
        [6.0, 7.0, 7.0, 9.0, 6.0]
    );
    own.plain("fmi3ExitInitializationMode");
    own.step(0.0, 0.5);
    close(own.get("Float64", "x"), 6.0 * (-3.5f64).exp(), 1e-7);
    close(own.get("Float64", "z"), 8.5, 1e-7);
}

#[test]
fn signals_in_connectors_of_the_model_are_its_own() {
    let unit = export("Tank", Version::V3).unwrap();
    let causality = |name: &str| unit.description.find(name).unwrap().causality;
    assert_eq!(causality("inlet.rate"), Causality::Input);
    assert_eq!(causality("inlet.level"), Causality::Output);
    let own = Instance::new(&unit, true);
    own.initialize();
    own.step(0.0, 1.0);
    close(own.get("Float64", "inlet.level"), 6.0, 1e-9);
    own.set("Float64", "inlet.rate", -1.0);
    own.step(1.0, 1.0);
    close(own.get("Float64", "inlet.level"), 3.0, 1e-9);
}

/// Causalities of a connector are those of all that is in it, and an equation may have any form.
#[test]
fn connectors_in_connectors_are_inputs_and_outputs() {
    let unit = export("Exchanger", Version::V3).unwrap();
    let causality = |name: &str| unit.description.find(name).unwrap().causality;
    for name in ["port.rate", "port.forward.T", "port.forward.c[1]", "port.forward.c[2]"] {
        assert_eq!(causality(name), Causality::Input, "{name}");
    }
    for name in ["port.backward.T", "port.backward.c[1]", "port.backward.c[2]"] {
        assert_eq!(causality(name), Causality::Output, "{name}");
    }
    let own = Instance::new(&unit, true);
    own.set("Float64", "port.forward.c[2]", 5.0);
    own.initialize();
    own.step(0.0, 0.5);
    close(own.get("Float64", "port.backward.T"), 1.0 + 0.5 * 2.0 * 6.0 * 2.0, 1e-7);
    assert_eq!(own.get::<f64>("Float64", "port.backward.c[2]"), 5.0);
}

#[test]
fn elements_of_array_inputs_are_inputs() {
    let unit = export("Vector", Version::V3).unwrap();
    let own = Instance::new(&unit, true);
    own.begin();
    assert_eq!(own.get::<f64>("Float64", "y"), 321.0);
    own.set("Float64", "u[3]", 0.25);
    own.set("Float64", "v[2]", 2.5);
    assert_eq!(own.get::<f64>("Float64", "y"), 44.0);
    own.plain("fmi3ExitInitializationMode");
    own.step(0.0, 1.0);
    close(own.get("Float64", "x"), 1.5, 1e-7);
    assert_eq!(own.derivative("y", "u[2]", false), 10.0);
    assert_eq!(own.derivative("der(x)", "v[1]", true), -1.0);
}

#[test]
fn derivatives_through_a_loop_are_exact() {
    let unit = export("Loop", Version::V3).unwrap();
    let exchange = Instance::new(&unit, false);
    exchange.initialize();
    let z: f64 = exchange.get("Float64", "z");
    close(z + 0.1 * z.powi(3) + z.sin(), 1.0, 1e-9);
    let expected = 1.0 / (1.0 + 0.3 * z * z + z.cos());
    close(exchange.derivative("z", "x", false), expected, 1e-9);
    close(exchange.derivative("der(x)", "x", false), -expected, 1e-9);
}

/// During the initialization values move with the parameters, initial ones as well.
#[test]
fn derivatives_of_initial_values_are_exact() {
    let unit = export("Begun", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.set("Float64", "a", 1.5);
    own.begin();
    let (a, x0) = (1.5, 3.0);
    let w: f64 = own.get("Float64", "w");
    close(w.powi(3) + w, a, 1e-9);
    let cases = [
        ("x", "a", x0),
        ("x", "x0", a),
        ("w", "a", 1.0 / (3.0 * w * w + 1.0)),
        ("w", "z", 0.0),
        ("z", "z", 1.0),
        ("y", "a", 2.0 * a * x0),
        ("der(x)", "x0", -a * a),
        ("der(z)", "a", x0),
    ];
    for (of, by, expected) in cases {
        for is_adjoint in [false, true] {
            let found = own.derivative(of, by, is_adjoint);
            assert!((found - expected).abs() <= 1e-9, "∂{of}/∂{by} = {found}, not {expected}");
        }
    }
    own.plain("fmi3ExitInitializationMode");
    own.update();
    own.plain("fmi3EnterContinuousTimeMode");
    close(own.derivative("y", "a", false), a * x0, 1e-9);
}

/// FMI 3.0 counts parameters and the time among what an unknown may depend on.
#[test]
fn derivatives_by_parameters_and_the_time_are_exact() {
    let unit = export("Chain", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.set("Float64", "a", 1.5);
    own.initialize();
    own.update();
    own.plain("fmi3EnterContinuousTimeMode");
    let (t, x, a) = (0.7f64, 2.0, 1.5);
    own.place(t, &[x]);
    let z: f64 = own.get("Float64", "z");
    let slope = 1.0 / (1.0 + 0.3 * z * z + z.cos());
    let cases = [
        ("der(x)", "a", -2.0 * x + t.sin()),
        ("der(x)", "time", a * t.cos()),
        ("der(x)", "x", -2.0 * a),
        ("der(x)", "u", 1.0),
        ("y", "a", t),
        ("y", "time", a),
        ("z", "a", slope * 2.0 * x),
        ("z", "time", slope),
        ("z", "unused", 0.0),
        ("x", "a", 0.0),
    ];
    for (of, by, expected) in cases {
        for is_adjoint in [false, true] {
            let found = own.derivative(of, by, is_adjoint);
            assert!((found - expected).abs() <= 1e-9, "∂{of}/∂{by} = {found}, not {expected}");
        }
    }
    // A loop may make everything of everything.
    assert_eq!(own.dependencies("der(x)"), None);

    let unit = export("Smooth", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    assert_eq!(own.dependencies("der(x)"), Some(vec!["a", "u", "x"]));
    assert_eq!(own.dependencies("y"), Some(vec!["time", "a", "x"]));
    let unit = export("Smooth", Version::V2).unwrap();
    let own = Instance { pointer: std::ptr::null_mut(), unit: &unit };
    assert_eq!(own.dependencies("der(x)"), Some(vec!["u", "x"]));
    assert_eq!(own.dependencies("y"), Some(vec!["time", "x"]));

    // Initial equations determine a parameter: what it follows from is not differentiated.
    let unit = export("Bound", Version::V3).unwrap();
    let own = Instance::new(&unit, false);
    own.initialize();
    let run: Symbol<Derivative> = function("fmi3GetDirectionalDerivative");
    let (of, by, seed, mut out) = (own.reference("der(z)"), own.reference("a"), 1.0, 0.0);
    let status = unsafe {
        run(own.pointer, &raw const of, 1, &raw const by, 1, &raw const seed, 1, &raw mut out, 1)
    };
    assert_eq!(status, 3);
    let said = |what: &str| MESSAGES.lock().unwrap().iter().any(|message| message.contains(what));
    assert!(said("initial equations determine parameters of the model"));
}

#[test]
fn what_a_unit_cannot_do_is_refused_with_its_place() {
    let refused = |class: &str| export(class, Version::V3).err().unwrap_or_default();
    let fast = refused("Fast");
    assert!(fast.contains("depends on the derivative of its input `u`"), "{fast}");
}

#[test]
fn a_unit_has_the_same_bytes_again_and_no_path() {
    let bytes = |unit: &Unpacked| std::fs::read(unit.folder.path().join(FILE)).unwrap();
    let (one, two) = (export("Ball", Version::V2).unwrap(), export("Ball", Version::V2).unwrap());
    assert_eq!(bytes(&one), bytes(&two));
    assert_eq!(one.description, two.description);
    let content = String::from_utf8_lossy(&bytes(&one)).into_owned();
    assert!(!content.contains("Classes.mo"));
}
