//! Systems that are structurally regular and yet singular: one of many solutions is not taken
//! without a word, and contradictions are errors.

use crate::support::simulated::{compiled, near};
use gapilib::Session;
use gapilib::internals::codegen::Access;
use gapilib::internals::sim::{Settings, simulate};
use gapilib::world::MemoryWorld;

/// Exit code, and what was reported, after simulating a model of these declarations and equations.
fn simulated(text: &str) -> (u8, String) {
    let model = format!("model M {text} end M;");
    let world = MemoryWorld::new().with_file("M.mo", &model);
    let streams = world.streams();
    let script = "openModel(\"M.mo\");\nsimulateModel(\"M\", stopTime = 1);";
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    (status.code, streams.errors())
}

/// The simulation reaches its end, with exactly one warning that begins thus.
fn warns(text: &str, of: &str) {
    let (code, errors) = simulated(text);
    assert_eq!(code, 0, "{text}: {errors}");
    assert_eq!(errors.matches("warning[undetermined]").count(), 1, "{text}: {errors}");
    assert!(errors.contains(of), "{text}: {errors}");
}

#[test]
fn redundant_equations_are_reported_with_their_unknowns() {
    warns("Real a, b; equation a + b = 1; 2*a + 2*b = 2;", "do not determine `a`, `b`");
    // A state is determined although what moves it is not.
    warns(
        "Real a, b, c(start = 0, fixed = true);
         equation a + b = c; 2*a + 2*b = 2*c; der(c) = a - b;",
        "do not determine `a`, `b`",
    );
    // Only some of the unknowns of a loop are open.
    warns(
        "Real a[4]; parameter Real k = 1;
         equation a[1] + a[2] + time*a[3] = 2; k*a[1] + a[2] + 2*a[3] = 2;
           (2 + time)*a[3] + a[1] + a[2] - a[4] = 2; a[4]*(3 + time) + a[3] = a[4] + k*a[3];",
        "do not determine `a[1]`, `a[2]`",
    );
}

/// The value at the end of a simulation of 1 s.
fn last(text: &str, name: &str) -> f64 {
    let program = compiled(&format!("model M {text} end M;")).expect("compiles");
    let mut system = program.system();
    let settings = Settings { stop: 1.0, ..Settings::default() };
    let (rows, _) = simulate(&mut system, &settings).expect("runs");
    let at = program.find_variable(name).expect("the variable exists");
    match program.variables()[at].access {
        Access::Observed { column, negated } => {
            let value = *rows.column(column).last().expect("a row");
            if negated { -value } else { value }
        }
        _ => system.value(at).expect("a parameter"),
    }
}

#[test]
fn the_solution_of_least_norm_is_taken() {
    let constant = "Real a, b; equation a + b = 1; 2*a + 2*b = 2;";
    let oblique = "Real a, b; equation a + 2*b = 5; 2*a + 4*b = 10;";
    let moving = "Real x(start = 0, fixed = true); Real a, b;
        equation der(x) = a; a + b = time; 3*a + 3*b = 3*time;";
    let by_parameter = "parameter Real k = 2; Real a, b; equation a + b = 1; k*a + 2*b = 2;";
    let parameters = "parameter Real a(fixed = false); parameter Real b(fixed = false);
        initial equation a + b = 1; 2*a + 2*b = 2;";
    let three = "Real a, b, c; equation a + b + c = 1; a - b = 0; 2*a + c = 1;";
    let cases: [(&str, &[(&str, f64)]); 6] = [
        (constant, &[("a", 0.5), ("b", 0.5)]),
        (oblique, &[("a", 1.0), ("b", 2.0)]),
        (moving, &[("a", 0.5), ("b", 0.5), ("x", 0.25)]),
        (by_parameter, &[("a", 0.5), ("b", 0.5)]),
        (parameters, &[("a", 0.5), ("b", 0.5)]),
        // a and b are one unknown: of 2 a + c = 1 the point nearest to the origin.
        (three, &[("a", 0.4), ("b", 0.4), ("c", 0.2)]),
    ];
    for (text, expected) in cases {
        for (name, value) in expected {
            near(last(text, name), *value, 1e-5);
        }
        warns(text, "one of many solutions is used");
    }
}

#[test]
fn a_coefficient_of_zero_leaves_its_unknown_open() {
    warns("parameter Real k = 0; Real x; equation k*x = 0;", "do not determine `x`");
    // For a while only.
    warns(
        "Real x; equation (if time < 0.5 then 1 else 0)*x = 0;",
        "do not determine `x`: their system is singular, and one of many solutions is used (from \
         t = 0.5",
    );
}

#[test]
fn initial_equations_that_depend_on_each_other_are_reported() {
    warns(
        "parameter Real k = 2; Real x, y; equation der(x) = 1; der(y) = x;
         initial equation x + y = 1; k*x + 2*y = 2;",
        "do not determine `x`, `y`",
    );
}

