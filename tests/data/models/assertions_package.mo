package Q
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
end Q;
