//! The shipped scripts with one line of INI changed give one error, that of the fault.

use crate::support::shipped;

const INI: &str = "scripts/GAPILib_INI.mos";

fn with_change(from: &str, to: &str) -> shipped::Run {
    let text = std::fs::read_to_string(shipped::project(INI)).unwrap();
    let changed = text.replace(from, to).replace("N_Cycle = 5000", "N_Cycle = 2");
    assert!(text.contains(from), "`{from}` is not in INI");
    shipped::run_in(shipped::world().with_file(INI, changed), "scripts/GAPILib.mos")
}

#[test]
fn one_fault_gives_one_error() {
    let cases = [
        ("PolarizationCurve(", "PolarisationCurve(", "unknown-class"),
        ("\"Ilim\"}", "\"Ilimit\"}", "parameter-not-found"),
        ("c12_n20_rh50_p15psig.mat", "c12.mat", "file-error"),
        (".mat\", \"i\", \"V\"", ".mat\", \"i\", \"U\"", "unknown-matrix"),
        ("0.01, 1.47}", "2, 1.47}", "bad-range"),
        ("N_Parents = 70", "N_Parents = 100", "bad-population"),
        ("F_Mut = 0.25", "F_Mut = 25", "bad-mutation-factor"),
        ("12345]", "-1]", "bad-seed"),
        ("Y_Name = \"V\"", "Y_Name = \"W\"", "unknown-output"),
        ("F_Mut = 0.25", "F_Mut = (0.25", "unclosed-bracket"),
    ];
    let mut wrong = Vec::new();
    for (from, to, code) in cases {
        let run = with_change(from, to);
        if run.codes() != [code] || run.status.code != 1 {
            wrong.push(format!("{to}: {:?}", run.codes()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
