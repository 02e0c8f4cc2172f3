//! What functions assert that are called without use of their values, and what initial sections
//! assert (MLS §8.3.7, §12.4).

use gapilib::Session;

const PACKAGE: &str = r#"package Q
function loops "cannot become an expression"
  input Real x;
protected
  Real y;
algorithm
  y := x;
  while y > 1 loop y := y - 1; end while;
  assert(y < 0.9, "y too large");
end loops;
function counted "has a value"
  input Real x;
  output Real y;
algorithm
  y := x;
  while y > 1 loop y := y - 1; end while;
  assert(y < 0.9, "y too large");
end counted;
function root
  input Real x;
  output Real y;
algorithm
  assert(x > 0, "root of what is not positive");
  y := sqrt(x);
end root;
function guarded
  input Real x;
  output Real y;
algorithm
  if x > 0 then y := root(x); else y := 0; end if;
end guarded;
function check "of texts, with a message that is made"
  input String name;
  input String names[:];
  input Real X[:];
protected
  Integer n = size(X, 1);
  String s;
algorithm
  for i in 1:n loop
    assert(X[i] >= 0.0, "in " + name + ": X[" + String(i) + "] is negative");
  end for;
  if n > 0 and abs(sum(X) - 1.0) > 1e-10 then
    s := "";
    for i in 1:n loop
      s := s + " " + String(X[i]) + " " + names[i];
    end for;
    Modelica.Utilities.Streams.error("the sum is not 1" + s);
  end if;
end check;
model Texts
  Real X[2] = {time, 1 - time};
equation
  check("m", {"a", "b"}, X);
end Texts;
model BadSum
  Real X[2] = {time, if time < 0.5 then 1 - time else 0.9};
equation
  check("m", {"a", "b"}, X);
end BadSum;
model Negative
  Real X[2] = {0.4 - time, 0.6 + time};
equation
  check("m", {"a", "b"}, X);
end Negative;
model Equation
  Real x = time;
equation
  loops(x);
end Equation;
model Statement
  Real x = time;
algorithm
  loops(x);
end Statement;
model Unused
  Real x = time;
equation
  counted(x);
end Unused;
model Branch
  Real x = time;
equation
  if x < 0.5 then loops(x); else loops(0.3); end if;
end Branch;
model Nested
  Real x = guarded(time - 0.5);
end Nested;
model Start
  Real x(start = 1, fixed = true);
initial equation
  assert(x > 0.5, "too small at the start");
  loops(x / 2);
equation
  der(x) = -3;
end Start;
model BadStart
  Real x(start = 1, fixed = true);
initial algorithm
  assert(x > 1.5, "too small at the start");
equation
  der(x) = -3;
end BadStart;
model BadCall
  Real x(start = 0.95, fixed = true);
initial equation
  loops(x);
equation
  der(x) = -3;
end BadCall;
model When
  Real x(start = 1, fixed = true);
equation
  der(x) = -3;
  when initial() then
    assert(x > 1.5, "too small at the start");
  end when;
end When;
end Q;"#;

const MESSAGES: &str = r#"package V
type E = enumeration(off, starting, running);
function root
  input Real x;
  input Integer n;
  output Real y;
algorithm
  assert(x > 0, "x = " + String(x, significantDigits = 3) + ", n = " + String(n));
  y := 1;
  for i in 1:n loop y := y*x; end for;
  while y > 1 loop y := y/2; end while;
end root;
function stops
  input Real x;
  output Real y;
algorithm
  y := x;
  while y > 1 loop y := y/2; end while;
  if x > 0.75 then
    Modelica.Utilities.Streams.error("x is " + String(x, format = ".2f"));
  end if;
end stops;
model Warning
  parameter Real p = 0.5;
  parameter Integer width = 8;
  Real x(start = 1, fixed = true);
  E e = if time < 0.75 then E.starting else E.running;
equation
  der(x) = -1;
  assert(x > p, "x = " + String(x, format = ".3f") + ", p = " + String(p, significantDigits = 3)
    + "|" + String(time > 0.1, minimumLength = 6) + "|" + String(p, minimumLength = width,
    leftJustified = false) + "|" + String(e) + "|" + String(e, minimumLength = 9) + "|"
    + (if x > 0.9 then "high" else "low"), AssertionLevel.warning);
end Warning;
model Error
  Real x(start = 1, fixed = true);
  Integer i = integer(4*time);
equation
  der(x) = -1;
  assert(x > 0.5, "x = " + String(x, format = ".2f") + ", i = " + String(i));
end Error;
model AtEvent
  Real x(start = 1, fixed = true);
equation
  der(x) = -1;
  when time > 0.25 then
    Modelica.Utilities.Streams.error("x = " + String(x, format = ".2f"));
  end when;
end AtEvent;
model InFunction
  Real x(start = 1, fixed = true), y = root(x - 0.5, integer(4*time));
equation
  der(x) = -1;
end InFunction;
model Stopped
  Real y = stops(time);
end Stopped;
model Printed
  parameter Real a[2] = {0.5, 1.25};
  parameter String first = "[" + String(a[1]) + "]";
  parameter String names[3] = {String(e) for e in E};
  E e(start = E.off, fixed = true);
