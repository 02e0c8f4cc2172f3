package functional_defaults "MLS 12.4.1, 12.4.2"
  partial function P
    input Real x;
    output Real y;
  end P;
  function g
    extends P;
    input Real a = 2;
    input Real b = a + 1;
    input Real c[2] = {x, a*b};
  algorithm
    y := a*x + b + 0*sum(c);
  end g;
  function call
    input P f;
    input Real x;
    output Real y;
  algorithm
    y := f(x);
  end call;
  model Main
    Real p = call(g, time);
    Real q = call(function g(a = 5), time);
    Real r = call(function g(b = 11), time);
  end Main;
end functional_defaults;
