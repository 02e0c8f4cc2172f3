package tolerated_constructs "what other tools take with a warning or none; errors for strict checks"
  connector Port
    flow Real q;
    Real c;
  equation
    annotation(Documentation(info = "an editor leaves the empty section"));
  end Port;
  connector Input = input Real;
  partial model Start
    Real x(start = 1, fixed = true);
  end Start;
  block Decay "a block that extends a model"
    extends Start;
  equation
    der(x) = -x;
  end Decay;
  model Conditional "a conditional component in branches that parameters exclude"
    parameter Boolean uses = false;
    Input u if uses;
    parameter Real given = 300;
    Real first = if uses then u else given;
    Real second = if not uses then given else 2*u;
  end Conditional;
  partial package Gas
    constant Real cp;
  end Gas;
  partial package Ideal
    extends Gas;
    constant Real T0 = 273;
  end Ideal;
  package Nitrogen
    extends Gas(cp = 1000);
  end Nitrogen;
  model Heater
    replaceable package Medium = Nitrogen constrainedby Ideal;
    Real h = Medium.cp*time;
  end Heater;
  model Main
    Port port;
    Decay decay;
    Conditional conditional;
    Heater heater;
    Real valued(value = 3);
  equation
    port.c = port.q;
  end Main;
end tolerated_constructs;
