within Modelica.Blocks.Sources;
block TimeTable "Straight lines between points over time"
  parameter Real table[:, 2] = fill(0.0, 0, 2) "points: times, not decreasing, and outputs";
  parameter SI.Time timeScale(min = Modelica.Constants.eps) = 1 "one unit of the times of the table";
  extends Modelica.Blocks.Interfaces.SignalSource;
  parameter SI.Time shiftTime = startTime "added to the times of the table";
protected
  discrete Real a "height of the line at the time of the table zero";
  discrete Real b "slope of the line, per unit of the times of the table";
  discrete SI.Time nextEvent(start = 0, fixed = true) "time of the next point";
  Real x = (time - shiftTime)/timeScale "time as it is in the table";

  function segment "The line at a time"
    extends Modelica.Icons.Function;
    input Real table[:, 2] "points";
    input Real x "time";
    output Real a "height of the line at zero";
    output Real b "its slope";
    output Real end_ "time of the point behind, or infinity";
  protected
    Integer n = size(table, 1) "number of points";
    constant Real tolerance = 1e-13 "relative error of the time";
  algorithm
    assert(n > 0, "the table is empty");
    a := table[1, 2];
    b := 0;
    end_ := Modelica.Constants.inf;
    for k in 1:n - 1 loop
      assert(table[k + 1, 1] >= table[k, 1], "the times of the table decrease: " + String(table[k + 1, 1])
        + " in row " + String(k + 1) + " follows " + String(table[k, 1]));
      if k == 1 or x >= table[k, 1] - tolerance*abs(x) then
        if table[k + 1, 1] > table[k, 1] then
          b := (table[k + 1, 2] - table[k, 2])/(table[k + 1, 1] - table[k, 1]);
          a := table[k, 2] - b*table[k, 1];
        else
          b := 0;
          a := table[k + 1, 2];
        end if;
        end_ := table[k + 1, 1];
      end if;
    end for;
    if x >= table[n, 1] - tolerance*abs(x) then
      end_ := Modelica.Constants.inf;
    end if;
  end segment;

  discrete Real end_ "time of the next point as it is in the table";
equation
  when {time >= pre(nextEvent), initial()} then
    (a, b, end_) = segment(table, x);
    nextEvent = if time < startTime then startTime
      elseif end_ < Modelica.Constants.inf then shiftTime + timeScale*end_
      else Modelica.Constants.inf;
  end when;
  y = offset + (if time < startTime then 0 else a + b*x);
  annotation(Documentation(info = "<html>
<p>Before the first and behind the last point the first and last line goes on. A jump is made by two
points of the same time.</p>
</html>"));
end TimeTable;
