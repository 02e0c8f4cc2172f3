//! Files of impedance instruments whose table is one part of many: everything else becomes blank lines,
//! so that lines keep their numbers.

use std::borrow::Cow;

/// The table of a file of Gamry (`.DTA`) or ZView (`.z`), with names and units as in other tables; any
/// other text as it is.
pub(super) fn table_of(text: Cow<'_, str>) -> Cow<'_, str> {
    if text.starts_with("EXPLAIN\n") {
        return gamry(&text).map_or(text, Cow::Owned);
    }
    let first = text.lines().next().unwrap_or_default();
    let is_zview = first.starts_with("ZPLOT2") || first.trim_matches('"').contains("W Data File");
    match is_zview {
        true => zview(&text).map_or(text, Cow::Owned),
        false => text,
    }
}

/// The table `ZCURVE`: a row of names, one of units, and rows that begin with a tab.
fn gamry(text: &str) -> Option<String> {
    let begin = text.lines().position(|line| line.starts_with("ZCURVE\tTABLE"))?;
    let rows = text.lines().skip(begin + 1);
    let count = rows.clone().take_while(|line| line.starts_with('\t')).count();
    let mut table = "\n".repeat(begin + 1);
    for line in rows.take(count) {
        table.push_str(line);
        table.push('\n');
    }
    (count > 2).then_some(table)
}

/// Everything after the line of names, which may be one quoted cell, and the end of the comments.
fn zview(text: &str) -> Option<String> {
    let is_head = |line: &str| {
        let line = line.trim_matches(['"', ' ', '\t']);
        line.starts_with("Freq") && line.contains("Z'")
    };
    let head = text.lines().position(is_head)?;
    let rows =
        || text.lines().skip(head + 1).map(|line| if line == "End Comments" { "" } else { line });
    let separator = match rows().find(|row| !row.is_empty())?.contains('\t') {
        true => "\t",
        false => ",",
    };
    let line = text.lines().nth(head)?.trim_matches(['"', ' ', '\t']);
    let names: Vec<&str> = match line.contains('\t') {
        true => line.split('\t').collect(),
        false => line.split("  ").filter(|name| !name.trim().is_empty()).collect(),
    };
    // The letters in brackets stand for curves on the screen.
    let plain =
        |name: &&str| name.trim().trim_end_matches("(a)").trim_end_matches("(b)").to_owned();
    let names: Vec<String> = names.iter().map(plain).collect();
    let rows: Vec<&str> = rows().collect();
    Some(format!("{}{}\n{}\n", "\n".repeat(head), names.join(separator), rows.join("\n")))
}

#[cfg(test)]
mod tests {
    use crate::mat::read_named;

    fn columns(name: &str, text: &str) -> Vec<(String, Option<String>, Vec<f64>)> {
        let file = read_named(name, text.as_bytes()).unwrap();
        let column = |name: &String| {
            let column = file.column(name).unwrap();
            (name.clone(), column.about.unit, column.values)
        };
        file.arrays.keys().map(column).collect()
    }

    #[test]
    fn the_impedance_of_a_gamry_file_is_one_of_its_tables() {
        let text = "EXPLAIN\nTAG\tEISPOT\nOCVCURVE\tTABLE\t2\n\tPt\tVf\n\t#\tV\n\t0\t0.1\nZCURVE\tTABLE\n\
            \tPt\tFreq\tZreal\tZphz\n\t#\tHz\tohm\t°\n\t0\t1e5\t0.5\t-3\n\t1\t1e4\t0.75\t-4\nEND\tX\n";
        let read = columns("a.DTA", text);
        assert_eq!(read[1], ("Freq".to_owned(), Some("Hz".to_owned()), vec![1e5, 1e4]));
        assert_eq!((read[2].0.as_str(), &read[2].2), ("Zreal", &vec![0.5, 0.75]));
    }

    /// Autolab (Nova) writes a table as others do.
    #[test]
    fn autolab_names_its_units_in_brackets() {
        let text = "Index;Frequency (Hz);Z' (Ω);-Z'' (Ω);Z (Ω);-Phase (°);Time (s)\n\
            1;10000;0.05;0.0008;0.05;0.9;0\n2;7585.78;0.0501;0.001;0.0501;1.2;3.2\n";
        let read = columns("a.txt", text);
        assert_eq!(read[1].2, [10000.0, 7585.78]);
        assert_eq!((read[3].0.as_str(), &read[3].2), ("-Z'' (Ω)", &vec![0.0008, 0.001]));
    }

    #[test]
    fn zview_writes_its_names_as_one_cell_or_before_the_end_of_comments() {
        let quoted = "\"Z60W Data File: Version 1.1\"\n\"\"\n0,2,0,1\n41\n\
            \"  Freq (Hz)    Ampl     Time(Sec)   Z'(a)    Z''(b)    GD\"\n\
            10000,0,0,0.01,0.007,0\n7498.9,0,0,0.02,0.005,0\n";
        let tabs = "ZPLOT2 ASCII\n  Date:   10-12-2018\n  Data Points:   56\n\
            \x20 Freq(Hz)\tAmpl\tTime(Sec)\tZ'(a)\tZ''(b)\tGD\nEnd Comments\n\
            10000\t0\t0\t0.01\t0.007\t0\n7498.9\t0\t0\t0.02\t0.005\t0\n";
        for (name, text) in [("a.txt", quoted), ("a.z", tabs)] {
            let read = columns(name, text);
            assert!(read[0].0.starts_with("Freq") && read[0].2 == [10000.0, 7498.9], "{read:?}");
            assert_eq!((read[3].0.as_str(), &read[3].2), ("Z'", &vec![0.01, 0.02]));
            assert_eq!((read[4].0.as_str(), &read[4].2), ("Z''", &vec![0.007, 0.005]));
        }
    }
}
