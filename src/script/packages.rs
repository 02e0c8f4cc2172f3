//! The Modelica packages that are part of the program: the content of the folder `models`.
//!
//! They look like a folder, [`FOLDER`], that a [`World`](crate::world::World) may answer
//! for, so that they are loaded as packages on a disk are. A user's library of the same name that
//! is found before takes the place of one of these.

use std::path::{Component, Path};

/// Where the packages seem to lie.
pub const FOLDER: &str = "/gapilib:models";

/// Paths below the folder, with `/`, sorted; and what the files hold.
static FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/models.rs"));

/// The bytes of a file below the folder.
pub fn read(path: &Path) -> Option<&'static [u8]> {
    let path = inside(path)?;
    let at = FILES.binary_search_by_key(&path.as_str(), |(name, _)| name).ok()?;
    Some(FILES[at].1)
}

/// The sorted names in a folder, which is this folder or one below.
pub fn list(folder: &Path) -> Option<Vec<String>> {
    let folder = inside(folder)?;
    let prefix = if folder.is_empty() { folder } else { folder + "/" };
    let inner = FILES.iter().filter_map(|(name, _)| name.strip_prefix(prefix.as_str()));
    let mut names: Vec<String> =
        inner.filter_map(|rest| rest.split('/').next()).map(str::to_owned).collect();
    names.dedup();
    (!names.is_empty()).then_some(names)
}

/// The part of a path below the folder, `None` if it lies elsewhere. On some systems an absolute
/// path begins with the name of a drive.
fn inside(path: &Path) -> Option<String> {
    let mut parts = path.components().filter_map(|part| match part {
        Component::Normal(part) => part.to_str(),
        _ => None,
    });
    let folder = parts.next()?;
    (path.has_root() && folder == &FOLDER[1..]).then(|| parts.collect::<Vec<_>>().join("/"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_list_what_can_be_read() {
        let top = list(Path::new(FOLDER)).expect("a folder");
        assert!(top.contains(&"GAPILib".to_owned()), "{top:?}");
        let inner = Path::new(FOLDER).join("GAPILib");
        let names = list(&inner).expect("a folder");
        assert_eq!(
            names,
            [
                "Basics",
                "Experiment.mo",
                "Free.mo",
                "Impedance",
                "Problem.mo",
                "package.mo",
                "package.order"
            ]
        );
        let text = read(&inner.join("package.mo")).expect("a file");
        assert!(text.starts_with(b"package GAPILib"));
    }

    #[test]
    fn other_folders_are_not_answered_for() {
        assert_eq!(list(Path::new("/models")), None);
        assert_eq!(list(&Path::new(FOLDER).join("Nothing")), None);
        assert_eq!(read(Path::new("gapilib:models/GAPILib/package.mo")), None);
        assert_eq!(read(&Path::new(FOLDER).join("GAPILib")), None);
    }
}
