//! Functional mock-up units of others, as a user meets them: `tests/fmus/unit.c`, compiled here.
//! Without a C compiler the tests that need one say so and pass.
//!
//! `GAPILIB_REFERENCE_FMUS` names a folder with the Reference-FMUs (`3/VanDerPol.fmu`,
//! `VanDerPol/VanDerPol_out.csv`); their expected outputs are those of the explicit Euler method.

use crate::support::program::{command, folder, gapi};
use gapilib::internals::fmi::Archive;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// Faults of the unit, by the numbers that `unit.c` gives them.
const CRASH: u32 = 1;
const HANG: u32 = 2;
const REPORT: u32 = 3;
const REFUSE: u32 = 4;
const LEAVE: u32 = 5;
const PRINT: u32 = 6;
const NOT_A_NUMBER: u32 = 7;
const WRITE: u32 = 8;
const NO_OUTPUT: u32 = 9;
const END: u32 = 10;
const AWAY: u32 = 11;
const STAY: u32 = 12;

/// The folder of binaries for this machine, by version.
pub(super) fn platform(version: u8) -> Option<&'static str> {
    match (version, cfg!(all(target_os = "linux", target_arch = "x86_64"))) {
        (2, true) => Some("linux64"),
        (3, true) => Some("x86_64-linux"),
        _ => None,
    }
}

/// The compiled library; `None`, said, where there is no compiler or the tests do not know the machine.
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn library(version: u8, here: &Path) -> Option<Vec<u8>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmus/unit.c");
    let object = here.join("unit.so");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let compiled = platform(version).is_some()
        && Command::new(compiler)
            .args(["-O1", "-shared", "-fPIC", &format!("-DFMI={version}"), "-o"])
            .args([&object, &source])
            .arg("-lm")
            .status()
            .is_ok_and(|status| status.success());
    if !compiled {
        eprintln!("skipped: there is no C compiler for a unit of this machine");
        return None;
    }
    let bytes = fs::read(&object).expect("a library");
    fs::remove_file(object).expect("removed");
    Some(bytes)
}

const DESCRIPTION_3: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="unit" instantiationToken="{unit}">
  <ModelExchange modelIdentifier="unit" needsCompletedIntegratorStep="true"/>
  <CoSimulation modelIdentifier="unit" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions><Unit name="1/s"/><Unit name="V"/></UnitDefinitions>
  <DefaultExperiment startTime="0" stopTime="2" stepSize="0.1" tolerance="1e-8"/>
  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous"/>
    <Float64 name="x0" valueReference="1" causality="parameter" variability="fixed" initial="exact" start="1"/>
    <Float64 name="x" valueReference="2" causality="local" variability="continuous" initial="calculated"/>
    <Float64 name="der(x)" valueReference="3" causality="local" variability="continuous" derivative="2"/>
    <Float64 name="k" valueReference="4" causality="parameter" variability="tunable" start="1" unit="1/s" min="0"/>
    <Float64 name="u" valueReference="5" causality="input" variability="continuous" start="0"/>
    <Float64 name="y" valueReference="6" causality="output" variability="continuous" unit="V"/>
    <Float64 name="jump" valueReference="7" causality="parameter" variability="fixed" start="0"/>
    <Float64 name="threshold" valueReference="8" causality="parameter" variability="fixed" start="-1e300"/>
    <Int32 name="n" valueReference="9" causality="output" variability="discrete"/>
    <Int32 name="fault" valueReference="10" causality="parameter" variability="fixed" start="0"/>
    <UInt64 name="m" valueReference="11" causality="structuralParameter" variability="fixed" start="2"/>
    <Float64 name="c" valueReference="12" causality="parameter" variability="fixed" start="1 0">
      <Dimension valueReference="11"/>
    </Float64>
    <String name="label" valueReference="13" causality="parameter" variability="fixed"><Start value=""/></String>
    <Boolean name="gain_on" valueReference="14" causality="parameter" variability="fixed" start="true"/>
    <Float64 name="w" valueReference="15" causality="output" variability="continuous"/>
  </ModelVariables>
  <ModelStructure>
    <Output valueReference="6"/>
    <Output valueReference="9"/>
    <Output valueReference="15"/>
    <ContinuousStateDerivative valueReference="3" dependencies="2 5"/>
    <EventIndicator valueReference="2"/>
  </ModelStructure>
</fmiModelDescription>
"#;

const DESCRIPTION_2: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="unit" guid="{unit}" numberOfEventIndicators="1">
  <ModelExchange modelIdentifier="unit"/>
  <CoSimulation modelIdentifier="unit" canHandleVariableCommunicationStepSize="true"/>
  <UnitDefinitions><Unit name="1/s"/><Unit name="V"/></UnitDefinitions>
  <DefaultExperiment startTime="0" stopTime="2" stepSize="0.1" tolerance="1e-8"/>
  <ModelVariables>
    <ScalarVariable name="x0" valueReference="1" causality="parameter" variability="fixed" initial="exact"><Real start="1"/></ScalarVariable>
    <ScalarVariable name="x" valueReference="2" initial="calculated"><Real/></ScalarVariable>
    <ScalarVariable name="der(x)" valueReference="3"><Real derivative="2"/></ScalarVariable>
    <ScalarVariable name="k" valueReference="4" causality="parameter" variability="tunable"><Real start="1" unit="1/s" min="0"/></ScalarVariable>
    <ScalarVariable name="u" valueReference="5" causality="input"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="y" valueReference="6" causality="output"><Real unit="V"/></ScalarVariable>
    <ScalarVariable name="jump" valueReference="7" causality="parameter" variability="fixed"><Real start="0"/></ScalarVariable>
    <ScalarVariable name="threshold" valueReference="8" causality="parameter" variability="fixed"><Real start="-1e300"/></ScalarVariable>
    <ScalarVariable name="n" valueReference="9" causality="output" variability="discrete"><Integer/></ScalarVariable>
    <ScalarVariable name="fault" valueReference="10" causality="parameter" variability="fixed"><Integer start="0"/></ScalarVariable>
    <ScalarVariable name="label" valueReference="13" causality="parameter" variability="fixed"><String start=""/></ScalarVariable>
    <ScalarVariable name="gain_on" valueReference="14" causality="parameter" variability="fixed"><Boolean start="true"/></ScalarVariable>
    <ScalarVariable name="w" valueReference="15" causality="output"><Real/></ScalarVariable>
  </ModelVariables>
  <ModelStructure>
    <Outputs><Unknown index="6"/><Unknown index="9"/><Unknown index="13"/></Outputs>
    <Derivatives><Unknown index="3" dependencies="2 5"/></Derivatives>
  </ModelStructure>
