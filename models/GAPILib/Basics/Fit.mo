within GAPILib.Basics;
function Fit "Fitness: sum of the squared differences between experiment and simulation"
  input Real DATASim_Int[:,:] "interpolated values, one individual in each row";
  input Real Yexp[size(DATASim_Int, 2)] "array of experimental Y data";
  output Real Eval_Mod[size(DATASim_Int, 1)] "sum of squared differences; 1e60 for a failed simulation";
protected
  Real sum_of_squares;
algorithm
  for k in 1:size(DATASim_Int, 1) loop
    sum_of_squares := 0;
    for j in 1:size(Yexp, 1) loop
      sum_of_squares := sum_of_squares + (Yexp[j] - DATASim_Int[k,j])^2;
    end for;
    // Only a number is below 1e60; NaN, the mark of a failed simulation, is not.
    Eval_Mod[k] := if sum_of_squares < 1e60 then sum_of_squares else 1e60;
  end for;
  annotation(Documentation(info = "<html>
<pre>
Fit = sum((Y(j) - Ysim(j))^2)
</pre>
<p>Smaller is better. A failed simulation, whose row holds NaN, has the fitness 1e60 [D].</p>
<p>Reference: Rubio et al. 2006, equation (1).</p>
</html>"));
end Fit;
