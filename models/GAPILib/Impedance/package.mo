within GAPILib;
package Impedance "Elements of equivalent circuits whose impedance is no rational function of the frequency"
  annotation(Documentation(info = "<html>
<p>Elements with the current as input and the voltage as output. Each is a sum of relaxations with time constants
that are evenly spaced by their logarithm, so that the same model simulates in time and has a spectrum;
its documentation says how far the sum is from the formula.</p>
</html>"));
end Impedance;
