model Keeps
  impure function kept
    input Integer s[:]; input Real x; input String name; input Boolean force = false;
    output Real y[2, 1];
  protected
    Integer n = max(s .* s); Real d[n] = fill(x, n);
    String path = "tmp/kept/" + name + ".mat"; Boolean ok;
  algorithm
    if force or not Modelica.Utilities.Files.exist(path) then
      Modelica.Utilities.Files.createDirectory("tmp");
      Modelica.Utilities.Files.createDirectory("tmp/kept");
      ok := Modelica.Utilities.Streams.writeRealMatrix(path, "y", {{sum(d)}, {n}});
    end if;
    y := Modelica.Utilities.Streams.readRealMatrix(path, "y", 2, 1);
  end kept;
  parameter Real x = 1.5;
  parameter Integer s[2](each fixed = false);
  parameter Real y[2, 1](each fixed = false);
  parameter Boolean force = false;
  Real z(start = 0, fixed = true);
initial equation
  s = {integer(time) + 2, 1};
  y = kept(s, x, "a" + String(s[1]), force);
equation
  der(z) = y[1, 1] + y[2, 1];
end Keeps;
