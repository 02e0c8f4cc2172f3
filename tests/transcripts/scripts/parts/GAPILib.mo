package GAPILib
  package Basics
    function Fit "The sum of absolute differences"
      input Real D[:, :];
      input Real Y[size(D, 2)];
      output Real f[size(D, 1)];
    algorithm
      for i in 1:size(D, 1) loop
        f[i] := sum(abs(D[i, k] - Y[k]) for k in 1:size(Y, 1));
      end for;
    end Fit;
  end Basics;
end GAPILib;
