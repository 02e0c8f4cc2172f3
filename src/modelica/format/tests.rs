//! Layouts of single constructs.

use super::*;

fn modelica(text: &str) -> String {
    format(SourceId::NONE, text, Language::Modelica).expect("it can be read")
}

fn script(text: &str) -> String {
    format(SourceId::NONE, text, Language::Script).expect("it can be read")
}

#[test]
fn empty_files_stay_empty() {
    assert_eq!(modelica(""), "");
    assert_eq!(script("\n\n"), "");
}

#[test]
fn line_ends_of_the_file_are_kept() {
    assert_eq!(script("x=1\r\n\r\n\r\ny=2\r\n"), "x = 1\r\n\r\ny = 2\r\n");
}
