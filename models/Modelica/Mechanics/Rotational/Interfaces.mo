within Modelica.Mechanics.Rotational;
package Interfaces "Flanges, and components by their flanges"
  extends Modelica.Icons.InterfacesPackage;

  connector Flange "End of a shaft"
    SI.Angle phi "absolute angle";
    flow SI.Torque tau "torque on the component";
  end Flange;

  connector Flange_a "End of a shaft, first of two"
    extends Flange;
  end Flange_a;

  connector Flange_b "End of a shaft, second of two"
    extends Flange;
  end Flange_b;

  connector Support "Housing of a shaft"
    extends Flange;
  end Support;

  model InternalSupport "Housing inside of a component"
    input SI.Torque tau "torque on the housing";
    SI.Angle phi "angle of the housing";
    Flange_a flange "to be connected to the housing";
  equation
    flange.tau = tau;
    flange.phi = phi;
  end InternalSupport;

  partial model PartialTwoFlanges "Two flanges"
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
  end PartialTwoFlanges;

  partial model PartialCompliant "A torque between two flanges that depends on their angle"
    SI.Angle phi_rel(start = 0) "angle of flange_b against flange_a";
    SI.Torque tau "torque between the flanges";
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
  equation
    phi_rel = flange_b.phi - flange_a.phi;
    flange_b.tau = tau;
    flange_a.tau = -tau;
  end PartialCompliant;

  partial model PartialCompliantWithRelativeStates "The same where the angle and its derivative are states"
    SI.Angle phi_rel(start = 0, stateSelect = stateSelect,
      nominal = if phi_nominal >= Modelica.Constants.eps then phi_nominal else 1)
      "angle of flange_b against flange_a";
    SI.AngularVelocity w_rel(start = 0, stateSelect = stateSelect) "its derivative";
    SI.AngularAcceleration a_rel(start = 0) "its second derivative";
    SI.Torque tau "torque between the flanges";
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
    parameter SI.Angle phi_nominal(displayUnit = "rad", min = 0.0) = 1e-4 "nominal angle";
    parameter StateSelect stateSelect = StateSelect.prefer "whether they are to be states";
  equation
    phi_rel = flange_b.phi - flange_a.phi;
    w_rel = der(phi_rel);
    a_rel = der(w_rel);
    flange_b.tau = tau;
    flange_a.tau = -tau;
  end PartialCompliantWithRelativeStates;

  partial model PartialElementaryOneFlangeAndSupport2 "A flange, and the angle of the housing"
    parameter Boolean useSupport = false "there is a flange of the housing";
    Flange_b flange "shaft";
    Support support(phi = phi_support, tau = -flange.tau) if useSupport "housing";
  protected
    SI.Angle phi_support "angle of the housing";
  equation
    if not useSupport then
      phi_support = 0;
    end if;
  end PartialElementaryOneFlangeAndSupport2;

  partial model PartialElementaryTwoFlangesAndSupport2 "Two flanges, and the angle of the housing"
    parameter Boolean useSupport = false "there is a flange of the housing";
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
    Support support(phi = phi_support, tau = -flange_a.tau - flange_b.tau) if useSupport "housing";
  protected
    SI.Angle phi_support "angle of the housing";
  equation
    if not useSupport then
      phi_support = 0;
    end if;
  end PartialElementaryTwoFlangesAndSupport2;

  partial model PartialTorque "A torque that acts on a flange against the housing"
    extends PartialElementaryOneFlangeAndSupport2;
    SI.Angle phi "angle of the flange against the housing";
  equation
    phi = flange.phi - phi_support;
  end PartialTorque;

  partial model PartialAbsoluteSensor "A sensor at one flange"
    extends Modelica.Icons.RoundSensor;
    Flange_a flange "flange";
  equation
    flange.tau = 0;
  end PartialAbsoluteSensor;

  partial model PartialRelativeSensor "A sensor between two flanges"
    extends Modelica.Icons.RoundSensor;
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
  equation
    flange_a.tau + flange_b.tau = 0;
  end PartialRelativeSensor;
end Interfaces;
