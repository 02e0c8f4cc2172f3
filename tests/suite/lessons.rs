//! The lessons of `gapi lesson`: each runs as it is shipped, passes its check, and says the same as
//! recorded; a learner's wrong answer does not pass.

use crate::cli::{folder, gapi};
use crate::shipped;
use gapilib::script::{Session, Transcript};
use std::path::Path;

#[test]
fn lessons_say_what_is_recorded() {
    let lessons = shipped::files("scripts/lessons", "mos");
    assert_eq!(lessons.len(), 12);
    for path in lessons {
        let name = path.file_name().unwrap().to_str().unwrap();
        let mut session = Session::new(Box::new(shipped::world()));
        session.output.transcript = Some(Transcript::default());
        let status = session.run_file(&Path::new("scripts/lessons").join(name));
        let transcript = session.output.transcript.take().unwrap_or_default().to_string();
        let number: u32 = name[..2].parse().unwrap();
        assert_eq!(status.code, 0, "{name}: {transcript}");
        assert!(transcript.contains(&format!("\nLesson {number} passed.")), "{name}: {transcript}");
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path("../lessons");
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!(name.trim_end_matches(".mos"), transcript));
    }
}

#[test]
fn the_command_runs_the_copy_of_the_learner() {
    let here = folder(&[]);
    let (code, out, _) = gapi(&here, &["lesson"]);
    assert_eq!((code, out.matches("\nLesson ").count()), (0, 11));
    let (code, out, _) = gapi(&here, &["lesson", "1"]);
    assert!(code == 0 && out.contains("Lesson 1 passed."), "{out}");
    assert!(out.ends_with("The next lesson: gapi lesson 2\n"), "{out}");
    let copy = here.path().join("lessons/01_one_parameter_by_hand.mos");
    let text = std::fs::read_to_string(&copy).unwrap();
    std::fs::write(&copy, text.replace("Guess := 4;", "Guess := 5;")).unwrap();
    let (_, out, errors) = gapi(&here, &["lesson", "1"]);
    assert!(out.contains("Lesson 1 is not passed yet."), "{out}");
    assert!(errors.contains("the guess is not good enough yet"), "{errors}");
    let (code, _, errors) = gapi(&here, &["lesson", "13"]);
    assert_eq!((code, errors.trim()), (2, "error: there is no lesson 13, only 1 to 12"));
}
