function doubled
  input Real x[:];
  output Real y[size(x, 1)];
protected
  Integer n = size(x, 1);
  Real scratch[n, 2];
algorithm
  for i in 1:n loop
    scratch[i, 1] := x[i];
    scratch[i, 2] := x[i];
    y[i] := sum(scratch[i, :]);
  end for;
end doubled;
