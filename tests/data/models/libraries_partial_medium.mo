partial package PartialMedium
    replaceable partial function density
      input Real T;
      output Real d;
    end density;
    replaceable partial model BaseProperties
      Real d;
    end BaseProperties;
  end PartialMedium;
  partial model PartialLaw
    Real y;
  end PartialLaw;
  package Water
    extends PartialMedium;
    redeclare function extends density
    algorithm
      d := 1000 - T;
    end density;
  end Water;
