//! Commands of other tools that are not carried out, each with its reason.

use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::script::Session;
use crate::script::errors::REFUSED;
use crate::value::Value;

macro_rules! refused {
    ($($name:literal: $reason:literal),* $(,)?) => {
        &[$(Builtin {
            header: concat!(
                "function ", $name, " \"Refused: ", $reason, ".\"\n",
                "  output Boolean ok;\n  annotation(variadic = true);\nend ", $name, ";\n"
            ),
            run: refuse,
        }),*]
    };
}

/// The commands of this file. They take any arguments.
pub(super) const FAMILY: Family = Family {
    packages: &[],
    dialect: None,
    builtins: refused![
        "translateModelFMU": "models are not exported as FMUs",
        "translateModelExport": "models are not exported as C code",
        "buildModelFMU": "models are not exported as FMUs",
        "importFMU": "FMUs are not read",
        "exportDiagram": "diagrams are not drawn",
        "exportDocumentation": "documentation is not written",
        "exportInitial": "settings are not written to a file: a script keeps them",
        "reopenStandardStream": "the standard streams belong to the caller",
        "alarm": "a script has its limit of time from the command line: --time-limit",
        "decryptModel": "encrypted models are not read",
    ],
};

fn refuse(_: &mut Session, args: Args) -> Result<Value, Failure> {
    let reason = args.description();
    let reason = reason.trim_start_matches("Refused: ").trim_end_matches('.');
    bail!(REFUSED, "`{}` is refused: {reason}", args.command())
}
