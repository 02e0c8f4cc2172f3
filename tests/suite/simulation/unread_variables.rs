//! Variables that results show and nothing reads: where they have no value, a simulation that somebody
//! listens to goes on and says so; what anything depends on must have a value.

use crate::support::simulated::{compiled, near};
use gapilib::internals::codegen::Access;
use gapilib::internals::sim::{Settings, Simulator, Trajectory};

/// Warnings, and the values of a variable at the start and at the end; or why there are none.
#[allow(clippy::type_complexity, reason = "a closure has no name")]
fn simulated(
    text: &str,
    listens: bool,
) -> Result<(Vec<String>, impl Fn(&str) -> [f64; 2]), String> {
    let program = compiled(text).expect("the model compiles");
    let mut system = program.system();
    if listens {
        system.listen();
    }
    let mut rows = Trajectory::default();
    let settings = Settings { tolerance: 1e-8, ..Settings::default() };
    let ended = Simulator::new().run(&mut system, &settings, &mut rows);
    ended.map_err(|error| system.explain(&error).message.clone())?;
    let warnings = system.log_messages().0.iter().map(|message| message.text.clone()).collect();
    let values = move |name: &str| {
        let at = program.find_variable(name).expect("the variable exists");
        let Access::Observed { column, .. } = program.variables()[at].access else {
            panic!("`{name}` is not observed")
        };
        let values = rows.column(column);
        [values[0], *values.last().expect("a row")]
    };
    Ok((warnings, values))
}

const EMPTY_PIPE: &str = "model M parameter Real h0 = 0; Real area = 10*h0; Real q = 0*time; \
    Real v = q/area; Real w = v + 1; Real x(start = 1, fixed = true); \
    equation der(x) = -x; end M;";

#[test]
fn what_nothing_reads_may_have_no_value() {
    let (warnings, values) = simulated(EMPTY_PIPE, true).expect("the simulation goes on");
    near(values("x")[1], (-1f64).exp(), 1e-6);
    assert!(values("v").iter().all(|v| v.is_nan()) && values("w").iter().all(|w| w.is_nan()));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].starts_with("`v` has no value"), "{warnings:?}");
}

#[test]
fn it_has_its_values_where_there_are_some() {
    let text = "model M Real x(start = 0, fixed = true); Real r = sin(x)/x; Real s = r + 1; \
        Real t = 1/(1 - time); equation der(x) = 1; end M;";
    let (warnings, values) = simulated(text, true).expect("the simulation goes on");
    assert!(values("r")[0].is_nan() && values("s")[0].is_nan());
    near(values("x")[1], 1.0, 1e-9);
    near(values("r")[1], 1f64.sin(), 1e-8);
    near(values("s")[1], 1.0 + 1f64.sin(), 1e-8);
    near(values("t")[0], 1.0, 1e-9);
    assert!(values("t")[1].is_nan());
    assert_eq!(warnings.len(), 2, "{warnings:?}");
}

#[test]
fn an_identification_does_not_go_on_without_a_value() {
    let error = simulated(EMPTY_PIPE, false).err().expect("nobody would hear the warning");
    assert!(error.starts_with("`v` has no value at t = 0: a division by zero"), "{error}");
}

#[test]
fn what_something_reads_must_have_a_value() {
    let models = [
        ("Real v = time/(0*x); equation der(x) = -x + 0*v;", "`v`"),
        ("Boolean b = sqrt(x - 0.5) > 0.1; equation der(x) = -x;", "`sqrt`"),
        ("Real v = sqrt(0.5 - time); equation der(x) = -x;", "`v`"),
        ("Real v = x/(time*0); equation der(x) = -x; assert(v < 1, \"too fast\");", "`v`"),
        ("Real v = 1/(x - x); equation der(x) = if v > 2 then 1 else -1;", "by zero"),
    ];
    for (rest, named) in models {
        let text = format!("model M Real x(start = 1, fixed = true); {rest} end M;");
        let error = simulated(&text, true).err().expect("it fails");
        assert!(error.contains(named), "{rest}: {error}");
    }
}

#[test]
fn parameters_are_finite() {
    for (binding, value) in [("big*big", "p"), ("exp(1000*big)", "p"), ("-log(0*big)", "p")] {
        let text = format!(
            "model M parameter Real big = 1e200; parameter Real p = {binding}; \
             Real x = min(p, time); end M;"
        );
        let error = simulated(&text, true).err().expect("an infinite parameter is an error");
        assert!(error.contains(&format!("`{value}` has no value")), "{binding}: {error}");
    }
    let program = compiled("model M parameter Real p = 1; Real x = p*time; end M;").expect("M");
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(program.system().set_parameter(0, value).is_err(), "{value}");
    }
}
