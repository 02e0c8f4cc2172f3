within Modelica.Mechanics.Rotational;
package Components "Inertias, springs, dampers and gears"
  extends Modelica.Icons.Package;

  model Fixed "Housing that stands"
    parameter SI.Angle phi0 = 0 "angle";
    Interfaces.Flange_b flange "flange";
  equation
    flange.phi = phi0;
  end Fixed;

  model Inertia "Rigid shaft with inertia"
    extends Interfaces.PartialTwoFlanges;
    parameter SI.Inertia J(min = 0, start = 1) "moment of inertia";
    parameter StateSelect stateSelect = StateSelect.default "whether angle and speed are to be states";
    SI.Angle phi(stateSelect = stateSelect) "angle";
    SI.AngularVelocity w(stateSelect = stateSelect) "speed";
    SI.AngularAcceleration a "acceleration";
  equation
    phi = flange_a.phi;
    phi = flange_b.phi;
    w = der(phi);
    a = der(w);
    J*a = flange_a.tau + flange_b.tau;
  end Inertia;

  model Disc "Rigid shaft without inertia, with an angle between its ends"
    extends Interfaces.PartialTwoFlanges;
    parameter SI.Angle deltaPhi = 0 "angle of flange_b against flange_a";
    SI.Angle phi "angle of the middle";
  equation
    flange_a.phi = phi - deltaPhi/2;
    flange_b.phi = phi + deltaPhi/2;
    flange_a.tau + flange_b.tau = 0;
  end Disc;

  model Spring "Linear spring"
    extends Interfaces.PartialCompliant;
    parameter SI.RotationalSpringConstant c(final min = 0, start = 1.0e5) "spring constant";
    parameter SI.Angle phi_rel0 = 0 "angle without torque";
  equation
    tau = c*(phi_rel - phi_rel0);
  end Spring;

  model Damper "Linear damper"
    extends Interfaces.PartialCompliantWithRelativeStates;
    parameter SI.RotationalDampingConstant d(final min = 0, start = 0) "damping constant";
    extends Modelica.Thermal.HeatTransfer.Interfaces.PartialElementaryConditionalHeatPortWithoutT;
  equation
    tau = d*w_rel;
    lossPower = tau*w_rel;
  end Damper;

  model SpringDamper "Linear spring and damper side by side"
    parameter SI.RotationalSpringConstant c(final min = 0, start = 1.0e5) "spring constant";
    parameter SI.RotationalDampingConstant d(final min = 0, start = 0) "damping constant";
    parameter SI.Angle phi_rel0 = 0 "angle without torque of the spring";
    extends Interfaces.PartialCompliantWithRelativeStates;
    extends Modelica.Thermal.HeatTransfer.Interfaces.PartialElementaryConditionalHeatPortWithoutT;
  protected
    SI.Torque tau_c "torque of the spring";
    SI.Torque tau_d "torque of the damper";
  equation
    tau_c = c*(phi_rel - phi_rel0);
    tau_d = d*w_rel;
    tau = tau_c + tau_d;
    lossPower = tau_d*w_rel;
  end SpringDamper;

  model IdealGear "Gear without losses and inertia"
    extends Interfaces.PartialElementaryTwoFlangesAndSupport2;
    parameter Real ratio(start = 1) "angle of flange_a over that of flange_b";
    SI.Angle phi_a "angle of flange_a against the housing";
    SI.Angle phi_b "angle of flange_b against the housing";
  equation
    phi_a = flange_a.phi - phi_support;
    phi_b = flange_b.phi - phi_support;
    phi_a = ratio*phi_b;
    ratio*flange_a.tau + flange_b.tau = 0;
  end IdealGear;

  model ElastoBacklash "Spring and damper behind a backlash"
    parameter SI.RotationalSpringConstant c(final min = Modelica.Constants.small, start = 1.0e5) "spring constant";
    parameter SI.RotationalDampingConstant d(final min = 0, start = 0) "damping constant";
    parameter SI.Angle b(final min = 0) = 0 "whole backlash";
    parameter SI.Angle phi_rel0 = 0 "angle in the middle of the backlash";
    extends Interfaces.PartialCompliantWithRelativeStates;
    extends Modelica.Thermal.HeatTransfer.Interfaces.PartialElementaryConditionalHeatPortWithoutT;
  protected
    SI.Angle x = phi_rel - phi_rel0 "angle from the middle of the backlash";
    SI.Torque tau_c "torque of the spring";
    SI.Torque pressed "torque of spring and damper, where the flanges touch";
  equation
    tau_c = c*(if x > b/2 then x - b/2 elseif x < -b/2 then x + b/2 else 0);
    pressed = tau_c + d*w_rel;
    // The flanges push but never pull: the damper only lessens the torque of the spring.
    tau = if x > b/2 then noEvent(max(0, pressed)) elseif x < -b/2 then noEvent(min(0, pressed)) else 0;
    lossPower = (tau - tau_c)*w_rel;
  end ElastoBacklash;
end Components;
