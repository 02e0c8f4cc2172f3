model M
  function f
    input Real u;
    output Real y;
  algorithm
    y := terms_of_f;
  end f;
  parameter Real p = 0.5;
  parameter Real q = terms_of_q;
  Real x[100](each start = 1, each fixed = true);
  Real all, of_function, of_algorithm;
equation
  for i in 1:100 loop
    der(x[i]) = 1;
  end for;
  all = 1 + terms_of_all;
  of_function = f(x[1]);
algorithm
  of_algorithm := terms_of_algorithm;
end M;
