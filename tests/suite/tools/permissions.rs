//! What scripts and models may do to the disk and to the terminal: the ways around it that were
//! found stay closed.

use crate::support::program::{command, folder, gapi};
use std::fs;
use std::path::Path;

/// A folder with a script, and beside its run folder a file of the user's.
fn home(script: &str) -> tempfile::TempDir {
    let here = folder(&[("job.mos", script), (".profile", "mine"), ("notes.txt", "mine")]);
    fs::write(here.path().join("M.mo"), "model M Real x; equation x = 1; end M;").unwrap();
    here
}

fn text(folder: &tempfile::TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap_or_else(|_| "(missing)".to_owned())
}

/// Each of these does something that a script in a home folder must not do.
#[test]
fn what_belongs_to_the_user_stays_as_it_is() {
    for attack in [
        "Modelica.Utilities.Streams.print(\"evil\", \".profile\")",
        "Modelica.Utilities.Streams.print(\"evil\", \"notes.txt\")",
        "Modelica.Utilities.Streams.print(\"evil\", \"M.mo\")",
        "Modelica.Utilities.Files.removeFile(\"notes.txt\")",
        "Modelica.Utilities.Files.remove(\".profile\")",
        "Modelica.Utilities.Files.copy(\"notes.txt\", \".profile\", true)",
        "Modelica.Utilities.Files.move(\"notes.txt\", \"moved.txt\")",
        "writeFile(\"notes.txt\", \"evil\")",
        "deleteFile(\"notes.txt\")",
        "Modelica.Utilities.Streams.writeRealMatrix(\"notes.txt\", \"m\", [1])",
        "loadString(\"model M Real x = 1; end M;\"); saveModel(\"M.mo\", M)",
    ] {
        let here = home(&format!("{attack};\n"));
        let dialect = if attack.contains("Modelica.") { "dymola" } else { "openmodelica" };
        let (_, out, errors) = gapi(&here, &["run", "job.mos", "--dialect", dialect]);
        assert!(errors.contains("--allow-write"), "{attack}: {out}{errors}");
        for name in [".profile", "notes.txt"] {
            assert_eq!(text(&here, name), "mine", "{attack}");
        }
        assert!(text(&here, "M.mo").starts_with("model M Real x; equation"), "{attack}");
    }
}

#[test]
fn what_the_user_allows_is_done() {
    let script = "Modelica.Utilities.Streams.print(\"more\", \"notes.txt\")\n\
                  Modelica.Utilities.Streams.print(\"model N end N;\", \"N.mo\")\n";
    let here = home(script);
    let (code, _, errors) = gapi(&here, &["run", "job.mos", "--allow-write"]);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(text(&here, "notes.txt"), "minemore\n");
    assert_eq!(text(&here, "N.mo"), "model N end N;\n");
}

/// The same script may run again: it replaces what it has made.
#[test]
fn a_script_replaces_its_own_files() {
    let script = "Modelica.Utilities.Streams.writeRealMatrix(\"made.mat\", \"m\", [1]);\n\
                  Modelica.Utilities.Streams.print(\"line\", \"made.txt\");\n";
    let here = home(script);
    for run in 1..=2 {
        let (code, _, errors) = gapi(&here, &["run", "job.mos"]);
        assert_eq!(code, 0, "run {run}: {errors}");
    }
    assert_eq!(text(&here, "made.txt"), "line\nline\n");
}

/// A model whose end value shows which script has simulated it.
const DECAY: &str = "model D parameter Real k = 1; Real x(start = 1, fixed = true); equation \
                     der(x) = -k*x; end D;";

/// A script that simulates with `k` into `file` and prints the end value that it reads there.
fn simulating(k: i32, file: &str) -> String {
    format!(
        "openModel(\"D.mo\");\nsimulateModel(\"D(k = {k})\", stopTime = 1, resultFile = \"{file}\");\n\
         n = readTrajectorySize(\"{file}\"); x = readTrajectory(\"{file}\", {{\"x\"}}, n);\n\
         print(\"x = \" + String(x[1, n], significantDigits = 4));\n"
    )
}

