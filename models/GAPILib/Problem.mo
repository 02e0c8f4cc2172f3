within GAPILib;
record Problem "What to identify, from which data, and how: the argument of identify"
  String title = "" "Heading of the report";
  String modelName "Class, or class with a modification";
  String files[:] = fill("", 0) "Modelica files and folders to load";
  GAPILib.Free parameters[:] "Parameters to identify, to fix or to tie";
  GAPILib.Experiment experiments[:] "What was measured";
  String noiseStates[:] = fill("", 0) "States on which process noise acts: what is measured is compared with its prediction from all earlier samples";
  Real noiseValues[:] = fill(0.0, 0) "The standard deviations that it adds in 1 s; 0, or none, to estimate them";
  Real noiseInitial[:] = fill(0.0, 0) "Standard deviations of the initial values of these states; none for 0";
  Integer predictionSteps = 0 "With process noise: over how many samples outputs are predicted as well, 2 or more; 0 for one sample alone";
  String fitness[:] = {"sum_of_squares"} "Fitness functions; several for nsga2";
  String method = "" "Optimizer; empty for the default";
  String settings[:] = fill("", 0) "Names of settings of the optimizer";
  Real settingValues[:] = fill(0.0, 0) "Their values";
  Boolean polish = true "Whether least squares refine the result";
  Real seed[:] = fill(0.0, 0) "Six numbers, or none for the default";
  Integer generations = 0 "Stop after so many; 0 for no limit, as for all limits";
  Integer evaluations = 0 "Stop after so many individuals";
  Real seconds = 0 "Stop after so many seconds of work";
  Real target[:] = fill(0.0, 0) "Stop at this fitness, if one is given";
  Integer stagnation = 0 "Stop after so many generations without improvement";
  String sampling = "" "How the first generation is drawn; empty for the optimizer's own, as for all operators";
  String selection = "" "Who becomes a parent, such as \"tournament(size = 3)\"";
  String crossover = "" "How parents make children";
  String mutation = "" "How genes change at random";
  String survival = "" "Who makes up the next generation";
  annotation(Documentation(info = "<html>
<p>The same as the file of <code>gapi identify</code>, which <code>identify</code> takes, too, by
its name. Without any stop condition a run ends after 20,000 evaluations.</p>
</html>"));
end Problem;
