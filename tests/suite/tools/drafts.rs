//! `gapi new` on exports of instruments and loggers: which column means which variable, and that the draft runs.

use crate::support::program::{folder, gapi};

/// Drafts a problem for a table and a model `M`, which must name these pairs of entries, and runs it.
fn drafted(table: &str, model: &str, entries: &[&str]) -> String {
    let here = folder(&[("d.csv", table), ("M.mo", model)]);
    let (code, out, errors) = gapi(&here, &["new", "d.csv", "--model", "M.mo"]);
    let text = std::fs::read_to_string(here.path().join("d.toml")).unwrap_or_default();
    assert!(code == 0 && out.contains("gapi identify d.toml"), "{out}{errors}\n{text}");
    for entry in entries {
        assert!(text.contains(entry), "`{entry}` is not in: {text}");
    }
    let (code, out, errors) =
        gapi(&here, &["identify", "d.toml", "--evaluations", "30", "--out", "o"]);
    assert_eq!(code, 0, "{out}{errors}\n{text}");
    text
}

/// Rows of a table, `k` from 0.
fn rows(count: u32, row: impl Fn(f64) -> String) -> String {
    (0..count).map(|k| row(f64::from(k)) + "\n").collect()
}

#[test]
fn a_battery_cycler_names_voltage_and_current() {
    let model = "model M\n  parameter Real R0(unit = \"Ohm\") = 2e-3;\n  parameter Real R1(unit = \"Ohm\") = 1e-3;\n\
                 parameter Real C1(unit = \"F\") = 1e4;\n  input Real I(unit = \"A\");\n  output Real V(unit = \"V\");\n\
                 Real v1(unit = \"V\", start = 0, fixed = true);\nequation\n  C1*der(v1) = I - v1/R1;\n\
                 V = 3.7 + R0*I + v1;\nend M;\n";
    let head = "Data_Point,Test_Time(s),Step_Index,Current(A),Voltage(V),Aux_Temperature(C)_1\n";
    let table = rows(30, |k| {
        format!("{},{k},7,{},{},25", k + 1.0, 10.0 * (k % 2.0), 3.7 + 0.02 * (k % 2.0))
    });
    let entries = [
        "column = \"Test_Time\"",
        "outputs.V = { column = \"Voltage\"",
        "inputs.I = { column = \"Current\"",
    ];
    let text = drafted(&(head.to_owned() + &table), model, &entries);
    assert!(text.contains("# not used: column \"Step_Index\""), "{text}");
}

#[test]
fn a_building_has_dates_decimal_commas_and_two_temperatures() {
    let model = "model M\n  parameter Real C(unit = \"J/K\") = 1e6;\n  parameter Real R(unit = \"K/W\") = 0.01;\n\
                 parameter Real Ti0(unit = \"degC\") = 20;\n  input Real Ta(unit = \"degC\");\n  input Real P(unit = \"W\");\n\
                 output Real Ti(unit = \"degC\", start = Ti0, fixed = true);\nequation\n\
                 C*der(Ti) = (Ta - Ti)/R + P;\nend M;\n";
    let head = "Zeitstempel;T_aussen [°C];T_innen [°C];P_heiz [W]\n";
    let table = rows(20, |k| {
        let (hours, minutes) = ((k / 4.0).floor(), 15.0 * (k % 4.0));
        format!("01.01.2023 0{hours}:{minutes:02};-1,{k};18,{};{}", 10.0 + k, 100.0 * (k % 3.0))
    });
    let entries = [
        "outputs.Ti = { column = \"T_innen\"",
        "inputs.Ta = { column = \"T_aussen\"",
        "inputs.P = { column = \"P_heiz\"",
        "column = \"Zeitstempel\"",
    ];
    let text = drafted(&(head.to_owned() + &table), model, &entries);
    assert!(!text.contains("converted to degC"), "°C is degC: {text}");
    let initial = text.lines().find(|line| line.starts_with("Ti0")).unwrap();
    assert!(initial.contains("around the first measured value"), "{initial}");
}

