within Modelica.Mechanics.Translational;
package Interfaces "Flanges, and components by their flanges"
  extends Modelica.Icons.InterfacesPackage;

  connector Flange "End of a rod"
    SI.Position s "absolute position";
    flow SI.Force f "force on the component";
  end Flange;

  connector Flange_a "End of a rod, first of two"
    extends Flange;
  end Flange_a;

  connector Flange_b "End of a rod, second of two"
    extends Flange;
  end Flange_b;

  connector Support "Housing of a rod"
    extends Flange;
  end Support;

  model InternalSupport "Housing inside of a component"
    input SI.Force f "force on the housing";
    SI.Position s "position of the housing";
    Flange_a flange "to be connected to the housing";
  equation
    flange.f = f;
    flange.s = s;
  end InternalSupport;

  partial model PartialTwoFlanges "Two flanges"
    Flange_a flange_a "first flange";
    Flange_b flange_b "second flange";
  end PartialTwoFlanges;

  partial model PartialRigid "Two flanges at the ends of a rigid body"
    SI.Position s "position of the middle";
    parameter SI.Length L(start = 0) "distance from flange_a to flange_b";
    extends PartialTwoFlanges;
  equation
    flange_a.s = s - L/2;
    flange_b.s = s + L/2;
  end PartialRigid;

  partial model PartialCompliant "A force between two flanges that depends on their distance"
    extends PartialTwoFlanges;
    SI.Position s_rel(start = 0) "distance from flange_a to flange_b";
    SI.Force f "force between the flanges";
  equation
    s_rel = flange_b.s - flange_a.s;
    flange_b.f = f;
    flange_a.f = -f;
  end PartialCompliant;

  partial model PartialCompliantWithRelativeStates "The same where the distance and its derivative are states"
    parameter StateSelect stateSelect = StateSelect.prefer "whether they are to be states";
    parameter SI.Distance s_nominal = 1e-4 "nominal distance";
    SI.Position s_rel(start = 0, stateSelect = stateSelect, nominal = s_nominal) "distance from flange_a to flange_b";
    SI.Velocity v_rel(start = 0, stateSelect = stateSelect) "its derivative";
    SI.Force f "force between the flanges";
    extends PartialTwoFlanges;
  equation
    s_rel = flange_b.s - flange_a.s;
    v_rel = der(s_rel);
    flange_b.f = f;
    flange_a.f = -f;
  end PartialCompliantWithRelativeStates;

  partial model PartialElementaryOneFlangeAndSupport2 "A flange, and the position of the housing"
    parameter Boolean useSupport = false "there is a flange of the housing";
    SI.Length s "position of the flange against the housing";
    Flange_b flange "rod";
    Support support(s = s_support, f = -flange.f) if useSupport "housing";
  protected
    SI.Length s_support "position of the housing";
  equation
    s = flange.s - s_support;
    if not useSupport then
      s_support = 0;
    end if;
  end PartialElementaryOneFlangeAndSupport2;

  partial model PartialForce "A force that acts on a flange against the housing"
    extends PartialElementaryOneFlangeAndSupport2;
    SI.Force f "force on the component, the same as flange.f";
  equation
    f = flange.f;
  end PartialForce;

  partial model PartialAbsoluteSensor "A sensor at one flange"
    extends Modelica.Icons.RectangularSensor;
    Flange_a flange "flange";
  equation
    flange.f = 0;
  end PartialAbsoluteSensor;

  partial model PartialRelativeSensor "A sensor between two flanges"
    extends Modelica.Icons.RectangularSensor;
    extends PartialTwoFlanges;
  equation
    flange_a.f + flange_b.f = 0;
  end PartialRelativeSensor;
end Interfaces;
