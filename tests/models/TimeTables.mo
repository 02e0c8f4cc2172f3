model TimeTables "Tables over time with straight lines, steps and splines, and a table of one and of two variables"
  import Modelica.Blocks;
  import Modelica.Blocks.Types;
  Blocks.Sources.CombiTimeTable lines(
    table = [0, 0, 1; 1, 2, 3; 2, 0, 5], extrapolation = Types.Extrapolation.Periodic);
  Blocks.Sources.CombiTimeTable steps(
    table = [0, 1; 1, 4; 2, 9], smoothness = Types.Smoothness.ConstantSegments,
    extrapolation = Types.Extrapolation.HoldLastPoint);
  Blocks.Tables.CombiTable1Ds square(
    table = [0, 0; 1, 1; 2, 4; 3, 9; 4, 16], smoothness = Types.Smoothness.ContinuousDerivative);
  Blocks.Tables.CombiTable2Ds product(table = [0, 1, 2, 3; 1, 1, 2, 3; 2, 2, 4, 6; 4, 4, 8, 12]);
  Blocks.Continuous.Integrator integral[2];
equation
  connect(lines.y, integral.u);
  connect(lines.y[1], square.u);
  connect(lines.y[1], product.u1);
  connect(lines.y[2], product.u2);
  annotation(experiment(StopTime = 3.5, Tolerance = 1e-9));
end TimeTables;