</fmiModelDescription>
"#;

fn description(version: u8) -> &'static str {
    if version == 2 { DESCRIPTION_2 } else { DESCRIPTION_3 }
}

fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = Archive::new();
    files.iter().for_each(|(path, content)| archive.insert(*path, *content));
    archive.to_bytes().expect("an archive")
}

/// A folder with `unit.fmu`.
fn with_unit(version: u8) -> Option<TempDir> {
    with_description(version, description(version))
}

/// The same with another description.
fn with_description(version: u8, description: &str) -> Option<TempDir> {
    let here = folder(&[]);
    let library = library(version, here.path())?;
    let path = format!("binaries/{}/unit.so", platform(version)?);
    let bytes = archive(&[("modelDescription.xml", description.as_bytes()), (&path, &library)]);
    fs::write(here.path().join("unit.fmu"), bytes).expect("written");
    Some(here)
}

/// The columns of the results of a simulation.
pub(super) fn simulated(here: &TempDir, more: &[&str]) -> Vec<(String, Vec<f64>)> {
    let base = ["simulate", "unit.fmu", "--allow-external=unit.fmu", "--output", "r.csv"];
    let (code, _, errors) = gapi(here, &[&base, more].concat());
    assert_eq!(code, 0, "{errors}");
    columns(&here.path().join("r.csv"))
}

pub(super) fn columns(path: &Path) -> Vec<(String, Vec<f64>)> {
    let mut csv = csv::Reader::from_path(path).expect("results");
    let names = csv.headers().expect("a header").clone();
    let name = |text: &str| text.split(" [").next().unwrap_or_default().to_owned();
    let mut all: Vec<(String, Vec<f64>)> =
        names.iter().map(|text| (name(text), Vec::new())).collect();
    for row in csv.records() {
        let row = row.expect("readable");
        all.iter_mut().zip(&row).for_each(|((_, column), text)| {
            column.push(text.parse().unwrap_or(f64::NAN));
        });
    }
    all
}

pub(super) fn column<'c>(all: &'c [(String, Vec<f64>)], name: &str) -> &'c [f64] {
    let found = all.iter().find(|(known, _)| known == name);
    &found.unwrap_or_else(|| panic!("no `{name}`")).1
}

pub(super) fn near(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} instead of {expected}");
}

/// Integrators come back to a point: for indicators, for a Jacobian, for a row of the results. Nothing is set or
/// asked for twice there, and the results are the exact ones.
#[test]
fn a_unit_is_asked_once_at_a_point() {
    let repeats = |version: u8| match version {
        2 => "<ScalarVariable name=\"repeats\" valueReference=\"17\"><Real/></ScalarVariable>",
        _ => "<Float64 name=\"repeats\" valueReference=\"17\" variability=\"continuous\"/>",
    };
    for (version, method) in
        [(3, "dassl"), (3, "radau"), (3, "dopri5"), (2, "dassl"), (2, "rodas4")]
    {
        let end = "</ModelVariables>";
        let text = description(version).replace(end, &format!("{}{end}", repeats(version)));
        let Some(here) = with_description(version, &text) else { return };
        let set = ["--set", "jump=1", "--set", "threshold=0.5", "--method", method];
        let all = simulated(&here, &set);
        assert_eq!(column(&all, "repeats").last(), Some(&0.0), "{version} {method}");
        let x = ((-1.0f64).exp() + 1.0) * (-1.0f64).exp();
        near(*column(&all, "x").last().expect("rows"), x, 1e-6);
    }
}

/// Both versions and kinds give the exact solution, with the jump at 1 s and what is set.
#[test]
fn units_of_both_versions_and_kinds_are_simulated() {
    for version in [2, 3] {
        let Some(here) = with_unit(version) else { return };
        for kind in [&[][..], &["--method", "co-simulation"]] {
            let set = ["--set", "k=2", "--set", "x0=3", "--set", "jump=0.5"];
            let all = simulated(&here, &[&set, kind].concat());
            let (time, y) = (column(&all, "time"), column(&all, "y"));
            assert_eq!(time.last(), Some(&2.0));
            for (t, y) in time.iter().zip(y).filter(|(t, _)| (**t - 1.0).abs() > 1e-9) {
                let after = if *t > 1.0 { 0.5 * (-2.0 * (t - 1.0)).exp() } else { 0.0 };
                near(*y, 3.0 * (-2.0 * t).exp() + after, 1e-6);
            }
            assert_eq!(column(&all, "k")[0], 2.0);
        }
    }
}

/// Points that differ by rounding alone are two rows, also where the unit steps from one to the next.
#[test]
fn data_points_that_differ_by_rounding_are_compared() {
    let Some(here) = with_unit(3) else { return };
    let times = [0.0, 0.1 + 0.2, 0.3, 0.7 + 0.1 + 0.1, 0.9, 0.1 + 0.7 + 0.1, 1.1 * 1.1, 1.21];
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let row = |t: &f64| format!("{t},{}\n", 3.0 * (-2.0 * t).exp() + 1e-3 * (37.0 * t).sin());
    let rows: String = times.iter().map(row).collect();
    fs::write(here.path().join("d.csv"), format!("time,y\n{rows}")).expect("written");
    let problem = format!("{PROBLEM}integrator = \"co-simulation\"\n");
    fs::write(here.path().join("p.toml"), problem).expect("written");
    let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--allow-external"]);
    assert!(code == 0 && !out.contains("ended early"), "{out}{errors}");
}

