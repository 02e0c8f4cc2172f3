// MLS §12.7.1, §12.9.7, §18.3: functions with derivatives, external objects, and annotations that
// ask for the evaluation of a parameter.
package external_objects
  class Table
    extends ExternalObject;
    function constructor
      input String name;
      output Table table;
    external "C" table = newTable(name);
    end constructor;
    function destructor
      input Table table;
    external "C" freeTable(table);
    end destructor;
  end Table;
  function square
    input Real x;
    output Real y = x^2;
  algorithm
    annotation(derivative = slope);
  end square;
  function slope
    input Real x, dx;
    output Real dy = 2*x*dx;
  algorithm
  end slope;
  model Main
    Table table = Table("a.txt");
    parameter Integer n = 2 annotation(Evaluate = true);
    Real y = square(n*time);
  end Main;
end external_objects;
