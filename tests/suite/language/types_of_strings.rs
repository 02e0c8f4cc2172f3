//! What `String` writes follows from the type of its argument, whatever expression it is.

use gapilib::Session;

#[test]
fn strings_of_expressions_have_the_types_of_their_values() {
    let model = include_str!("../../data/models/types_of_strings.mo");
    let world = crate::support::shipped::world().with_file("T.mo", model);
    let streams = world.streams();
    let script = "openModel(\"T.mo\");\nsimulateModel(\"T.M\", stopTime = 1);";
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    assert_eq!(status.code, 0, "{}", streams.errors());
    let lines = [
        "1;2.5;2;1;1;1;low;low | low low | 1 1 2",
        "1;2.5;3;1.5;1.5;1;high;high | high high | 2.5 2.5 3",
    ];
    for line in lines {
        assert!(streams.output().contains(line), "`{line}` is not in {}", streams.output());
    }
}
