within CaseStudies.Currents;
model Reaction "Reaction and double layer of a part of a layer, at a constant pressure of oxygen"
  Charge charge(delta(start = Eoc, fixed = true)) "what flows in";
  outer parameter Units.Length h;
  outer parameter Units.CurrentDensity Aioref;
  outer parameter Units.TafelSlope B;
  outer parameter Units.CurrentDensity jlim;
  outer parameter Units.CapacitanceDensity cdl;
  outer parameter Units.Potential Eoc;
  Units.CurrentDensity i "current of the reaction";
protected
  constant Units.Length dref = 1e-6 "thickness of layer that Aioref, jlim and cdl belong to";
  Units.CurrentDensity K "current without a limit";
equation
  K = Aioref*h/dref*(exp((Eoc - charge.delta)/B) - 1);
  i = K/(1 + K/(jlim*h/dref));
  charge.ion = i - cdl*h/dref*der(charge.delta);
  charge.total = 0;
  annotation(Documentation(info = "<html>
<p>The kinetics of <a href=\"modelica://FuelCellLib.Basics.vc_act\">FuelCellLib.Basics.vc_act</a> at the
pressure that Aioref belongs to.</p>
</html>"));
end Reaction;
