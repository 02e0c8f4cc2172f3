//! `Modelica.Utilities.Files`, and the file commands of both tools.

use super::strings::text;
use super::{Args, Builtin, Failure, Family};
use crate::access::faults::cannot;
use crate::access::policy::Access;
use crate::bail;
use crate::diag::Fault;
use crate::errors::FILE_ERROR;
use crate::value::Value;
use crate::{Dialect, Session};
use std::path::{Path, PathBuf};

/// `Modelica.Utilities.Files`.
pub(super) const FAMILY: Family = Family {
    packages: &["Modelica.Utilities.Files"],
    dialect: None,
    builtins: &[
        Builtin { header: EXIST, run: exist },
        Builtin { header: LIST_FILES, run: list_files },
        Builtin { header: COPY, run: copy },
        Builtin { header: MOVE, run: move_file },
        Builtin { header: REMOVE, run: remove },
        Builtin { header: REMOVE_FILE, run: remove_file },
        Builtin { header: CREATE_DIRECTORY, run: create_directory },
        Builtin { header: FULL_PATH_NAME, run: full_path_name },
        Builtin { header: SPLIT_PATH_NAME, run: split_path_name },
        Builtin { header: LOAD_RESOURCE, run: load_resource },
    ],
};

/// OpenModelica's file commands.
pub(super) const OPENMODELICA: Family = Family {
    packages: &["OpenModelica.Scripting"],
    dialect: Some(Dialect::OpenModelica),
    builtins: &[
        Builtin { header: WRITE_FILE, run: write_file },
        Builtin { header: READ_FILE, run: read_file },
        Builtin { header: REGULAR_FILE_EXISTS, run: regular_file_exists },
        Builtin { header: DIRECTORY_EXISTS, run: directory_exists },
        Builtin { header: DELETE_FILE, run: delete_file },
        Builtin { header: REMOVE_PATH, run: remove_path },
        Builtin { header: MKDIR, run: mkdir },
        Builtin { header: BASENAME, run: basename },
        Builtin { header: DIRNAME, run: dirname },
        Builtin { header: REALPATH, run: realpath },
    ],
};

fn path_of(session: &Session, args: &mut Args, name: &str) -> Result<PathBuf, Fault> {
    let path: String = args.take(name)?;
    Ok(session.world.find_file(Path::new(&path)).unwrap_or_else(|| PathBuf::from(path)))
}

const EXIST: &str = r#"
function exist "Whether a file or directory exists."
  input String name;
  output Boolean result;
end exist;
"#;

fn exist(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("name")?;
    match session.world.find_file(Path::new(&name)) {
        Some(found) => Ok(session.world.kind_of(&found)?.is_some().into()),
        None => Ok(session.world.kind_of(Path::new(&name))?.is_some().into()),
    }
}

const LIST_FILES: &str = r#"
function list "Prints the lines of a file, or the names in a directory."
  input String name;
end list;
"#;

fn list_files(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path = path_of(session, &mut args, "name")?;
    let listing = if session.world.is_dir(&path) {
        let names = session.world.list_dir(&path).map_err(|error| cannot("read", &path, &error))?;
        names.iter().map(|name| format!("{name}\n")).collect()
    } else {
        session.world.read_text(&path)?
    };
    session.print_of_script(&listing);
    Ok(Value::nothing())
}

const COPY: &str = r#"
function copy "Copies a file."
  input String oldName;
  input String newName;
  input Boolean replace = false "whether an existing file is overwritten";
end copy;
"#;

fn copy(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let old = path_of(session, &mut args, "oldName")?;
    let new = PathBuf::from(args.take::<String>("newName")?);
    let replace: bool = args.take("replace")?;
    copy_file(session, &old, &new, replace)?;
    Ok(Value::nothing())
}

fn copy_file(session: &mut Session, old: &Path, new: &Path, replace: bool) -> Result<(), Fault> {
    if session.world.kind_of(new)?.is_some() && !replace {
        bail!(FILE_ERROR, "`{}` already exists", new.display(); help: "set `replace = true` to \
            overwrite it");
    }
    let bytes = session.world.read_bytes(old)?;
    session.world.write_file(new, &bytes)
}

const MOVE: &str = r#"
function move "Moves a file."
  input String oldName;
  input String newName;
  input Boolean replace = false "whether an existing file is overwritten";
end move;
"#;

fn move_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let old = path_of(session, &mut args, "oldName")?;
    let new = PathBuf::from(args.take::<String>("newName")?);
    let replace: bool = args.take("replace")?;
    // Refused before anything is done.
    session.world.may(Access::Write, &old)?;
    copy_file(session, &old, &new, replace)?;
    session.world.remove_file(&old)?;
    Ok(Value::nothing())
}

const REMOVE: &str = r#"
function remove "Removes a file, or a directory with its contents, if it exists; for a link, only the link."
  input String name;
end remove;
"#;

fn remove(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path = PathBuf::from(args.take::<String>("name")?);
    if session.world.kind_of(&path)?.is_some() {
        remove_tree(session, &path)?;
    }
    Ok(Value::nothing())
}

/// Removes what is in a directory before the directory; links are not followed.
fn remove_tree(session: &mut Session, path: &Path) -> Result<(), Fault> {
    if session.world.is_dir(path) && !session.world.is_link(path) {
        let entries = session.world.list_dir(path);
        for entry in entries.map_err(|error| cannot("read", path, &error))? {
            remove_tree(session, &path.join(entry))?;
        }
    }
    session.world.remove_file(path)
}

