within GAPILib.Basics;
function Eval "Simulates the model with the genes of every individual"
  input String SimuPath "path of the model's file or package folder; empty when it is loaded already";
  input String SimuCaseStudyName "name of the model to simulate, with a modification if wanted";
  input Real Xexp[:] "array of experimental X data";
  input Real New_Generation[:,:] "complete set of population values";
  // added
  input String Parameter_Names[:] = fill("", 0) "the identified parameters, one for each column; empty: the model's top-level tunable parameters in order of declaration";
  input String X_Name = "time" "the variable that Xexp holds values of";
  input String Y_Name = "" "the variable that was measured; empty: the model's only top-level output";
  output Real DATASim_Int[size(New_Generation, 1), size(Xexp, 1)] "Y_Name interpolated at Xexp, one individual in each row; NaN where the simulation failed";
  output String Messages[size(New_Generation, 1)] "empty where the simulation succeeded";
  external "builtin" Eval(SimuPath, SimuCaseStudyName, Xexp, New_Generation, Parameter_Names, X_Name, Y_Name, DATASim_Int, Messages);
  annotation(Documentation(info = "<html>
<p>Every individual is simulated with its genes as values of the parameters, from the start time to
the stop time of the model's <code>experiment</code> annotation, and <code>Y_Name</code> is
interpolated linearly at <code>Xexp</code>. <code>X_Name</code> need not be time: a slow ramp of the
current gives a polarization curve [D]. Where X depends on time alone, the outputs are computed
exactly at the measured points, and the simulation ends at the last of them. A measured point that
the simulation does not reach is an error that names it.</p>
<p>An individual whose simulation fails (an assertion, a logarithm of a negative number, no
convergence) does not end the run: its row is NaN and its message says why [D].</p>
<p>All individuals are simulated in parallel. This function needs the simulator, so it is built into
the program.</p>
<p>Reference: Rubio et al. 2006, section 3.2 and Table 2.</p>
</html>"));
end Eval;