/// A line of means below the numbers makes a text of the column of times: another quantity does not take
/// its place.
#[test]
fn what_cannot_be_times_is_not_taken_for_them() {
    let tank = "model M\n  parameter Real k = 0.1;\n  output Real h(unit = \"m\", start = 1, fixed = true);\n\
                equation\n  der(h) = -k*h;\nend M;\n";
    let rows = rows(8, |k| format!("{k};{};{}", 1000.0 + k, 100.0 - 5.0 * k));
    let table = format!("Zeit [s];Druck [mbar];h [cm]\n{rows}Mittelwert;;80\n");
    let here = folder(&[("d.csv", &table), ("M.mo", tank)]);
    let (code, out, errors) = gapi(&here, &["new", "d.csv", "--model", "M.mo"]);
    let text = std::fs::read_to_string(here.path().join("d.toml")).unwrap_or_default();
    assert!(code == 0 && out.contains("it cannot run yet"), "{out}{errors}");
    assert!(text.contains("# x = { variable = \"time\"") && !text.contains("\nx = "), "{text}");
    assert!(text.contains("`Mittelwert` in `Zeit [s]` is not a number"), "{text}");
    assert!(text.contains("# not used: column \"Druck\""), "{text}");
}

#[test]
fn a_unit_or_the_beginning_of_a_name_decides() {
    let tank = "model M\n  parameter Real k(min = 0.001, max = 1) = 0.1;\n\
                output Real h(unit = \"m\", start = 1, fixed = true);\nequation\n  der(h) = -k*h;\nend M;\n";
    let text = drafted(
        &("t [min];Füllstand [cm]\n".to_owned() + &rows(8, |k| format!("{k};{}", 100.0 - 5.0 * k))),
        tank,
        &["outputs.h = { column = \"Füllstand\"", "converted to m"],
    );
    assert!(text.contains("k = { min = 0.001, max = 1.0 }"), "{text}");
    let reactor = "model M\n  parameter Real k = 0.1;\n  parameter Real T(unit = \"degC\") = 60;\n\
                   output Real c(start = 2, fixed = true);\nequation\n  der(c) = -k*c*T/60;\nend M;\n";
    let text = drafted(
        &("time_s,conc\n".to_owned() + &rows(8, |k| format!("{k},{}", 2.0 - 0.2 * k))),
        reactor,
        &["outputs.c = { column = \"conc\"", "column = \"time_s\""],
    );
    assert!(text.contains("T = { min = 40.0, max = 80.0 }"), "{text}");
}

/// A date and a time of day in two columns; units after `in`, one with a slash; indoor and outdoor
/// temperatures that come in the order in which they are mistaken for each other.
#[test]
fn a_logger_with_date_and_clock_is_matched_by_descriptions() {
    let model = "model M\n  parameter Real C(unit = \"J/K\") = 1e6;\n  parameter Real R(unit = \"K/W\") = 0.01;\n\
                 parameter Real A(unit = \"m2\") = 1;\n  input Real Ta(unit = \"degC\") \"outdoor temperature\";\n\
                 input Real G(unit = \"W/m2\") \"global radiation\";\n\
                 output Real Ti(unit = \"degC\", start = 20, fixed = true) \"room temperature\";\nequation\n\
                 C*der(Ti) = (Ta - Ti)/R + A*G;\nend M;\n";
    let head =
        "Datum;Uhrzeit;Aussentemperatur in °C;Globalstrahlung in W/m²;Raumtemperatur in °C\n";
    let table = rows(40, |k| {
        let (day, hours) = (1.0 + (k / 24.0).floor(), k % 24.0);
        format!("0{day}.02.2024;{hours:02}:00;-1,{};{};1{},2", k % 9.0, 10.0 * k, 5.0 + k % 4.0)
    });
    drafted(
        &(head.to_owned() + &table),
        model,
        &[
            "column = \"Uhrzeit\"",
            "outputs.Ti = { column = \"Raumtemperatur\"",
            "inputs.Ta = { column = \"Aussentemperatur\"",
            "inputs.G = { column = \"Globalstrahlung\"",
        ],
    );
}

/// A state of charge ends at 1, whatever its value in the model.
#[test]
fn a_fraction_ends_at_one() {
    let model = "model M\n  parameter Real SOC0(unit = \"1\") = 0.8 \"initial state of charge\";\n\
                 parameter Real eta = 0.9 \"efficiency\";\n  parameter Real k = 0.5 \"rate\";\n\
                 Real s(start = SOC0, fixed = true);\n  output Real y = s*eta;\nequation\n  der(s) = -k*s;\nend M;\n";
    let table = format!("time,y\n{}", rows(10, |k| format!("{},{}", k / 10.0, 0.7 - k / 30.0)));
    drafted(
        &table,
        model,
        &[
            "SOC0 = { min = 0.0, max = 1.0 }",
            "eta = { min = 0.0, max = 1.0 }",
            "k = { min = 0.05, max = 5.0 }",
        ],
    );
}