/// Every Modelica tool replaces its result files, whoever has written them.
#[test]
fn results_of_another_script_are_replaced() {
    for file in ["r.mat", "r.csv"] {
        let here = folder(&[("D.mo", DECAY)]);
        for (name, k, expected) in [("a", 1, "x = 0.36"), ("b", 2, "x = 0.13")] {
            let script = format!("{name}.mos");
            fs::write(here.path().join(&script), simulating(k, file)).unwrap();
            for out in ["one", "two"] {
                let (code, text, errors) =
                    gapi(&here, &["run", &script, "--out", out, "--overwrite"]);
                assert!(code == 0 && text.contains(expected), "{file} {name}: {text}{errors}");
            }
        }
    }
}

/// What a simulation would have written is not read from a file that it did not write.
#[test]
fn a_refused_or_failed_simulation_is_not_followed_by_older_results() {
    let data = "time,x\n0,7\n1,7\n";
    let here = folder(&[("D.mo", DECAY), ("r.csv", data), ("a.mos", &simulating(1, "r.csv"))]);
    let (code, out, errors) = gapi(&here, &["run", "a.mos"]);
    assert!(code == 1 && errors.contains("this run did not create it"), "{out}{errors}");
    assert!(
        errors.contains("older than this script expects") && !out.contains("x = "),
        "{out}{errors}"
    );
    assert_eq!(text(&here, "r.csv"), data);
    let failing = simulating(1, "r.mat")
        + &simulating(2, "r.mat")
            .replace("D(k = 2)", "D(no = 2)")
            .replace("n = ", "m = ")
            .replace("; x = ", "; y = ")
            .replace("n);", "m);")
            .replace("x[1, n]", "y[1, m]");
    fs::write(here.path().join("b.mos"), failing).unwrap();
    let (code, out, errors) = gapi(&here, &["run", "b.mos"]);
    assert!(code == 1 && out.matches("x = ").count() == 1, "{out}{errors}");
    assert!(errors.contains("the simulation that writes it failed"), "{out}{errors}");
}

/// Scripts generate scripts and models; build systems and interpreters execute other files by their
/// names alone.
#[test]
fn scripts_create_the_kinds_of_files_that_scripts_write() {
    let print = |name: &str| format!("Modelica.Utilities.Streams.print(\"x = 1;\", \"{name}\");\n");
    let new = ["sweep.mos", "N.mo", "log.txt", "d.csv", "a.svg", "t.tex", "results/job/Makefile"];
    let script: String = new.iter().map(|name| print(name)).collect();
    let here = home(&(script + "RunScript(\"sweep.mos\");\n"));
    let (code, _, errors) = gapi(&here, &["run", "job.mos"]);
    assert_eq!(code, 0, "{errors}");
    assert!(new.iter().all(|name| text(&here, name) == "x = 1;\n"), "{errors}");
    for name in ["Makefile", "conftest.py", "sitecustomize.py", "CMakeLists.txt", "a/package.mo"] {
        let here = home(&print(name));
        let (code, _, errors) = gapi(&here, &["run", "job.mos"]);
        assert!(code == 1 && errors.contains("write it to the output folder"), "{name}: {errors}");
        assert_eq!(text(&here, name), "(missing)");
    }
}

#[test]
fn secrets_outside_are_not_read() {
    let elsewhere = folder(&[("secret.txt", "a secret")]);
    let secret = elsewhere.path().join("secret.txt").display().to_string();
    for path in [secret.as_str(), "/proc/self/environ", "/dev/zero", "/sys/kernel/uevent_seqnum"] {
        let here = home(&format!("print(readFile(\"{path}\"));\n"));
        let (code, out, errors) = gapi(&here, &["run", "job.mos", "--dialect", "openmodelica"]);
        assert!(code == 1 && errors.contains("refused-command"), "{path}: {out}{errors}");
        assert!(!out.contains("secret") && !out.contains("PATH="), "{out}");
    }
    let here = home(&format!("print(readFile(\"{secret}\"));\n"));
    let (.., errors) = gapi(&here, &["run", "job.mos", "--dialect", "openmodelica"]);
    let folder = format!("`--allow-read={}`", elsewhere.path().display());
    assert!(errors.contains(&folder), "{errors}");
    let folder = format!("--allow-read={}", elsewhere.path().display());
    for allowed in ["--allow-read", &folder] {
        let (code, out, errors) =
            gapi(&here, &["run", "job.mos", "--dialect", "openmodelica", allowed]);
        assert!(code == 0 && out.contains("a secret"), "{out}{errors}");
    }
    let here = home("print(readFile(\"/proc/self/environ\"));\n");
    let (code, out, _) =
        gapi(&here, &["run", "job.mos", "--dialect", "openmodelica", "--allow-read"]);
    assert!(code == 1 && !out.contains("PATH="), "{out}");
}

