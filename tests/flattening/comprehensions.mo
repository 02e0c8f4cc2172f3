// MLS §10.4.1, §10.3.4.1: iterators in array constructors and reductions; over an array of
// components they are written out, since a component is chosen by a number alone. `array` is
// another form of the braces (§10.4).
package comprehensions
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  record Data
    Real a, b = 2*a;
  end Data;
  function f
    input Data d;
    input Real x;
    output Real y = d.a*x + d.b;
  algorithm
  end f;
  constant Data table[2] = {Data(a = 1), Data(a = 3)};
  function tabulated
    input Real x;
    output Real y[2] = {f(table[i], x) for i in 1:2};
  algorithm
  end tabulated;
  model Cell
    parameter Data d(a = 5);
    Data state(a = time);
  end Cell;
  model Main
    parameter Integer n = 2;
    Pin p[n];
    Cell c[n];
    Data all[n] = c.state;
    Real kept[n] = {i^2 for i in 1:n};
    Real voltages[n] = {p[i].v for i in 1:n};
    Real nested[2, n] = {i*p[j].v for j in 1:n, i in 1:2};
    Real total = sum(p[i].v*p[i].i for i in 1:n);
    Real values[n] = {f(c[i].d, time) for i in 1:n};
    Real function_values[2] = tabulated(time);
    Real listed[3] = array(1, time, 3);
  equation
    for i in 1:n loop
      p[i].v = i;
    end for;
  end Main;
end comprehensions;
