//! Commands that write models as functional mock-up units, and that import units.

use super::imported_units;
use super::{Args, Builtin, Failure, Family};
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fmi::description::Version;
use crate::fmi::export::{Kinds, identifier};
use crate::fmi::import::{Imported, InterfaceKind};
use crate::models::exported::exported;
use crate::models::imported::{self, CO_SIMULATION};
use crate::name::Name;
use crate::value::Value;
use crate::{Dialect, Session, bail, fault};
use std::path::Path;

/// Dymola's commands.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: TRANSLATE_MODEL_FMU, run: translate_model_fmu },
        Builtin { header: IMPORT_FMU, run: import_fmu },
    ],
};

/// OpenModelica's commands.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: BUILD_MODEL_FMU, run: build_model_fmu },
        Builtin { header: TRANSLATE_MODEL_FMU_OPENMODELICA, run: build_model_fmu },
        Builtin { header: IMPORT_FMU_OPENMODELICA, run: import_fmu_openmodelica },
    ],
};

fn version(text: &str) -> Result<Version, Fault> {
    match text {
        "2" | "2.0" => Ok(Version::V2),
        "3" | "3.0" => Ok(Version::V3),
        other => Err(fault!(BAD_ARGUMENT, "FMUs of the version `{other}` are not written";
            help: "write \"2\" or \"3\"")),
    }
}

fn kinds(text: &str) -> Result<Kinds, Fault> {
    let (model_exchange, co_simulation) = match text {
        "me" => (true, false),
        "cs" | "csSolver" => (false, true),
        "all" | "me_cs" => (true, true),
        other => bail!(BAD_ARGUMENT, "there are no FMUs of the kind `{other}`";
            help: "write \"me\", \"cs\", or for both \"all\" (Dymola) or \"me_cs\" (OpenModelica)"),
    };
    Ok(Kinds { model_exchange, co_simulation })
}

/// Writes the unit of a model; whether that was possible. Errors are reported.
fn write(session: &mut Session, class: &str, form: (Version, Kinds), file: &str) -> bool {
    let done = exported(session, class, form.0, form.1);
    let Some(bytes) = session.or_report_all(done) else { return false };
    let written = session.write_file(Path::new(file), &bytes);
    session.or_report(written).is_some()
}

const TRANSLATE_MODEL_FMU: &str = r#"
function translateModelFMU "Writes a model, with the values that the script gave to its parameters, as a functional mock-up unit: a file .fmu in the current folder."
  input String modelToOpen = "" "Class or Class(modification); empty: the model used last";
  input Boolean storeResult = false "has no effect: the importer stores results";
  input String modelName = "" "name of the file without .fmu; empty: the class with _ for .";
  input String fmiVersion = "2" "2 or 3";
  input String fmiType = "all" "me, cs, all; csSolver is cs";
  input Boolean includeSource = false "has no effect: there is no source in C";
  input Integer includeImage = 0 "has no effect";
  input String includeVariables[:] = fill("", 0) "has no effect: all variables that are not protected are in the unit";
  output String FMUName "name of the file without .fmu; empty if it could not be written";
end translateModelFMU;
"#;

fn translate_model_fmu(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: String = args.take("modelToOpen")?;
    let form =
        (version(&args.take::<String>("fmiVersion")?)?, kinds(&args.take::<String>("fmiType")?)?);
    let name: String = args.take("modelName")?;
    let class = super::simulation::problem_in_use(session, &class)?;
    let name = if name.is_empty() { identifier(&class) } else { name };
    let is_written = write(session, &class, form, &format!("{name}.fmu"));
    Ok(if is_written { name } else { String::new() }.into())
}

/// A header of OpenModelica with these defaults.
macro_rules! build_header {
    ($name:literal, $description:literal, $platforms:literal) => {
        concat!(
            "function ",
            $name,
            " \"",
            $description,
            "\"\n",
            r#"  input TypeName className;
  input String version = "2.0" "2.0 or 3.0";
  input String fmuType = "me" "me, cs, me_cs";
  input String fileNamePrefix = "<default>" "name of the file without .fmu; the class if not given";
"#,
            $platforms,
            r#"  input Boolean includeResources = false "has no effect: tables of files are part of the model";
  output String generatedFileName "empty if it could not be written";
"#,
            "end ",
            $name,
            ";\n"
        )
    };
}