#[test]
fn a_nonlinear_loop_that_leaves_unknowns_open_is_solved_and_reported() {
    let text = "Real x(start = 1), y; equation (x + y)^2 = 1 + time; 2*(x + y)^2 = 2 + 2*time;";
    warns(text, "may not determine `x`, `y`");
    let sum = format!("Real s = x + y; {text}");
    assert!((last(&sum, "s") - 2.0f64.sqrt()).abs() < 1e-6);
}

#[test]
fn a_network_without_ground_has_its_currents() {
    // Three resistors in a triangle, and loads of constant power between its corners.
    let text = "Real v[3](start = {3, 0, -3}); Real i[3];
        Real p = 1 + 0.15*time;
        equation
          i = {v[1] - v[2], v[2] - v[3], v[3] - v[1]};
          (v[1] - v[2])*(i[1] - i[3]) = 9*p; (v[1] - v[2])*(i[2] - i[1]) = 0;
          (v[1] - v[2])*(i[3] - i[2]) = -9*p;";
    warns(text, "may not determine");
    // v1 - v2 = v2 - v3 = d: d (d + 2 d) = 9 p, with p = 1.15 at the end.
    let difference = format!("Real d = v[1] - v[2]; {text}");
    assert!((last(&difference, "d") - (3.0f64 * 1.15).sqrt()).abs() < 1e-12);
}

/// The energy balance of a pump without flow is 0 = 0: its medium stays as warm as it was.
#[test]
fn what_nothing_determines_any_more_stays_as_it_was() {
    let pump = "function density input Real p; input Real h; output Real d; algorithm
          d := 1 + 0.01*h^2 + 0.001*p; annotation(Inline = false); end density;
        Real v(start = 1); Real h(start = 1); Real p(start = 2); Real m; Real rho;
        Real open = max(1 - 2*time, 0); Real q(start = 0, fixed = true);
        equation m = open*(p - 1)/sqrt(abs(p - 1) + 0.1); m = rho*v; rho = density(p, h);
          p = rho*(2 - v - v^2); der(q) = v;
          0 = (if m > 0 then m else m*h) - (if m > 0 then m*h else m) + v*p/0.8;";
    warns(pump, "may not determine `p`, `h`, `v`");
    // As long as there is a flow, h = 1 + p/(0.8 rho), with p = 2 rho when it ends.
    near(last(pump, "h"), 3.5, 1e-3);
    near(last(pump, "v"), 0.0, 1e-12);
}

/// The end of a heat exchanger without flow: m (T - 300) = Q is 0 = 0.
#[test]
fn what_a_linear_system_leaves_open_stays_as_it_was() {
    let exchanger = |end: f64| {
        format!(
            "Real T(start = 350); Boolean on = time >= 0.25 and time < 0.75 and time < {end};
             Real m = if on then 2 else 0; Real q = if on then 20 else 0;
             equation m*T - m*300 = q;"
        )
    };
    warns(&exchanger(1.0), "do not determine `T`");
    // 310 with flow, and afterwards as well; 350 where there never was any.
    near(last(&exchanger(1.0), "T"), 310.0, 1e-9);
    near(last(&exchanger(0.0), "T"), 350.0, 1e-9);
}

/// The torque of an axis about which nothing turns: its coefficient is what rounding leaves of zero, and
/// a Newton step that divides by it would be as long as it likes.
#[test]
fn what_rounding_alone_determines_stays_at_its_start() {
    let text = "parameter Real k = 1e-30; Real a(start = 5), b(start = 0.5);
        equation b + b^3 + k*a*b = 0.101; 2*b + b^3 + k*a*b = 0.201;";
    near(last(text, "b"), 0.1, 1e-12);
    near(last(text, "a"), 5.0, 1e-6);
}

#[test]
fn a_turning_point_is_an_error() {
    let text = "Real x(start = 1), y; equation x^2 + y = 1 - time; y = 0.5*time;";
    let (code, errors) = simulated(text);
    assert_eq!(code, 1, "{errors}");
}

#[test]
fn contradictions_are_errors() {
    for text in [
        "Real a, b; equation a + b = 1; 2*a + 2*b = 3;",
        "parameter Real k = 0; Real x; equation k*x = 1;",
        "Real x; equation 0*x = 0;",
        "Real x; equation x - x = 0;",
    ] {
        let (code, errors) = simulated(text);
        assert_eq!(code, 1, "{text}: {errors}");
        let words = ["no unique solution", "do not determine its variables"];
        assert!(words.iter().any(|words| errors.contains(words)), "{text}: {errors}");
    }
}

#[test]
fn regular_systems_are_not_reported() {
    for text in [
        "Real a, b; equation a + b = 1; 2*a + 2.001*b = 2;",
        "Real a, b; equation 1e-9*a + 1e9*b = 0; 1e9*a - 1e-9*b = 0;",
        "Real a, b; equation a + (1 + time)*b = 0; a - b = 0;",
    ] {
        let (code, errors) = simulated(text);
        assert!(code == 0 && errors.is_empty(), "{text}: {errors}");
    }
}
