model Checked
  function check
    input Real table[:];
  algorithm
    for i in 2:size(table, 1) loop
      assert(table[i] > table[i - 1], "not ascending");
    end for;
  end check;
  parameter Real table[3] = {0, 1, 2};
  Real x(start = 1, fixed = true);
initial algorithm
  check(table);
equation
  der(x) = -x;
end Checked;
