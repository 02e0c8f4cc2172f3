within GAPILib.Basics;
function Exp_Adq_SISO "Reads the measured data of one input and one output from a MAT file"
  input String namefile "name of the .mat file where the experimental data is stored";
  input String Xmatrixname "name of the matrix of X values";
  input String Ymatrixname "name of the matrix of Y values";
  output Boolean State_Exp_Adq "true when both matrices were read and their sizes agree";
  output Integer SizeMatrix[2] "numbers of elements of the X and of the Y matrix";
  output Real Xexp[:] "array of experimental X data";
  output Real Yexp[:] "array of experimental Y data";
  external "builtin" Exp_Adq_SISO(namefile, Xmatrixname, Ymatrixname, State_Exp_Adq, SizeMatrix, Xexp, Yexp);
  annotation(Documentation(info = "<html>
<p>Reads two matrices and gives their elements as vectors, row by row; usually each is one row or one
column. The file is looked for beside the script that calls the function, then beside the scripts
that called that one, then in the working directory [D].</p>
<p>A missing file, a missing matrix, sizes that differ and values that are no finite numbers are
reported; <code>State_Exp_Adq</code> is then <code>false</code> and both vectors are empty [D].</p>
<p>This function reads a file, so it is built into the program.</p>
<p>Reference: Rubio et al. 2006, Table 2.</p>
</html>"));
end Exp_Adq_SISO;