/// How a unit of FMI 3.0 is built of a file.
fn build_description(file: &str, language: &str) -> String {
    format!(
        "<fmiBuildDescription fmiVersion=\"3.0\"><BuildConfiguration modelIdentifier=\"unit\">\
         <SourceFileSet language=\"{language}\"><SourceFile name=\"{file}\"/>\
         <PreprocessorDefinition name=\"FMI\" value=\"3\"/></SourceFileSet>\
         </BuildConfiguration></fmiBuildDescription>"
    )
}

/// A unit of which there are sources alone is compiled, with the headers of the standard at hand; what a
/// compiler does not accept is said.
#[test]
fn units_with_sources_alone_are_compiled() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fmus/unit.c");
    let source = fs::read(source).expect("the unit of the tests");
    for version in [2, 3] {
        let here = folder(&[]);
        if library(version, here.path()).is_none() {
            return;
        }
        let types = if version == 2 { "fmi2TypesPlatform.h" } else { "fmi3PlatformTypes.h" };
        let all = format!("#include \"{types}\"\n#define FMI {version}\n#include \"unit.c\"\n");
        let listed = "modelIdentifier=\"unit\"><SourceFiles><File name=\"all.c\"/></SourceFiles>";
        let listed = format!("<ModelExchange {listed}</ModelExchange>");
        let plain = "<ModelExchange modelIdentifier=\"unit\"/>";
        let description = description(version).replace(plain, &listed);
        let build = build_description("unit.c", "C99");
        let write = |source: &[u8]| {
            let bytes = archive(&[
                ("modelDescription.xml", description.as_bytes()),
                ("sources/all.c", all.as_bytes()),
                ("sources/unit.c", source),
                ("sources/buildDescription.xml", build.as_bytes()),
            ]);
            fs::write(here.path().join("unit.fmu"), bytes).expect("written");
        };
        write(&source);
        let all = simulated(&here, &["--set", "k=2", "--set", "x0=3"]);
        near(*column(&all, "y").last().expect("a row"), 3.0 * (-4.0f64).exp(), 1e-6);
        write(b"this is no C");
        let (code, _, errors) = gapi(&here, &["simulate", "unit.fmu", "--allow-external"]);
        assert!(code == 1 && errors.contains("does not accept its sources"), "{errors}");
        let (code, _, errors) = gapi(&here, &["simulate", "unit.fmu"]);
        assert!(code == 1 && errors.contains("is not run without permission"), "{errors}");
    }
}

/// The parts of a unit for scheduled execution run at the ticks of its clocks: periodic ones, those that
/// the data trigger, and those that the unit asks for.
#[test]
fn parts_of_a_unit_run_at_the_ticks_of_clocks() {
    let exchange =
        "<ModelExchange modelIdentifier=\"unit\" needsCompletedIntegratorStep=\"true\"/>";
    let simulation =
        "<CoSimulation modelIdentifier=\"unit\" canHandleVariableCommunicationStepSize=\"true\"/>";
    let clocks = "<Clock name=\"each\" valueReference=\"21\" causality=\"input\" priority=\"1\" \
                  intervalVariability=\"constant\" intervalDecimal=\"0.5\"/>\
                  <Clock name=\"tick\" valueReference=\"22\" causality=\"input\" priority=\"0\" \
                  intervalVariability=\"triggered\"/>\
                  <Clock name=\"wait\" valueReference=\"23\" causality=\"input\" priority=\"2\" \
                  intervalVariability=\"countdown\"/></ModelVariables>";
    let description = DESCRIPTION_3
        .replace(exchange, "<ScheduledExecution modelIdentifier=\"unit\"/>")
        .replace(simulation, "")
        .replace("</ModelVariables>", clocks);
    let Some(here) = with_description(3, &description) else { return };
    let data = "time,tick,u\n0,0,0\n0.6,1,2\n1.5,1,3\n2,0,0\n";
    fs::write(here.path().join("t.csv"), data).expect("written");
    let all = simulated(&here, &["--input", "t.csv"]);
    let (time, n) = (column(&all, "time"), column(&all, "n"));
    assert_eq!((time.last(), n.last()), (Some(&2.0), Some(&125.0)));
    let at = |t: f64| *n.iter().zip(time).rfind(|(_, time)| **time <= t).expect("a row").0;
    assert_eq!([at(0.0), at(0.55), at(0.6), at(1.2), at(1.25)], [1.0, 2.0, 12.0, 13.0, 113.0]);
    // What is triggered comes before what is periodic at 1.5 s.
    near(*column(&all, "y").last().expect("a row"), 4.47849, 1e-12);
    assert!(all.iter().all(|(name, _)| name != "tick"));
}

/// The clocks of the reference unit tick as its description says.
#[test]
fn the_reference_unit_with_clocks_ticks() {
    let Some(folder_of_units) = std::env::var_os("GAPILIB_REFERENCE_FMUS") else { return };
    let unit = Path::new(&folder_of_units).join("3/Clocks.fmu");
    if !unit.is_file() {
        return;
    }
    let here = folder(&[]);
    fs::copy(unit, here.path().join("unit.fmu")).expect("copied");
    let ticks = |t: u32| u32::from([0, 1, 8, 9].contains(&t));
    let rows = (0..=10).map(|t| format!("{t},{},{}\n", ticks(t), 10 * t)).collect::<String>();
    let data = format!("time,inClock2,input2\n{rows}");
    fs::write(here.path().join("t.csv"), data).expect("written");
    let all = simulated(&here, &["--input", "t.csv", "--stop-time", "9.5"]);
    let last = |name: &str| *column(&all, name).last().expect("a row");
    assert_eq!(
        [last("inClock1Ticks"), last("inClock2Ticks"), last("inClock3Ticks")],
        [10.0, 4.0, 1.0]
    );
    assert_eq!(
        [last("totalInClockTicks"), last("result2"), last("output3")],
        [15.0, 180.0, 1000.0]
    );
}

