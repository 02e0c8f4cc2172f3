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

/// What a run that starts in this folder may do.
fn next_run(root: &Path) -> Disk {
    let disk = Disk::default();
    disk.grant(Grant::Own(&root.join("results")));
    disk.grant(Grant::Create(root));
    disk
}

#[test]
fn a_run_replaces_what_an_earlier_run_has_made_and_nothing_else() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path().canonicalize().expect("an absolute path");
    let disk = || next_run(&root);
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

/// Each time that a file is written has a line in the record, until there are too many.
#[test]
fn the_record_does_not_grow_without_end() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let root = folder.path().canonicalize().expect("an absolute path");
    let disk = || next_run(&root);
    let (first, path) = (disk(), root.join("curve.csv"));
    for number in 0..1100 {
        let text = number.to_string();
        first.write_with(&path, &mut |to| to.write_all(text.as_bytes())).expect("its own");
    }
    let record = fs::read_to_string(root.join("results").join(RECORD)).expect("a record");
    assert!(record.lines().count() < 200, "{} lines", record.lines().count());
    disk().write(&path, b"again").expect("made by the run before");
}

#[test]
fn files_found_in_a_folder_lie_in_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (inside, file) = (folder.path().join("in"), folder.path().join("in/a.mos"));
    fs::create_dir(&inside).expect("made");
    fs::write(&file, "1").expect("written");
    fs::write(folder.path().join("out.mos"), "1").expect("written");
    assert!(is_file_in(&inside, &file));
    assert!(!is_file_in(&inside, &inside) && !is_file_in(&inside, &inside.join("absent.mos")));
    assert!(!is_file_in(&inside, &folder.path().join("out.mos")));
    #[cfg(unix)]
    for (target, name, is_inside) in [("a.mos", "near", true), ("../out.mos", "far", false)] {
        std::os::unix::fs::symlink(target, inside.join(name)).expect("a link");
        assert_eq!(is_file_in(&inside, &inside.join(name)), is_inside, "{name}");
    }
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

    /// Why a path cannot be resolved is known only to those who may know what is there.
    #[test]
    fn paths_that_end_too_early_tell_nothing() {
        let (_folder, root, disk) = run();
        symlink("round", root.join("run/results/round")).expect("a link");
        symlink("round", root.join("private/round")).expect("a link");
        symlink("../private", root.join("run/p")).expect("a link");
        disk.write(&root.join("run/results/file"), b"x").expect("written");
        let kind = |error: io::Error| (refusal_of(&error), error.kind());
        let (none, not_a_folder) = (None, io::ErrorKind::NotADirectory);
        let inside = |name: &str| root.join("run/results").join(name);
        let round = disk.read(&inside("round")).expect_err("a loop");
        assert_eq!(refusal_of(&round), None, "{round}");
        for done in [
            disk.read(&inside("file/x")).map(drop),
            disk.write(&inside("file/x"), b"x"),
            disk.create_folders(&inside("file")),
        ] {
            assert_eq!(done.map_err(kind), Err((none, not_a_folder)));
        }
        for name in ["secret/x", "round", "round/x", "absent/x", "secret/../absent", "absent"] {
            for place in ["private", "run/p"] {
                let path = root.join(place).join(name);
                let read = disk.read(&path).expect_err("outside");
                assert_eq!(refusal_of(&read), Some(Refusal::Reading), "{}", path.display());
                for done in
                    [disk.write(&path, b"x"), disk.append(&path, b"x"), disk.create_folders(&path)]
                {
                    let refusal = done.map_err(|error| refusal_of(&error));
                    assert_eq!(refusal, Err(Some(Refusal::Outside)), "{}", path.display());
                }
            }
        }
        let existing = disk.create_folders(&root.join("private/deep")).expect_err("outside");
        assert_eq!(refusal_of(&existing), Some(Refusal::Outside));
        disk.create_folders(&root.join("run/results")).expect("it is there");
    }

    #[test]
    fn folders_and_what_is_missing_are_not_written_over() {
        let (_folder, root, disk) = run();
        let inside = |name: &str| root.join("run/results").join(name);
        disk.create_folders(&inside("sub/below")).expect("made");
        let over = disk.write(&inside("sub"), b"x").expect_err("a folder");
        assert_eq!(over.kind(), io::ErrorKind::IsADirectory);
        for done in [
            disk.write(&inside("absent/x"), b"x"),
            disk.append(&inside("absent/x"), b"x"),
            disk.remove(&inside("absent/x")),
            disk.read(&inside("sub/../absent/../x")).map(drop),
        ] {
            assert_eq!(done.map_err(|error| error.kind()), Err(io::ErrorKind::NotFound));
        }
        assert!(disk.remove(&inside("sub")).is_err(), "it is not empty");
        disk.remove(&inside("sub/below")).expect("empty");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_larger_than_the_memory_is_not_read() {
        let (_folder, root, disk) = run();
        let path = root.join("run/results/large");
        File::create(&path).and_then(|file| file.set_len(1 << 42)).expect("sparse");
        let refused = disk.read(&path).expect_err("4 TiB");
        assert_eq!(refused.to_string(), "it is larger than the memory of this machine");
        assert_eq!(disk.read_start(&path, 3).expect("its beginning"), [0; 3]);
    }

    #[test]
    fn devices_are_written_where_the_user_names_them() {
        let (_folder, _, disk) = run();
        let null = Path::new("/dev/null");
        assert!(disk.append(null, b"x").is_err() && disk.write(null, b"x").is_err());
        disk.grant(Grant::Named(null));
        disk.append(null, b"x").expect("named");
        disk.write(null, b"x").expect("named");
        assert!(disk.permits(null, Access::Write).is_ok());
        assert!(disk.write(Path::new("/dev/full"), b"x").is_err());
    }

    /// `-o figure.svg` in a stranger's folder: a link of this name reaches nothing outside, there or not.
    #[test]
    fn an_output_that_is_named_does_not_follow_a_link_out_of_its_folder() {
        let (_folder, root, disk) = run();
        for (name, target) in [("a.svg", "../private/secret"), ("b.svg", "../private/new")] {
            let link = root.join("run").join(name);
            symlink(target, &link).expect("a link");
            disk.grant(Grant::Named(&link));
            let refused =
                [disk.write(&link, b"x"), disk.append(&link, b"x"), write_named(&link, b"x")];
            for refused in refused {
                assert_eq!(refused.map_err(|e| refusal_of(&e)), Err(Some(Refusal::NamedLink)));
            }
        }
        assert_eq!(fs::read(root.join("private/secret")).expect("there"), b"mine");
        assert!(!root.join("private/new").exists());
        let within = root.join("run/c.svg");
        symlink("d.svg", &within).expect("a link");
        disk.grant(Grant::Named(&within));
        disk.write(&within, b"x").expect("in the same folder");
        assert_eq!(fs::read(root.join("run/d.svg")).expect("there"), b"x");
    }

    #[test]
    fn files_of_the_program_replace_links() {
        let (_folder, root, _) = run();
        let link = root.join("run/results/report.html");
        symlink("../../private/secret", &link).expect("a link");
        write_own(&link, b"own").expect("written");
        assert!(!link.is_symlink());
        fs::remove_file(&link).expect("removed");
        symlink("../../private/secret", &link).expect("a link");
        write_beside(&link, b"beside").expect("written");
        assert_eq!(fs::read(&link).expect("there"), b"beside");
        assert_eq!(fs::read(root.join("private/secret")).expect("there"), b"mine");
    }
}