const REMOVE_FILE: &str = r#"
function removeFile "Removes a file, if it exists."
  input String fileName;
end removeFile;
"#;

fn remove_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path = PathBuf::from(args.take::<String>("fileName")?);
    match session.world.kind_of(&path)? {
        Some(true) => bail!(FILE_ERROR, "`{}` is a directory", path.display()),
        Some(false) => session.world.remove_file(&path)?,
        None => {}
    }
    Ok(Value::nothing())
}

const CREATE_DIRECTORY: &str = r#"
function createDirectory "Creates a directory and its parent directories."
  input String directoryName;
end createDirectory;
"#;

fn create_directory(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path = PathBuf::from(args.take::<String>("directoryName")?);
    session.world.create_directory(&path)?;
    Ok(Value::nothing())
}

const FULL_PATH_NAME: &str = r#"
function fullPathName "The absolute path of a file or directory."
  input String name;
  output String fullName;
end fullPathName;
"#;

fn full_path_name(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("name")?;
    Ok(text(session.world.absolute(Path::new(&name)).display().to_string()))
}

const SPLIT_PATH_NAME: &str = r#"
function splitPathName "Directory, file name and extension of a path."
  input String pathName;
  output String directory "with the trailing slash";
  output String name;
  output String extension "with its dot";
end splitPathName;
"#;

fn split_path_name(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path: String = args.take("pathName")?;
    let after_slash = path.rfind(['/', '\\']).map_or(0, |slash| slash + 1);
    let (directory, file) = path.split_at(after_slash);
    let dot = file.rfind('.').filter(|dot| *dot > 0).unwrap_or(file.len());
    let (name, extension) = file.split_at(dot);
    Ok(Value::Tuple([directory, name, extension].map(Value::from).to_vec()))
}

const LOAD_RESOURCE: &str = r#"
function loadResource "The path of a file named by a path or a modelica:// URI."
  input String uri;
  output String fileReference;
end loadResource;
"#;

fn load_resource(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let uri: String = args.take("uri")?;
    Ok(text(session.resource(&uri)?.display().to_string()))
}

const WRITE_FILE: &str = r#"
function writeFile "Writes a string to a file."
  input String fileName;
  input String data;
  input Boolean append = false;
  output Boolean success;
end writeFile;
"#;

fn write_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let (name, data): (String, String) = (args.take("fileName")?, args.take("data")?);
    let written = match args.take("append")? {
        true => session.world.append_file(Path::new(&name), data.as_bytes()),
        false => session.world.write_file(Path::new(&name), data.as_bytes()),
    };
    Ok(session.succeeded(written))
}

const READ_FILE: &str = r#"
function readFile "The contents of a file."
  input String fileName;
  output String contents "empty if it cannot be read";
end readFile;
"#;

fn read_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("fileName")?;
    let read = session.world.read_text(Path::new(&name));
    Ok(text(session.or_report(read).unwrap_or_default()))
}

const REGULAR_FILE_EXISTS: &str = r#"
function regularFileExists "Whether a file exists and is not a directory."
  input String fileName;
  output Boolean exists;
end regularFileExists;
"#;

fn regular_file_exists(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("fileName")?;
    Ok((session.world.kind_of(Path::new(&name))? == Some(false)).into())
}

const DIRECTORY_EXISTS: &str = r#"
function directoryExists "Whether a directory exists."
  input String dirName;
  output Boolean exists;
end directoryExists;
"#;

fn directory_exists(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let name: String = args.take("dirName")?;
    Ok((session.world.kind_of(Path::new(&name))? == Some(true)).into())
}

const DELETE_FILE: &str = r#"
function deleteFile "Removes a file."
  input String fileName;
  output Boolean success;
end deleteFile;
"#;

fn delete_file(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let removed = session.world.remove_file(Path::new(&args.take::<String>("fileName")?));
    Ok(session.succeeded(removed))
}

const REMOVE_PATH: &str = r#"
function remove "Removes a file or an empty directory."
  input String path;
  output Boolean success;
end remove;
"#;

fn remove_path(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let removed = session.world.remove_file(Path::new(&args.take::<String>("path")?));
    Ok(session.succeeded(removed))
}

const MKDIR: &str = r#"
function mkdir "Creates a directory and its parent directories."
  input String newDirectory;
  output Boolean success;
end mkdir;
"#;

fn mkdir(session: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let made = session.world.create_directory(Path::new(&args.take::<String>("newDirectory")?));
    Ok(session.succeeded(made))
}

const BASENAME: &str = r#"
function basename "The part of a path after the last slash."
  input String path;
  output String basename;
end basename;
"#;

fn basename(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path: String = args.take("path")?;
    Ok(path.rsplit('/').next().unwrap_or_default().into())
}

const DIRNAME: &str = r#"
function dirname "The part of a path before the last slash."
  input String path;
  output String dirname;
end dirname;
"#;

fn dirname(_: &mut Session, mut args: Args) -> Result<Value, Failure> {
    let path: String = args.take("path")?;
    Ok(match path.rfind('/') {
        Some(0) => "/".into(),
        Some(slash) => path[..slash].into(),
        None => ".".into(),
    })
}

const REALPATH: &str = r#"
function realpath "The absolute path of a file or directory."
  input String name;
  output String fullName;
end realpath;
"#;

fn realpath(session: &mut Session, args: Args) -> Result<Value, Failure> {
    full_path_name(session, args)
}
