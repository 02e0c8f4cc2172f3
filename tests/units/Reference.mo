package Reference "The models of the Reference-FMUs, in Modelica"
  model Dahlquist "x' = -k x"
    parameter Real k = 1;
    output Real x(start = 1, fixed = true);
  equation
    der(x) = -k*x;
    annotation(experiment(StopTime = 10, Interval = 0.1));
  end Dahlquist;

  model VanDerPol "The van der Pol oscillator"
    parameter Real mu = 1;
    output Real x0(start = 2, fixed = true) "the first state";
    output Real x1(start = 0, fixed = true) "the second state";
  equation
    der(x0) = x1;
    der(x1) = mu*((1 - x0^2)*x1) - x0;
    annotation(experiment(StopTime = 20, Interval = 0.01));
  end VanDerPol;

  model BouncingBall "A ball that is dropped from a height of 1 m"
    parameter Real g(unit = "m/s2") = -9.81;
    parameter Real e(min = 0.5, max = 1) = 0.7;
    constant Real v_min(unit = "m/s") = 0.1;
    output Real h(unit = "m", displayUnit = "mm", start = 1, fixed = true);
    output Real v(unit = "m/s", start = 0, fixed = true);
    Boolean flying(start = true, fixed = true);
  equation
    der(h) = if flying then v else 0;
    der(v) = if flying then g else 0;
    when h <= 0 then
      flying = -e*pre(v) > v_min;
      reinit(v, if flying then -e*pre(v) else 0);
    end when;
    annotation(experiment(StopTime = 3, Interval = 0.01));
  end BouncingBall;

  model Stair "Counts seconds"
    output Integer counter(start = 1, fixed = true);
  equation
    when sample(1, 1) then
      counter = pre(counter) + 1;
    end when;
    when counter == 10 then
      terminate("the counter has reached 10");
    end when;
    annotation(experiment(StopTime = 10, Interval = 0.2));
  end Stair;

  type Option = enumeration(Option_1, Option_2);

  model Feedthrough
    parameter Real fixed_parameter = 0;
    input Real Float64_continuous_input(start = 0);
    output Real Float64_continuous_output;
    discrete input Real Float64_discrete_input(start = 0);
    discrete output Real Float64_discrete_output;
    input Integer Int32_input(start = 0);
    output Integer Int32_output;
    input Boolean Boolean_input(start = false);
    output Boolean Boolean_output;
    input Option Enumeration_input(start = Option.Option_1);
    output Option Enumeration_output;
  equation
    Float64_continuous_output = Float64_continuous_input + fixed_parameter;
    Float64_discrete_output = Float64_discrete_input;
    Int32_output = Int32_input;
    Boolean_output = Boolean_input;
    Enumeration_output = Enumeration_input;
    annotation(experiment(StopTime = 2, Interval = 0.1));
  end Feedthrough;

  model StateSpace "x' = A x + B u, y = C x + D u"
    parameter Real A[3, 3] = [1, 0, 0; 0, 1, 0; 0, 0, 1], B[3, 3] = [1, 0, 0; 0, 1, 0; 0, 0, 1];
    parameter Real C[3, 3] = [1, 0, 0; 0, 1, 0; 0, 0, 1], D[3, 3] = [1, 0, 0; 0, 1, 0; 0, 0, 1];
    parameter Real x0[3] = {0, 0, 0};
    input Real u[3](start = {1, 2, 3});
    output Real y[3];
    Real x[3](start = x0, each fixed = true);
  equation
    der(x) = A*x + B*u;
    y = C*x + D*u;
    annotation(experiment(StopTime = 10));
  end StateSpace;

  model Roberts "The reaction of Robertson"
    output Real y1(start = 1, fixed = true, nominal = 1e-4);
    output Real y2(start = 0, fixed = true, nominal = 1e-2);
    output Real y3(nominal = 1e-2);
  equation
    der(y1) = -0.04*y1 + 1e4*y2*y3;
    der(y2) = 0.04*y1 - 1e4*y2*y3 - 3e7*y2^2;
    y1 + y2 + y3 = 1;
    annotation(experiment(StartTime = 1e-5, StopTime = 100));
  end Roberts;

  function readLine
    input String fileName;
    input Integer lineNumber = 1;
    output String string;
    output Boolean endOfFile;
    external "C" string = ModelicaInternal_readLine(fileName, lineNumber, endOfFile);
  end readLine;

  model Resource "The code of the letter in a file, which becomes part of the unit"
    parameter String line = readLine("y.txt");
    output Integer y = if line == "a" then 97 else 0;
    annotation(experiment(StopTime = 1));
  end Resource;

  model Clocks "Two periodic clocks and one with a condition"
    output Integer fast(start = 0, fixed = true), slow(start = 0, fixed = true);
    output Integer crossed(start = 0, fixed = true);
    Real x(start = 0, fixed = true);
    discrete Integer a(start = 0), b(start = 0), c(start = 0);
  equation
    der(x) = cos(time);
    when Clock(1, 10) then
      a = previous(a) + 1;
    end when;
    when Clock(3, 10) then
      b = previous(b) + 1;
    end when;
    when Clock(x > 0.5) then
      c = previous(c) + 1;
    end when;
    fast = hold(a);
    slow = hold(b);
    crossed = hold(c);
    annotation(experiment(StopTime = 2.95));
  end Clocks;

  model Pendulum "A loop and dynamic state selection"
    parameter Real L = 1;
    Real x(start = 1, fixed = true), y, vx(start = 0, fixed = true), vy, F;
  equation
    der(x) = vx; der(y) = vy;
    der(vx) = -F*x; der(vy) = -F*y - 9.81;
    x^2 + y^2 = L^2;
    annotation(experiment(StopTime = 3));
  end Pendulum;

  model Roots "A nonlinear loop"
    Real x(start = 1, fixed = true), z(start = 1);
  equation
    der(x) = -z;
    z + 0.1*z^3 + sin(z) = x;
    annotation(experiment(StopTime = 3));
  end Roots;

  model Relay "Hysteresis by relations"
    Real x(start = 0, fixed = true);
    Boolean on(start = true, fixed = true);
  equation
    der(x) = if on then 1 - x else -x;
    on = not pre(on) and x < 0.25 or pre(on) and x <= 0.75;
    annotation(experiment(StopTime = 10));
  end Relay;
end Reference;
