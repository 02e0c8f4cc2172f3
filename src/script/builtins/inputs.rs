//! Headers of commands, and lines that several have in common.

/// The header of a function with these lines.
macro_rules! header {
    ($name:literal, $description:literal, $($lines:tt)+) => {
        concat!("function ", $name, " \"", $description, "\"\n", $($lines)+, "end ", $name, ";\n")
    };
}

/// What `simulateModel` and its relatives are asked for.
macro_rules! simulation {
    () => {
        r#"  input String problem = "" "Class or Class(modification); empty: the model used last";
  input Real startTime = 0.0 "s" annotation(optional = true);
  input Real stopTime = 1.0 "s" annotation(optional = true);
  input Integer numberOfIntervals = 500 annotation(optional = true);
  input Real outputInterval = 0.0 "s; used if numberOfIntervals is 0 or not given" annotation(optional = true);
  input String method = "Dassl" annotation(optional = true);
  input Real tolerance = 0.0001 "relative" annotation(optional = true);
  input Real fixedstepsize = 0.0 "s, for methods with a fixed step" annotation(optional = true);
  input String resultFile = "dsres" ".mat is added if the name has no extension";
"#
    };
}

/// What its relatives set.
macro_rules! initial_names {
    () => {
        r#"  input String initialNames[:] = fill("", 0) "parameters, and states or variables with a start value; linearize: for the number of a file dslin<number>.mat";
"#
    };
}

/// The seed of a call that draws random numbers.
macro_rules! seed {
    () => {
        r#"  input Any Seed "Real[1,6]: seed, as for Ram_Gen_ARENA";
"#
    };
}

/// The seed that continues.
macro_rules! next_seed {
    () => {
        r#"  output Real Seed_Next[:,:] "Real[1,6]: generator state to pass to the next call";
"#
    };
}

/// The search ranges of the parameters.
macro_rules! ranges {
    () => {
        r#"  input Real Param_Min[:] "lower bounds of the search ranges";
  input Real Param_Max[:] "upper bounds of the search ranges";
"#
    };
}

/// The model that is simulated, and where it is compared.
macro_rules! model {
    () => {
        r#"  input String SimuPath "path of the model's file or package folder; empty if the model is already loaded";
  input String SimuCaseStudyName "name of the model to simulate, optionally with a modification";
  input Any Xexp "Real[:]: array of experimental X data";
"#
    };
}

/// The variables of a model that is simulated.
macro_rules! variables {
    () => {
        r#"  input String Parameter_Names[:] = fill("", 0) "the estimated parameters, one per column; empty: the model's top-level tunable parameters in order of declaration";
  input String X_Name = "time" "the variable whose values Xexp contains";
  input String Y_Name = "" "the measured variable; empty: the model's only top-level output";
"#
    };
}

pub(super) use {header, initial_names, model, next_seed, ranges, seed, simulation, variables};
