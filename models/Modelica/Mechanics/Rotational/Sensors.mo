within Modelica.Mechanics.Rotational;
package Sensors "Sensors of angle, speed, acceleration, torque and power"
  extends Modelica.Icons.SensorsPackage;

  model AngleSensor "Absolute angle"
    extends Interfaces.PartialAbsoluteSensor;
    Modelica.Blocks.Interfaces.RealOutput phi(unit = "rad", displayUnit = "deg") "angle";
  equation
    phi = flange.phi;
  end AngleSensor;

  model SpeedSensor "Absolute speed"
    extends Interfaces.PartialAbsoluteSensor;
    Modelica.Blocks.Interfaces.RealOutput w(unit = "rad/s") "speed";
  equation
    w = der(flange.phi);
  end SpeedSensor;

  model AccSensor "Absolute acceleration"
    extends Interfaces.PartialAbsoluteSensor;
    SI.AngularVelocity w "speed";
    Modelica.Blocks.Interfaces.RealOutput a(unit = "rad/s2") "acceleration";
  equation
    w = der(flange.phi);
    a = der(w);
  end AccSensor;

  model RelAngleSensor "Angle between two flanges"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput phi_rel(unit = "rad", displayUnit = "deg")
      "angle of flange_b against flange_a";
  equation
    phi_rel = flange_b.phi - flange_a.phi;
    flange_a.tau = 0;
  end RelAngleSensor;

  model RelSpeedSensor "Difference of two speeds"
    extends Interfaces.PartialRelativeSensor;
    SI.Angle phi_rel "angle of flange_b against flange_a";
    Modelica.Blocks.Interfaces.RealOutput w_rel(unit = "rad/s") "its derivative";
  equation
    phi_rel = flange_b.phi - flange_a.phi;
    w_rel = der(phi_rel);
    flange_a.tau = 0;
  end RelSpeedSensor;

  model TorqueSensor "Torque through a shaft"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput tau(unit = "N.m") "torque, the same as flange_a.tau";
  equation
    flange_a.phi = flange_b.phi;
    tau = flange_a.tau;
  end TorqueSensor;

  model PowerSensor "Power through a shaft"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput power(unit = "W") "power from flange_a to flange_b";
  equation
    flange_a.phi = flange_b.phi;
    power = flange_a.tau*der(flange_a.phi);
  end PowerSensor;
end Sensors;
