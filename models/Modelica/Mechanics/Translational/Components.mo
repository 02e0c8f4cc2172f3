within Modelica.Mechanics.Translational;
package Components "Masses, springs and dampers"
  extends Modelica.Icons.Package;

  model Fixed "Housing that stands"
    parameter SI.Position s0 = 0 "position";
    Interfaces.Flange_b flange "flange";
  equation
    flange.s = s0;
  end Fixed;

  model Mass "Rigid body with mass"
    parameter SI.Mass m(min = 0, start = 1) "mass";
    parameter StateSelect stateSelect = StateSelect.default "whether position and velocity are to be states";
    extends Interfaces.PartialRigid(L = 0, s(start = 0, stateSelect = stateSelect));
    SI.Velocity v(start = 0, stateSelect = stateSelect) "velocity";
    SI.Acceleration a(start = 0) "acceleration";
  equation
    v = der(s);
    a = der(v);
    m*a = flange_a.f + flange_b.f;
  end Mass;

  model Rod "Rigid body without mass"
    extends Interfaces.PartialRigid;
  equation
    flange_a.f + flange_b.f = 0;
  end Rod;

  model Spring "Linear spring"
    extends Interfaces.PartialCompliant;
    parameter SI.TranslationalSpringConstant c(final min = 0, start = 1) "spring constant";
    parameter SI.Distance s_rel0 = 0 "length without force";
  equation
    f = c*(s_rel - s_rel0);
  end Spring;

  model Damper "Linear damper"
    extends Interfaces.PartialCompliantWithRelativeStates;
    parameter SI.TranslationalDampingConstant d(final min = 0, start = 0) "damping constant";
    extends Modelica.Thermal.HeatTransfer.Interfaces.PartialElementaryConditionalHeatPortWithoutT;
  equation
    f = d*v_rel;
    lossPower = f*v_rel;
  end Damper;

  model SpringDamper "Linear spring and damper side by side"
    extends Interfaces.PartialCompliantWithRelativeStates;
    parameter SI.TranslationalSpringConstant c(final min = 0, start = 1) "spring constant";
    parameter SI.TranslationalDampingConstant d(final min = 0, start = 1) "damping constant";
    parameter SI.Position s_rel0 = 0 "length without force of the spring";
    extends Modelica.Thermal.HeatTransfer.Interfaces.PartialElementaryConditionalHeatPortWithoutT;
  protected
    SI.Force f_c "force of the spring";
    SI.Force f_d "force of the damper";
  equation
    f_c = c*(s_rel - s_rel0);
    f_d = d*v_rel;
    f = f_c + f_d;
    lossPower = f_d*v_rel;
  end SpringDamper;
end Components;
