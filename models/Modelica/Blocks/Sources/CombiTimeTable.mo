within Modelica.Blocks.Sources;
block CombiTimeTable "Columns of a table over time"
  extends Modelica.Blocks.Interfaces.MO(final nout = max(size(columns, 1), size(offset, 1)));
  import Modelica.Blocks.Tables.Internal;
  import Modelica.Blocks.Types.Smoothness;
  import Modelica.Blocks.Types.TimeEvents;
  parameter Boolean tableOnFile = false "the table is in a file";
  parameter Real table[:, :] = fill(0.0, 0, 2) "points, if the table is not in a file: times and outputs";
  parameter String tableName = "NoName" "name of the table in the file";
  parameter String fileName = "NoName" "name of the file";
  parameter String delimiter = "," "between the columns of a CSV file";
  parameter Integer nHeaderLines = 0 "lines of a CSV file before the points";
  parameter Boolean verboseRead = true "tell that the file is read";
  parameter Integer columns[:] = 2:size(table, 2) "columns of the outputs";
  parameter Smoothness smoothness = Modelica.Blocks.Types.Smoothness.LinearSegments "between the points";
  parameter Modelica.Blocks.Types.Extrapolation extrapolation = Modelica.Blocks.Types.Extrapolation.LastTwoPoints
    "outside of the points";
  parameter SI.Time timeScale(min = Modelica.Constants.eps) = 1 "one unit of the times of the table";
  parameter Real offset[:] = {0} "added to the outputs: one number, or one for each";
  parameter SI.Time startTime = 0 "before it the outputs are the offsets";
  parameter SI.Time shiftTime = startTime "added to the times of the table";
  parameter TimeEvents timeEvents = Modelica.Blocks.Types.TimeEvents.Always "where events are";
  parameter Boolean verboseExtrapolation = false "warn where the time is outside of the table";
  final parameter SI.Time t_min = t_minScaled*timeScale "first time of the table";
  final parameter SI.Time t_max = t_maxScaled*timeScale "last time of the table";
  final parameter Real t_minScaled = Internal.getTimeTableTmin(tableID) "first time as it is in the table";
  final parameter Real t_maxScaled = Internal.getTimeTableTmax(tableID) "last time as it is in the table";
protected
  final parameter Real p_offset[nout] = if size(offset, 1) == 1 then fill(offset[1], nout) else offset
    "offset of each output";
  parameter Modelica.Blocks.Types.ExternalCombiTimeTable tableID = Modelica.Blocks.Types.ExternalCombiTimeTable(
    if tableOnFile then tableName else "NoName",
    if tableOnFile then fileName else "NoName",
    table,
    startTime/timeScale,
    columns,
    smoothness,
    extrapolation,
    shiftTime/timeScale,
    if smoothness == Smoothness.LinearSegments then timeEvents
      elseif smoothness == Smoothness.ConstantSegments then TimeEvents.Always
      else TimeEvents.NoTimeEvents,
    tableOnFile and verboseRead,
    delimiter,
    nHeaderLines) "the table";
  discrete SI.Time nextTimeEvent(start = 0, fixed = true) "time of the next event";
  discrete Real nextTimeEventScaled(start = 0, fixed = true) "the same as it is in the table";
  Real timeScaled "time as it is in the table";
equation
  timeScaled = time/timeScale;
  when {time >= pre(nextTimeEvent), initial()} then
    nextTimeEventScaled = Internal.getNextTimeEvent(tableID, timeScaled);
    nextTimeEvent = if nextTimeEventScaled < Modelica.Constants.inf/timeScale
      then nextTimeEventScaled*timeScale else Modelica.Constants.inf;
  end when;
  if verboseExtrapolation then
    assert(time - shiftTime >= t_min and time - shiftTime <= t_max,
      "the time is outside of the table", AssertionLevel.warning);
  end if;
  if smoothness == Smoothness.ConstantSegments then
    for i in 1:nout loop
      y[i] = p_offset[i]
        + Internal.getTimeTableValueNoDer(tableID, i, timeScaled, nextTimeEventScaled, pre(nextTimeEventScaled));
    end for;
  elseif smoothness == Smoothness.LinearSegments then
    for i in 1:nout loop
      y[i] = p_offset[i]
        + Internal.getTimeTableValueNoDer2(tableID, i, timeScaled, nextTimeEventScaled, pre(nextTimeEventScaled));
    end for;
  else
    for i in 1:nout loop
      y[i] = p_offset[i]
        + Internal.getTimeTableValue(tableID, i, timeScaled, nextTimeEventScaled, pre(nextTimeEventScaled));
    end for;
  end if;
end CombiTimeTable;
