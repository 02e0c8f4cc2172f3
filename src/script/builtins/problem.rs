//! Identification as a problem of its own, from a script.

use super::{Args, Builtin, Failure, Family};
use crate::Session;
use crate::bail;
use crate::runs::problem;
use crate::runs::problem::RunOptions;
use crate::value::Value;
use crate::value::errors::TYPE_MISMATCH;
use std::path::Path;

/// The commands of this file.
pub(super) const FAMILY: Family = Family {
    packages: &["GAPILib"],
    dialect: None,
    builtins: &[Builtin { header: IDENTIFY, run: identify }],
};

const IDENTIFY: &str = r#"
function identify "Estimates the parameters of a problem and writes a report."
  input Any problem "record GAPILib.Problem, or the name of a problem file (.toml)";
  input String folder = "" "subfolder of the output folder for the results";
  input Boolean resume = false "resume from the checkpoint in that folder";
  input Boolean profile = false "compute profile likelihoods after the estimation";
  input String sensitivity = "" "global sensitivity analysis before the estimation: morris or sobol";
  output Real values[:] "estimated values, in the order of the estimated parameters";
  output Real fitness "the smallest value of the (first) fitness function";
  output Real deviations[:] "standard errors (1 sigma); NaN where they are not identifiable from the data";
end identify;
"#;

fn identify(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let requested: Value = args.take("problem")?;
    let folder: String = args.take("folder")?;
    let sensitivity: String = args.take("sensitivity")?;
    let resume = args.take("resume")?;
    let options = RunOptions {
        resume,
        // A script that runs again starts again, unless it says otherwise.
        fresh: !resume,
        profile: args.take("profile")?,
        sensitivity: Some(sensitivity).filter(|name| !name.is_empty()),
        folder: folder.into(),
        ..RunOptions::default()
    };
    let solution = match requested {
        Value::String(file) => problem::solve(session, Path::new(&*file), &options)?,
        Value::Record(record) => problem::solve_record(session, &record, &options)?,
        other => bail!(
            TYPE_MISMATCH,
            "`problem` of `identify` is {} instead of a problem", other.type_name();
            help: "pass a record `GAPILib.Problem(…)` or the name of a problem file"
        ),
    };
    let values = solution.parameters.iter().map(|p| p.value).collect();
    let deviations = solution.parameters.iter().map(|p| p.deviation.unwrap_or(f64::NAN)).collect();
    Ok(Value::Tuple(vec![
        Value::reals(values),
        Value::Real(solution.fitness),
        Value::reals(deviations),
    ]))
}
