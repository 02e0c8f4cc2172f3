model Elements
  function f
    input Real a;
    input Real b;
    output Real y = 2*a + b;
    output Real z = a - b;
  end f;
  Real y[2] = f({time, 1}, 3);
  Real m[2, 2] = f([1, 2; 3, 4], [time, 0; 0, time]);
  Real u[2];
  Real w[2];
equation
  (u, w) = f({1, time}, {time, 2});
end Elements;
