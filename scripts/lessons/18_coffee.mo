model Coffee "a cup of coffee that cools; the time is in minutes"
  parameter Real k = 0.1 "how fast it cools, per minute";
  parameter Real T_room = 20 "temperature of the room in degC";
  output Real T(start = 90, fixed = true) "temperature of the coffee in degC";
equation
  der(T) = 0;  // <- complete this equation
  annotation(experiment(StopTime = 60));
end Coffee;
