within CaseStudies;
package Currents "Protons and electrons in a layer with a double layer"
  import Units = FuelCellLib.Units;

  connector Charge "Protons and electrons"
    Units.Potential ve "potential of the protons";
    Units.Potential delta(start = 1) "potential of the electrons over that of the protons";
    flow Units.CurrentDensity ion "current of the protons";
    flow Units.CurrentDensity total "current of both";
    annotation(Documentation(info = "<html>
<p>Voltage and total current in place of the electrons' own: no control volume takes up total current,
so it is one variable for the whole layer, and the voltage is what the double layers store. The
potentials then follow one by one, without a system of equations.</p>
</html>"));
  end Charge;

  annotation(Documentation(info = "<html>
<p>Currents are conventional and positive into a component.</p>
</html>"));
end Currents;
