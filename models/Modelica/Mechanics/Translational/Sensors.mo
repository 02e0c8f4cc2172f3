within Modelica.Mechanics.Translational;
package Sensors "Sensors of position, velocity, acceleration, force and power"
  extends Modelica.Icons.SensorsPackage;

  model PositionSensor "Absolute position"
    extends Interfaces.PartialAbsoluteSensor;
    Modelica.Blocks.Interfaces.RealOutput s(unit = "m") "position";
  equation
    s = flange.s;
  end PositionSensor;

  model SpeedSensor "Absolute velocity"
    extends Interfaces.PartialAbsoluteSensor;
    Modelica.Blocks.Interfaces.RealOutput v(unit = "m/s") "velocity";
  equation
    v = der(flange.s);
  end SpeedSensor;

  model AccSensor "Absolute acceleration"
    extends Interfaces.PartialAbsoluteSensor;
    SI.Velocity v "velocity";
    Modelica.Blocks.Interfaces.RealOutput a(unit = "m/s2") "acceleration";
  equation
    v = der(flange.s);
    a = der(v);
  end AccSensor;

  model RelPositionSensor "Distance between two flanges"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput s_rel(unit = "m") "distance from flange_a to flange_b";
  equation
    s_rel = flange_b.s - flange_a.s;
    flange_a.f = 0;
  end RelPositionSensor;

  model ForceSensor "Force through a rod"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput f(unit = "N") "force, the same as flange_a.f";
  equation
    flange_a.s = flange_b.s;
    f = flange_a.f;
  end ForceSensor;

  model PowerSensor "Power through a rod"
    extends Interfaces.PartialRelativeSensor;
    Modelica.Blocks.Interfaces.RealOutput power(unit = "W") "power from flange_a to flange_b";
  equation
    flange_a.s = flange_b.s;
    power = flange_a.f*der(flange_a.s);
  end PowerSensor;
end Sensors;