#[test]
fn a_curve_is_matched_by_its_units() {
    let cell = "model M\n  parameter Real V0 = 1;\n  parameter Real R = 0.1;\n  input Real i(unit = \"A\");\n\
                output Real V(unit = \"V\");\nequation\n  V = V0 - R*i;\nend M;\n";
    drafted(
        &("I [A];U [mV]\n".to_owned() + &rows(8, |k| format!("{k};{}", 900.0 - 25.0 * k))),
        cell,
        &["x = { variable = \"i\", column = \"I\" }", "outputs.V = { column = \"U\""],
    );
}

#[test]
fn without_names_and_units_the_start_value_decides() {
    let block = "model M\n  parameter Real G(unit = \"W/K\") = 2;\n  Real T(unit = \"K\", start = 293, fixed = true);\n\
                 Real x(start = 0, fixed = true);\nequation\n  der(T) = -G*(T - 290)/100;\n  der(x) = T - 293;\nend M;\n";
    let text = drafted(
        &("c1,c2,c3\n".to_owned()
            + &rows(8, |k| format!("{k},{},{}", 5.0 * k + 40.0, 293.0 - 0.1 * k))),
        block,
        &["outputs.T = { column = \"c3\"", "x = { variable = \"time\", column = \"c1\" }"],
    );
    assert!(text.contains("it may also be `x`"), "{text}");
}

#[test]
fn a_unit_of_another_quantity_is_no_match() {
    let model = "model M\n  parameter Real k = 0.1;\n  output Real v(unit = \"V\", start = 5, fixed = true);\n\
                 equation\n  der(v) = -k*v;\nend M;\n";
    let text = drafted(
        &("time,v_wind [m/s],Spannung\n".to_owned()
            + &rows(8, |k| format!("{k},3,{}", 5.0 - 0.3 * k))),
        model,
        &["outputs.v = { column = \"Spannung\""],
    );
    assert!(text.contains("# not used: column \"v_wind\""), "{text}");
}

/// Where all parameters are those of components, the draft has them as comments to choose among.
#[test]
fn parameters_of_components_are_proposed() {
    let model = "model M\n  model Tank parameter Real A = 2; parameter Real k = 0.5; Real h(start = 1, fixed = true);\n\
                 equation A*der(h) = -k*h; end Tank;\n  Tank tank[25];\n  output Real y = tank[1].h;\nend M;\n";
    let table = format!("time,y\n{}", rows(10, |k| format!("{k},{}", (-k / 4.0).exp())));
    let here = folder(&[("d.csv", table.as_str()), ("M.mo", model)]);
    let (code, out, errors) = gapi(&here, &["new", "d.csv", "--model", "M.mo"]);
    assert_eq!(code, 0, "{out}{errors}");
    let text = std::fs::read_to_string(here.path().join("d.toml")).unwrap();
    assert!(text.contains("\n# \"tank[1].k\" = { min = "), "{text}");
    assert!(text.contains("\n# and 30 more\n"), "{text}");
}

/// A table in the model is not estimated number by number: the draft says how one of them could be.
#[test]
fn tables_keep_their_numbers() {
    let model = "model M\n  parameter Real k = 1;\n  parameter Real c[2] = {1, 2};\n\
                 parameter Real ocv[3,2] = [0, 3; 0.5, 3.5; 1, 4];\n  Real x(start = 1, fixed = true);\n\
                 output Real y;\nequation\n  der(x) = -k*x;\n  y = ocv[1,2] + c[1]*x + c[2];\nend M;\n";
    let table = format!("time,y\n{}", rows(10, |k| format!("{},{}", k / 10.0, 7.0 - k / 20.0)));
    let text = drafted(&table, model, &["\nk = {", "\n\"c[1]\" = {", "# ocv keeps its 6 values"]);
    assert!(!text.contains("\n\"ocv["), "{text}");
}