/// The step of an input is an event, and so is a state that falls below its threshold; Integers follow.
#[test]
fn inputs_and_events_are_those_of_the_data_and_of_the_unit() {
    for version in [2, 3] {
        let Some(here) = with_unit(version) else { return };
        fs::write(here.path().join("u.csv"), "time,u\n0,0\n0.5,0\n0.5,2\n2,2\n").expect("written");
        let all = simulated(&here, &["--input", "u.csv", "--set", "threshold=0.8"]);
        let exact = |t: f64| match t < 0.5 {
            true => (-t).exp(),
            false => 2.0 + ((-0.5f64).exp() - 2.0) * (0.5 - t).exp(),
        };
        let (time, x) = (column(&all, "time"), column(&all, "x"));
        time.iter().zip(x).for_each(|(t, x)| near(*x, exact(*t), 1e-6));
        let n = column(&all, "n");
        assert_eq!((n[0], n.last()), (0.0, Some(&1.0)));
        let fell = time.iter().zip(n).find(|(_, n)| **n == 1.0).expect("an event").0;
        near(*fell, -(0.8f64.ln()), 1e-6);
    }
}

/// Sizes of arrays, their elements, Booleans and Strings can be set; what does not fit is refused.
#[test]
fn arrays_and_all_types_are_set() {
    let Some(here) = with_unit(3) else { return };
    let all = simulated(&here, &["--set", "m=3", "--set", "c[2]=2", "--set", "c[3]=4"]);
    near(column(&all, "y")[0], 7.0, 1e-12);
    assert_eq!(column(&all, "c[3]")[0], 4.0);
    let all = simulated(&here, &["--set", "gain_on=false"]);
    assert_eq!(column(&all, "y")[0], 0.0);
    let base = ["simulate", "unit.fmu", "--allow-external"];
    for (set, said) in [
        ("label=refused", "this label is refused"),
        ("c[3]=1", "has no variable `c[3]`"),
        ("fault=0.5", "is Int32 and cannot be 0.5"),
        ("y=1", "is computed by the FMU"),
        ("kk=1", "did you mean `k`?"),
        ("labl=a", "did you mean `label`?"),
        ("gain_on=perhaps", "cannot be `perhaps`"),
        ("k=0,5", "numbers have a decimal point: write `0.5`"),
    ] {
        let (code, out, errors) = gapi(&here, &[&base[..], &["--set", set]].concat());
        assert!(code == 1 && errors.contains(said), "{set}: {out}{errors}");
    }
}

#[test]
fn nothing_runs_without_permission() {
    let Some(here) = with_unit(3) else { return };
    let (code, _, errors) = gapi(&here, &["simulate", "unit.fmu", "--allow-external=other.fmu"]);
    assert_eq!(code, 1);
    for word in ["external-refused", "`unit.fmu`", "--allow-external=unit.fmu"] {
        assert!(errors.contains(word), "{word}: {errors}");
    }
}

/// The option that a refusal proposes is the one that permits it, also for links and names with spaces.
#[cfg(unix)]
#[test]
fn the_permission_that_is_proposed_permits() {
    let Some(here) = with_unit(3) else { return };
    let at = |name: &str| here.path().join(name);
    fs::copy(at("unit.fmu"), at("a pump.fmu")).expect("copied");
    std::os::unix::fs::symlink(at("unit.fmu"), at("link.fmu")).expect("a link");
    for (name, written, given) in [
        ("a pump.fmu", "--allow-external=\"a pump.fmu\"", "--allow-external=a pump.fmu"),
        ("link.fmu", "--allow-external=./link.fmu", "--allow-external=./link.fmu"),
    ] {
        let (code, _, errors) = gapi(&here, &["simulate", name]);
        assert!(code == 1 && errors.contains(written), "{errors}");
        let (code, _, errors) = gapi(&here, &["simulate", name, given]);
        assert_eq!(code, 0, "{errors}");
    }
}

/// A unit that goes wrong in its own way: the message says how, and no files stay in the working folder.
#[test]
fn faults_of_a_unit_are_said() {
    let Some(here) = with_unit(3) else { return };
    let base = ["simulate", "unit.fmu", "--allow-external", "--set"];
    for kind in [&[][..], &["--method", "co-simulation"]] {
        for (fault, said) in [
            (CRASH, "ended by signal 11 (segmentation fault)"),
            (REPORT, "reports an error: the pump is dry"),
            (LEAVE, "exit code 7; it printed last: last words"),
        ] {
            let set = format!("fault={fault}");
            let (code, out, errors) = gapi(&here, &[&base[..], &[&set], kind].concat());
            assert!(code == 1 && errors.contains(said), "{set}: {out}{errors}");
        }
    }
    let step = ["--method", "co-simulation"];
    for (fault, kind, said) in [
        (REFUSE, &step[..], "`fmi3DoStep` of the FMU refuses these values"),
        (REFUSE, &[], "`fmi3SetTime` of the FMU refuses these values"),
        (STAY, &step, "at 0.5 s: `fmi3DoStep` of the FMU returns early again and again"),
        (NOT_A_NUMBER, &[], "a state is not finite"),
    ] {
        let set = format!("fault={fault}");
        let (code, out, errors) = gapi(&here, &[&base[..], &[&set], kind].concat());
        assert!(code == 1 && errors.contains(said), "{set}: {out}{errors}");
    }
    let printing = format!("fault={PRINT}");
    let (code, out, errors) = gapi(&here, &[&base[..], &[&printing]].concat());
    assert!(code == 0 && errors.contains("printed to the output"), "{out}{errors}");
    assert_eq!(errors.matches("printed to the output").count(), 1, "{errors}");
    let writing = format!("fault={WRITE}");
    let (code, out, errors) = gapi(&here, &[&base[..], &[&writing]].concat());
    assert!(code == 0 && !here.path().join("remaining.txt").exists(), "{out}{errors}");
}

