within Modelica.Blocks;
package Continuous "Linear systems in continuous time"
  extends Modelica.Icons.Package;
  import Modelica.Blocks.Interfaces;
  import Modelica.Blocks.Types.Init;

  block Integrator "Integral of the input, with reset"
    parameter Real k = 1 "factor";
    parameter Boolean use_reset = false "there is an input that resets";
    parameter Boolean use_set = false "there is an input with the output after a reset";
    parameter Init initType = Init.InitialState "how it starts";
    parameter Real y_start = 0 "output at the start, and after a reset";
    extends Interfaces.SISO;
    Interfaces.BooleanInput reset if use_reset "resets where it becomes true";
    Interfaces.RealInput set if use_reset and use_set "output after a reset";
  protected
    Interfaces.BooleanOutput local_reset "reset, false without";
    Interfaces.RealOutput local_set "output after a reset";
  initial equation
    if initType == Init.SteadyState then
      der(y) = 0;
    elseif initType == Init.InitialState or initType == Init.InitialOutput then
      y = y_start;
    end if;
  equation
    der(y) = k*u;
    if use_reset then
      connect(reset, local_reset);
      if use_set then
        connect(set, local_set);
      else
        local_set = y_start;
      end if;
      when local_reset then
        reinit(y, local_set);
      end when;
    else
      local_reset = false;
      local_set = 0;
    end if;
  end Integrator;

  block LimIntegrator "Integral of the input between limits, with reset"
    parameter Real k = 1 "factor";
    parameter Real outMax(start = 1) "upper limit";
    parameter Real outMin = -outMax "lower limit";
    parameter Boolean use_reset = false "there is an input that resets";
    parameter Boolean use_set = false "there is an input with the output after a reset";
    parameter Init initType = Init.InitialState "how it starts";
    parameter Boolean limitsAtInit = true "the limits hold while it is initialised";
    parameter Real y_start = 0 "output at the start, and after a reset";
    parameter Boolean strict = false "reaching a limit is no event";
    extends Interfaces.SISO;
    Interfaces.BooleanInput reset if use_reset "resets where it becomes true";
    Interfaces.RealInput set if use_reset and use_set "output after a reset";
  protected
    Interfaces.BooleanOutput local_reset "reset, false without";
    Interfaces.RealOutput local_set "output after a reset";
  initial equation
    if initType == Init.SteadyState then
      der(y) = 0;
    elseif initType == Init.InitialState or initType == Init.InitialOutput then
      y = y_start;
    end if;
  equation
    if initial() and not limitsAtInit then
      der(y) = k*u;
    elseif strict then
      der(y) = noEvent(if y <= outMin and k*u < 0 or y >= outMax and k*u > 0 then 0 else k*u);
    else
      der(y) = if y <= outMin and k*u < 0 or y >= outMax and k*u > 0 then 0 else k*u;
    end if;
    if use_reset then
      connect(reset, local_reset);
      if use_set then
        connect(set, local_set);
      else
        local_set = y_start;
      end if;
      when local_reset then
        reinit(y, max(outMin, min(outMax, local_set)));
      end when;
    else
      local_reset = false;
      local_set = 0;
    end if;
  end LimIntegrator;

  block Derivative "Derivative of the input behind a first order filter: k s/(T s + 1)"
    parameter Real k = 1 "factor";
    parameter SI.Time T(min = Modelica.Constants.small) = 0.01 "time constant of the filter";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real x_start = 0 "state at the start";
    parameter Real y_start = 0 "output at the start";
    extends Interfaces.SISO;
    output Real x(start = x_start) "state: the filtered input";
  protected
    parameter Boolean zeroGain = abs(k) < Modelica.Constants.eps "there is nothing to differentiate";
  initial equation
    if initType == Init.SteadyState then
      der(x) = 0;
    elseif initType == Init.InitialState then
      x = x_start;
    elseif initType == Init.InitialOutput then
      if zeroGain then
        x = u;
      else
        y = y_start;
      end if;
    end if;
  equation
    T*der(x) = if zeroGain then 0 else u - x;
    y = if zeroGain then 0 else k*(u - x)/T;
  end Derivative;

  block FirstOrder "k/(T s + 1)"
    parameter Real k = 1 "factor";
    parameter SI.Time T(start = 1) "time constant";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real y_start = 0 "output at the start";
    extends Interfaces.SISO(y(start = y_start));
  initial equation
    if initType == Init.SteadyState then
      der(y) = 0;
    elseif initType == Init.InitialState or initType == Init.InitialOutput then
      y = y_start;
    end if;
  equation
    T*der(y) + y = k*u;
  end FirstOrder;

  block SecondOrder "k/((s/w)^2 + 2 D s/w + 1)"
    parameter Real k = 1 "factor";
    parameter Real w(start = 1) "angular frequency without damping";
    parameter Real D(start = 1) "damping ratio";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real y_start = 0 "output at the start";
    parameter Real yd_start = 0 "its derivative";
    extends Interfaces.SISO(y(start = y_start));
    output Real yd(start = yd_start) "derivative of the output";
  initial equation
    if initType == Init.SteadyState then
      der(y) = 0;
      der(yd) = 0;
    elseif initType == Init.InitialState or initType == Init.InitialOutput then
      y = y_start;
      yd = yd_start;
    end if;
  equation
    der(y) = yd;
    der(yd) = w*w*(k*u - y) - 2*D*w*yd;
  end SecondOrder;

  block PI "k (1 + 1/(T s))"
    parameter Real k = 1 "factor";
    parameter SI.Time T(start = 1, min = Modelica.Constants.small) "time constant";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real x_start = 0 "state at the start";
    parameter Real y_start = 0 "output at the start";
    extends Interfaces.SISO;
    output Real x(start = x_start) "state: the integral part";
  initial equation
    if initType == Init.SteadyState then
      der(x) = 0;
    elseif initType == Init.InitialState then
      x = x_start;
    elseif initType == Init.InitialOutput then
      y = y_start;
    end if;
  equation
    T*der(x) = u;
    y = k*(u + x);
  end PI;

  block TransferFunction "b(s)/a(s)"
    extends Interfaces.SISO;
    parameter Real b[:] = {1} "coefficients of the numerator, highest power first";
    parameter Real a[:] = {1} "coefficients of the denominator, highest power first";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real x_start[size(a, 1) - 1] = zeros(nx) "states at the start";
    parameter Real y_start = 0 "output at the start; the derivatives are zero then";
    output Real x[size(a, 1) - 1](start = x_start) "states, controller canonical form";
  protected
    parameter Integer nx = size(a, 1) - 1 "number of states";
    parameter Real n[nx + 1] = cat(1, zeros(nx + 1 - size(b, 1)), b) "numerator with leading zeros";
    parameter Real d = n[1]/a[1] "direct share of the input";
  initial equation
    if initType == Init.SteadyState then
      der(x) = zeros(nx);
    elseif initType == Init.InitialState then
      x = x_start;
    elseif initType == Init.InitialOutput and nx > 0 then
      y = y_start;
      der(x[2:nx]) = zeros(nx - 1);
    end if;
  equation
    assert(size(b, 1) <= size(a, 1), "the numerator has a higher power than the denominator");
    if nx > 0 then
      a[1]*der(x[1]) = u - a[2:nx + 1]*x;
      der(x[2:nx]) = x[1:nx - 1];
      y = d*u + (n[2:nx + 1] - d*a[2:nx + 1])*x;
    else
      y = d*u;
    end if;
  end TransferFunction;

  block StateSpace "der(x) = A x + B u, y = C x + D u"
    parameter Real A[:, size(A, 1)] = [1, 0; 0, 1] "states to derivatives";
    parameter Real B[size(A, 1), :] = [1; 1] "inputs to derivatives";
    parameter Real C[:, size(A, 1)] = [1, 1] "states to outputs";
    parameter Real D[size(C, 1), size(B, 2)] = zeros(size(C, 1), size(B, 2)) "inputs to outputs";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real x_start[nx] = zeros(nx) "states at the start";
    parameter Real y_start[ny] = zeros(ny) "outputs at the start";
    extends Interfaces.MIMO(final nin = size(B, 2), final nout = size(C, 1));
    output Real x[size(A, 1)](start = x_start) "states";
  protected
    parameter Integer nx = size(A, 1) "number of states";
    parameter Integer ny = size(C, 1) "number of outputs";
  initial equation
    if initType == Init.SteadyState then
      der(x) = zeros(nx);
    elseif initType == Init.InitialState then
      x = x_start;
    elseif initType == Init.InitialOutput then
      y = y_start;
    end if;
  equation
    der(x) = A*x + B*u;
    y = C*x + D*u;
  end StateSpace;

  block Der "Derivative of the input"
    extends Interfaces.SISO;
  equation
    y = der(u);
  end Der;

  block CriticalDamping "Equal first order filters in a row"
    extends Interfaces.SISO;
    parameter Integer n = 2 "number of filters";
    parameter SI.Frequency f(start = 1) "cut-off frequency";
    parameter Boolean normalized = true "the amplitude is 1/sqrt(2) at the cut-off frequency";
    parameter Init initType = Init.NoInit "how it starts";
    parameter Real x_start[n] = zeros(n) "states at the start";
    parameter Real y_start = 0.0 "output at the start; the derivatives are zero then";
    output Real x[n](start = x_start) "outputs of the filters";
  protected
    parameter Real alpha = if normalized then sqrt(2^(1/n) - 1) else 1.0 "correction of the frequency";
    parameter Real w = 2*Modelica.Constants.pi*f/alpha "angular frequency of one filter";
  initial equation
    if initType == Init.SteadyState then
      der(x) = zeros(n);
    elseif initType == Init.InitialState then
      x = x_start;
    elseif initType == Init.InitialOutput then
      y = y_start;
      der(x[1:n - 1]) = zeros(n - 1);
    end if;
  equation
    der(x) = w*(cat(1, {u}, x[1:n - 1]) - x);
    y = x[n];
  end CriticalDamping;
end Continuous;
