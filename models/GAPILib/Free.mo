within GAPILib;
record Free "A parameter of a problem: free within a range, or fixed, or tied to others"
  String name "Parameter of the model, or state whose initial value is meant";
  Real min = 0 "Smallest value";
  Real max = 0 "Largest value, above min for a free parameter";
  String scale = "" "linear or log; empty: log where a positive range is wider than a decade";
  Real start[:] = fill(0.0, 0) "A value to begin with, if one is known";
  Real fixed[:] = fill(0.0, 0) "The value, if it is not to be identified";
  String tied = "" "An expression of other parameters, such as 2*A";
  String unit = "" "Unit; empty for that of the model";
  Boolean initialValue = false "Whether the initial value of the state is meant";
  Boolean perExperiment = false "Whether every experiment has its own";
  String prior = "" "What is known of it without the data, such as \"normal(mean = 1, sd = 0.1)\", \"laplace(median = 1, scale = 0.1)\" or \"uniform\"";
end Free;
