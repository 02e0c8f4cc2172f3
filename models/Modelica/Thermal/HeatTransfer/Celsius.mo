within Modelica.Thermal.HeatTransfer;
package Celsius "The same with temperatures in degrees Celsius"
  extends Modelica.Icons.VariantsPackage;

  model ToKelvin "From degrees Celsius to kelvin"
    Modelica.Blocks.Interfaces.RealInput Celsius(unit = "degC") "degrees Celsius";
    Modelica.Blocks.Interfaces.RealOutput Kelvin(unit = "K") "kelvin";
  equation
    Kelvin = Celsius - Modelica.Constants.T_zero;
  end ToKelvin;

  model FromKelvin "From kelvin to degrees Celsius"
    Modelica.Blocks.Interfaces.RealInput Kelvin(unit = "K") "kelvin";
    Modelica.Blocks.Interfaces.RealOutput Celsius(unit = "degC") "degrees Celsius";
  equation
    Celsius = Kelvin + Modelica.Constants.T_zero;
  end FromKelvin;

  model FixedTemperature "Constant temperature"
    parameter Modelica.Units.NonSI.Temperature_degC T "temperature";
    Interfaces.HeatPort_b port "port";
  equation
    port.T = T - Modelica.Constants.T_zero;
  end FixedTemperature;

  model PrescribedTemperature "Temperature that is an input"
    Interfaces.HeatPort_b port "port";
    Modelica.Blocks.Interfaces.RealInput T(unit = "degC") "temperature";
  equation
    port.T = T - Modelica.Constants.T_zero;
  end PrescribedTemperature;

  model TemperatureSensor "Temperature in degrees Celsius"
    Modelica.Blocks.Interfaces.RealOutput T(unit = "degC") "temperature";
    Interfaces.HeatPort_a port "port";
  equation
    T = port.T + Modelica.Constants.T_zero;
    port.Q_flow = 0;
  end TemperatureSensor;
end Celsius;
