//! Lines that several headers of commands have in common, for `concat!`.

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

pub(super) use {model, next_seed, ranges, seed, variables};
