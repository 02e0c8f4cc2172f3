//! Loading classes into the session, and asking what is there.

use super::classes::constant_names;
use super::{Args, Builtin, Failure, Family};
use crate::bail;
use crate::errors::BAD_ARGUMENT;
use crate::name::Name;
use crate::syntax::ast::{ClassSpecifier, Element, Section, Visibility};
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::{Path, PathBuf};

/// Dymola's commands.
pub(super) const FAMILY: Family = Family {
    packages: &["DymolaCommands.SimulatorAPI"],
    dialect: Some(Dialect::Dymola),
    builtins: &[
        Builtin { header: OPEN_MODEL, run: open_model },
        Builtin { header: OPEN_MODEL_FILE, run: open_model_file },
        Builtin { header: ERASE_CLASSES, run: erase_classes },
    ],
};

/// OpenModelica's commands.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: LOAD_FILE, run: load_file },
        Builtin { header: LOAD_FILES, run: load_files },
        Builtin { header: LOAD_MODEL, run: load_model },
        Builtin { header: LOAD_STRING, run: load_string },
        Builtin { header: EXIST_CLASS, run: exist_class },
        Builtin { header: DELETE_CLASS, run: delete_class },
        Builtin { header: GET_CLASS_NAMES, run: get_class_names },
        Builtin { header: GET_SOURCE_FILE, run: get_source_file },
    ],
};

const OPEN_MODEL: &str = r#"
function openModel "Loads a Modelica file or package."
  input String path;
  input Boolean mustRead = true "false: a file that is already loaded is not read again";
  input Boolean changeDirectory = true "whether to change the working directory to the folder of the file";
  output Boolean ok;
end openModel;
"#;

fn open_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path = PathBuf::from(args.take::<String>("path")?);
    let change: bool = args.take("changeDirectory")?;
    let found = session.world.find_file(&path);
    let loaded = session.load_path(&path);
    if session.or_report_all(loaded).is_none() {
        return Ok(false.into());
    }
    if let (true, Some(folder)) = (change, found.as_deref().and_then(Path::parent)) {
        session.world.trust_results(folder);
        let changed = session.world.change_dir(&folder.to_string_lossy());
        return Ok(session.succeeded(changed));
    }
    Ok(true.into())
}

const OPEN_MODEL_FILE: &str = r#"
function openModelFile "Loads the file or package of a class by its name."
  input String modelName;
  input String path = "" "the file, if the name alone is not sufficient to find it";
  input String version = "";
  input Boolean mustRead = false;
  input Boolean changeDirectory = false;
  output Boolean ok;
end openModelFile;
"#;

fn open_model_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (model, path): (String, String) = (args.take("modelName")?, args.take("path")?);
    if path.is_empty() {
        let (model, version) = (Name::parse(&model), args.take::<String>("version")?);
        session.require_version(&model, vec![version]);
        return Ok(is_loaded(session, &model).into());
    }
    let loaded = session.load_path(Path::new(&path));
    Ok(session.or_report_all(loaded).is_some().into())
}

/// Whether a class is loaded, now if need be; reported if it is nowhere.
fn is_loaded(session: &mut Session, name: &Name) -> bool {
    let found = session.find_class(name);
    let found = session.or_report_all(found);
    if found == Some(false) {
        let fault = session.classes.class_to_load(name);
        session.report_fault(fault);
    }
    found == Some(true)
}

const ERASE_CLASSES: &str = r#"
function eraseClasses "Removes loaded classes."
  input String classnames[:];
  output Boolean ok;
end eraseClasses;
"#;

fn erase_classes(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let names: Vec<String> = args.take("classnames")?;
    let removed: Vec<bool> =
        names.iter().map(|name| session.classes.remove(&Name::parse(name))).collect();
    Ok(removed.into_iter().all(|removed| removed).into())
}

const LOAD_FILE: &str = r#"
function loadFile "Loads the classes of a Modelica file."
  input String fileName;
  input String encoding = "UTF-8" "has no effect: UTF-8 is tried, then Latin-1";
  input Boolean uses = true;
  input Boolean notify = true;
  input Boolean requireExactVersion = false;
  input Boolean allowWithin = true;
  output Boolean success "false if the file is missing or malformed; getErrorString() says why";
end loadFile;
"#;

fn load_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let loaded = session.load_path(Path::new(&args.take::<String>("fileName")?));
    Ok(session.or_report_all(loaded).is_some().into())
}

const LOAD_FILES: &str = r#"
function loadFiles "Loads the classes of Modelica files."
  input String fileNames[:];
  input String encoding = "UTF-8" "has no effect: UTF-8 is tried, then Latin-1";
  input Integer numThreads = 1 "has no effect";
  input Boolean uses = true;
  input Boolean notify = true;
  input Boolean requireExactVersion = false;
  input Boolean allowWithin = true;
  output Boolean success;
end loadFiles;
"#;