algorithm
  when time > 0.5 then
    e := E.running;
    for q in {0.25, 2.75} loop
      Modelica.Utilities.Streams.print(String(q) + " " + String(2*q, significantDigits = 2));
    end for;
    for i in 1:2 loop
      Modelica.Utilities.Streams.print(first + String(i, minimumLength = 3) + " " + names[i]);
    end for;
    Modelica.Utilities.Streams.print(String(e) + " " + String(integer(10*time)));
  end when;
end Printed;
end V;"#;

/// Exit code, output and errors.
fn simulate_message(model: &str) -> (u8, String, String) {
    let world = crate::support::shipped::world().with_file("V.mo", MESSAGES);
    let streams = world.streams();
    let script = format!("openModel(\"V.mo\");\nsimulateModel(\"V.{model}\", stopTime = 1);");
    let status = Session::new(Box::new(world)).run_text("s.mos", &script);
    (status.code, streams.output(), streams.errors())
}

#[test]
fn messages_have_the_values_of_when_they_are_given() {
    let (code, _, errors) = simulate_message("Warning");
    assert_eq!(code, 0, "{errors}");
    let words = "p = 0.5|true  |     0.5|starting|starting |low (at t = 0.";
    assert!(errors.contains(words) && !errors.contains('…'), "{errors}");
    // It is given at the end of a step, with what x is then.
    let number = |before: &str, after: char| -> f64 {
        let (_, rest) = errors.split_once(before).expect("the words before a number");
        rest.split(after).next().expect("a number").parse().expect("a number")
    };
    assert!((number("x = ", ',') + number("(at t = ", ')') - 1.0).abs() < 1e-3, "{errors}");
    let failing = [
        ("Error", "x = 0.50, i = 2 (at t = 0.5"),
        ("AtEvent", "x = 0.75 (at t = 0.25"),
        ("Stopped", "x is 0.75 (at t = 0.75"),
    ];
    for (model, message) in failing {
        let (code, _, errors) = simulate_message(model);
        assert!(code != 0 && errors.contains(message), "{model}: {errors}");
    }
    let (code, _, errors) = simulate_message("InFunction");
    // Where x reaches the bound, n is about to change from 1 to 2.
    let has_numbers = [1, 2].iter().any(|n| errors.contains(&format!(", n = {n} (at t = 0.5")))
        && !errors.contains('…');
    assert!(code != 0 && has_numbers, "{errors}");
}

#[test]
fn strings_of_loop_variables_have_their_types() {
    let (code, output, errors) = simulate_message("Printed");
    assert_eq!(code, 0, "{errors}");
    let lines = ["0.25 0.5", "2.75 5.5", "[0.5]1   off", "[0.5]2   starting", "running 5"];
    for line in lines {
        assert!(output.contains(line), "`{line}` is not in {output}");
    }
}

fn simulate(model: &str) -> (u8, String) {
    let world = crate::support::shipped::world().with_file("Q.mo", PACKAGE);
    let streams = world.streams();
    let script = format!("openModel(\"Q.mo\");\nsimulateModel(\"Q.{model}\", stopTime = 1);");
    let status = Session::new(Box::new(world)).run_text("s.mos", &script);
    (status.code, streams.errors())
}

fn fails(model: &str, message: &str) {
    let (code, errors) = simulate(model);
    assert!(errors.contains(message), "{model}: {errors}");
    assert_ne!(code, 0, "{model}");
}

#[test]
fn functions_called_for_what_they_assert_are_looked_at() {
    for model in ["Equation", "Statement", "Unused"] {
        fails(model, "y too large (at t = 0.9");
    }
}

#[test]
fn what_stands_in_a_branch_is_looked_at_only_there() {
    for model in ["Branch", "Nested"] {
        let (code, errors) = simulate(model);
        assert_eq!(code, 0, "{model}: {errors}");
    }
}

#[test]
fn messages_may_be_known_in_part() {
    let (code, errors) = simulate("Texts");
    assert_eq!(code, 0, "{errors}");
    fails("BadSum", "the sum is not 1");
    fails("Negative", "in m: X[");
}

#[test]
fn initial_sections_assert_at_the_start_alone() {
    let (code, errors) = simulate("Start");
    assert_eq!(code, 0, "{errors}");
    fails("BadStart", "too small at the start (at t = 0)");
    fails("BadCall", "y too large (at t = 0)");
    fails("When", "too small at the start (at t = 0)");
}

/// `|Σ f - 1| <= 0` asks more of a sum than arithmetic gives; a difference that matters fails.
#[test]
fn sums_are_asserted_up_to_rounding() {
    let model = |value: &str| {
        format!(
            "model M parameter Real f[3] = {{{value}, 0.2, 0.1}}; initial equation \
             assert(abs(f[1] + f[2] + f[3] - 1) <= 0, \"the fractions\"); \
             equation assert(sum(f) <= 1 and abs(1 - sum(f))*time <= 0, \"the sum\"); end M;"
        )
    };
    let run = |value: &str| {
        let world = gapilib::world::MemoryWorld::new().with_file("M.mo", model(value));
        let errors = world.streams();
        let script = "openModel(\"M.mo\");\nsimulateModel(\"M\", stopTime = 1);";
        let status = Session::new(Box::new(world)).run_text("s.mos", script);
        (status.code, errors.errors())
    };
    let (code, errors) = run("0.7");
    assert_eq!(code, 0, "{errors}");
    let (code, errors) = run("0.70000001");
    assert!(code != 0 && errors.contains("the fractions"), "{errors}");
}
