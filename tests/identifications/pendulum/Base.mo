package Base "operators that others extend"
  function begin
    input Real low[:];
    input Real high[:];
    input Real u[:,:];
    output Real pop[size(u, 1), size(u, 2)];
  algorithm
    for i in 1:size(u, 1) loop
      pop[i,:] := low + (high - low).*u[i,:];
    end for;
  end begin;
  replaceable function choose "order of a generation"
    input Real pop[:,:];
    input Real fit[:];
    output Real ordered[size(pop, 1), size(pop, 2)];
  algorithm
    ordered := GAPILib.Basics.Fit_Order(pop, fit, size(pop, 1), size(pop, 1) - 4, 1);
  end choose;
end Base;
