//! The sorted system of every model in `tests/structure`.

use super::flat_class::flat;
use gapilib::dae::{report, sort};

#[test]
fn sorted_systems() {
    insta::glob!("../structure", "*.mo", |path| {
        let text = std::fs::read_to_string(path).expect("the model can be read");
        let shown = match sort(&flat(&text)) {
            Ok(sorted) => report(&sorted),
            Err(diagnostic) => {
                format!(
                    "error[{}]: {}\n{}",
                    diagnostic.code.slug,
                    diagnostic.message,
                    diagnostic.helps.join("\n")
                )
            }
        };
        let name = path.file_stem().expect("a file has a name").to_string_lossy().into_owned();
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(path.parent().expect("a file lies in a folder"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_snapshot_suffix("");
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!(name, shown));
    });
}
