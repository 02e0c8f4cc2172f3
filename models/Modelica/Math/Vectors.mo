within Modelica.Math;
package Vectors "Functions of vectors"
  extends Modelica.Icons.Package;

  function toString "Text of a vector, an element a line"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    input String name = "" "its name";
    input Integer significantDigits = 6 "digits of an element";
    output String s = "" "text";
  algorithm
    s := if name == "" then "" else name + " = \n";
    for i in 1:size(v, 1) loop
      s := s + "  " + String(v[i], significantDigits = significantDigits) + "\n";
    end for;
  end toString;

  function isEqual "Whether two vectors are equal within a tolerance"
    extends Modelica.Icons.Function;
    input Real v1[:] "vector";
    input Real v2[:] "another";
    input Real eps(min = 0) = 0 "tolerance of an element";
    output Boolean result "whether they are";
  algorithm
    result := size(v1, 1) == size(v2, 1);
    if result then
      for i in 1:size(v1, 1) loop
        result := result and abs(v1[i] - v2[i]) <= eps;
      end for;
    end if;
  end isEqual;

  function norm "p-norm of a vector"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    input Real p(min = 1) = 2 "1, 2, Modelica.Constants.inf, or a number between";
    output Real result "norm";
  protected
    Real largest = if size(v, 1) > 0 then max(abs(v)) else 0 "greatest absolute value";
  algorithm
    assert(p >= 1, "the p of the norm is less than 1");
    if p == 2 then
      result := sqrt(v*v);
    elseif p == 1 then
      result := sum(abs(v));
    elseif p >= Modelica.Constants.inf or largest == 0 then
      result := largest;
    else
      result := largest*sum((abs(v[i])/largest)^p for i in 1:size(v, 1))^(1/p);
    end if;
  end norm;

  function length "Euclidean length of a vector"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    output Real result "length";
  algorithm
    result := sqrt(v*v);
    annotation(Inline = true);
  end length;

  function normalize "The vector of length 1 in the same direction"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    input Real eps(min = 0.0) = 100*Modelica.Constants.eps "shorter vectors are divided by this length";
    output Real result[size(v, 1)](each final unit = "1") "vector of length 1";
  algorithm
    result := smooth(0, if length(v) >= eps then v/length(v) else v/eps);
    annotation(Inline = true);
  end normalize;

  function normalizeWithAssert "The vector of length 1 in the same direction; an error for a vector of zeros"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    output Real result[size(v, 1)] "vector of length 1";
  algorithm
    assert(length(v) > 0, "a vector of length 0 has no direction");
    result := v/length(v);
  end normalizeWithAssert;

  function reverse "The elements from last to first"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    output Real result[size(v, 1)] "reversed vector";
  algorithm
    result := {v[size(v, 1) + 1 - i] for i in 1:size(v, 1)};
    annotation(Inline = true);
  end reverse;

  function sort "Sorted elements and where they were"
    extends Modelica.Icons.Function;
    input Real v[:] "vector";
    input Boolean ascending = true "smallest first, else greatest first";
    output Real sorted_v[size(v, 1)] = v "sorted vector, equal elements in their order";
    output Integer indices[size(v, 1)] = 1:size(v, 1) "sorted_v = v[indices]";
  protected
    Real element "element to be placed";
    Integer place "where it goes";
  algorithm
    for i in 2:size(v, 1) loop
      element := v[i];
      place := i;
      while place > 1 loop
        if ascending and sorted_v[place - 1] <= element or not ascending and sorted_v[place - 1] >= element then
          break;
        end if;
        sorted_v[place] := sorted_v[place - 1];
        indices[place] := indices[place - 1];
        place := place - 1;
      end while;
      sorted_v[place] := element;
      indices[place] := i;
    end for;
  end sort;

  function find "Index of the first element equal to a number within a tolerance"
    extends Modelica.Icons.Function;
    input Real e "number";
    input Real v[:] "vector";
    input Real eps(min = 0) = 0 "tolerance";
    output Integer result "index; 0 if there is none";
  algorithm
    result := 0;
    for i in size(v, 1):-1:1 loop
      result := if abs(v[i] - e) <= eps then i else result;
    end for;
  end find;

  function interpolate "Straight lines between points"
    extends Modelica.Icons.Function;
    input Real x[:] "abscissas, not falling";
    input Real y[size(x, 1)] "ordinates";
    input Real xi "abscissa of the wanted point";
    input Integer iLast = 1 "where the search begins";
    output Real yi "its ordinate; outside of the points that of the first or last line";
    output Integer iNew = 1 "first point of the line";
  protected
    Integer n = size(x, 1) "number of points";
  algorithm
    assert(n > 0, "there are no points to interpolate between");
    if n == 1 then
      yi := y[1];
    else
      iNew := min(max(iLast, 1), n - 1);
      while iNew < n - 1 and xi >= x[iNew + 1] loop
        iNew := iNew + 1;
      end while;
      while iNew > 1 and xi < x[iNew] loop
        iNew := iNew - 1;
      end while;
      yi := if x[iNew + 1] > x[iNew]
        then y[iNew] + (y[iNew + 1] - y[iNew])*((xi - x[iNew])/(x[iNew + 1] - x[iNew]))
        else y[iNew];
    end if;
  end interpolate;

  function relNodePositions "Positions of nodes from 0 to 1: the first and last intervals are half as long"
    extends Modelica.Icons.Function;
    input Integer nNodes "number of nodes, at least 2, with those at the ends";
    output Real xsi[nNodes] "positions";
  protected
    Real delta = if nNodes > 2 then 1/(nNodes - 2) else 0 "length of an inner interval";
  algorithm
    assert(nNodes >= 2, "there are at least two nodes");
    xsi := {min(1, max(0, (i - 1.5)*delta)) for i in 1:nNodes};
    xsi[nNodes] := 1;
  end relNodePositions;
end Vectors;
