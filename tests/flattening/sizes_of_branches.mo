// The sizes of an if-expression whose branches differ are those of the branch that parameters
// choose; an iterator does not change the sizes of an element (MLS §10.1, §10.4.1).
model SizesOfBranches
  block Table
    parameter Real data[:, 2] = [0, 0];
    output Real y;
  equation
    y = data[size(data, 1), 1];
  end Table;
  parameter Real times[:] = {1, 2, 3};
  final parameter Integer n = size(times, 1);
  parameter Boolean high = false;
  Table table(
    final data = if n > 0 then if high then [times[1], 1; times, {mod(i + 1, 2) for i in 1:n}]
      else [times[1], 0; times, {mod(i, 2) for i in 1:n}] else [0, 1]);
end SizesOfBranches;
