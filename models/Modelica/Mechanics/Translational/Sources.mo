within Modelica.Mechanics.Translational;
package Sources "Given forces and motions"
  extends Modelica.Icons.SourcesPackage;

  model Force "Force that is an input"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2;
    Modelica.Blocks.Interfaces.RealInput f(unit = "N") "force that drives the flange";
  equation
    flange.f = -f;
  end Force;

  model ConstantForce "Constant force"
    extends Interfaces.PartialForce;
    parameter SI.Force f_constant "force that drives the flange";
  equation
    f = -f_constant;
  end ConstantForce;

  model ForceStep "Step of force"
    extends Interfaces.PartialForce;
    parameter SI.Force stepForce(start = 1) "height of the step";
    parameter SI.Force offsetForce(start = 0) "force before the step";
    parameter SI.Time startTime = 0 "time of the step";
  equation
    f = -offsetForce - (if time < startTime then 0 else stepForce);
  end ForceStep;

  model Speed "Velocity that is an input, filtered or exact"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2(
      s(start = 0, fixed = true, stateSelect = StateSelect.prefer));
    parameter Boolean exact = false "the velocity is the input, else the input is filtered";
    parameter SI.Frequency f_crit = 50 "cut-off frequency of the filter";
    SI.Velocity v(stateSelect = if exact then StateSelect.default else StateSelect.prefer) "velocity";
    SI.Acceleration a "its derivative; zero where the velocity is exact";
    Modelica.Blocks.Interfaces.RealInput v_ref(unit = "m/s") "velocity to be reached";
  initial equation
    if not exact then
      v = v_ref;
    end if;
  equation
    v = der(s);
    if exact then
      v = v_ref;
      a = 0;
    else
      a = der(v);
      a = 2*Modelica.Constants.pi*f_crit*(v_ref - v);
    end if;
  end Speed;

  model Accelerate "Acceleration that is an input"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2(
      s(start = 0, fixed = true, stateSelect = StateSelect.prefer));
    SI.Velocity v(start = 0, fixed = true, stateSelect = StateSelect.prefer) "velocity";
    SI.Acceleration a "acceleration";
    Modelica.Blocks.Interfaces.RealInput a_ref(unit = "m/s2") "acceleration";
  equation
    v = der(s);
    a = der(v);
    a = a_ref;
  end Accelerate;
end Sources;
