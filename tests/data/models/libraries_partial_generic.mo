model Sensor
    replaceable package Medium = PartialMedium;
    RealInput T;
    RealOutput d = Medium.density(T);
  end Sensor;
  model Volume
    extends Sensor;
    Medium.BaseProperties properties;
  end Volume;
  model Fitting
    replaceable PartialLaw law;
  end Fitting;
  model Complete
    Sensor sensor(redeclare package Medium = Water, T = 1);
  end Complete;
