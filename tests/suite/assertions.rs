//! What functions assert that are called without use of their values, and what initial sections
//! assert (MLS §8.3.7, §12.4).

use gapilib::script::Session;
use gapilib::script::world::MemoryWorld;

const PACKAGE: &str = "package Q
function loops \"cannot become an expression\"
  input Real x;
protected
  Real y;
algorithm
  y := x;
  while y > 1 loop y := y - 1; end while;
  assert(y < 0.9, \"y too large\");
end loops;
function counted \"has a value\"
  input Real x;
  output Real y;
algorithm
  y := x;
  while y > 1 loop y := y - 1; end while;
  assert(y < 0.9, \"y too large\");
end counted;
function root
  input Real x;
  output Real y;
algorithm
  assert(x > 0, \"root of what is not positive\");
  y := sqrt(x);
end root;
function guarded
  input Real x;
  output Real y;
algorithm
  if x > 0 then y := root(x); else y := 0; end if;
end guarded;
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
  assert(x > 0.5, \"too small at the start\");
  loops(x / 2);
equation
  der(x) = -3;
end Start;
model BadStart
  Real x(start = 1, fixed = true);
initial algorithm
  assert(x > 1.5, \"too small at the start\");
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
    assert(x > 1.5, \"too small at the start\");
  end when;
end When;
end Q;";

fn simulate(model: &str) -> (u8, String) {
    let world = MemoryWorld::new().with_file("Q.mo", PACKAGE);
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
fn initial_sections_assert_at_the_start_alone() {
    let (code, errors) = simulate("Start");
    assert_eq!(code, 0, "{errors}");
    fails("BadStart", "too small at the start (at t = 0)");
    fails("BadCall", "y too large (at t = 0)");
    fails("When", "too small at the start (at t = 0)");
}
