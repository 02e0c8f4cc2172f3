within Modelica.Units;
package Conversions "Functions between SI and other units"
  extends Modelica.Icons.Package;
  package NonSIunits = Modelica.Units.NonSI "Former name of the types in other units";

  function to_unit1 "The same number with the unit 1"
    extends Modelica.Icons.Function;
    input Real r "number of any unit";
    output Real result(unit = "1") "the same number";
  algorithm
    result := r;
    annotation(Inline = true);
  end to_unit1;

  function to_degC "From kelvin to degrees Celsius"
    extends Modelica.Icons.Function;
    input SI.Temperature Kelvin "kelvin";
    output NonSI.Temperature_degC Celsius "degrees Celsius";
  algorithm
    Celsius := Kelvin + Modelica.Constants.T_zero;
    annotation(Inline = true);
  end to_degC;

  function from_degC "From degrees Celsius to kelvin"
    extends Modelica.Icons.Function;
    input NonSI.Temperature_degC Celsius "degrees Celsius";
    output SI.Temperature Kelvin "kelvin";
  algorithm
    Kelvin := Celsius - Modelica.Constants.T_zero;
    annotation(Inline = true);
  end from_degC;

  function to_degF "From kelvin to degrees Fahrenheit"
    extends Modelica.Icons.Function;
    input SI.Temperature Kelvin "kelvin";
    output NonSI.Temperature_degF Fahrenheit "degrees Fahrenheit";
  algorithm
    Fahrenheit := 32 + 9/5*(Kelvin + Modelica.Constants.T_zero);
    annotation(Inline = true);
  end to_degF;

  function from_degF "From degrees Fahrenheit to kelvin"
    extends Modelica.Icons.Function;
    input NonSI.Temperature_degF Fahrenheit "degrees Fahrenheit";
    output SI.Temperature Kelvin "kelvin";
  algorithm
    Kelvin := 5/9*(Fahrenheit - 32) - Modelica.Constants.T_zero;
    annotation(Inline = true);
  end from_degF;

  function to_degRk "From kelvin to degrees Rankine"
    extends Modelica.Icons.Function;
    input SI.Temperature Kelvin "kelvin";
    output NonSI.Temperature_degRk Rankine "degrees Rankine";
  algorithm
    Rankine := 9/5*Kelvin;
    annotation(Inline = true);
  end to_degRk;

  function from_degRk "From degrees Rankine to kelvin"
    extends Modelica.Icons.Function;
    input NonSI.Temperature_degRk Rankine "degrees Rankine";
    output SI.Temperature Kelvin "kelvin";
  algorithm
    Kelvin := 5/9*Rankine;
    annotation(Inline = true);
  end from_degRk;

  function to_deg "From radians to degrees"
    extends Modelica.Icons.Function;
    input SI.Angle radian "radians";
    output NonSI.Angle_deg degree "degrees";
  algorithm
    degree := 180/Modelica.Constants.pi*radian;
    annotation(Inline = true);
  end to_deg;

  function from_deg "From degrees to radians"
    extends Modelica.Icons.Function;
    input NonSI.Angle_deg degree "degrees";
    output SI.Angle radian "radians";
  algorithm
    radian := Modelica.Constants.pi/180*degree;
    annotation(Inline = true);
  end from_deg;

  function to_rpm "From radians per second to revolutions per minute"
    extends Modelica.Icons.Function;
    input SI.AngularVelocity rs "radians per second";
    output NonSI.AngularVelocity_rpm rpm "revolutions per minute";
  algorithm
    rpm := 30/Modelica.Constants.pi*rs;
    annotation(Inline = true);
  end to_rpm;

  function from_rpm "From revolutions per minute to radians per second"
    extends Modelica.Icons.Function;
    input NonSI.AngularVelocity_rpm rpm "revolutions per minute";
    output SI.AngularVelocity rs "radians per second";
  algorithm
    rs := Modelica.Constants.pi/30*rpm;
    annotation(Inline = true);
  end from_rpm;

  function to_kmh "From metres per second to kilometres per hour"
    extends Modelica.Icons.Function;
    input SI.Velocity ms "metres per second";
    output NonSI.Velocity_kmh kmh "kilometres per hour";
  algorithm
    kmh := 3.6*ms;
    annotation(Inline = true);
  end to_kmh;

  function from_kmh "From kilometres per hour to metres per second"
    extends Modelica.Icons.Function;
    input NonSI.Velocity_kmh kmh "kilometres per hour";
    output SI.Velocity ms "metres per second";
  algorithm
    ms := kmh/3.6;
    annotation(Inline = true);
  end from_kmh;

  function to_day "From seconds to days"
    extends Modelica.Icons.Function;
    input SI.Time s "seconds";
    output NonSI.Time_day day "days";
  algorithm
    day := s/86400;
    annotation(Inline = true);
  end to_day;

  function from_day "From days to seconds"
    extends Modelica.Icons.Function;
    input NonSI.Time_day day "days";
    output SI.Time s "seconds";
  algorithm
    s := 86400*day;
    annotation(Inline = true);
  end from_day;

  function to_hour "From seconds to hours"
    extends Modelica.Icons.Function;
    input SI.Time s "seconds";
    output NonSI.Time_hour hour "hours";
  algorithm
    hour := s/3600;
    annotation(Inline = true);
  end to_hour;

  function from_hour "From hours to seconds"
    extends Modelica.Icons.Function;
    input NonSI.Time_hour hour "hours";
    output SI.Time s "seconds";
  algorithm
    s := 3600*hour;
    annotation(Inline = true);
  end from_hour;

  function to_minute "From seconds to minutes"
    extends Modelica.Icons.Function;
    input SI.Time s "seconds";
    output NonSI.Time_minute minute "minutes";
  algorithm
    minute := s/60;
    annotation(Inline = true);
  end to_minute;

  function from_minute "From minutes to seconds"
    extends Modelica.Icons.Function;
    input NonSI.Time_minute minute "minutes";
    output SI.Time s "seconds";
  algorithm
    s := 60*minute;
    annotation(Inline = true);
  end from_minute;

  function to_litre "From cubic metres to litres"
    extends Modelica.Icons.Function;
    input SI.Volume m3 "cubic metres";
    output NonSI.Volume_litre litre "litres";
  algorithm
    litre := 1000*m3;
    annotation(Inline = true);
  end to_litre;

  function from_litre "From litres to cubic metres"
    extends Modelica.Icons.Function;
    input NonSI.Volume_litre litre "litres";
    output SI.Volume m3 "cubic metres";
  algorithm
    m3 := litre/1000;
    annotation(Inline = true);
  end from_litre;

  function to_Ah "From coulombs to ampere hours"
    extends Modelica.Icons.Function;
    input SI.ElectricCharge Coulomb "coulombs";
    output NonSI.ElectricCharge_Ah AmpereHour "ampere hours";
  algorithm
    AmpereHour := Coulomb/3600;
    annotation(Inline = true);
  end to_Ah;

  function from_Ah "From ampere hours to coulombs"
    extends Modelica.Icons.Function;
    input NonSI.ElectricCharge_Ah AmpereHour "ampere hours";
    output SI.ElectricCharge Coulomb "coulombs";
  algorithm
    Coulomb := 3600*AmpereHour;
    annotation(Inline = true);
  end from_Ah;

  function to_Wh "From joules to watt hours"
    extends Modelica.Icons.Function;
    input SI.Energy Joule "joules";
    output NonSI.Energy_Wh WattHour "watt hours";
  algorithm
    WattHour := Joule/3600;
    annotation(Inline = true);
  end to_Wh;

  function from_Wh "From watt hours to joules"
    extends Modelica.Icons.Function;
    input NonSI.Energy_Wh WattHour "watt hours";
    output SI.Energy Joule "joules";
  algorithm
    Joule := 3600*WattHour;
    annotation(Inline = true);
  end from_Wh;

  function to_kWh "From joules to kilowatt hours"
    extends Modelica.Icons.Function;
    input SI.Energy J "joules";
    output NonSI.Energy_kWh kWh "kilowatt hours";
  algorithm
    kWh := J/3.6e6;
    annotation(Inline = true);
  end to_kWh;

  function from_kWh "From kilowatt hours to joules"
    extends Modelica.Icons.Function;
    input NonSI.Energy_kWh kWh "kilowatt hours";
    output SI.Energy J "joules";
  algorithm
    J := 3.6e6*kWh;
    annotation(Inline = true);
  end from_kWh;

  function to_bar "From pascals to bars"
    extends Modelica.Icons.Function;
    input SI.Pressure Pa "pascals";
    output NonSI.Pressure_bar bar "bars";
  algorithm
    bar := Pa/1e5;
    annotation(Inline = true);
  end to_bar;

  function from_bar "From bars to pascals"
    extends Modelica.Icons.Function;
    input NonSI.Pressure_bar bar "bars";
    output SI.Pressure Pa "pascals";
  algorithm
    Pa := 1e5*bar;
    annotation(Inline = true);
  end from_bar;

  function to_gps "From kilograms per second to grams per second"
    extends Modelica.Icons.Function;
    input SI.MassFlowRate kgps "kilograms per second";
    output NonSI.MassFlowRate_gps gps "grams per second";
  algorithm
    gps := 1000*kgps;
    annotation(Inline = true);
  end to_gps;

  function from_gps "From grams per second to kilograms per second"
    extends Modelica.Icons.Function;
    input NonSI.MassFlowRate_gps gps "grams per second";
    output SI.MassFlowRate kgps "kilograms per second";
  algorithm
    kgps := gps/1000;
    annotation(Inline = true);
  end from_gps;

  function to_cm2 "From square metres to square centimetres"
    extends Modelica.Icons.Function;
    input SI.Area m2 "square metres";
    output NonSI.Area_cm cm2 "square centimetres";
  algorithm
    cm2 := 1e4*m2;
    annotation(Inline = true);
  end to_cm2;

  function from_cm2 "From square centimetres to square metres"
    extends Modelica.Icons.Function;
    input NonSI.Area_cm cm2 "square centimetres";
    output SI.Area m2 "square metres";
  algorithm
    m2 := 1e-4*cm2;
    annotation(Inline = true);
  end from_cm2;

  function from_Hz "From cycles to radians per second"
    extends Modelica.Icons.Function;
    input SI.Frequency f "frequency";
    output SI.AngularVelocity w "angular velocity";
  algorithm
    w := 2*Modelica.Constants.pi*f;
    annotation(Inline = true);
  end from_Hz;

  function to_Hz "From radians to cycles per second"
    extends Modelica.Icons.Function;
    input SI.AngularVelocity w "angular velocity";
    output SI.Frequency f "frequency";
  algorithm
    f := w/(2*Modelica.Constants.pi);
    annotation(Inline = true);
  end to_Hz;
end Conversions;
