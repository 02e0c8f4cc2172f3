package P
  partial package PartialMedium
    replaceable record State
    end State;
    replaceable model BaseProperties
      State state;
    end BaseProperties;
  end PartialMedium;
  package Water
    extends PartialMedium;
    redeclare record extends State
      Real p;
      Real T;
    end State;
  end Water;
  model M
    replaceable package Medium = Water;
    Medium.BaseProperties medium;
    Real p = medium.state.p;
    annotation(Icon(graphics = {Line(smooth = Smooth.Bezier)}));
  end M;
end P;
