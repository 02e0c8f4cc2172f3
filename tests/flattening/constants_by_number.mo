// A loop variable of a function chooses among the records of a constant array.
model constants_by_number
  record Data
    String name;
    Real MM;
    Real c[2];
  end Data;
  package Medium
    constant Data data[2] = {Data("a", 1, {1, 2}), Data("b", 2, {3, 4})};
    function f
      input Real x[:];
      output Real y = sum(x[j]/data[j].MM for j in 1:size(x, 1));
    algorithm
      for i in 1:size(x, 1) loop
        y := y + data[i].c[i];
      end for;
    end f;
  end Medium;
  Real y = Medium.f({time, 2});
end constants_by_number;