/// What the program says, on one line, where calls of units may take so many seconds.
fn patient(here: &TempDir, arguments: &[&str], seconds: &str) -> (i32, String) {
    let mut child = command(here.path(), arguments);
    let output = child.env("GAPILIB_FMU_CALL_SECONDS", seconds).output().expect("it ends");
    let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
    (output.status.code().unwrap_or(-1), one_line(&text))
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// A call that does not return is ended after the seconds that the environment gives it.
#[test]
fn a_call_that_does_not_return_is_ended() {
    let Some(here) = with_unit(3) else { return };
    let hang = format!("fault={HANG}");
    let simulate = ["simulate", "unit.fmu", "--allow-external", "--set", &hang];
    let step = [&simulate[..], &["--method", "co-simulation"]].concat();
    for (arguments, seconds, said) in [
        (
            &simulate[..],
            "0.5",
            "a call of `fmi3SetTime` has not returned for 0.5 s (GAPILIB_FMU_CALL_SECONDS allows more)",
        ),
        (&step, "0.5", "a call of `fmi3DoStep` has not returned for 0.5 s"),
        (&simulate, "soon", "GAPILIB_FMU_CALL_SECONDS is not a number of seconds"),
    ] {
        let (code, text) = patient(&here, arguments, seconds);
        assert!(code == 1 && text.contains(said), "{seconds}: {text}");
    }
}

/// A fit in which no call returns ends, after a few simulations, with the function.
#[test]
fn a_fit_of_a_unit_that_always_hangs_ends() {
    let Some(here) = with_unit(3) else { return };
    fs::write(here.path().join("d.csv"), data()).expect("written");
    let entry = format!("set = {{ fault = {HANG} }}\n");
    fs::write(here.path().join("p.toml"), format!("{PROBLEM}{entry}")).expect("written");
    let (_, text) = patient(&here, &["identify", "p.toml", "--allow-external"], "0.2");
    assert!(text.contains("a call of `fmi3SetTime` has not returned for 0.2 s"), "{text}");
}

/// Values that are not finite, and a unit that ends the simulation, are noted; a fit counts both as failures.
#[test]
fn missing_values_and_early_ends_are_said() {
    for version in [2, 3] {
        let Some(here) = with_unit(version) else { return };
        fs::write(here.path().join("d.csv"), data()).expect("written");
        let simulate = ["simulate", "unit.fmu", "--allow-external", "--set"];
        for kind in [&["--method", "dassl"][..], &["--method", "co-simulation"]] {
            let fault = format!("fault={NO_OUTPUT}");
            let (code, _, errors) = gapi(&here, &[&simulate[..], &[&fault], kind].concat());
            let said =
                one_line(&errors).contains("`unit.fmu` gives no numbers: `y` is NaN from 0.");
            assert!(code == 0 && said, "{errors}");
            // Units of FMI 2.0 for model exchange need not announce completed steps.
            if version == 2 && kind[1] == "dassl" {
                continue;
            }
            let fault = format!("fault={END}");
            let (code, _, errors) = gapi(&here, &[&simulate[..], &[&fault], kind].concat());
            let said = one_line(&errors).contains("`unit.fmu` ended the simulation at 0.");
            assert!(code == 0 && said && errors.contains("before 2 s"), "{errors}");
        }
        for (fault, said) in [
            (NO_OUTPUT, "`y` is NaN at 0.6 s"),
            (END, "the model ended the simulation before 0.7 s"),
        ] {
            let entry = format!("integrator = \"co-simulation\"\nset = {{ fault = {fault} }}\n");
            fs::write(here.path().join("p.toml"), format!("{PROBLEM}{entry}")).expect("written");
            let (_, out, errors) = gapi(&here, &["identify", "p.toml", "--allow-external"]);
            assert!(one_line(&format!("{out}{errors}")).contains(said), "{out}{errors}");
        }
    }
}

/// A step that says it has ended elsewhere has failed.
#[test]
fn steps_end_within_themselves() {
    for (version, function) in [(2, "fmi2GetRealStatus"), (3, "fmi3DoStep")] {
        let Some(here) = with_unit(version) else { return };
        let fault = format!("fault={AWAY}");
        let simulate = ["simulate", "unit.fmu", "--allow-external", "--set", &fault];
        let (code, _, errors) =
            gapi(&here, &[&simulate[..], &["--method", "co-simulation"]].concat());
        let text = one_line(&errors);
        let said =
            format!("`{function}` of the FMU says that its step from 0.5 s to 0.6 s ended at 99 s");
        assert!(code == 1 && text.contains("`unit.fmu`") && text.contains(&said), "{text}");
    }
}

/// A ramp between two rows of the data, with few output points: the mean over short steps, and in FMI 2.0
/// derivatives of the input. Rows show what the outputs were computed with.
#[test]
fn inputs_change_during_steps_of_co_simulation() {
    let flag = "canHandleVariableCommunicationStepSize=\"true\"";
    for (version, tolerance) in [(2, 1e-12), (3, 3e-6)] {
        let more = if version == 2 { " canInterpolateInputs=\"true\"" } else { "" };
        let description = description(version).replace(flag, &format!("{flag}{more}"));
        let Some(here) = with_description(version, &description) else { return };
        fs::write(here.path().join("u.csv"), "time,u\n0,0\n2,4\n").expect("written");
        let cs = ["--input", "u.csv", "--method", "co-simulation", "--intervals", "10"];
        let all = simulated(&here, &[&cs[..], &["--set", "k=2"]].concat());
        for (row, t) in column(&all, "time").iter().enumerate() {
            near(column(&all, "u")[row], 2.0 * t, 1e-12);
            near(column(&all, "w")[row], 4.0 * t, 1e-12);
            let exact = t - 0.5 + 1.5 * (-2.0 * t).exp();
            near(column(&all, "x")[row], exact, tolerance);
        }
    }
}

/// Steps of one length that do not end at the last row of the data lead beyond it: the unit knows the end of the
/// last one.
#[test]
fn fixed_steps_may_lead_beyond_the_data() {
    for version in [2, 3] {
        let fixed = description(version)
            .replace("StepSize=\"true\"", "StepSize=\"false\"")
            .replace("stepSize=\"0.1\"", "stepSize=\"0.3\"");
        let Some(here) = with_description(version, &fixed) else { return };
        let rows: String = (0..=20)
            .map(|n| format!("{},{}\n", 0.1 * f64::from(n), (-0.1 * f64::from(n)).exp()))
            .collect();
        let problem = "model = \"unit.fmu\"\n[parameters]\nk = { min = 0.1, max = 10 }\n[[experiment]]\n\
                       data = \"d.csv\"\noutputs = { y = \"y\" }\nintegrator = \"co-simulation\"\n";
        fs::write(here.path().join("d.csv"), format!("time,y\n{rows}")).expect("written");
        fs::write(here.path().join("p.toml"), problem).expect("written");
        let identify = ["identify", "p.toml", "--allow-external", "--out", "o"];
        let (code, out, errors) = gapi(&here, &identify);
        assert_eq!(code, 0, "{out}{errors}");
        let text = fs::read_to_string(here.path().join("o/result.json")).expect("a result");
        let result: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        near(result["parameters"][0]["value"].as_f64().expect("a number"), 1.0, 0.02);
    }
}

/// A permission is for a path, or for a name in any folder.
#[test]
fn units_are_allowed_by_their_paths() {
    let Some(here) = with_unit(3) else { return };
    let folder = here.path().join("sub");
    fs::create_dir(&folder).expect("made");
    fs::copy(here.path().join("unit.fmu"), folder.join("unit.fmu")).expect("copied");
    let absolute = here.path().join("unit.fmu");
    let absolute = absolute.to_string_lossy();
    for (unit, allowed, is_allowed) in [
        ("unit.fmu", "unit.fmu", true),
        ("unit.fmu", "./unit.fmu", true),
        ("./unit.fmu", "sub/../unit.fmu", true),
        ("unit.fmu", &absolute, true),
        (&absolute, "./unit.fmu", true),
        ("sub/unit.fmu", "unit.fmu", true),
        ("sub/unit.fmu", "sub/unit.fmu", true),
        ("sub/unit.fmu", "./unit.fmu", false),
        ("unit.fmu", "sub/unit.fmu", false),
    ] {
        let allow = format!("--allow-external={allowed}");
        let (code, _, errors) = gapi(&here, &["simulate", unit, &allow]);
        assert_eq!(code == 0, is_allowed, "{unit} {allowed}: {errors}");
        let help = format!("`--allow-external={unit}`");
        assert!(is_allowed || one_line(&errors).contains(&help), "{errors}");
    }
}

/// A fit says by which kind a unit is simulated that offers two, and what starts with other values than the
/// description has.
#[test]
fn fits_say_the_kind_and_other_starts() {
    let other = "<Float64 name=\"other\" valueReference=\"16\" causality=\"parameter\" \
                 variability=\"fixed\" start=\"3\"/></ModelVariables>";
    let description = DESCRIPTION_3.replace("</ModelVariables>", other);
    let Some(here) = with_description(3, &description) else { return };
    fs::write(here.path().join("d.csv"), data()).expect("written");
    for (entry, kind) in [
        ("", "is simulated by model exchange"),
        ("integrator = \"co-simulation\"\n", "is simulated by co-simulation, as `integrator` says"),
    ] {
        fs::write(here.path().join("p.toml"), format!("{PROBLEM}{entry}")).expect("written");
        let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--allow-external"]);
        let text = one_line(&format!("{out}{errors}"));
        let starts =
            "computes with other values than its description says: other = 7 in the place of 3";
        assert!(code == 0 && text.contains(kind) && text.contains(starts), "{text}");
    }
}

const PROBLEM: &str = "model = \"unit.fmu\"\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                       x0 = { min = 0.1, max = 10 }\n[[experiment]]\ndata = \"d.csv\"\n\
                       outputs = { y = \"y\" }\n";

fn data() -> String {
    let row = |t: f64| {
        // A ripple that no parameter follows.
        let ripple = 1e-3 * (37.0 * t).sin();
        format!("{t},{}\n", 3.0 * (-2.0 * t).exp() + ripple)
    };
    let rows: String = (0..=20).map(|n| row(f64::from(n) / 10.0)).collect();
    format!("time,y\n{rows}")
}

/// The fit of a unit is that of the formula, for both versions and kinds, and its files have the same
/// bytes with one thread and with three.
#[test]
fn parameters_of_units_are_identified_on_any_number_of_threads() {
    let mut found = Vec::new();
    for version in [2, 3] {
        let Some(here) = with_unit(version) else { return };
        fs::write(here.path().join("d.csv"), data()).expect("written");
        for (kind, entry) in [("me", ""), ("cs", "integrator = \"co-simulation\"\n")] {
            fs::write(here.path().join("p.toml"), format!("{PROBLEM}{entry}")).expect("written");
            let mut results = Vec::new();
            for threads in ["1", "3"] {
                let out = format!("{kind}{threads}");
                let (code, said, errors) = gapi(
                    &here,
                    &[
                        "identify",
                        "p.toml",
                        "--allow-external=unit.fmu",
                        "--threads",
                        threads,
                        "--out",
                        &out,
                    ],
                );
                assert_eq!(code, 0, "{said}{errors}");
                let because = match (kind, version) {
                    ("cs", _) => "the FMU integrates itself",
                    (_, 2) => "FMUs of FMI 2.0 have no derivatives by parameters",
                    _ => "the FMU has no directional derivatives",
                };
                assert!(said.contains(because), "{said}");
                let text = fs::read_to_string(here.path().join(&out).join("result.json"));
                results.push(text.expect("a result"));
            }
            assert_eq!(without_time(&results[0]), without_time(&results[1]));
            found.push(estimates(&results[0]));
        }
    }
    for [k, x0] in &found {
        near(*k, found[0][0], 1e-4);
        near(*x0, found[0][1], 1e-4);
        near(*k, 2.0, 5e-3);
        near(*x0, 3.0, 5e-3);
    }
}

/// Seconds on the clock differ from run to run.
fn without_time(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.contains("second") && !line.contains("threads")).collect()
}

