within Modelica.Blocks.Tables;
package Internal "What the tables outside of Modelica offer"
  extends Modelica.Icons.InternalPackage;

  function getTimeTableValue "Value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTimeTable_getValue(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent);
    annotation(derivative(noDerivative = nextTimeEvent, noDerivative = pre_nextTimeEvent) = getDerTimeTableValue);
  end getTimeTableValue;

  function getTimeTableValueNoDer "Value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTimeTable_getValue(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent);
  end getTimeTableValueNoDer;

  function getTimeTableValueNoDer2 "Value that is to be differentiated once at most"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTimeTable_getValue(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent);
    annotation(derivative(noDerivative = nextTimeEvent, noDerivative = pre_nextTimeEvent) = getDerTimeTableValueNoDer);
  end getTimeTableValueNoDer2;

  function getDerTimeTableValue "Derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    input Real der_timeIn "derivative of time";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTimeTable_getDerValue(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent, der_timeIn);
    annotation(derivative(order = 2, noDerivative = nextTimeEvent, noDerivative = pre_nextTimeEvent) = getDer2TimeTableValue);
  end getDerTimeTableValue;

  function getDerTimeTableValueNoDer "Derivative of the value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    input Real der_timeIn "derivative of time";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTimeTable_getDerValue(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent, der_timeIn);
  end getDerTimeTableValueNoDer;

  function getDer2TimeTableValue "Second derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Integer icol "number of the output";
    input Real timeIn "time";
    input Real nextTimeEvent "time of the next event";
    input Real pre_nextTimeEvent "the same before an event";
    input Real der_timeIn "derivative of time";
    input Real der2_timeIn "second derivative of time";
    output Real der2_y "second derivative";
  external "C" der2_y = ModelicaStandardTables_CombiTimeTable_getDer2Value(tableID, icol, timeIn, nextTimeEvent, pre_nextTimeEvent, der_timeIn, der2_timeIn);
  end getDer2TimeTableValue;

  function getTable1DValue "Value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable1D_getValue(tableID, icol, u);
    annotation(derivative = getDerTable1DValue);
  end getTable1DValue;

  function getTable1DValueNoDer "Value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable1D_getValue(tableID, icol, u);
  end getTable1DValueNoDer;

  function getTable1DValueNoDer2 "Value that is to be differentiated once at most"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable1D_getValue(tableID, icol, u);
    annotation(derivative = getDerTable1DValueNoDer);
  end getTable1DValueNoDer2;

  function getDerTable1DValue "Derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    input Real der_u "derivative of the input";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTable1D_getDerValue(tableID, icol, u, der_u);
    annotation(derivative(order = 2) = getDer2Table1DValue);
  end getDerTable1DValue;

  function getDerTable1DValueNoDer "Derivative of the value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    input Real der_u "derivative of the input";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTable1D_getDerValue(tableID, icol, u, der_u);
  end getDerTable1DValueNoDer;

  function getDer2Table1DValue "Second derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    input Integer icol "number of the output";
    input Real u "input";
    input Real der_u "derivative of the input";
    input Real der2_u "second derivative of the input";
    output Real der2_y "second derivative";
  external "C" der2_y = ModelicaStandardTables_CombiTable1D_getDer2Value(tableID, icol, u, der_u, der2_u);
  end getDer2Table1DValue;

  function getTable2DValue "Value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable2D_getValue(tableID, u1, u2);
    annotation(derivative = getDerTable2DValue);
  end getTable2DValue;

  function getTable2DValueNoDer "Value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable2D_getValue(tableID, u1, u2);
  end getTable2DValueNoDer;

  function getTable2DValueNoDer2 "Value that is to be differentiated once at most"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    output Real y "value";
  external "C" y = ModelicaStandardTables_CombiTable2D_getValue(tableID, u1, u2);
    annotation(derivative = getDerTable2DValueNoDer);
  end getTable2DValueNoDer2;

  function getDerTable2DValue "Derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    input Real der_u1 "derivative of the first input";
    input Real der_u2 "derivative of the second input";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTable2D_getDerValue(tableID, u1, u2, der_u1, der_u2);
    annotation(derivative(order = 2) = getDer2Table2DValue);
  end getDerTable2DValue;

  function getDerTable2DValueNoDer "Derivative of the value that is not to be differentiated"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    input Real der_u1 "derivative of the first input";
    input Real der_u2 "derivative of the second input";
    output Real der_y "derivative";
  external "C" der_y = ModelicaStandardTables_CombiTable2D_getDerValue(tableID, u1, u2, der_u1, der_u2);
  end getDerTable2DValueNoDer;

  function getDer2Table2DValue "Second derivative of the value"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    input Real u1 "first input";
    input Real u2 "second input";
    input Real der_u1 "derivative of the first input";
    input Real der_u2 "derivative of the second input";
    input Real der2_u1 "second derivative of the first input";
    input Real der2_u2 "second derivative of the second input";
    output Real der2_y "second derivative";
  external "C" der2_y = ModelicaStandardTables_CombiTable2D_getDer2Value(tableID, u1, u2, der_u1, der_u2, der2_u1, der2_u2);
  end getDer2Table2DValue;

  function getTimeTableTmin "First time"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    output Real timeMin "first time";
  external "C" timeMin = ModelicaStandardTables_CombiTimeTable_minimumTime(tableID);
  end getTimeTableTmin;

  function getTimeTableTmax "Last time"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    output Real timeMax "last time";
  external "C" timeMax = ModelicaStandardTables_CombiTimeTable_maximumTime(tableID);
  end getTimeTableTmax;

  function getNextTimeEvent "Time of the next event"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTimeTable tableID "table";
    input Real timeIn "time";
    output Real nextTimeEvent "time of the next event";
  external "C" nextTimeEvent = ModelicaStandardTables_CombiTimeTable_nextTimeEvent(tableID, timeIn);
  end getNextTimeEvent;

  function getTable1DAbscissaUmin "Smallest input"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    output Real uMin "smallest input";
  external "C" uMin = ModelicaStandardTables_CombiTable1D_minimumAbscissa(tableID);
  end getTable1DAbscissaUmin;

  function getTable1DAbscissaUmax "Greatest input"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable1D tableID "table";
    output Real uMax "greatest input";
  external "C" uMax = ModelicaStandardTables_CombiTable1D_maximumAbscissa(tableID);
  end getTable1DAbscissaUmax;

  function getTable2DAbscissaUmin "Smallest inputs"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    output Real uMin[2] "smallest inputs";
  external "C" ModelicaStandardTables_CombiTable2D_minimumAbscissa(tableID, uMin);
  end getTable2DAbscissaUmin;

  function getTable2DAbscissaUmax "Greatest inputs"
    extends Modelica.Icons.Function;
    input Modelica.Blocks.Types.ExternalCombiTable2D tableID "table";
    output Real uMax[2] "greatest inputs";
  external "C" ModelicaStandardTables_CombiTable2D_maximumAbscissa(tableID, uMax);
  end getTable2DAbscissaUmax;
end Internal;
