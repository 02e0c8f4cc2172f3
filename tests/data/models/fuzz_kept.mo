model Kept
  function f input Real u; output Real v; algorithm v := u*u + 1; annotation(derivative = df); end f;
  function df input Real u; input Real du; output Real dv; algorithm dv := 2*u*du; end df;
  function total input Real u[:]; output Real s; protected Real k[size(u, 1)]; algorithm
    s := 0; k := u; for i in 1:size(u, 1) loop k[i] := k[i]^2; s := s + k[integer(min(i, 2))]; end for;
    assert(s >= 0, "no sum");
  end total;
  function said input Real u; output Real v; algorithm v := 2*u;
    assert(u < 100, "it is " + String(u) + " or " + String(u, format = "5.2f") + String(u > 1)); end said;
  function solved input Real A[2, 2]; input Real b[2]; output Real x[2] = b; output Integer info;
    protected Real factors[2, 2] = A; Integer pivots[2];
    external "FORTRAN 77" dgesv(2, 1, factors, 2, pivots, x, 2, info); end solved;
  class Table extends ExternalObject;
    function constructor input String name; input String file; input Real rows[:, :]; input Integer columns[:];
      input Integer smoothness; output Table table;
      external "C" table = ModelicaStandardTables_CombiTable1D_init(name, file, rows, size(rows, 1),
        size(rows, 2), columns, size(columns, 1), smoothness); end constructor;
    function destructor input Table table;
      external "C" ModelicaStandardTables_CombiTable1D_close(table); end destructor;
  end Table;
  function looked_up input Table table; input Integer column; input Real u; output Real v;
    external "C" v = ModelicaStandardTables_CombiTable1D_getValue(table, column, u); end looked_up;
  parameter Real p = 2;
  parameter Integer n = 2;
  parameter Table table = Table("NoName", "NoName", {{0, 1}, {1, 3}}, {2}, 1);
  Real solution[2] = solved({{2, x[1]}, {1, 3}}, x) + {said(x[2]), looked_up(table, 1, x[1])};
  Real x[n](each start = 1, each fixed = true);
  Real y;
  Real z(start = 1);
  Real a; Real b; Real c;
  Real h(start = 1, fixed = true); Real v(start = 0, fixed = true);
  Real late; Real[2] ends; Boolean high;
  discrete Real d(start = 0, fixed = true);
equation
  for i in 1:n loop der(x[i]) = -p*x[i]; end for;
  y = f(x[1]) + total(x) + (if time > 0.5 then exp(-x[2])*sqrt(1 + x[2]^2) else floor(3*x[1]));
  z^3 + z = y;
  a + p*b - c = x[1]; b - a + p*c = x[2]; p*a + b + c*(1 + x[1]) = 1;
  der(h) = v; der(v) = -9.81;
  high = h > 0.5 and y < 5;
  late = delay(x[1], 0.1);
  (ends[1], ends[2]) = spatialDistribution(x[1], x[2], time, true, {0, 1}, {1, 1});
  assert(h < 100, "it is at " + String(h));
  when h < 0 then reinit(v, -0.7*pre(v)); end when;
  when sample(0.2, 0.2) then d = pre(d) + 1; end when;
  when time > 0.95 then terminate("over"); end when;
end Kept;
