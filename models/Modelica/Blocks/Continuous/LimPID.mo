within Modelica.Blocks.Continuous;
block LimPID "P, PI, PD or PID controller with limited output, anti-windup and weights of the set point"
  extends Modelica.Blocks.Interfaces.SVcontrol;
  import Modelica.Blocks.Types.SimpleController;
  output Real controlError = u_s - u_m "set point less measurement";
  parameter SimpleController controllerType = SimpleController.PID "parts of the controller";
  parameter Real k = 1 "factor";
  parameter SI.Time Ti(min = Modelica.Constants.small) = 0.5 "time constant of the integral part";
  parameter SI.Time Td(min = 0) = 0.1 "time constant of the derivative part";
  parameter Real yMax(start = 1) "upper limit of the output";
  parameter Real yMin = -yMax "lower limit of the output";
  parameter Real wp(min = 0) = 1 "weight of the set point in the proportional part";
  parameter Real wd(min = 0) = 0 "weight of the set point in the derivative part";
  parameter Real Ni(min = 100*Modelica.Constants.eps) = 0.9 "Ni Ti is the time constant of the anti-windup";
  parameter Real Nd(min = 100*Modelica.Constants.eps) = 10 "the filter of the derivative is that much faster";
  parameter Boolean withFeedForward = false "there is an input for a feed-forward signal";
  parameter Real kFF = 1 "factor of the feed-forward signal";
  parameter Init initType = Init.InitialState "how it starts";
  parameter Real xi_start = 0 "state of the integral part at the start";
  parameter Real xd_start = 0 "state of the derivative part at the start";
  parameter Real y_start = 0 "output at the start";
  parameter Modelica.Blocks.Types.LimiterHomotopy homotopyType = Modelica.Blocks.Types.LimiterHomotopy.Linear
    "what the limiter does in the simplified initial problem";
  parameter Boolean strict = false "reaching a limit is no event";
  parameter Boolean limitsAtInit = true "not used, kept for models of version 3";
  constant SI.Time unitTime = 1 "one second, for the units";
  Modelica.Blocks.Interfaces.RealInput u_ff if withFeedForward "feed-forward signal";
  Modelica.Blocks.Math.Add addP(k1 = wp, k2 = -1) "weighted control error";
  Modelica.Blocks.Math.Gain P(k = 1) "proportional part";
  Modelica.Blocks.Math.Add addD(k1 = wd, k2 = -1) if with_D "weighted control error of the derivative part";
  Derivative D(
    k = Td/unitTime,
    T = max(Td/Nd, 1e-14),
    x_start = xd_start,
    initType = if initType == Init.SteadyState or initType == Init.InitialOutput then Init.SteadyState
      elseif initType == Init.InitialState then Init.InitialState
      else Init.NoInit) if with_D "derivative part";
  Modelica.Blocks.Math.Add3 addI(k2 = -1) if with_I "control error with the anti-windup";
  Integrator I(
    k = unitTime/Ti,
    y_start = xi_start,
    initType = if initType == Init.SteadyState then Init.SteadyState
      elseif initType == Init.InitialState then Init.InitialState
      else Init.NoInit) if with_I "integral part";
  Modelica.Blocks.Math.Add3 addPID "sum of the parts";
  Modelica.Blocks.Math.Gain gainPID(k = k) "factor of the sum";
  Modelica.Blocks.Math.Add addFF(k1 = 1, k2 = kFF) "feed-forward signal added";
  Modelica.Blocks.Nonlinear.Limiter limiter(
    uMax = yMax,
    uMin = yMin,
    strict = strict,
    homotopyType = homotopyType) "limits of the output";
  Modelica.Blocks.Math.Add addSat(k1 = +1, k2 = -1) if with_I "what the limits take away";
  Modelica.Blocks.Math.Gain gainTrack(k = 1/(k*Ni)) if with_I "anti-windup";
  Modelica.Blocks.Sources.Constant Dzero(k = 0) if not with_D "no derivative part";
  Modelica.Blocks.Sources.Constant Izero(k = 0) if not with_I "no integral part";
  Modelica.Blocks.Sources.Constant FFzero(k = 0) if not withFeedForward "no feed-forward signal";
protected
  parameter Boolean with_I = controllerType == SimpleController.PI or controllerType == SimpleController.PID;
  parameter Boolean with_D = controllerType == SimpleController.PD or controllerType == SimpleController.PID;
initial equation
  if initType == Init.InitialOutput then
    gainPID.y = y_start;
  end if;
equation
  assert(yMax >= yMin, "yMax has to be at least yMin");
  connect(u_s, addP.u1);
  connect(u_m, addP.u2);
  connect(addP.y, P.u);
  connect(P.y, addPID.u1);
  connect(u_s, addD.u1);
  connect(u_m, addD.u2);
  connect(addD.y, D.u);
  connect(D.y, addPID.u2);
  connect(Dzero.y, addPID.u2);
  connect(u_s, addI.u1);
  connect(u_m, addI.u2);
  connect(gainTrack.y, addI.u3);
  connect(addI.y, I.u);
  connect(I.y, addPID.u3);
  connect(Izero.y, addPID.u3);
  connect(addPID.y, gainPID.u);
  connect(gainPID.y, addFF.u1);
  connect(u_ff, addFF.u2);
  connect(FFzero.y, addFF.u2);
  connect(addFF.y, limiter.u);
  connect(limiter.y, y);
  connect(limiter.y, addSat.u1);
  connect(addFF.y, addSat.u2);
  connect(addSat.y, gainTrack.u);
end LimPID;
