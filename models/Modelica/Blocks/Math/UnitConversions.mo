within Modelica.Blocks.Math;
encapsulated package UnitConversions "Blocks from one unit to another"
  import Modelica;
  extends Modelica.Icons.Package;

  block To_degC "From kelvin to degrees Celsius"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "K"), y(unit = "degC"));
  equation
    y = u - 273.15;
  end To_degC;

  block From_degC "From degrees Celsius to kelvin"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "degC"), y(unit = "K"));
  equation
    y = u + 273.15;
  end From_degC;

  block To_degF "From kelvin to degrees Fahrenheit"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "K"), y(unit = "degF"));
  equation
    y = u*9/5 - 459.67;
  end To_degF;

  block From_degF "From degrees Fahrenheit to kelvin"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "degF"), y(unit = "K"));
  equation
    y = (u + 459.67)*5/9;
  end From_degF;

  block To_degRk "From kelvin to degrees Rankine"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "K"), y(unit = "degRk"));
  equation
    y = u*9/5;
  end To_degRk;

  block From_degRk "From degrees Rankine to kelvin"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "degRk"), y(unit = "K"));
  equation
    y = u*5/9;
  end From_degRk;

  block To_deg "From radians to degrees"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "rad"), y(unit = "deg"));
  equation
    y = u*180/Modelica.Constants.pi;
  end To_deg;

  block From_deg "From degrees to radians"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "deg"), y(unit = "rad"));
  equation
    y = u*Modelica.Constants.pi/180;
  end From_deg;

  block To_rpm "From radians per second to revolutions per minute"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "rad/s"), y(unit = "rev/min"));
  equation
    y = u*30/Modelica.Constants.pi;
  end To_rpm;

  block From_rpm "From revolutions per minute to radians per second"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "rev/min"), y(unit = "rad/s"));
  equation
    y = u*Modelica.Constants.pi/30;
  end From_rpm;

  block To_kmh "From metres per second to kilometres per hour"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "m/s"), y(unit = "km/h"));
  equation
    y = u*3.6;
  end To_kmh;

  block From_kmh "From kilometres per hour to metres per second"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "km/h"), y(unit = "m/s"));
  equation
    y = u/3.6;
  end From_kmh;

  block To_day "From seconds to days"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "s"), y(unit = "d"));
  equation
    y = u/86400;
  end To_day;

  block From_day "From days to seconds"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "d"), y(unit = "s"));
  equation
    y = u*86400;
  end From_day;

  block To_hour "From seconds to hours"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "s"), y(unit = "h"));
  equation
    y = u/3600;
  end To_hour;

  block From_hour "From hours to seconds"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "h"), y(unit = "s"));
  equation
    y = u*3600;
  end From_hour;

  block To_minute "From seconds to minutes"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "s"), y(unit = "min"));
  equation
    y = u/60;
  end To_minute;

  block From_minute "From minutes to seconds"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "min"), y(unit = "s"));
  equation
    y = u*60;
  end From_minute;

  block To_litre "From cubic metres to litres"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "m3"), y(unit = "l"));
  equation
    y = u*1000;
  end To_litre;

  block From_litre "From litres to cubic metres"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "l"), y(unit = "m3"));
  equation
    y = u/1000;
  end From_litre;

  block To_kWh "From joules to kilowatt hours"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "J"), y(unit = "kW.h"));
  equation
    y = u/3.6e6;
  end To_kWh;

  block From_kWh "From kilowatt hours to joules"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "kW.h"), y(unit = "J"));
  equation
    y = u*3.6e6;
  end From_kWh;

  block To_bar "From pascals to bars"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "Pa"), y(unit = "bar"));
  equation
    y = u/1e5;
  end To_bar;

  block From_bar "From bars to pascals"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "bar"), y(unit = "Pa"));
  equation
    y = u*1e5;
  end From_bar;

  block To_gps "From kilograms per second to grams per second"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "kg/s"), y(unit = "g/s"));
  equation
    y = u*1000;
  end To_gps;

  block From_gps "From grams per second to kilograms per second"
    extends Modelica.Blocks.Interfaces.PartialConversionBlock(u(unit = "g/s"), y(unit = "kg/s"));
  equation
    y = u/1000;
  end From_gps;
end UnitConversions;
