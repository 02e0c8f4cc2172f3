//! Functions that rearrange arrays of records in models (MLS §10.3.3, §10.3.5, §10.4.2).

use gapilib::script::Session;
use gapilib::script::world::MemoryWorld;

const MODEL: &str = "model M
  record Point
    Real x;
    Real y[2];
  end Point;
  parameter Integer n = 2;
  Point filled[n] = fill(Point(time, {1, 2}), n);
  Point joined[n + 1] = cat(1, filled, {Point(3, {4, 5})});
  Point grid[2, 1] = {{filled[1]}, {Point(6, {7, 8})}};
  Point turned[1, 2] = transpose(grid);
  parameter Point given[n] = fill(Point(9, {10, 11}), n);
end M;";

#[test]
fn records_are_filled_joined_and_transposed() {
    let world = MemoryWorld::new().with_file("M.mo", MODEL);
    let streams = world.streams();
    let script = "openModel(\"M.mo\");
simulateModel(\"M\", stopTime = 0.5, resultFile = \"r\");
names := {\"filled[2].x\", \"joined[3].x\", \"joined[2].y[2]\", \"joined[3].y[1]\",
          \"turned[1, 2].x\", \"turned[1, 1].y[2]\", \"turned[1, 2].y[2]\", \"given[2].y[1]\"};
for i in 1:size(names, 1) loop
  value := readTrajectory(\"r.mat\", {names[i]}, readTrajectorySize(\"r.mat\"));
  print(names[i] + \" \" + String(value[1, end]));
end for;";
    let status = Session::new(Box::new(world)).run_text("s.mos", script);
    assert_eq!((status.code, streams.errors().as_str()), (0, ""));
    let output = streams.output();
    let values: Vec<&str> = output
        .lines()
        .filter_map(|line| line.split_once("] ").or(line.split_once(".x ")))
        .map(|(_, value)| value)
        .collect();
    assert_eq!(values, ["0.5", "3", "2", "4", "6", "2", "8", "10"], "{output}");
}
