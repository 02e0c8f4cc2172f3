within GAPILib.Basics;
function Refine "Least squares: brings individuals to the next optimum by Levenberg and Marquardt's method"
  input String SimuPath "path of the model's file or package folder; empty when it is loaded already";
  input String SimuCaseStudyName "name of the model to simulate, with a modification if wanted";
  input Real Xexp[:] "array of experimental X data";
  input Real Yexp[size(Xexp, 1)] "array of experimental Y data";
  input Real Individuals[:,:] "where to begin, one individual in each row";
  input Real Param_Min[size(Individuals, 2)] "lower bound of every parameter";
  input Real Param_Max[size(Individuals, 2)] "upper bound of every parameter; a positive range wider than a decade is followed by its logarithm";
  input String Parameter_Names[:] = fill("", 0) "the identified parameters, one for each column; empty: the model's top-level tunable parameters in order of declaration";
  input String X_Name = "time" "the variable that Xexp holds values of";
  input String Y_Name = "" "the variable that was measured; empty: the model's only top-level output";
  output Real Refined[size(Individuals, 2)] "the best individual found";
  output Real Fit_Refined "its sum of squared differences";
  output Integer Simulations "how many it took";
  external "builtin" Refine(SimuPath, SimuCaseStudyName, Xexp, Yexp, Individuals, Param_Min, Param_Max, Parameter_Names, X_Name, Y_Name, Refined, Fit_Refined, Simulations);
  annotation(Documentation(info = "<html>
<p>Not a function of the paper. The genetic algorithm comes near an optimum and stays near it, since
its children differ from their parents by whole genes. From each row of <code>Individuals</code> the
sum of squared differences is followed downhill, within the bounds; the best end of all is returned.
All simulations of a call count as one generation of the run. A simulation that fails is a step that
is not taken.</p>
<p>This function needs the simulator, so it is built into the program.</p>
<p>Reference: J. Nocedal, S. J. Wright: Numerical Optimization. Springer, 2006, section 10.3.</p>
</html>"));
end Refine;
