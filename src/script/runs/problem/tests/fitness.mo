function distance
  input Real simulated[:];
  input Real measured[:];
  output Real largest = max(abs(simulated - measured));
end distance;
function squares
  input Real simulated[:];
  input Real measured[:];
  input Real weights[:];
  output Real sum;
algorithm
  sum := 0;
  for k in 1:size(simulated, 1) loop
    sum := sum + (weights[k]*(simulated[k] - measured[k]))^2;
  end for;
end squares;
function undecided
  input Real x;
  output Real y = x;
end undecided;
