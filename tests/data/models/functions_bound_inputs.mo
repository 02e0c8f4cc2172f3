model Partial
  partial function Shape
    input Real x;
    output Real y;
  end Shape;
  function trapezoid
    input Real a;
    input Real b;
    input Shape f;
    output Real area;
  algorithm
    area := (b - a)*(f(a) + f(b))/2;
  end trapezoid;
  function halves
    input Real a;
    input Real b;
    input Shape f;
    output Real area;
  algorithm
    area := trapezoid(a, (a + b)/2, f) + trapezoid((a + b)/2, b, f);
  end halves;
  function line
    input Real slope;
    input Real x;
    input Real offset;
    output Real y;
  algorithm
    y := offset + slope*x;
  end line;
  function raised
    input Real a;
    input Real b;
    input Lift f;
    output Real area;
  algorithm
    area := halves(a, b, function f(offset = 3));
  end raised;
  partial function Lift
    input Real x;
    input Real offset;
    output Real y;
  end Lift;
  Real area = halves(0, 2, function line(slope = time, offset = 3));
  Real twice = raised(0, 2, function line(slope = 2*time));
end Partial;
