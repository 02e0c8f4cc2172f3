within Modelica.Thermal.HeatTransfer;
package Components "What stores and transfers heat"
  extends Modelica.Icons.Package;

  model HeatCapacitor "A body of one temperature that stores heat"
    parameter SI.HeatCapacity C "heat capacity";
    SI.Temperature T(start = 293.15, displayUnit = "degC") "temperature";
    SI.TemperatureSlope der_T(start = 0) "its derivative";
    Interfaces.HeatPort_a port "port";
  equation
    T = port.T;
    der_T = der(T);
    C*der(T) = port.Q_flow;
  end HeatCapacitor;

  model ThermalConductor "Conduction, in proportion to the temperature difference"
    extends Interfaces.Element1D;
    parameter SI.ThermalConductance G "conductance";
  equation
    Q_flow = G*dT;
  end ThermalConductor;

  model ThermalResistor "Conduction, given by the resistance"
    extends Interfaces.Element1D;
    parameter SI.ThermalResistance R "resistance";
  equation
    dT = R*Q_flow;
  end ThermalResistor;

  model Convection "Convection between a wall and a fluid; the conductance is an input"
    SI.HeatFlowRate Q_flow "heat from the wall to the fluid";
    SI.TemperatureDifference dT "temperature of the wall less that of the fluid";
    Modelica.Blocks.Interfaces.RealInput Gc(unit = "W/K") "conductance";
    Interfaces.HeatPort_a solid "wall";
    Interfaces.HeatPort_b fluid "fluid";
  equation
    dT = solid.T - fluid.T;
    Q_flow = Gc*dT;
    solid.Q_flow = Q_flow;
    fluid.Q_flow = -Q_flow;
  end Convection;

  model ConvectiveResistor "Convection between a wall and a fluid; the resistance is an input"
    SI.HeatFlowRate Q_flow "heat from the wall to the fluid";
    SI.TemperatureDifference dT "temperature of the wall less that of the fluid";
    Modelica.Blocks.Interfaces.RealInput Rc(unit = "K/W") "resistance";
    Interfaces.HeatPort_a solid "wall";
    Interfaces.HeatPort_b fluid "fluid";
  equation
    dT = solid.T - fluid.T;
    dT = Rc*Q_flow;
    solid.Q_flow = Q_flow;
    fluid.Q_flow = -Q_flow;
  end ConvectiveResistor;

  model BodyRadiation "Radiation between two bodies"
    extends Interfaces.Element1D;
    parameter Real Gr(unit = "m2") "net radiation conductance: area, emissivity and view factor";
  equation
    Q_flow = Gr*Modelica.Constants.sigma*(port_a.T^4 - port_b.T^4);
  end BodyRadiation;

  model ThermalCollector "Several ports joined to one"
    parameter Integer m(min = 1) = 3 "number of ports";
    Interfaces.HeatPort_a port_a[m] "ports";
    Interfaces.HeatPort_b port_b "one port";
  equation
    for i in 1:m loop
      port_a[i].T = port_b.T;
    end for;
    port_b.Q_flow + sum(port_a.Q_flow) = 0;
  end ThermalCollector;
end Components;