fn estimates(text: &str) -> [f64; 2] {
    let result: serde_json::Value = serde_json::from_str(text).expect("JSON");
    let parameters = result["parameters"].as_array().expect("parameters");
    ["k", "x0"].map(|name| {
        let own = parameters.iter().find(|own| own["name"] == name).expect("a parameter");
        own["value"].as_f64().expect("a number")
    })
}

/// Simulations in which the unit crashes or does not return have failed, and the run continues.
#[test]
fn a_unit_that_crashes_or_hangs_costs_its_simulations_alone() {
    let Some(here) = with_unit(3) else { return };
    fs::write(here.path().join("d.csv"), data()).expect("written");
    for (fault, said) in [(CRASH, "signal 11"), (HANG, "takes more time than allowed")] {
        // A unit that does not return is given some seconds each time.
        let few = "[method]\npopulation = 4\n[stop]\nevaluations = 4\n";
        let entry = format!("max_seconds = 0.2\nset = {{ fault = {fault} }}\n{few}");
        fs::write(here.path().join("p.toml"), format!("{PROBLEM}{entry}")).expect("written");
        let problem = ["identify", "p.toml", "--allow-external", "--out", &format!("o{fault}")];
        let mut child = command(here.path(), &problem);
        let output = child.output().expect("it ends");
        let text = String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned();
        assert!(output.status.code().is_some_and(|code| code != 101), "{text}");
        assert!(text.contains(said), "{fault}: {text}");
    }
}