fn load_files(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let mut success = true;
    for file in args.take::<Vec<String>>("fileNames")? {
        let loaded = session.load_path(Path::new(&file));
        success &= session.or_report_all(loaded).is_some();
    }
    Ok(success.into())
}

const LOAD_MODEL: &str = r#"
function loadModel "Loads a package from the library folders."
  input TypeName className;
  input String priorityVersion[:] = {"default"} "versions in order of preference; default: the newest";
  input Boolean notify = false;
  input String languageStandard = "";
  input Boolean requireExactVersion = false;
  output Boolean success;
end loadModel;
"#;

fn load_model(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("className")?;
    session.require_version(&name, args.take("priorityVersion")?);
    Ok(is_loaded(session, &name).into())
}

const LOAD_STRING: &str = r#"
function loadString "Loads the classes of a string of Modelica source text."
  input String data;
  input String filename = "<interactive>" "the file name used in messages";
  input String encoding = "UTF-8" "has no effect";
  input Boolean merge = false;
  input Boolean uses = true;
  input Boolean notify = true;
  input Boolean requireExactVersion = false;
  output Boolean success;
end loadString;
"#;

fn load_string(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (data, name): (String, String) = (args.take("data")?, args.take("filename")?);
    let loaded = session.load_text(&name, &data);
    Ok(session.or_report_all(loaded).is_some().into())
}

const EXIST_CLASS: &str = r#"
function existClass "Whether a class is loaded."
  input TypeName cl;
  output Boolean exists;
end existClass;
"#;

fn exist_class(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("cl")?;
    let found = session.ask_library(|library| Ok(library.contains(&name)));
    Ok(session.or_report_all(found).unwrap_or(false).into())
}

const DELETE_CLASS: &str = r#"
function deleteClass "Removes a top-level class."
  input TypeName className;
  output Boolean success;
end deleteClass;
"#;

fn delete_class(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("className")?;
    Ok(session.classes.remove(&name).into())
}

const GET_CLASS_NAMES: &str = r#"
function getClassNames "Names of the classes in a class, or at the top level."
  input TypeName class_ = AllLoadedClasses;
  input Boolean recursive = false;
  input Boolean qualified = false;
  input Boolean sort = false;
  input Boolean builtin = false "true is not supported: predefined types are not classes here";
  input Boolean showProtected = false "whether to include protected classes";
  input Boolean includeConstants = false "whether to include the constants of the class";
  output TypeName classNames[:];
end getClassNames;
"#;

fn get_class_names(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let class: Name = args.take("class_")?;
    let at_top = class.last().is_some_and(|name| name == "AllLoadedClasses");
    let class = if at_top { Name::default() } else { class };
    let (recursive, qualified): (bool, bool) = (args.take("recursive")?, args.take("qualified")?);
    let found = session.ask_library(|library| {
        Ok(match (class.parts.is_empty(), recursive) {
            (true, true) => library.all(),
            (true, false) => library.roots().map(Name::from).collect(),
            (false, true) => library.all_in(&class).into_iter().skip(1).collect(),
            (false, false) => {
                library.children(&class).into_iter().map(|name| class.child(name)).collect()
            }
        })
    });
    let mut found: Vec<Name> = session.or_report_all(found).unwrap_or_default();
    if args.take("builtin")? {
        bail!(
            BAD_ARGUMENT,
            "`builtin = true` is not supported: predefined types are not classes here"
        );
    }
    if !args.take::<bool>("showProtected")? {
        found.retain(|name| !is_protected(session, name));
    }
    if args.take("includeConstants")?
        && let Some(definition) = session.library().definition(&class)
    {
        found.extend(constant_names(&definition).into_iter().map(|name| class.child(name)));
    }
    let shown = |name: Name| match (qualified || recursive, name.last()) {
        (false, Some(last)) => last.to_string(),
        _ => name.to_string(),
    };
    let mut names: Vec<String> = found.into_iter().map(shown).collect();
    if args.take("sort")? {
        names.sort();
    }
    Ok(names.into())
}

/// Whether a class is declared in a protected section of the class around it.
pub(super) fn is_protected(session: &mut Session, name: &Name) -> bool {
    let Some(own) = name.last().filter(|_| name.parts.len() > 1) else { return false };
    let Some(around) = session.library().definition(&name.parent()) else { return false };
    let ClassSpecifier::Long(long) = &around.specifier else { return false };
    long.sections.iter().any(|section| match section {
        Section::Elements { visibility: Some(Visibility::Protected), elements } => {
            elements.iter().any(
                |element| matches!(element, Element::Class(class) if class.class.name.node == own),
            )
        }
        _ => false,
    })
}

const GET_SOURCE_FILE: &str = r#"
function getSourceFile "The file that a class was loaded from."
  input TypeName class_;
  output String filename "empty if it was not loaded from a file";
end getSourceFile;
"#;

fn get_source_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: Name = args.take("class_")?;
    let file = session.source_file(&name);
    Ok(file.map_or(String::new(), |file| file.display().to_string()).into())
}
