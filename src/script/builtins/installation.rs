//! Questions about the tool and the machine that a script runs on.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::name::Name;
use crate::value::{ArrayValue, Elements, Value};
use crate::{Dialect, Session};

/// The commands of OpenModelica.
pub(super) const FAMILY: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: GET_MODELICA_PATH, run: get_modelica_path },
        Builtin { header: GET_TEMP_DIRECTORY_PATH, run: get_temp_directory_path },
        Builtin { header: GET_INSTALLATION_DIRECTORY_PATH, run: get_installation_directory_path },
        Builtin { header: GET_LOADED_LIBRARIES, run: get_loaded_libraries },
        Builtin { header: NUM_PROCESSORS, run: num_processors },
        Builtin { header: URI_TO_FILENAME, run: uri_to_filename },
        Builtin { header: TYPE_NAME_STRING, run: type_name_string },
    ],
};

/// The commands of Dymola.
pub(super) const DYMOLA: Family = Family {
    packages: &["DymolaCommands.System"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: DYMOLA_VERSION_NUMBER, run: dymola_version_number },
        Builtin { header: DYMOLA_VERSION, run: dymola_version },
    ],
};

/// The release of Dymola whose documentation the commands follow.
const DYMOLA_RELEASE: f64 = 2018.0;

const GET_MODELICA_PATH: &str = r#"
function getModelicaPath "Folders whose packages can be loaded by name, separated by colons; the built-in library is last."
  output String modelicaPath;
end getModelicaPath;
"#;

fn get_modelica_path(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let own = session.library_folders().iter().map(|folder| folder.display().to_string());
    let all: Vec<String> = own.chain([crate::packages::FOLDER.to_owned()]).collect();
    Ok(text(all.join(":")))
}

const GET_TEMP_DIRECTORY_PATH: &str = r#"
function getTempDirectoryPath "A folder for temporary files: the output folder."
  output String tempDirectoryPath;
end getTempDirectoryPath;
"#;

fn get_temp_directory_path(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(text(session.world.absolute(&session.world.output_dir()).display().to_string()))
}

const GET_INSTALLATION_DIRECTORY_PATH: &str = r#"
function getInstallationDirectoryPath "The location of the program's libraries, which are part of the program itself."
  output String installationDirectoryPath;
end getInstallationDirectoryPath;
"#;

fn get_installation_directory_path(_: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(text(crate::packages::FOLDER.to_owned()))
}

const GET_LOADED_LIBRARIES: &str = r#"
function getLoadedLibraries "Names and folders of the loaded top-level classes."
  output String libraries[:, 2];
end getLoadedLibraries;
"#;

fn get_loaded_libraries(session: &mut Session, _: Args) -> Result<Value, Failure> {
    let roots: Vec<Name> = session.library().roots().map(Name::from).collect();
    let mut elements = Vec::with_capacity(2 * roots.len());
    for name in &roots {
        let file = session.source_file(name).map_or(String::new(), |f| f.display().to_string());
        elements.extend([name.to_string().into(), file.into()]);
    }
    let dims = vec![roots.len(), 2];
    Ok(Value::Array(ArrayValue::new(dims, Elements::String(elements))))
}

const NUM_PROCESSORS: &str = r#"
function numProcessors "Number of processors available for parallel work."
  output Integer result;
end numProcessors;
"#;

fn num_processors(session: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok((session.world.threads() as i64).into())
}

const URI_TO_FILENAME: &str = r#"
function uriToFilename "The path of a modelica:// URI."
  input String uri;
  output String filename "empty if it does not exist";
end uriToFilename;
"#;

fn uri_to_filename(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let found = session.resource(&args.take::<String>("uri")?);
    let path = session.or_report(found).map(|path| path.display().to_string());
    Ok(text(path.unwrap_or_default()))
}

const TYPE_NAME_STRING: &str = r#"
function typeNameString "The name of a class as a string."
  input TypeName cl;
  output String out;
end typeNameString;
"#;

fn type_name_string(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    Ok(text(args.take::<Name>("cl")?.to_string()))
}

const DYMOLA_VERSION_NUMBER: &str = r#"
function DymolaVersionNumber "The Dymola release whose commands are supported, as a number."
  output Real versionNumber;
end DymolaVersionNumber;
"#;

fn dymola_version_number(_: &mut Session, _: Args) -> Result<Value, Failure> {
    Ok(Value::Real(DYMOLA_RELEASE))
}

const DYMOLA_VERSION: &str = r#"
function DymolaVersion "The name and version of this program, and the Dymola release whose commands are supported."
  output String version;
end DymolaVersion;
"#;

fn dymola_version(_: &mut Session, _: Args) -> Result<Value, Failure> {
    let own = concat!("gapilib ", env!("CARGO_PKG_VERSION"));
    Ok(text(format!("{own} (commands of Dymola {DYMOLA_RELEASE})")))
}