#[test]
fn problems_name_what_a_unit_does_not_have() {
    let Some(here) = with_unit(3) else { return };
    fs::write(here.path().join("d.csv"), data()).expect("written");
    for (from, to, said) in [
        ("k = {", "kk = {", "has no parameter `kk`"),
        ("k = {", "y = {", "is computed by the FMU and cannot be estimated"),
        ("k = {", "fault = {", "only real numbers can"),
        ("{ y = ", "{ z = ", "has no variable `z`"),
        ("outputs =", "set = { label = \"refused\" }\noutputs =", "this label is refused"),
        ("outputs =", "set = { labl = \"a\" }\noutputs =", "did you mean `label`?"),
        ("k = { min = 0.1, max = 10 }", "k = { tied = \"2*x0\" }", "`k` is tied"),
        ("outputs =", "steady_state = true\noutputs =", "`steady_state` of experiment 1"),
        ("outputs =", "inputs = { w = \"y\" }\noutputs =", "its inputs are `u`"),
    ] {
        fs::write(here.path().join("p.toml"), PROBLEM.replacen(from, to, 1)).expect("written");
        let (code, out, errors) = gapi(&here, &["identify", "p.toml", "--allow-external"]);
        assert!(code == 1 && errors.contains(said), "{said}: {out}{errors}");
    }
}

/// What is said of a text in the place of a library.
const UNUSABLE: &str =
    if cfg!(target_os = "linux") { "is not a shared library of Linux" } else { "cannot be loaded" };

/// What is no unit, or none for this machine, is refused with its file and a remedy.
#[test]
fn files_that_are_not_usable_units_are_refused() {
    let Some(platform) = platform(3) else { return };
    let binary = format!("binaries/{platform}/unit.so");
    let of = |xml: &str| archive(&[("modelDescription.xml", xml.as_bytes()), (&binary, b"none")]);
    let changed = |from: &str, to: &str| {
        assert!(DESCRIPTION_3.contains(from), "{from}");
        of(&DESCRIPTION_3.replacen(from, to, 1))
    };
    let exchange =
        "<ModelExchange modelIdentifier=\"unit\" needsCompletedIntegratorStep=\"true\"/>";
    let simulation =
        "<CoSimulation modelIdentifier=\"unit\" canHandleVariableCommunicationStepSize=\"true\"/>";
    let without_kinds = DESCRIPTION_3.replace(exchange, "").replace(simulation, "");
    let scheduled =
        DESCRIPTION_3.replace(exchange, "<ScheduledExecution modelIdentifier=\"unit\"/>");
    let scheduled = scheduled.replace(simulation, "");
    let clock = "<Clock name=\"tick\" valueReference=\"99\" causality=\"input\" \
                 intervalVariability=\"constant\" intervalDecimal=\"1\"/>\n  </ModelVariables>";
    let whole = of(DESCRIPTION_3);
    let windows =
        [("modelDescription.xml", DESCRIPTION_3.as_bytes()), ("binaries/win64/u.dll", b"")];
    let built = |file: &str, language: &str| {
        let build = build_description(file, language);
        let own = ("modelDescription.xml", DESCRIPTION_3.as_bytes());
        archive(&[own, ("sources/u.c", b""), ("sources/buildDescription.xml", build.as_bytes())])
    };
    let sources: [(&str, &[u8]); 2] =
        [("modelDescription.xml", DESCRIPTION_3.as_bytes()), ("sources/u.c", b"")];
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (b"no archive".to_vec(), "not an FMU"),
        (Vec::new(), "not an FMU"),
        (whole[..whole.len() / 2].to_vec(), "not an FMU"),
        (archive(&[("a.txt", b"")]), "there is no `modelDescription.xml`"),
        (archive(&[("modelDescription.xml", DESCRIPTION_3.as_bytes())]), "has no binaries at all"),
        (archive(&windows), "it has `binaries/win64/u.dll`"),
        (archive(&sources), "does not say what it is compiled of"),
        (built("v.c", "C99"), "it has no `sources/v.c`"),
        (built("u.c", "C++11"), "its sources are C++11, not C"),
        (of("<fmiModelDescription"), "modelDescription.xml"),
        (of("<other/>"), "modelDescription.xml"),
        (changed("fmiVersion=\"3.0\"", "fmiVersion=\"1.0\""), "1.0"),
        (changed(" instantiationToken=\"{unit}\"", ""), "instantiationToken"),
        (changed("modelIdentifier=\"unit\" ", ""), "modelIdentifier"),
        (changed("causality=\"output\"", "causality=\"outlet\""), "outlet"),
        (changed("valueReference=\"6\"", "valueReference=\"six\""), "six"),
        (
            changed("<Dimension valueReference=\"11\"/>", "<Dimension valueReference=\"77\"/>"),
            "`c` has in `Dimension` the value reference 77, which no variable has",
        ),
        (
            changed("start=\"-1e300\"", "start=\"low\""),
            "line 16: `low` is not a value of the attribute `start`",
        ),
        (changed("unit=\"V\"", "unit=\"W\""), "`y` has the unit `W`"),
        (of(&without_kinds), "neither `ModelExchange` nor `CoSimulation`"),
        (of(&scheduled), UNUSABLE),
        (changed("</ModelVariables>", clock), "clock `tick`"),
        (whole, UNUSABLE),
    ];
    for (number, (bytes, said)) in cases.into_iter().enumerate() {
        let here = folder(&[]);
        fs::write(here.path().join("unit.fmu"), bytes).expect("written");
        let (code, out, errors) = gapi(&here, &["simulate", "unit.fmu", "--allow-external"]);
        let text = format!("{number} ({said}): {out}{errors}");
        assert!(code == 1 && errors.contains("unit.fmu") && errors.contains(said), "{text}");
        assert!(!errors.contains("panicked"), "{text}");
    }
}

