//! Commands that write models as functional mock-up units, and that import units.

use super::imported_units;
use super::inputs;
use super::{Args, Builtin, Failure, Family};
use crate::diag::Fault;
use crate::errors::BAD_ARGUMENT;
use crate::fmi::description::Version;
use crate::fmi::export::{Kinds, identifier};
use crate::fmi::import::{Imported, InterfaceKind};
use crate::lower::errors::NOT_SUPPORTED;
use crate::models::exported::{Form, exported};
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
fn write(session: &mut Session, class: &str, form: Form<'_>, file: &str) -> bool {
    let done = exported(session, class, form);
    let Some(bytes) = session.or_report_all(done) else { return false };
    let written = session.world.write_file(Path::new(file), &bytes);
    session.or_report(written).is_some()
}

const TRANSLATE_MODEL_FMU: &str = r#"
function translateModelFMU "Writes a model, with the values that the script gave to its parameters, as a functional mock-up unit: a file .fmu in the current folder."
  input String modelToOpen = "" "Class or Class(modification); empty: the model used last";
  input Boolean storeResult = false "has no effect: the importer stores results";
  input String modelName = "" "name of the model in the unit, and of its file without .fmu; empty: the class, in the name of the file with _ for .";
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
    let version = version(&args.take::<String>("fmiVersion")?)?;
    let kinds = kinds(&args.take::<String>("fmiType")?)?;
    let given: String = args.take("modelName")?;
    let name = Some(given.as_str()).filter(|name| !name.is_empty());
    let class = super::simulation::problem_in_use(session, &class)?;
    let file = name.map_or_else(|| identifier(&class), str::to_owned);
    let form = Form { version, kinds, name };
    let is_written = write(session, &class, form, &format!("{file}.fmu"));
    Ok(if is_written { file } else { String::new() }.into())
}

/// A header of OpenModelica with these defaults.
macro_rules! build_header {
    ($name:literal, $description:literal, $platforms:literal) => {
        inputs::header!(
            $name,
            $description,
            r#"  input TypeName className;
  input String version = "2.0" "2.0 or 3.0";
  input String fmuType = "me" "me, cs, me_cs";
  input String fileNamePrefix = "<default>" "name of the file without .fmu; the class if not given";
"#,
            $platforms,
            r#"  input Boolean includeResources = false "has no effect: tables of files are part of the model";
  output String generatedFileName "empty if it could not be written";
"#
        )
    };
}

const BUILD_MODEL_FMU: &str = build_header!(
    "buildModelFMU",
    "Writes a model as a functional mock-up unit.",
    "  input String platforms[:] = {\"static\"} \"a unit is for the platform of this program; others are noted\";\n"
);

const TRANSLATE_MODEL_FMU_OPENMODELICA: &str = build_header!(
    "translateModelFMU",
    "Writes a model as a functional mock-up unit, as buildModelFMU does.",
    ""
);

fn build_model_fmu(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("className")?;
    let version = version(&args.take::<String>("version")?)?;
    let kinds = kinds(&args.take::<String>("fmuType")?)?;
    let form = Form { version, kinds, name: None };
    let prefix: String = args.take("fileNamePrefix")?;
    if args.names().any(|name| name == "platforms") {
        note_platforms(session, &args.take::<Vec<String>>("platforms")?);
    }
    let class = class.to_string();
    let prefix = if ["", "<default>"].contains(&prefix.as_str()) { class.clone() } else { prefix };
    let file = format!("{prefix}.fmu");
    let is_written = write(session, &class, form, &file);
    let shown = session.world.absolute(file.as_ref()).display().to_string();
    Ok(if is_written { shown } else { String::new() }.into())
}

/// Notes platforms that are asked for by name.
fn note_platforms(session: &mut Session, platforms: &[String]) {
    let is_own = |name: &&String| ["static", "dynamic"].contains(&name.as_str());
    for name in platforms.iter().filter(|name| !is_own(name)) {
        session.note(
            NOT_SUPPORTED,
            format!("`{name}` has no effect: the unit is for the platform of this program alone"),
        );
    }
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
function importFMU "Imports a functional mock-up unit: from then on simulate simulates it under its name, whether or not the script loads the file that is returned. It runs only with the permission of the command line, --allow-external=FILE."
  input String filename;
  input String workdir = "<default>" "folder of the file; <default>: the current one";
  input Integer loglevel = 3 "has no effect";
  input Boolean fullPath = false "whether the whole path of the file is returned";
  input Boolean debugLogging = false "has no effect";
  input Boolean generateInputConnectors = true "has no effect";
  input Boolean generateOutputConnectors = true "has no effect";
  input TypeName modelName = Default "name; if not given that of its model with the ending _me_FMU or _cs_FMU";
  output String generatedFileName "a Modelica file with a class of this name, which stands for the unit; empty if it could not be imported";
end importFMU;
"#;

fn import_fmu_openmodelica(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let file: String = args.take("filename")?;
    let given = args.take::<Name>("modelName")?.to_string();
    let (folder, is_full): (String, bool) = (args.take("workdir")?, args.take("fullPath")?);
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
    let Some(name) = import(session, &file, None, name) else { return Ok(String::new().into()) };
    let written = format!("{name}.mo");
    let folder = if folder == "<default>" { "" } else { folder.as_str() };
    let path = Path::new(folder).join(&written);
    let done = session.world.write_file(&path, placeholder(&name, &file).as_bytes());
    if session.or_report(done).is_none() {
        return Ok(String::new().into());
    }
    let whole = session.world.absolute(&path).display().to_string();
    Ok(if is_full { whole } else { written }.into())
}

/// A class in the place of a unit, which scripts load after an import. It cannot be simulated itself.
fn placeholder(name: &str, file: &str) -> String {
    let file = file.replace('\\', "/").replace('"', "'");
    format!(
        "model {name} \"The FMU {file}\"\nequation\n  assert(false, \"`{name}` stands for an FMU: \
         import it, importFMU(\\\"{file}\\\"), before it is simulated\");\nend {name};\n"
    )
}