/// A link `d` makes `d/../x` another place than `x`.
#[cfg(unix)]
#[test]
fn links_lead_nowhere_else() {
    for attack in [
        "Modelica.Utilities.Streams.print(\"evil\", \"d/../x\")",
        "Modelica.Utilities.Streams.print(\"evil\", \"d/x\")",
        "Modelica.Utilities.Files.createDirectory(\"d/../x\")",
        "Modelica.Utilities.Files.removeFile(\"d/../kept\")",
        "Modelica.Utilities.Streams.writeRealMatrix(\"d/../x.mat\", \"m\", [1])",
        "simulateModel(\"M\", resultFile = \"d/../x\")",
    ] {
        let here = home(&format!("openModel(\"M.mo\");\n{attack};\n"));
        let outside = folder(&[("kept", "mine")]);
        fs::create_dir(outside.path().join("deep")).unwrap();
        std::os::unix::fs::symlink(outside.path().join("deep"), here.path().join("d")).unwrap();
        gapi(&here, &["run", "job.mos", "--dialect", "dymola"]);
        let mut names: Vec<_> =
            fs::read_dir(outside.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        assert_eq!(names, ["deep", "kept"], "{attack}");
        assert_eq!(fs::read_dir(outside.path().join("deep")).unwrap().count(), 0, "{attack}");
    }
}

/// Models print into files, too.
#[test]
fn models_change_nothing_of_the_users() {
    let model = "model W Real x(start = 0, fixed = true); equation der(x) = 1; when time > 0.5 then \
                 Modelica.Utilities.Streams.print(\"evil\", \".bashrc\"); \
                 Modelica.Utilities.Streams.print(\"evil\", \"notes.txt\"); end when; end W;";
    let here = folder(&[("W.mo", model), (".bashrc", "mine"), ("notes.txt", "mine")]);
    let (code, _, errors) = gapi(&here, &["simulate", "W.mo"]);
    assert!(code == 1 && errors.contains("--allow-write"), "{errors}");
    assert_eq!((text(&here, ".bashrc"), text(&here, "notes.txt")), ("mine".into(), "mine".into()));
    let (code, _, errors) = gapi(&here, &["simulate", "W.mo", "--allow-write"]);
    assert_eq!(code, 0, "{errors}");
    assert_eq!(text(&here, ".bashrc"), "mineevil\n");
}

/// What the command line names is allowed, and replaced.
#[test]
fn what_the_command_line_names_is_written() {
    let here = home("1 + 1\n");
    let elsewhere = folder(&[("out.csv", "old"), ("log.txt", "old")]);
    let path = |name: &str| elsewhere.path().join(name).display().to_string();
    let (code, _, errors) = gapi(&here, &["simulate", "M.mo", "--output", &path("out.csv")]);
    assert_eq!(code, 0, "{errors}");
    assert!(text(&elsewhere, "out.csv").starts_with("\"time\""));
    let (code, _, errors) = gapi(&here, &["run", "job.mos", "--transcript", &path("log.txt")]);
    assert_eq!(code, 0, "{errors}");
    assert!(text(&elsewhere, "log.txt").contains("1 + 1"));
    #[cfg(unix)]
    {
        let (code, _, errors) = gapi(&here, &["simulate", "M.mo", "--output", "/dev/null"]);
        assert!(code == 0 || errors.contains("format"), "{errors}");
    }
}

/// A terminal carries out what stands in a diagnostic's message and source line.
#[test]
fn diagnostics_carry_no_commands_to_the_terminal() {
    let here =
        home("x = \"\u{1b}]52;c;ZXZpbA==\u{7}\" + nothing(\"\u{9b}2J\");\nerror(\"\u{1b}[2J\");\n");
    for colour in ["never", "always"] {
        let (_, _, errors) = gapi(&here, &["run", "job.mos", "--color", colour]);
        assert!(!errors.contains("\u{1b}]") && !errors.contains('\u{9b}'), "{errors:?}");
        assert!(!errors.contains("\u{1b}[2J") && !errors.contains('\u{7}'), "{errors:?}");
        assert!(errors.contains("␛]52") && errors.contains("␛[2J"), "{errors}");
    }
}

/// Names of files reach messages as well.
#[test]
fn names_of_files_carry_no_commands() {
    let here = home("");
    let (_, _, errors) = gapi(&here, &["run", "\u{1b}[2Jmissing.mos"]);
    assert!(!errors.contains('\u{1b}') && errors.contains("␛[2J"), "{errors:?}");
    assert!(!Path::new("\u{1b}[2Jmissing.mos").exists());
}

/// Whether there is a file is not told of those that may not be read.
/// A file, a folder, what a file cannot contain, links that go round: all are as if they were absent.
#[cfg(unix)]
#[test]
fn what_exists_outside_is_not_told() {
    let elsewhere = folder(&[("secret.txt", "a secret")]);
    std::fs::create_dir(elsewhere.path().join("inner.d")).unwrap();
    std::os::unix::fs::symlink("round.d", elsewhere.path().join("round.d")).unwrap();
    let outside = elsewhere.path().display();
    let allowed = regex::Regex::new("--allow-read=[^`]*").unwrap();
    for question in [
        "regularFileExists(\"PATH\")",
        "directoryExists(\"PATH\")",
        "Modelica.Utilities.Files.exist(\"PATH\")",
        "readFile(\"PATH\")",
        "readFile(\"PATH/x\")",
        "Modelica.Utilities.Files.remove(\"PATH\")",
        "Modelica.Utilities.Files.removeFile(\"PATH\")",
        "Modelica.Utilities.Files.copy(\"notes.txt\", \"PATH\")",
        "Modelica.Utilities.Files.createDirectory(\"PATH\")",
        "print(Modelica.Utilities.Files.loadResource(\"PATH\"))",
        "Modelica.Utilities.Streams.print(\"a\", \"PATH\")",
        "Modelica.Utilities.Streams.writeRealMatrix(\"PATH\", \"a\", [1], true)",
        "Modelica.Utilities.Streams.readRealMatrix(\"PATH\", \"a\", 1, 1)",
        "openModel(\"PATH\")",
        "uriToFilename(\"file://PATH\")",
        "loadFile(\"PATH\")",
        "mkdir(\"PATH\")",
        "writeFile(\"PATH\", \"a\")",
        "cd(\"PATH/..\")",
        "cd(\"PATH\")",
        "runScript(\"PATH\")",
        "runScript(\"PATH.mos\")",
    ] {
        let dialect = if question.contains("Modelica.") { "dymola" } else { "openmodelica" };
        let mut answers = Vec::new();
        for name in ["absent.txt", "secret.txt", "inner.d", "secret.txt/x", "round.d"] {
            if question.contains("PATH/..") && name.contains('/') {
                continue;
            }
            let here =
                home(&format!("{};\n", question.replace("PATH", &format!("{outside}/{name}"))));
            let (code, out, errors) = gapi(&here, &["run", "job.mos", "--dialect", dialect]);
            assert!(code == 1 && errors.contains("--allow-"), "{question}: {out}{errors}");
            let own = here.path().display().to_string();
            // The folder to allow is that of the name, whether it exists or not.
            let said = out + &errors;
            let said = allowed.replace_all(&said, "--allow-read=FOLDER");
            let said = said.replace(name, "NAME").replace(&own, "HERE");
            answers.push(said.replace(['^', '~'], ""));
        }
        for answer in &answers[1..] {
            assert_eq!(answer, &answers[0], "{question}");
        }
    }
    // Folders that the run lies in are known to be there.
    let here = home("print(String(directoryExists(\"..\")))\n");
    let (code, out, errors) = gapi(&here, &["run", "job.mos", "--dialect", "openmodelica"]);
    assert!(code == 0 && out.contains("true"), "{out}{errors}");
}

/// What `lesson`, `teach` and `test` write goes the way of all files: whole or not at all, and not
/// into what is neither a file nor named as a device.
#[cfg(unix)]
#[test]
fn all_commands_write_whole_files() {
    use std::os::unix::fs::MetadataExt as _;
    let here = home("1 + 1\n");
    fs::write(here.path().join("report.xml"), "old").unwrap();
    let before = fs::metadata(here.path().join("report.xml")).unwrap().ino();
    let (_, out, errors) = gapi(&here, &["test", "job.mos", "--junit", "report.xml", "--accept"]);
    assert!(text(&here, "report.xml").contains("<testsuite"), "{out}{errors}");
    let after = fs::metadata(here.path().join("report.xml")).unwrap().ino();
    assert_ne!(before, after, "a new file takes the name when it is whole");
    assert!(text(&here, "job.mos.snap").contains("[exit code 0]"), "{out}{errors}");
    let (code, _, errors) = gapi(&here, &["test", "job.mos", "--junit", "/dev/null"]);
    assert_eq!(code, 0, "{errors}");
    let (code, _, errors) = gapi(&here, &["test", "job.mos", "--junit", "nowhere/report.xml"]);
    assert!(code == 1 && errors.contains("nowhere/report.xml"), "{errors}");
}

/// The guide lists the kinds of files and the exceptions that the program knows.
#[test]
fn the_guide_lists_the_files_that_scripts_create() {
    use gapilib::internals::script::access::policy::{EXCEPTIONS, KINDS};
    let guide = include_str!("../../../docs/src/permissions.md");
    for (kind, endings) in KINDS {
        let listed: Vec<String> = endings.iter().map(|ending| format!("`.{ending}`")).collect();
        let row = format!("| {kind} | {} |", listed.join(", "));
        assert!(guide.contains(&row), "{row}");
    }
    let listed: Vec<String> = EXCEPTIONS.iter().map(|name| format!("`{name}`")).collect();
    assert!(guide.contains(&listed.join(", ")), "{listed:?}");
}

/// Secrets have all names there are: only what is known to hold none is read unasked.
#[test]
fn environment_variables_are_read_by_name() {
    let names = ["DATABASE_URL", "MYSQL_PWD", "GH_PAT", "SLACK_WEBHOOK", "home"];
    let run = |name: &str, more: &[&str]| {
        let here = home(&format!("print(\"<\" + getEnvironmentVar(\"{name}\") + \">\");\n"));
        let arguments = [&["run", "job.mos", "--dialect", "openmodelica"], more].concat();
        let mut command = command(here.path(), &arguments);
        names.iter().for_each(|name| {
            command.env(name, "s3cret");
        });
        let output = command.env("MODELICAPATH", "/libraries").output().unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        (output.status.code(), text(output.stdout), text(output.stderr))
    };
    for name in &names[..4] {
        let (code, out, errors) = run(name, &[]);
        assert!(
            code == Some(1) && errors.contains(&format!("--allow-env={name}")),
            "{out}{errors}"
        );
        assert!(!out.contains("s3cret") && !errors.contains("s3cret"), "{out}{errors}");
        let (code, out, errors) = run(name, &[&format!("--allow-env={name}")]);
        assert!(code == Some(0) && out.contains("<s3cret>"), "{out}{errors}");
    }
    let (code, out, errors) = run("MODELICAPATH", &[]);
    assert!(code == Some(0) && out.contains("</libraries>"), "{out}{errors}");
    let (code, out, errors) = run("NOT_SET_ANYWHERE", &[]);
    assert!(code == Some(0) && out.contains("<>"), "{out}{errors}");
}

#[test]
fn folders_are_excluded_whatever_else_is_allowed() {
    let here = home("print(readFile(\"private/a.txt\"));\nwriteFile(\"private/b.txt\", \"x\");\n");
    fs::create_dir(here.path().join("private")).unwrap();
    fs::write(here.path().join("private/a.txt"), "a secret").unwrap();
    let base = ["run", "job.mos", "--dialect", "openmodelica"];
    let (code, out, errors) = gapi(&here, &base);
    assert!(code == 0 && out.contains("a secret"), "{out}{errors}");
    fs::remove_file(here.path().join("private/b.txt")).unwrap();
    let denied = ["--deny-read=private", "--allow-read", "--allow-write"];
    let (code, out, errors) = gapi(&here, &[&base[..], &denied].concat());
    assert!(code == 1 && errors.contains("closed to scripts and models"), "{out}{errors}");
    assert!(!out.contains("a secret") && text(&here, "private/b.txt") == "(missing)", "{out}");
}

/// The list says what holds, and nothing is done.
#[test]
fn permissions_are_listed() {
    let here = home("writeFile(\"new.txt\", \"x\");\n");
    let arguments = ["run", "job.mos", "--show-permissions", "--allow-env=MINE", "--deny-read=a"];
    let (code, out, errors) = gapi(&here, &arguments);
    assert_eq!(code, 0, "{errors}");
    let folder = here.path().canonicalize().unwrap();
    let path = folder.display();
    let squeezed: Vec<String> =
        out.lines().map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")).collect();
    for row in [
        format!("read, create new files {path}"),
        format!("read, create, replace, remove {path}/results/job"),
        format!("closed {path}/a"),
        "functions in C none".to_owned(),
        "start programs none".to_owned(),
    ] {
        assert!(squeezed.contains(&row), "{row}: {out}");
    }
    assert!(out.contains("OPENMODELICAHOME") && out.contains("MINE"), "{out}");
    assert_eq!(text(&here, "new.txt"), "(missing)");
    let (code, _, errors) = gapi(&here, &["test", "job.mos", "--show-permissions"]);
    assert!(code == 2 && errors.contains("--show-permissions"), "{errors}");
}

#[test]
fn check_shows_where_libraries_come_from() {
    let here = home("");
    fs::create_dir(here.path().join("models")).unwrap();
    fs::write(here.path().join("models/P.mo"), "package P constant Real k = 2; end P;").unwrap();
    fs::write(here.path().join("N.mo"), "model N Modelica.Units.SI.Time t = P.k; end N;").unwrap();
    let (code, out, errors) = gapi(&here, &["check", "N.mo", "--model", "N", "-v"]);
    assert_eq!(code, 0, "{errors}");
    assert!(out.contains("`Modelica` is part of gapi"), "{out}");
    assert!(out.contains("`P` is loaded from `") && out.contains("models/P.mo`"), "{out}");
}

/// Who can see a file can know its number and birth: a record that comes with a script gives no access
/// to it.
#[test]
#[cfg(unix)]
fn a_record_of_a_stranger_opens_nothing() {
    use std::os::unix::fs::MetadataExt as _;
    let elsewhere = folder(&[("secret.txt", "a secret")]);
    let secret = elsewhere.path().canonicalize().unwrap().join("secret.txt");
    let found = fs::metadata(&secret).unwrap();
    let Ok(birth) = found.created() else { return };
    let nanos = birth.duration_since(std::time::UNIX_EPOCH).unwrap().as_nanos();
    let path = secret.display();
    let here = home(&format!("print(readFile(\"{path}\"));\nwriteFile(\"{path}\", \"evil\");\n"));
    fs::create_dir_all(here.path().join("results/job")).unwrap();
    let origin = "{\n  \"command\": \"gapi run\",\n  \"input\": \"../../job.mos\"\n}\n";
    fs::write(here.path().join("results/job/origin.json"), origin).unwrap();
    let record = format!("{} {nanos} {path}\n", found.ino());
    fs::write(here.path().join("results/job/files_made.txt"), record).unwrap();
    let (code, out, errors) = gapi(&here, &["run", "job.mos", "--dialect", "openmodelica"]);
    assert!(code == 1 && !out.contains("a secret"), "{out}{errors}");
    assert_eq!(text(&elsewhere, "secret.txt"), "a secret");
}

/// The name of a script does not choose the output folder.
#[test]
fn a_script_of_dots_owns_nothing_else() {
    let here = folder(&[("notes.txt", "mine")]);
    let script = "Modelica.Utilities.Streams.print(\"evil\", \"notes.txt\");\n";
    let origin = "{\n  \"command\": \"gapi run\",\n  \"input\": \"...mos\"\n}\n";
    for name in ["...mos", "..mos", "....mos"] {
        fs::write(here.path().join(name), script).unwrap();
        fs::write(here.path().join("origin.json"), origin.replace("...mos", name)).unwrap();
        let (code, _, errors) = gapi(&here, &["run", name]);
        assert!(code == 1 && errors.contains("--allow-write"), "{name}: {errors}");
        assert_eq!(text(&here, "notes.txt"), "mine", "{name}");
    }
}

/// Functions without outputs are called for what they do, at events alone, too.
#[test]
fn a_model_makes_and_removes_at_an_event() {
    for call in ["createDirectory", "removeFile", "remove"] {
        let model = format!(
            "model M Real x(start = 1, fixed = true); equation der(x) = -x; when time > 0.5 then \
             Modelica.Utilities.Files.{call}(\"made\"); end when; end M;"
        );
        let here = folder(&[("M.mo", &model)]);
        let (code, out, errors) = gapi(&here, &["simulate", "M.mo", "--output", "m.csv"]);
        assert_eq!(code, 0, "{call}: {out}{errors}");
        assert_eq!(here.path().join("made").is_dir(), call == "createDirectory");
    }
}
