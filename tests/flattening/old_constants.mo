// The same constants and parameters in every class: those that a class inherits and declares once
// more in the same words are one (MLS §7.1), those of components stay apart.
package old_constants
  partial model Conduct
    constant Real R = 8.30824;
    parameter Real T = 298;
    Real D;
  end Conduct;
  partial model Store
    constant Real R = 8.30824;
    parameter Real T = 298;
    Real c;
  equation
    c = 1/(R*T);
  end Store;
  model Volume
    extends Conduct;
    extends Store;
    constant Real R = 8.30824;
    parameter Real T = 298;
  equation
    D = R*T;
  end Volume;
  model Main
    constant Real R = 8.30824;
    parameter Real T = 340;
    Volume first(T = T), second;
    Real sum = first.D + second.D + R;
  end Main;
end old_constants;
