//! The ways out of the folders that are allowed.

use super::*;
use crate::script::access::policy::refusal_of;

#[test]
fn a_failed_write_leaves_no_files() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let missing = folder.path().join("no such folder").join("file");
    assert!(write_atomically(&missing, b"x").is_err());
    let path = folder.path().join("file");
    write_atomically(&path, b"one").expect("a writable folder");
    write_atomically(&path, b"two").expect("a writable folder");
    assert_eq!(fs::read(&path).expect("the file"), b"two");
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1);
}

#[test]
fn a_run_replaces_what_an_earlier_run_has_made_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path().canonicalize().expect("an absolute path");
    let disk = || {
        let disk = Disk::default();
        disk.grant(Grant::Own(&root.join("results")));
        disk.grant(Grant::Create(&root));
        disk
    };
    fs::write(root.join("thesis.tex"), "mine").expect("written");
    disk().write(&root.join("curve.csv"), b"1").expect("new");
    disk().write(&root.join("curve.csv"), b"2").expect("made by the run before");
    disk().append(&root.join("curve.csv"), b"3").expect("made by the run before");
    let refused = disk().write(&root.join("thesis.tex"), b"x").expect_err("the user's");
    assert_eq!(refusal_of(&refused), Some(Refusal::Existing));
    // Another file of the same name is not the one that the run has made.
    fs::remove_file(root.join("curve.csv")).expect("removed");
    fs::write(root.join("another"), "mine").expect("written");
    fs::rename(root.join("another"), root.join("curve.csv")).expect("renamed");
    assert!(disk().write(&root.join("curve.csv"), b"4").is_err());
    assert!(disk().append(&root.join("curve.csv"), b"4").is_err());
    assert!(disk().remove(&root.join("curve.csv")).is_err());
}

#[cfg(unix)]
mod links {
    use super::*;
    use std::os::unix::fs::symlink;

