within Modelica.Mechanics.Rotational;
package Sources "Given torques and motions"
  extends Modelica.Icons.SourcesPackage;

  model Torque "Torque that is an input"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2;
    Modelica.Blocks.Interfaces.RealInput tau(unit = "N.m") "torque that drives the flange";
  equation
    flange.tau = -tau;
  end Torque;

  model Torque2 "Torque between two flanges that is an input"
    extends Interfaces.PartialTwoFlanges;
    Modelica.Blocks.Interfaces.RealInput tau(unit = "N.m") "torque that drives flange_b against flange_a";
  equation
    flange_a.tau = tau;
    flange_b.tau = -tau;
  end Torque2;

  model ConstantTorque "Constant torque"
    extends Interfaces.PartialTorque;
    parameter SI.Torque tau_constant "torque that drives the flange";
    SI.AngularVelocity w "speed of the flange against the housing";
    SI.Torque tau "torque that drives the flange";
  equation
    w = der(phi);
    tau = -flange.tau;
    tau = tau_constant;
  end ConstantTorque;

  model TorqueStep "Step of torque"
    extends Interfaces.PartialTorque;
    parameter SI.Torque stepTorque(start = 1) "height of the step";
    parameter SI.Torque offsetTorque(start = 0) "torque before the step";
    parameter SI.Time startTime = 0 "time of the step";
    SI.Torque tau "torque that drives the flange";
  equation
    tau = -flange.tau;
    tau = offsetTorque + (if time < startTime then 0 else stepTorque);
  end TorqueStep;

  model LinearSpeedDependentTorque "Torque in proportion to the speed"
    extends Interfaces.PartialTorque;
    parameter SI.Torque tau_nominal "torque at the nominal speed; negative for a load";
    parameter Boolean TorqueDirection = true "the same direction of torque in both directions of rotation";
    parameter SI.AngularVelocity w_nominal(min = Modelica.Constants.eps) "nominal speed";
    SI.AngularVelocity w "speed of the flange against the housing";
    SI.Torque tau "torque that drives the flange";
  equation
    w = der(phi);
    tau = -flange.tau;
    tau = if TorqueDirection then tau_nominal*abs(w/w_nominal) else tau_nominal*(w/w_nominal);
  end LinearSpeedDependentTorque;

  model QuadraticSpeedDependentTorque "Torque in proportion to the square of the speed"
    extends Interfaces.PartialTorque;
    parameter SI.Torque tau_nominal "torque at the nominal speed; negative for a load";
    parameter Boolean TorqueDirection = true "the same direction of torque in both directions of rotation";
    parameter SI.AngularVelocity w_nominal(min = Modelica.Constants.eps) "nominal speed";
    SI.AngularVelocity w "speed of the flange against the housing";
    SI.Torque tau "torque that drives the flange";
  equation
    w = der(phi);
    tau = -flange.tau;
    tau = tau_nominal*(w/w_nominal)*(if TorqueDirection then w/w_nominal else abs(w/w_nominal));
  end QuadraticSpeedDependentTorque;

  model ConstantSpeed "Constant speed"
    extends Interfaces.PartialTorque;
    parameter SI.AngularVelocity w_fixed "speed";
    SI.AngularVelocity w "speed of the flange against the housing";
  equation
    w = der(phi);
    w = w_fixed;
  end ConstantSpeed;

  model Speed "Speed that is an input, filtered or exact"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2;
    parameter Boolean exact = false "the speed is the input, which has to be differentiable, else it is filtered";
    parameter SI.Frequency f_crit = 50 "cut-off frequency of the filter";
    SI.Angle phi(start = 0, fixed = true, stateSelect = StateSelect.prefer) "angle against the housing";
    SI.AngularVelocity w(stateSelect = if exact then StateSelect.default else StateSelect.prefer) "its derivative";
    SI.AngularAcceleration a "its second derivative";
    Modelica.Blocks.Interfaces.RealInput w_ref(unit = "rad/s") "speed to be reached";
  initial equation
    if not exact then
      w = w_ref;
    end if;
  equation
    phi = flange.phi - phi_support;
    w = der(phi);
    if exact then
      w = w_ref;
      a = 0;
    else
      a = der(w);
      a = 2*Modelica.Constants.pi*f_crit*(w_ref - w);
    end if;
  end Speed;

  model Accelerate "Acceleration that is an input"
    extends Interfaces.PartialElementaryOneFlangeAndSupport2;
    SI.Angle phi(start = 0, fixed = true, stateSelect = StateSelect.prefer) "angle against the housing";
    SI.AngularVelocity w(start = 0, fixed = true, stateSelect = StateSelect.prefer) "its derivative";
    SI.AngularAcceleration a "its second derivative";
    Modelica.Blocks.Interfaces.RealInput a_ref(unit = "rad/s2") "acceleration";
  equation
    phi = flange.phi - phi_support;
    w = der(phi);
    a = der(w);
    a = a_ref;
  end Accelerate;
end Sources;
