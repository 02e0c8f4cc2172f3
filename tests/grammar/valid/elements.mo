model M
  import A.B;
  import C = A.B "alias";
  import A.B.*;
  import A.B.{C, D};
  extends Base(final x = 1, break y, break connect(a, b[1]), redeclare R r) annotation(e = 1);
  Real x, y[3] = {1, 2, 3} "vector", z(start = 1) if c "conditional" annotation(d = 1);
  Real[2, :] w;
  parameter Integer n = 3;
  constant .Modelica.Units.SI.Voltage v = 1;
  discrete input Boolean b;
  flow output Real i;
  stream Real h;
  final inner World world;
  outer World other;
  inner outer World both;
  redeclare final replaceable R r constrainedby Base(x = 1) "why" annotation(choicesAllMatching = true);
  replaceable model Inner = R(x = 2) constrainedby Base;
  replaceable package Medium = Water extends OldStyle;
public
protected
  Real hidden;
  class Local
    Real x;
  end Local;
public
  Real shown = break;
end M;
