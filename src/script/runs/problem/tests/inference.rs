//! Problems that ask for more than estimates.

use super::*;
use crate::identify::problem::EndingKind;
use crate::identify::problem::inference::compare;

pub(super) const EMPTIES: &str = "
model = \"Free\"
files = [\"tank.mo\"]
[parameters]
k = { min = 0.1, max = 5 }
area = { min = 0.1, max = 10 }
[[experiment]]
name = \"empties\"
data = \"d.csv\"
outputs = { q = { column = \"q\", sigma = 0.01 } }
tolerance = 1e-9
[stop]
evaluations = 600
";

/// q of the emptying tank with an error that alternates.
pub(super) fn data() -> String {
    let mut sign = 1.0;
    let mut rows = Vec::new();
    for k in 0..17 {
        let t = f64::from(k) / 4.0;
        sign = -sign * if k % 3 == 0 { -1.0 } else { 1.0 };
        rows.push(format!("{t},{}", 0.8 * height(t, 1.0, 0.0) + 0.01 * sign));
    }
    format!("time,q\n{}\n", rows.join("\n"))
}

fn value(solution: &Solution, name: &str) -> f64 {
    solution.parameters.iter().find(|p| p.name == name).unwrap().value
}

#[test]
fn bands_and_plans_reach_beyond_what_was_measured() {
    let problem = EMPTIES.replace(
        "[parameters]",
        "bands = [\"h\"]\n[design]\npoints = 4\nrange = [0, 10]\noutputs = { h = 0.001 }\n[parameters]",
    );
    let solution = solved(&[("p.toml", problem), ("d.csv", data())]);
    let bands = &solution.inferred.bands;
    let names: Vec<&str> = bands.iter().map(|band| band.y[0].as_str()).collect();
    assert_eq!(names, ["q", "h"]);
    // h begins at 1 whatever the parameters are.
    assert!(bands[1].points[0].confidence.unwrap() < 1e-9);
    assert!(bands[1].points[50].confidence.unwrap() > 1e-3);
    assert_eq!(bands[0].points.last().unwrap().x, 4.0, "as far as it is simulated");
    let next = solution.inferred.next_measurement.as_ref().unwrap();
    let plans: Vec<_> = next.proposals.iter().filter(|p| p.criterion == "interval").collect();
    // An exact output is worth more than a noisy one: it gives k/area, and q gives k.
    assert_eq!(plans[1].plans[0].variable, "h", "{plans:?}");
    let text = solution.text();
    assert!(text.contains("would narrow the 95 % interval of area from ±"), "{text}");
    assert!(text.contains("h of empties, which was not measured, is known to ±0."), "{text}");
    let again: Solution = serde_json::from_str(&solution.to_json()).unwrap();
    assert_eq!(again.text(), text);
}

#[test]
fn priors_weigh_against_the_data() {
    // The amplitude gives k with a standard error of about 1 %, so a prior of 0.01 % dominates it.
    let prior = |prior: &str| EMPTIES.replace("max = 5 }", &format!("max = 5, prior = {prior} }}"));
    let solve = |prior_text: &str| solved(&[("p.toml", prior(prior_text)), ("d.csv", data())]);
    let narrow = solve("{ mean = 0.82, sd = 0.0001 }");
    assert!((value(&narrow, "k") - 0.82).abs() < 1e-3, "{}", value(&narrow, "k"));
    assert_eq!(narrow.series.len(), 1);
    assert!(
        narrow.text().contains("The estimate of k comes only from its prior"),
        "{}",
        narrow.text()
    );
    let wide = solve("{ median = 0.82, factor = 3 }");
    assert!((value(&wide, "k") - 0.8).abs() < 0.02, "{}", value(&wide, "k"));
    assert!(!wide.text().contains("prior of k"), "{}", wide.text());
    let refused = |text: &str| refusal(text, &data());
    assert!(refused(&prior("{ mean = 0.8 }")).contains("cannot be read"));
    let without = prior("{ mean = 0.8, sd = 0.1 }").replace(", sigma = 0.01", "");
    assert!(refused(&without).contains("must be weighted against the data"));
    let fixed =
        EMPTIES.replace("k = { min = 0.1, max = 5 }", "k = { fixed = 1, prior = \"uniform\" }");
    assert!(refused(&fixed).contains("`k` has a prior but is not estimated"));
}

#[test]
fn a_steady_state_before_the_experiment() {
    let steps = "model Steps\n  extends Tank(u = if time < 1 then 1 else 3);\nend Steps;\n";
    let problem = EMPTIES
        .replace("\"Free\"", "\"Steps\"")
        .replace("[\"tank.mo\"]", "[\"tank.mo\", \"steps.mo\"]")
        .replace("[[experiment]]", "[[experiment]]\nsteady_state = true");
    let data = table("time,q", |t| {
        let h = if t < 1.0 { 1.25 } else { 3.75 - 2.5 * (-0.4 * (t - 1.0)).exp() };
        (0.8 * h).to_string()
    });
    let files =
        [("p.toml", problem.clone()), ("d.csv", data.clone()), ("steps.mo", steps.to_owned())];
    let solution = solved(&files);
    // q depends on k/area alone in this experiment.
    let rate = value(&solution, "k") / value(&solution, "area");
    assert!((rate - 0.4).abs() < 1e-4, "{rate}");
    assert!(solution.series[0].rmse < 1e-5, "{}", solution.series[0].rmse);
    let with_start =
        EMPTIES.replace("[[experiment]]", "[[experiment]]\nsteady_state = true\nstart = { h = 2 }");
    assert!(refusal(&with_start, &data).contains("the initial value of `h` cannot be chosen"));
}

/// A ⇌ B keeps the sum of both: the rest state has the sum of the start values, a = 2/3 of it for
/// kf = 1 and kr = 2, and the step of the rate at t = 1 leads to 1/2.
#[test]
fn a_steady_state_keeps_what_the_equations_conserve() {
    let exchange = "model Exchange\n  parameter Real kf = 1.5, kr = 1.5, total = 3;\n  Real a(start = \
                    total, fixed = true), b(start = 0, fixed = true), v;\nequation\n  v = kf*(if \
                    time < 1 then 1 else 2)*a - kr*b;\n  der(a) = -v;\n  der(b) = v;\nend Exchange;\n";
    let problem = "model = \"Exchange\"\nfiles = [\"m.mo\"]\n[parameters]\nkf = { min = 0.1, max = 10 }\nkr = \
                   { min = 0.1, max = 10 }\n[[experiment]]\ndata = \"d.csv\"\nx = \"time\"\n\
                   outputs = { a = \"a\" }\nsteady_state = true\n";
    let data = table("time,a", |t| {
        let a = if t < 1.0 { 2.0 } else { 1.5 + 0.5 * (-4.0 * (t - 1.0)).exp() };
        a.to_string()
    });
    let files = [("p.toml", problem.to_owned()), ("d.csv", data), ("m.mo", exchange.to_owned())];
    let solution = solved(&files);
    for (name, expected) in [("kf", 1.0), ("kr", 2.0)] {
        let found = value(&solution, name);
        assert!((found - expected).abs() < 1e-3, "{name} = {found}");
    }
    let said = solution.findings.iter().find(|finding| finding.sentence.contains("conserve"));
    assert!(said.unwrap().sentence.ends_with("a + b = total"), "{said:?}");
}

/// Sums with weights: dimers count twice, volumes and heat capacities are parameters, rates are sums,
/// products and variables of their own. At rest the sum is that of the start values.
#[test]
fn a_steady_state_keeps_weighted_sums() {
    let dimer = "parameter Real k = 1, w = 2; Real u(start = 1, fixed = true), p(start = 0, fixed = true), \
                 d(start = 0, fixed = true), q; Real y = u + p + 2*d; equation ";
    let forms = [
        "q = 0; der(u) = 0.5*p - u; der(p) = u - 0.5*p - 2*k*(p^2 - 0.1*d); der(d) = k*(p^2 - 0.1*d);",
        "q = p*p - d/10; der(u) = 0.5*p - u; der(p) = u - 0.5*p - 2*q*k; der(d) = k*q;",
        "q = k*p/(0.3 + p); der(u) = 0.5*p - u; der(p) = u - 0.5*p - 2*(q - 0.1*d); der(d) = q - 0.1*d;",
        "q = 0; der(u) = 0.5*p - u; der(p) = u - 0.5*p - w*k*(p^2 - 0.1*d); der(d) = k*(p^2 - 0.1*d);",
    ];
    let heat = "parameter Real k = 0.7, w = 2, C = 5; Real y = (w*a + C*b)/260, a(start = 80, fixed = true), \
                b(start = 20, fixed = true); equation w*der(a) = k*(b - a); C*der(b) = k*(a - b);";
    let bodies = forms.iter().map(|form| format!("{dimer}{form}")).chain([heat.to_owned()]);
    for body in bodies {
        let model = format!("model Sum {body} end Sum;\n");
        let problem = "model = \"Sum\"\nfiles = [\"m.mo\"]\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                       [[experiment]]\ndata = \"d.csv\"\nsteady_state = true\n\
                       outputs = { y = { sigma = 1 } }\n[stop]\nevaluations = 3\n";
        let data = table("time,y", |_| "0".to_owned());
        let files = [("p.toml", problem.to_owned()), ("d.csv", data), ("m.mo", model)];
        let solution = solved(&files);
        let rmse = solution.series[0].rmse;
        assert!((rmse - 1.0).abs() < 1e-6, "{body}: the sum is {rmse}");
    }
}

/// A sum whose weights are no products of powers is not passed over.
#[test]
fn a_steady_state_that_is_not_determined_is_refused() {
    let model = "model Sum parameter Real k = 1, w = 1; Real a(start = 1, fixed = true), b(start = 1, fixed \
                 = true); equation der(a) = -k*(a - b)*(1 + w); der(b) = k*(a - b); end Sum;\n";
    let problem = "model = \"Sum\"\nfiles = [\"m.mo\"]\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                   [[experiment]]\ndata = \"d.csv\"\nsteady_state = true\noutputs = { a = \"a\" }\n";
    let data = table("time,a", |_| "1".to_owned());
    let files = [("p.toml", problem.to_owned()), ("d.csv", data), ("m.mo", model.to_owned())];
    let said = refusal_of(&files);
    assert!(
        said.contains("the equations conserve 1 sum of states that cannot be written"),
        "{said}"
    );
}

/// A rate that is zero in the model leaves an equation of its rest without any coefficient; it is estimated
/// nevertheless. The step from rest at x = z = 1/k2 is computed by small steps of Euler's method, which
/// are as exact as the comparison.
#[test]
fn a_rate_that_is_zero_in_the_model_is_estimated_from_rest() {
    let model = "model Side\n  parameter Real kb = 0, k2 = 2;\n  Real x, z;\nequation\n  der(x) = \
                 (if time < 1 then 1 else 2) - k2*x - kb*(x - z);\n  der(z) = kb*(x - z);\nend \
                 Side;\n";
    let problem = "model = \"Side\"\nfiles = [\"m.mo\"]\n[parameters]\nkb = { min = 0.01, max = 10 }\nk2 = \
                   { min = 0.1, max = 10 }\n[[experiment]]\ndata = \"d.csv\"\nx = \"time\"\n\
                   outputs = { z = \"z\" }\nsteady_state = true\n";
    let (kb, k2, h) = (0.5, 1.25, 1e-5);
    let (mut x, mut z, mut time) = (1.0 / k2, 1.0 / k2, 1.0);
    let data = table("time,z", |t| {
        while time < t - 0.5 * h {
            let flow = kb * (x - z);
            (x, z, time) = (x + h * (2.0 - k2 * x - flow), z + h * flow, time + h);
        }
        z.to_string()
    });
    let files = [("p.toml", problem.to_owned()), ("d.csv", data), ("m.mo", model.to_owned())];
    let solution = solved(&files);
    for (name, expected) in [("kb", kb), ("k2", k2)] {
        let found = value(&solution, name);
        assert!((found / expected - 1.0).abs() < 2e-3, "{name} = {found}");
    }
}

/// Rest at u = 1 from t = -1 on, and a step to 2 at t = 0: a goes from 1 to 2 with the rate k = 1.
#[test]
fn inputs_have_their_values_before_0() {
    let model = "model Inflow\n  parameter Real k = 2;\n  input Real u;\n  Real a;\nequation\n  \
                 der(a) = k*(u - a);\nend Inflow;\n";
    let problem = "model = \"Inflow\"\nfiles = [\"m.mo\"]\n[parameters]\nk = { min = 0.1, max = \
                   10 }\n[[experiment]]\ndata = \"d.csv\"\nx = \"time\"\ninputs = { u = { column = \
                   \"u\", interpolation = \"hold\" } }\noutputs = { a = \"a\" }\nsteady_state = true\n";
    let a = |t: f64| 2.0 - (-t.max(0.0)).exp();
    let row = |k: i32| {
        let t = 0.25 * f64::from(k);
        format!("{t},{},{}\n", if t < 0.0 { 1 } else { 2 }, a(t))
    };
    let data = format!("time,u,a\n{}", (-4..9).map(row).collect::<String>());
    let world = shipped(world(&[("p.toml", problem.to_owned()), ("d.csv", data)]), Path::new(""));
    let mut session = Session::new(Box::new(world.with_file("m.mo", model)));
    let solution = solve(&mut session, Path::new("p.toml"), &RunOptions::default());
    let solution = solution.unwrap_or_else(|errors| panic!("{}", errors[0].message));
    assert!((value(&solution, "k") - 1.0).abs() < 1e-4, "{}", value(&solution, "k"));
    assert!(solution.series[0].rmse < 1e-5, "{}", solution.series[0].rmse);
}

#[test]
fn delays_are_estimated() {
    let later = |t: f64| if t < 0.6 { 0.8 } else { 0.8 * height(t - 0.6, 1.0, 0.0) };
    let data = table("time,q", |t| later(t).to_string());
    let problem = EMPTIES
        .replace("sigma = 0.01", "sigma = 0.01, delay = \"tau\"")
        .replace("[parameters]", "[parameters]\ntau = { min = 0, max = 2 }");
    let solution = solved(&[("p.toml", problem.clone()), ("d.csv", data.clone())]);
    assert!((value(&solution, "tau") - 0.6).abs() < 2e-3, "{}", value(&solution, "tau"));
    assert!((value(&solution, "k") - 0.8).abs() < 2e-3, "{}", value(&solution, "k"));
    assert_eq!(solution.series[0].y[0], "q");
    assert_eq!(solution.inferred.bands[0].y[0], "q");
    let fixed = EMPTIES.replace("sigma = 0.01", "sigma = 0.01, delay = 0.6");
    let solution = solved(&[("p.toml", fixed.clone()), ("d.csv", data.clone())]);
    assert!((value(&solution, "area") - 2.0).abs() < 5e-3, "{}", value(&solution, "area"));
    assert!(refusal(&fixed.replace("delay = 0.6", "delay = -1"), &data).contains("can become -1"));
    let unknown = fixed.replace("delay = 0.6", "delay = \"lag\"");
    assert!(refusal(&unknown, &data).contains("not in `[parameters]`"));
}

#[test]
fn nested_models_are_compared() {
    let fixed = |area: &str| {
        EMPTIES.replace("area = { min = 0.1, max = 10 }", &format!("area = {{ fixed = {area} }}"))
    };
    let solve = |text: String| solved(&[("p.toml", text), ("d.csv", data())]);
    let (both, right, wrong) = (solve(EMPTIES.to_owned()), solve(fixed("2")), solve(fixed("2.2")));
    let named = |name: &str| name.to_owned();
    let found = compare(&[(named("small"), &right), (named("large"), &both)]).unwrap();
    assert_eq!(found.nested.len(), 1);
    assert_eq!((found.nested[0].smaller, found.nested[0].freedom), (0, 1));
    assert!(found.nested[0].probability.unwrap() > 0.05, "{:?}", found.nested);
    assert!(found.sentence.contains("does not support the larger model"), "{}", found.sentence);
    let found = compare(&[(named("wrong"), &wrong), (named("large"), &both)]).unwrap();
    assert!(found.sentence.starts_with("These data favour large"), "{}", found.sentence);
    assert!(found.sentence.contains("the likelihood ratio rejects it"), "{}", found.sentence);
    // ln L of known deviations: −χ²/2 − n ln(σ √2π).
    let square: f64 = right.series[0].points.iter().map(|p| ((p[1] - p[2]) / 0.01).powi(2)).sum();
    let log = -0.5 * square - 17.0 * (0.01 * std::f64::consts::TAU.sqrt()).ln();
    let likelihood = right.inferred.likelihood.unwrap();
    assert!((likelihood.log - log).abs() < 1e-9 * log.abs());
    assert_eq!((likelihood.points, likelihood.estimated), (17, 1));
    let other =
        solved(&[("p.toml", EMPTIES.to_owned()), ("d.csv", data().replace("0.5,", "0.51,"))]);
    let message = compare(&[(named("a"), &both), (named("b"), &other)]).unwrap_err().message;
    assert!(message.contains("different data"), "{message}");
}

/// A search that ends far from the minimum: its weight says nothing of the model.
#[test]
fn models_that_are_not_at_a_minimum_are_not_judged() {
    let short = |text: &str| {
        let text = text.replace("evaluations = 600", "evaluations = 60");
        solved(&[
            ("p.toml", text + "[method]\nname = \"gapilib2006\"\npolish = false\n"),
            ("d.csv", data()),
        ])
    };
    let smaller = EMPTIES.replace("area = { min = 0.1, max = 10 }", "area = { fixed = 2 }");
    let (small, large) = (short(&smaller), short(EMPTIES));
    let found = compare(&[("small".to_owned(), &small), ("large".to_owned(), &large)]).unwrap();
    assert!(found.sentence.starts_with("The models cannot be compared"), "{}", found.sentence);
    assert!(found.models.iter().all(|model| model.weight.is_none()), "{:?}", found.models);
    assert!(found.nested.iter().all(|pair| pair.probability.is_none()), "{:?}", found.nested);
}

/// The same search with profiles, which least squares lead to the minimum first: the exact values
/// of the tank within the profiles' intervals, and the interval holds the value of the table.
#[test]
fn profiles_belong_to_a_minimum() {
    let text = EMPTIES.replace("evaluations = 600", "evaluations = 60");
    let text = text + "[method]\nname = \"gapilib2006\"\npolish = false\n";
    let options = RunOptions { profile: true, ..RunOptions::default() };
    let solution = solved_with(&[("p.toml", text), ("d.csv", data())], &options);
    assert_eq!(
        solution.outcome.ending.kind,
        EndingKind::Minimum,
        "{}",
        solution.outcome.ending.words
    );
    let profiles = solution.profiles.as_ref().unwrap();
    for (parameter, profile) in solution.parameters.iter().zip(&profiles.profiles) {
        let [Some(low), Some(high)] = profile.interval else { panic!("{profile:?}") };
        assert!((low..=high).contains(&parameter.value), "{parameter:?} {profile:?}");
    }
    let said = &solution.findings[0].sentence;
    assert!(said.contains("after the search found a better fit"), "{said}");
}

#[test]
fn what_a_model_does_not_have_cannot_be_inferred() {
    let refused = |added: &str| {
        refusal(&EMPTIES.replace("[parameters]", &format!("{added}\n[parameters]")), &data())
    };
    assert!(refused("bands = [\"x\"]").contains("`bands` names `x`, which is not a Real variable"));
    assert!(refused("[design]\npoints = 0").contains("`points` of `design` is 0"));
    assert!(refused("[design]\noutputs = { h = -1 }").contains("standard deviation of `h`"));
    assert!(refused("[design]\nrange = [1, 0]").contains("goes from 1 to 0"));
    assert!(refused("constraints = [\"k = area\"]").contains("cannot be read"));
    assert!(refused("constraints = [\"k < q\"]").contains("not an estimated parameter"));
    assert!(refused("[bootstrap]\nresampling = \"all\"").contains("`all`"));
    assert!(refused("[posterior]\nsamples = 3").contains("`samples` of `posterior` is 3"));
}

/// Replicates are series of their own: the log-normal one is the third.
#[test]
fn log_normal_errors_belong_to_their_output_beside_replicates() {
    let problem = "model = \"Free\"\nfiles = [\"tank.mo\"]\n[parameters]\nk = { min = 0.1, max = 5 }\n\
                   area = { fixed = 2 }\n[[experiment]]\ndata = \"d.csv\"\n\
                   x = { variable = \"time\", column = \"t\" }\n[experiment.outputs]\n\
                   h = { columns = [\"h1\", \"h2\"], sigma = 0.01 }\n\
                   q = { column = \"q\", sigma = 0.01, error = \"lognormal\" }\n";
    let data = table("t,h1,h2,q", |t| {
        let h = height(t, 1.0, 0.0);
        format!("{},{},{}", h + 0.01, h - 0.01, 0.8 * h)
    });
    let solution = solved(&[("p.toml", problem.to_owned()), ("d.csv", data)]);
    let names: Vec<&str> = solution.series.iter().map(|own| own.y[0].as_str()).collect();
    assert_eq!(names, ["h", "h", "ln(q)"]);
}

/// Two constants, measured under two conditions.
const CONSTANTS: &str = "model M\n  parameter Real p = 1;\n  parameter Real q = 1;\n  Real a = p;\n  \
                         Real b = q;\nend M;\n";

#[test]
fn an_experiment_sets_parameters_to_expressions_of_estimated_ones() {
    let experiment = |data: &str, set: &str| {
        format!(
            "[[experiment]]\ndata = \"{data}\"\nset = {{ q = \"{set}\" }}\noutputs = {{ b = {{ column = \"b\", sigma = 1 }} }}\n"
        )
    };
    let problem = format!(
        "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\np = {{ min = 0.1, max = 9 }}\n{}{}",
        experiment("one.csv", "p"),
        experiment("two.csv", "3*p")
    );
    let solution = solved(&[
        ("p.toml", problem),
        ("M.mo", CONSTANTS.into()),
        ("one.csv", "time,b\n0,1\n1,3\n".into()),
        ("two.csv", "time,b\n0,5\n1,7\n".into()),
    ]);
    // Σ xy/Σ x² with x = 1, 1, 3, 3.
    assert!((value(&solution, "p") - 2.0).abs() < 1e-6, "{}", solution.text());
}

/// The sum of squares of all outputs that share a sigma divides by all their points.
#[test]
fn outputs_share_a_sigma_that_is_estimated() {
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
                   p = { min = -9, max = 9 }\nq = { min = -9, max = 9 }\n\
                   [[experiment]]\ndata = \"d.csv\"\n[experiment.outputs]\n\
                   a = { column = \"a\", sigma = \"estimate s\" }\n\
                   b = { column = \"b\", sigma = \"estimate s\" }\n";
    let data = "time,a,b\n0,1,0\n1,2,4\n2,3,2\n3,2,2\n";
    let files =
        [("p.toml", problem.to_owned()), ("M.mo", CONSTANTS.into()), ("d.csv", data.into())];
    let solution = solved(&files);
    assert!((value(&solution, "p") - 2.0).abs() < 1e-6, "{}", solution.text());
    assert!((value(&solution, "q") - 2.0).abs() < 1e-6, "{}", solution.text());
    // 2 + 8 over 8 points: n/2 (ln 2π s² + 1).
    let expected = 4.0 * ((std::f64::consts::TAU * 10.0 / 8.0).ln() + 1.0);
    let found = solution.likelihood.negative_log_likelihood.unwrap();
    assert!((found - expected).abs() < 1e-6, "{found} {expected}");
}

/// Where the derivative of n/2 ln Σ (y - p)² + (p - m)²/(2 s²) is zero.
#[test]
fn a_prior_is_weighed_against_a_sigma_that_is_estimated() {
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
                   p = { min = -9, max = 9, prior = { mean = 0, sd = 0.5 } }\n\
                   [[experiment]]\ndata = \"d.csv\"\n\
                   outputs = { a = { column = \"a\", sigma = \"estimate\" } }\n";
    let measured = [1.0, 2.0, 3.0, 2.5];
    let data = "time,a\n0,1\n1,2\n2,3\n3,2.5\n";
    let files =
        [("p.toml", problem.to_owned()), ("M.mo", CONSTANTS.into()), ("d.csv", data.into())];
    let solution = solved(&files);
    let p = value(&solution, "p");
    let square: f64 = measured.iter().map(|y| (y - p) * (y - p)).sum();
    let sum: f64 = measured.iter().map(|y| y - p).sum();
    let derivative = -4.0 * sum / square + p / 0.25;
    assert!(derivative.abs() < 1e-4, "{derivative}\n{}", solution.text());
}

/// c exp(-k t) with normal errors of standard deviation a + b y.
const DECLINE: &str = "1.82799, 1.69848, 1.50309, 1.32431, 1.24172, 1.09779, 1.06899, 1.05214, \
    0.8629, 0.78171, 0.76625, 0.69488, 0.62506, 0.53161, 0.51743, 0.49728, 0.39052, 0.38217, \
    0.30833, 0.29639, 0.2559, 0.27054, 0.2237, 0.23649, 0.21402, 0.18899, 0.12875, 0.1512, \
    0.14623, 0.13631, 0.09814, 0.10481, 0.0878, 0.08189, 0.10086, 0.06709, 0.07114, 0.07716, \
    0.05221, 0.05323";

/// The same data with sigma as a formula of the problem and as a variable of the model, whole and in
/// two experiments.
fn declines() -> [Solution; 3] {
    let mut rows: Vec<String> = DECLINE.split(", ").map(str::trim).map(str::to_owned).collect();
    rows.iter_mut().enumerate().for_each(|(k, y)| *y = format!("{},{y}", (k + 1) as f64 / 10.0));
    let table = |rows: &[String]| format!("time,y\n{}\n", rows.join("\n"));
    let model = "model M\n  parameter Real k = 1;\n  parameter Real c = 1;\n  \
                 parameter Real a = 0.1;\n  parameter Real b = 0.1;\n  \
                 Real y(start = c, fixed = true);\n  Real sd = a + b*y;\n\
                 equation\n  der(y) = -k*y;\nend M;\n";
    let bare = model.replace("  parameter Real a = 0.1;\n  parameter Real b = 0.1;\n", "");
    let bare = bare.replace("  Real sd = a + b*y;\n", "");
    let problem = |experiments: &str| {
        format!(
            "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
             k = {{ min = 0.1, max = 9 }}\nc = {{ min = 0.1, max = 9 }}\n\
             a = {{ min = 1e-4, max = 1 }}\nb = {{ min = 1e-4, max = 1 }}\n{experiments}"
        )
    };
    let experiment = |data: &str, sigma: &str| {
        format!(
            "[[experiment]]\ndata = \"{data}\"\ntolerance = 1e-9\n\
             outputs = {{ y = {{ column = \"y\", sigma = \"{sigma}\" }} }}\n"
        )
    };
    let formula = problem(&experiment("d.csv", "a + b*abs(y)"));
    let variable = problem(&experiment("d.csv", "sd"));
    let two = problem(&(experiment("e.csv", "a + b*y") + &experiment("f.csv", "b*y + a")));
    let files = |problem: String, model: &str| {
        let files = [
            ("p.toml", problem),
            ("M.mo", model.to_owned()),
            ("d.csv", table(&rows)),
            ("e.csv", table(&rows[..13])),
            ("f.csv", table(&rows[13..])),
        ];
        solved_with(&files, &RunOptions { profile: true, ..RunOptions::default() })
    };
    [files(formula, &bare), files(variable, model), files(two, &bare)]
}

/// Values, -log L and standard errors (from the Fisher information) by SciPy.
#[test]
fn sigma_is_a_formula_with_estimated_parameters() {
    let expected = [
        ("k", 0.92439134, 0.01113404),
        ("c", 2.00725334, 0.03260019),
        ("a", 0.00987376, 0.00265892),
        ("b", 0.03346339, 0.00888293),
    ];
    for solution in declines() {
        let text = solution.text();
        for (name, best, error) in expected {
            let own = solution.parameters.iter().find(|own| own.name == name).unwrap();
            assert!((own.value / best - 1.0).abs() < 2e-5, "{name} {best}\n{text}");
            let found = own.deviation.unwrap();
            assert!((found / error - 1.0).abs() < 1e-4, "{name} {found} {error}\n{text}");
        }
        let found = solution.likelihood.negative_log_likelihood.unwrap();
        assert!((found + 94.5096237308639).abs() < 1e-6, "{found}\n{text}");
        assert!(solution.outcome.ending.kind == EndingKind::Minimum, "{text}");
        assert!(solution.likelihood.chi_square.is_none(), "fitted deviations test nothing\n{text}");
        let points: usize = solution.series.iter().map(|own| own.points.len()).sum();
        assert_eq!(points, 40, "deviations are no data\n{text}");
        // Where -log L rises by half of 3.84 in the profile.
        let profiles = solution.profiles.as_ref().unwrap();
        let [Some(low), Some(high)] = profiles.profiles[3].interval else { panic!("{text}") };
        assert!((low / 0.0157401 - 1.0).abs() < 1e-3, "{low}\n{text}");
        assert!((high / 0.0593620 - 1.0).abs() < 1e-3, "{high}\n{text}");
    }
}

/// A share is 0/0 where the other output alone is measured; where it is measured itself, the place of the
/// division is named.
#[test]
fn values_that_are_not_compared_may_be_missing() {
    let model = "model M\n  parameter Real k = 1;\n  Real a(start = 0, fixed = true);\n  \
                 Real b(start = 0, fixed = true);\n  Real share = a/(a + b);\nequation\n  \
                 der(a) = k;\n  der(b) = 1;\nend M;\n";
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.1, max = 9 }\n[[experiment]]\ndata = \"d.csv\"\n\
                   outputs = { a = \"a\", share = \"share\" }\n";
    let files = |first: &str| {
        let data = format!("time,a,share\n0,0.1,{first}\n1,2.9,0.75\n2,6.1,0.75\n");
        [("p.toml", problem.to_owned()), ("M.mo", model.to_owned()), ("d.csv", data)]
    };
    let solution = solved(&files(""));
    assert!((value(&solution, "k") - 3.0).abs() < 0.1, "{}", solution.text());
    let mut session = Session::new(Box::new(world(&files("0.5"))));
    let errors = solve(&mut session, Path::new("p.toml"), &RunOptions::default()).unwrap_err();
    let said = format!("{errors:?}");
    assert!(said.contains("a division by zero"), "{said}");
}

/// x' = k (u - x) with u = 2 before 0 and 0 from then on, after 10 s at u = 2: at rest for k = 3, not for
/// k = 0.1.
#[test]
fn an_experiment_that_does_not_come_to_rest_is_named() {
    let model = "model M\n  parameter Real k = 1;\n  Real x(start = 0, fixed = true);\nequation\n  \
                 der(x) = k*((if time < 0 then 2 else 0) - x);\nend M;\n";
    let problem = "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\n\
                   k = { min = 0.01, max = 9 }\n[[experiment]]\nname = \"step\"\ndata = \"d.csv\"\n\
                   start_time = -10\nrest = true\noutputs = { x = { column = \"x\", sigma = 0.01 } }\n";
    for (k, is_at_rest) in [(3.0, true), (0.1, false)] {
        let begin = 2.0 * (1.0 - f64::exp(-10.0 * k));
        let rows: String = (0..8)
            .map(|row| {
                let time = f64::from(row) / k / 4.0;
                format!("{time},{}\n", begin * f64::exp(-k * time) + 0.01 * f64::from(row % 2))
            })
            .collect();
        let solution = solved(&[
            ("p.toml", problem.to_owned()),
            ("M.mo", model.to_owned()),
            ("d.csv", format!("time,x\n{rows}")),
        ]);
        assert!((value(&solution, "k") / k - 1.0).abs() < 0.05, "{}", solution.text());
        let said = solution.text();
        assert_eq!(said.contains("step: the model is not at rest"), !is_at_rest, "{said}");
    }
}

/// Formulas for sigma as users write them: a parameter in one experiment alone, tied ones, and what
/// cannot be meant.
#[test]
fn formulas_of_sigma_are_read_or_refused_with_the_reason() {
    let model = "model M\n  parameter Real k = 1;\n  Real y(start = 2, fixed = true, unit = \"V\");\n  \
                 Real mv(unit = \"mV\") = 100;\nequation\n  der(y) = -k*y;\nend M;\n";
    let rows: String = (1..=9)
        .map(|row| {
            format!("{row},{}\n", 2.0 * f64::exp(-0.3 * f64::from(row)) + 0.01 * f64::from(row % 2))
        })
        .collect();
    let files = |parameters: &str, sigmas: [&str; 2]| {
        let experiment = |sigma: &str| {
            format!(
                "[[experiment]]\ndata = \"d.csv\"\noutputs = {{ y = {{ column = \"y\", sigma = \"{sigma}\" }} }}\n"
            )
        };
        let problem = format!(
            "model = \"M\"\nfiles = [\"M.mo\"]\nbands = false\n[parameters]\nk = {{ min = 0.1, max = 2 }}\n\
             {parameters}\n{}{}",
            experiment(sigmas[0]),
            experiment(sigmas[1])
        );
        [("p.toml", problem), ("M.mo", model.to_owned()), ("d.csv", format!("time,y\n{rows}"))]
    };
    let range = "a = { min = 1e-4, max = 1 }\nb = { min = 1e-4, max = 1 }";
    let solution = solved(&files(range, ["a", "b*y"]));
    assert!((value(&solution, "k") - 0.3).abs() < 0.02, "{}", solution.text());
    let tied = "a = { min = 1e-4, max = 1 }\nb = { tied = \"2*a\" }";
    let solution = solved(&files(tied, ["b*y", "b*y + a*time"]));
    assert!((value(&solution, "k") - 0.3).abs() < 0.02, "{}", solution.text());
    for (sigma, said) in [
        ("a+", "which is neither a column of the data nor a formula"),
        ("mv", "is in mV, but `y` is in V"),
        ("a*wrong", "contains `wrong`"),
        ("-a", "is not positive everywhere"),
    ] {
        let mut session = Session::new(Box::new(world(&files(range, [sigma, "a + b"]))));
        let errors = solve(&mut session, Path::new("p.toml"), &RunOptions::default()).unwrap_err();
        assert!(errors[0].message.contains(said), "{sigma}: {}", errors[0].message);
    }
}
