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
    Integer i "point behind the time";
  algorithm
    assert(n > 0, "the table is empty");
    i := n + 1;
    end_ := Modelica.Constants.inf;
    for k in n:-1:1 loop
      if table[k, 1] > x + 1e-13*abs(x) then
        i := k;
        end_ := table[k, 1];
      end if;
    end for;
    i := max(2, min(i, n));
    if n == 1 then
      b := 0;
      a := table[1, 2];
    elseif table[i, 1] > table[i - 1, 1] then
      b := (table[i, 2] - table[i - 1, 2])/(table[i, 1] - table[i - 1, 1]);
      a := table[i - 1, 2] - b*table[i - 1, 1];
    else
      b := 0;
      a := table[i, 2];
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
