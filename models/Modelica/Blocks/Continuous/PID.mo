within Modelica.Blocks.Continuous;
block PID "Controller k (1 + 1/(Ti s) + Td s/(Td/Nd s + 1))"
  extends Modelica.Blocks.Interfaces.SISO;
  parameter Real k = 1 "factor";
  parameter SI.Time Ti(min = Modelica.Constants.small, start = 0.5) "time constant of the integral part";
  parameter SI.Time Td(min = 0, start = 0.1) "time constant of the derivative part";
  parameter Real Nd(min = Modelica.Constants.small) = 10 "the filter of the derivative is that much faster";
  parameter Init initType = Init.InitialState "how it starts";
  parameter Real xi_start = 0 "state of the integral part at the start";
  parameter Real xd_start = 0 "state of the derivative part at the start";
  parameter Real y_start = 0 "output at the start";
  constant SI.Time unitTime = 1 "one second, for the units";
  Modelica.Blocks.Math.Gain P(k = 1) "proportional part";
  Integrator I(
    k = unitTime/Ti,
    y_start = xi_start,
    initType = if initType == Init.SteadyState then Init.SteadyState
      elseif initType == Init.InitialState then Init.InitialState
      else Init.NoInit) "integral part";
  Derivative D(
    k = Td/unitTime,
    T = max(Td/Nd, 100*Modelica.Constants.eps),
    x_start = xd_start,
    initType = if initType == Init.SteadyState or initType == Init.InitialOutput then Init.SteadyState
      elseif initType == Init.InitialState then Init.InitialState
      else Init.NoInit) "derivative part";
  Modelica.Blocks.Math.Add3 Add "sum of the parts";
  Modelica.Blocks.Math.Gain Gain(k = k) "factor of the sum";
initial equation
  if initType == Init.InitialOutput then
    y = y_start;
  end if;
equation
  connect(u, P.u);
  connect(u, I.u);
  connect(u, D.u);
  connect(P.y, Add.u1);
  connect(I.y, Add.u2);
  connect(D.y, Add.u3);
  connect(Add.y, Gain.u);
  connect(Gain.y, y);
end PID;