    /// A folder `run`, in which files may be made, beside a file of the user's.
    fn run() -> (tempfile::TempDir, PathBuf, Disk) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let root = folder.path().canonicalize().expect("an absolute path");
        for made in ["run/results", "private/deep"] {
            fs::create_dir_all(root.join(made)).expect("made");
        }
        fs::write(root.join("private/secret"), "mine").expect("written");
        let disk = Disk::default();
        disk.grant(Grant::Own(&root.join("run/results")));
        disk.grant(Grant::Create(&root.join("run")));
        (folder, root, disk)
    }

    #[test]
    fn the_record_stays_in_the_output_folder_that_was_chosen() {
        let (_folder, root, disk) = run();
        fs::remove_dir(root.join("run/results")).expect("removed");
        symlink(root.join("private"), root.join("run/results")).expect("a link");
        assert!(disk.write(&root.join("run/new.csv"), b"x").is_err());
        assert_eq!(fs::read_dir(root.join("private")).expect("readable").count(), 2);
        assert_eq!(fs::read_dir(root.join("run")).expect("readable").count(), 1);
    }

    #[test]
    fn links_and_dots_lead_nowhere_else() {
        let (_folder, root, disk) = run();
        symlink("../private/deep", root.join("run/d")).expect("a link");
        symlink("../private/secret", root.join("run/results/file")).expect("a link");
        symlink("../../private/new", root.join("run/results/dangling")).expect("a link");
        symlink("round", root.join("run/round")).expect("a link");
        let run = root.join("run");
        for path in ["d/../secret", "results/../../private/secret", "results/../d/../secret"] {
            let refused = disk.read(&run.join(path)).expect_err(path);
            assert_eq!(refusal_of(&refused), Some(Refusal::Reading), "{path}");
            for done in [
                disk.write(&run.join(path), b"x"),
                disk.append(&run.join(path), b"x"),
                disk.remove(&run.join(path)),
                disk.create_folders(&run.join(path)),
            ] {
                assert_eq!(
                    done.as_ref().err().and_then(refusal_of),
                    Some(Refusal::Outside),
                    "{path}"
                );
            }
        }
        symlink("../../private/secret", root.join("run/results/inside")).expect("a link");
        assert!(disk.write(&run.join("results/inside"), b"x").is_err());
        assert!(disk.write(&run.join("results/dangling"), b"x").is_err());
        assert!(disk.create_folders(&run.join("d/new")).is_err());
        assert!(disk.write(&run.join("round"), b"x").is_err());
        assert_eq!(fs::read(root.join("private/secret")).expect("there"), b"mine");
        assert!(!root.join("private/new").exists());
        // The link itself lies in the output folder.
        disk.remove(&run.join("results/inside")).expect("removed");
        assert!(root.join("private/secret").exists());
    }

    #[test]
    fn further_names_of_a_file_do_not_open_it() {
        let (_folder, root, disk) = run();
        fs::hard_link(root.join("private/secret"), root.join("run/results/log")).expect("a link");
        let refused = disk.append(&root.join("run/results/log"), b"x").expect_err("shared");
        assert_eq!(refusal_of(&refused), Some(Refusal::Shared));
        disk.write(&root.join("run/results/log"), b"x").expect("a new file of this name");
        assert_eq!(fs::read(root.join("private/secret")).expect("there"), b"mine");
    }

    #[test]
    fn temporary_names_cannot_be_known() {
        let (_folder, root, disk) = run();
        let foreseen = format!("a.csv.{}.tmp", std::process::id());
        symlink("../../private/secret", root.join("run/results").join(foreseen)).expect("a link");
        disk.write(&root.join("run/results/a.csv"), b"x").expect("written");
        assert_eq!(fs::read(root.join("private/secret")).expect("there"), b"mine");
        let names = [0; 4].map(|_| temporary::temporary_name("a".as_ref()));
        assert!(names.iter().collect::<BTreeSet<_>>().len() == 4, "{names:?}");
    }

    #[test]
    fn what_killed_processes_left_is_removed_and_nothing_else() {
        let (_folder, root, disk) = run();
        let left = |number: u32| root.join(format!("run/a.mat.{number:016x}.gapi-tmp"));
        let old = std::time::SystemTime::now() - std::time::Duration::from_secs(3600);
        let written = |path: &Path| {
            let file = File::create(path).expect("made");
            file.set_modified(old).expect("set");
            file
        };
        written(&left(1));
        let locked = written(&left(2));
        locked.lock().expect("locked");
        fs::write(left(3), "young").expect("written");
        let others = ["run/a.tmp", "run/b.0123456789abcdef.tmp"].map(|name| root.join(name));
        others.iter().for_each(|path| drop(written(path)));
        symlink("../private/secret", left(4)).expect("a link");
        fs::hard_link(root.join("private/secret"), left(5)).expect("a hard link");
        disk.write(&root.join("run/a.mat"), b"x").expect("written");
        assert!(!left(1).exists());
        for path in [2, 3, 5].map(left).iter().chain(&others) {
            assert!(path.exists(), "{}", path.display());
        }
        assert!(left(4).is_symlink() && root.join("private/secret").exists());
    }

    /// As long as the file system allows.
    #[test]
    fn long_names_are_written() {
        let (_folder, root, disk) = run();
        let name = format!("{}.csv", "é".repeat(125));
        disk.write(&root.join("run").join(&name), b"x").expect("written");
    }

    #[test]
    fn pipes_and_devices_are_not_files() {
        let (_folder, root, disk) = run();
        let pipe = root.join("run/results/pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|status| status.success()));
        symlink("/dev/zero", root.join("run/results/zero")).expect("a link");
        symlink("/proc/self/environ", root.join("run/results/environ")).expect("a link");
        disk.grant(Grant::ReadAll);
        for name in ["pipe", "zero", "environ"] {
            let path = root.join("run/results").join(name);
            let refused = disk.read(&path).expect_err(name);
            assert_eq!(refusal_of(&refused), Some(Refusal::System), "{name}");
            assert!(disk.append(&path, b"x").is_err() && disk.write(&path, b"x").is_err());
        }
    }
}
