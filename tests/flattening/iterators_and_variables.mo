model iterators_and_variables "iterators may have the names of variables"
  type E = enumeration(one, two);
  E e = if time < 1 then E.one else E.two;
  Real x = time;
  parameter String names[2] = {String(e) for e in E};
  parameter Real squares[3] = {x^2 for x in 1:3};
  parameter Real total = sum(x for x in {0.5, 1.5});
end iterators_and_variables;