const BUILD_MODEL_FMU: &str = build_header!(
    "buildModelFMU",
    "Writes a model as a functional mock-up unit.",
    "  input String platforms[:] = {\"static\"} \"has no effect: it runs on the platform of this program\";\n"
);

const TRANSLATE_MODEL_FMU_OPENMODELICA: &str = build_header!(
    "translateModelFMU",
    "Writes a model as a functional mock-up unit, as buildModelFMU does.",
    ""
);

fn build_model_fmu(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let form =
        (version(&args.take::<String>("version")?)?, kinds(&args.take::<String>("fmuType")?)?);
    let prefix: String = args.take("fileNamePrefix")?;
    let class = class.to_string();
    let prefix = if ["", "<default>"].contains(&prefix.as_str()) { class.clone() } else { prefix };
    let file = format!("{prefix}.fmu");
    let is_written = write(session, &class, form, &file);
    let shown = session.world.absolute(file.as_ref()).display().to_string();
    Ok(if is_written { shown } else { String::new() }.into())
}

/// Imports a unit under the name that `name` makes of the name of its model.
fn import(
    session: &mut Session,
    file: &str,
    method: Option<&str>,
    name: impl FnOnce(&Imported) -> String,
) -> Option<String> {
    let unit = imported::import(session, Path::new(file), method);
    let unit = session.or_report(unit)?;
    let name = name(&unit);
    imported_units::keep(session, name.clone(), unit);
    Some(name)
}

const IMPORT_FMU: &str = r#"
function importFMU "Imports a functional mock-up unit: from then on simulateModel and its relatives simulate it under the name of its model with _ for . and with the ending _fmu. It runs only with the permission of the command line, --allow-external=FILE."
  input String fileName;
  input Boolean includeAllVariables = true "has no effect: all variables are stored";
  input Boolean integrate = true "true: this program integrates (model exchange); false: the unit integrates (co-simulation)";
  input Boolean promptReplacement = false "has no effect";
  input String packageName = "" "package in which the name is then found; empty: none";
  input String includeVariables[:] = fill("", 0) "has no effect: all variables are stored";
  output Boolean ok;
end importFMU;
"#;

fn import_fmu(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (file, package): (String, String) = (args.take("fileName")?, args.take("packageName")?);
    let method = if args.take("integrate")? { None } else { Some(CO_SIMULATION) };
    let name = |unit: &Imported| {
        let name = format!("{}_fmu", identifier(&unit.description.model_name));
        if package.is_empty() { name } else { format!("{package}.{name}") }
    };
    Ok(import(session, &file, method, name).is_some().into())
}

const IMPORT_FMU_OPENMODELICA: &str = r#"
function importFMU "Imports a functional mock-up unit: from then on simulate simulates it under the name that is returned. It runs only with the permission of the command line, --allow-external=FILE."
  input String filename;
  input String workdir = "<default>" "has no effect: no file is written";
  input Integer loglevel = 3 "has no effect";
  input Boolean fullPath = false "has no effect";
  input Boolean debugLogging = false "has no effect";
  input Boolean generateInputConnectors = true "has no effect";
  input Boolean generateOutputConnectors = true "has no effect";
  input TypeName modelName = Default "name; if not given that of its model with the ending _me_FMU or _cs_FMU";
  output String generatedFileName "the name; empty if it could not be imported. No file is written";
end importFMU;
"#;

fn import_fmu_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("filename")?;
    let given = args.take::<Name>("modelName")?.to_string();
    let name = |unit: &Imported| {
        let kind = match unit.kind {
            InterfaceKind::ModelExchange => "me",
            InterfaceKind::CoSimulation => "cs",
            InterfaceKind::ScheduledExecution => "se",
        };
        match given.as_str() {
            "Default" => format!("{}_{kind}_FMU", identifier(&unit.description.model_name)),
            _ => given,
        }
    };
    Ok(import(session, &file, None, name).unwrap_or_default().into())
}