/// A unit whose library does not fit its description.
#[test]
fn a_wrong_token_is_said_by_the_unit() {
    for (version, attribute) in [(2, "guid=\"{unit}\""), (3, "instantiationToken=\"{unit}\"")] {
        let xml = description(version).replace(attribute, &attribute.replace("unit", "other"));
        let Some(here) = with_description(version, &xml) else { return };
        let (code, out, errors) = gapi(&here, &["simulate", "unit.fmu", "--allow-external"]);
        assert!(code == 1 && errors.contains("says (logStatusError): wrong"), "{out}{errors}");
        let name = attribute.split('=').next().unwrap_or_default();
        let help = format!("which has the {name} `{{other}}`; it has no folder `resources`");
        let text = one_line(&errors);
        assert!(text.contains("makes no instance: wrong") && text.contains(&help), "{errors}");
        // A fit of it ends the same way.
        let problem = "model = \"unit.fmu\"\n[parameters]\nk = { min = 0.1, max = 10 }\n\
                       [[experiment]]\ndata = \"data.csv\"\noutputs = { y = \"y\" }\n";
        fs::write(here.path().join("fit.toml"), problem).expect("written");
        fs::write(here.path().join("data.csv"), "time,y\n0,1\n1,2\n2,3\n").expect("written");
        let (code, out, errors) = gapi(&here, &["identify", "fit.toml", "--allow-external"]);
        assert!(code == 1 && !errors.contains("panicked"), "{out}{errors}");
        assert!(one_line(&errors).contains("makes no instance: wrong"), "{out}{errors}");
    }
}

/// Checking shows what a unit is without running it.
#[test]
fn a_check_runs_nothing() {
    let here = folder(&[]);
    let platform = platform(3).unwrap_or("x86_64-linux");
    let binary = format!("binaries/{platform}/unit.so");
    let description = DESCRIPTION_3.as_bytes();
    let this = std::env::current_exe().and_then(fs::read).expect("a program");
    let bytes = archive(&[("modelDescription.xml", description), (&binary, &this)]);
    fs::write(here.path().join("unit.fmu"), bytes).expect("written");
    let (code, out, errors) = gapi(&here, &["check", "unit.fmu"]);
    if platform == "x86_64-linux" && cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        assert_eq!(code, 0, "{errors}");
        for word in ["FMI 3.0", "model exchange, co-simulation", "1 state", "inputs: u", "y [V]"] {
            assert!(out.contains(word), "{word}: {out}");
        }
    }
    fs::write(here.path().join("unit.fmu"), b"none").expect("written");
    let (code, out, errors) = gapi(&here, &["check", "unit.fmu"]);
    assert!(code == 1 && errors.contains("bad-fmu"), "{out}{errors}");
}

/// The folder of the Reference-FMUs, if a variable names one; said if not.
#[allow(clippy::print_stderr, reason = "a test that is skipped has to say so")]
fn reference_units() -> Option<PathBuf> {
    let named = std::env::var_os("GAPILIB_REFERENCE_FMUS").map(PathBuf::from);
    if named.is_none() {
        eprintln!("skipped: GAPILIB_REFERENCE_FMUS names no folder");
    }
    named
}

/// The Reference-FMUs against their expected outputs. These are those of explicit Euler steps, which
/// co-simulation repeats to the bit and model exchange does with the same method, but for the places of
/// events (`BouncingBall`) and steps within the output interval (`StateSpace`), which are not compared.
#[test]
fn reference_units_give_their_expected_outputs() {
    let Some(units) = reference_units() else { return };
    let here = folder(&[]);
    let mut compared = 0;
    for version in [2, 3] {
        for model in [
            "VanDerPol",
            "BouncingBall",
            "Dahlquist",
            "Stair",
            "Resource",
            "Feedthrough",
            "StateSpace",
        ] {
            let unit = units.join(format!("{version}/{model}.fmu"));
            if !unit.is_file() {
                continue;
            }
            let expected = columns(&units.join(format!("{model}/{model}_out.csv")));
            for (method, tolerance) in [("co-simulation", 0.0), ("euler", 1e-12)] {
                if method == "euler" && ["BouncingBall", "StateSpace"].contains(&model) {
                    continue;
                }
                let path = unit.to_string_lossy();
                let simulate = ["simulate", &*path, "--allow-external", "--method", method];
                let output = ["--output", "r.csv"];
                let (code, out, errors) = gapi(&here, &[&simulate[..], &output].concat());
                assert_eq!(code, 0, "{model}: {out}{errors}");
                let found = columns(&here.path().join("r.csv"));
                compared += compare(model, &expected, &found, tolerance);
            }
        }
    }
    assert!(compared > 10_000, "{compared} values compared");
}

/// Compares what both have; the number of values.
fn compare(
    model: &str,
    expected: &[(String, Vec<f64>)],
    found: &[(String, Vec<f64>)],
    tolerance: f64,
) -> usize {
    let (times, own) = (column(expected, "time"), column(found, "time"));
    let mut compared = 0;
    for (name, values) in expected.iter().filter(|(name, _)| name != "time") {
        let Some((_, own_values)) = found.iter().find(|(known, _)| known == name) else { continue };
        for (t, value) in times.iter().zip(values).filter(|(_, value)| value.is_finite()) {
            let rows = own.iter().zip(own_values).filter(|(own, _)| (*own - t).abs() < 1e-9);
            let error = rows.map(|(_, own)| (own - value).abs()).fold(f64::INFINITY, f64::min);
            assert!(error <= tolerance, "{model}: `{name}` at {t} s is off by {error}");
            compared += 1;
        }
    }
    compared
}
