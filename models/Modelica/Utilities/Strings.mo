within Modelica.Utilities;
package Strings "Functions of texts; characters are counted from 1"
  extends Modelica.Icons.FunctionsPackage;

  function length "Number of characters"
    extends Modelica.Icons.Function;
    input String string "text";
    output Integer result "number";
  external "C" result = ModelicaStrings_length(string);
  end length;

  function substring "Characters of a range"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) "first character";
    input Integer endIndex "last character";
    output String result "the characters";
  external "C" result = ModelicaStrings_substring(string, startIndex, endIndex);
  end substring;

  function repeat "A text several times"
    extends Modelica.Icons.Function;
    input Integer n(min = 0) = 1 "how often";
    input String string = " " "text";
    output String repeatedString "the text n times";
  algorithm
    repeatedString := "";
    for i in 1:n loop
      repeatedString := repeatedString + string;
    end for;
  end repeat;

  function compare "Order of two texts"
    extends Modelica.Icons.Function;
    input String string1 "first text";
    input String string2 "second text";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Modelica.Utilities.Types.Compare result "order";
  external "C" result = ModelicaStrings_compare(string1, string2, caseSensitive);
  end compare;

  function isEqual "Whether two texts are equal"
    extends Modelica.Icons.Function;
    input String string1 "first text";
    input String string2 "second text";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Boolean identical "whether they are";
  algorithm
    identical := compare(string1, string2, caseSensitive) == Types.Compare.Equal;
  end isEqual;

  function isEmpty "Whether there is nothing but white space"
    extends Modelica.Icons.Function;
    input String string "text";
    output Boolean result "whether there is nothing else";
  algorithm
    result := Advanced.skipWhiteSpace(string) > length(string);
  end isEmpty;

  function contains "Whether a text is in another"
    extends Modelica.Icons.Function;
    input String string "text that is searched";
    input String searchString "text that is looked for";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Boolean result "whether it is there";
  algorithm
    result := find(string, searchString, 1, caseSensitive) > 0;
  end contains;

  function count "How often a text is in another, without overlaps"
    extends Modelica.Icons.Function;
    input String string "text that is searched";
    input String searchString "text that is looked for";
    input Integer startIndex(min = 1) = 1 "where the search begins";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Integer result "how often";
  protected
    Integer place "where it was found";
  algorithm
    result := 0;
    place := find(string, searchString, startIndex, caseSensitive);
    while place > 0 loop
      result := result + 1;
      place := find(string, searchString, place + length(searchString), caseSensitive);
    end while;
  end count;

  function find "First place of a text in another"
    extends Modelica.Icons.Function;
    input String string "text that is searched";
    input String searchString "text that is looked for";
    input Integer startIndex(min = 1) = 1 "where the search begins";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Integer index "place of its first character; 0 if it is not there";
  protected
    Integer n = length(searchString) "number of characters that are looked for";
    Integer last = length(string) - n + 1 "last place where it could be";
  algorithm
    index := 0;
    if n > 0 then
      for i in max(1, startIndex):last loop
        if isEqual(substring(string, i, i + n - 1), searchString, caseSensitive) then
          index := i;
          break;
        end if;
      end for;
    end if;
  end find;

  function findLast "Last place of a text in another"
    extends Modelica.Icons.Function;
    input String string "text that is searched";
    input String searchString "text that is looked for";
    input Integer startIndex(min = 0) = 0 "where the search begins, backward; 0: at the end";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output Integer index "place of its first character; 0 if it is not there";
  protected
    Integer n = length(searchString) "number of characters that are looked for";
    Integer last = length(string) - n + 1 "last place where it could be";
  algorithm
    index := 0;
    if n > 0 then
      for i in (if startIndex > 0 then min(startIndex, last) else last):-1:1 loop
        if isEqual(substring(string, i, i + n - 1), searchString, caseSensitive) then
          index := i;
          break;
        end if;
      end for;
    end if;
  end findLast;

  function replace "Another text in place of one"
    extends Modelica.Icons.Function;
    input String string "text that is searched";
    input String searchString "text that is replaced";
    input String replaceString "text in its place";
    input Integer startIndex(min = 1) = 1 "where the search begins";
    input Boolean replaceAll = true "everywhere, else at the first place";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output String result "new text";
  protected
    Integer place "where it was found";
    Integer done "characters that are copied";
  algorithm
    result := "";
    done := 0;
    place := find(string, searchString, startIndex, caseSensitive);
    while place > 0 loop
      result := result + (if place > done + 1 then substring(string, done + 1, place - 1) else "") + replaceString;
      done := place + length(searchString) - 1;
      place := if replaceAll then find(string, searchString, done + 1, caseSensitive) else 0;
    end while;
    result := result + (if done < length(string) then substring(string, done + 1, length(string)) else "");
  end replace;

  function sort "Texts in their order"
    extends Modelica.Icons.Function;
    input String stringVector1[:] "texts";
    input Boolean caseSensitive = true "whether A is another letter than a";
    output String stringVector2[size(stringVector1, 1)] = stringVector1 "sorted texts";
  protected
    String held "text to be placed";
    Integer place "where it goes";
  algorithm
    for i in 2:size(stringVector1, 1) loop
      held := stringVector2[i];
      place := i;
      while place > 1 loop
        if compare(stringVector2[place - 1], held, caseSensitive) <> Types.Compare.Greater then
          break;
        end if;
        stringVector2[place] := stringVector2[place - 1];
        place := place - 1;
      end while;
      stringVector2[place] := held;
    end for;
  end sort;

  function hashString "A number that depends on all characters"
    extends Modelica.Icons.Function;
    input String string "text";
    output Integer hash "number";
  external "C" hash = ModelicaStrings_hashString(string);
  end hashString;

  function scanReal "A real number in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input Boolean unsigned = false "a sign is an error";
    input String message = "" "end of the text of the error";
    output Real number "the number";
    output Integer nextIndex "character behind it";
  algorithm
    (nextIndex, number) := Advanced.scanReal(string, startIndex, unsigned);
    if nextIndex == startIndex then
      syntaxError(string, startIndex, "a real number is expected. " + message);
    end if;
  end scanReal;

  function scanInteger "An integer in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input Boolean unsigned = false "a sign is an error";
    input String message = "" "end of the text of the error";
    output Integer number "the number";
    output Integer nextIndex "character behind it";
  algorithm
    (nextIndex, number) := Advanced.scanInteger(string, startIndex, unsigned);
    if nextIndex == startIndex then
      syntaxError(string, startIndex, "an integer is expected. " + message);
    end if;
  end scanInteger;

  function scanBoolean "A truth value in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input String message = "" "end of the text of the error";
    output Boolean number "true or false";
    output Integer nextIndex "character behind it";
  protected
    String word "identifier in the text";
  algorithm
    (nextIndex, word) := Advanced.scanIdentifier(string, startIndex);
    if word <> "true" and word <> "false" then
      syntaxError(string, startIndex, "true or false is expected. " + message);
    end if;
    number := word == "true";
  end scanBoolean;

  function scanString "A text between quotation marks in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input String message = "" "end of the text of the error";
    output String result "text without the quotation marks";
    output Integer nextIndex "character behind it";
  algorithm
    (nextIndex, result) := Advanced.scanString(string, startIndex);
    if nextIndex == startIndex then
      syntaxError(string, startIndex, "a text between quotation marks is expected. " + message);
    end if;
  end scanString;

  function scanIdentifier "An identifier in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input String message = "" "end of the text of the error";
    output String identifier "identifier";
    output Integer nextIndex "character behind it";
  algorithm
    (nextIndex, identifier) := Advanced.scanIdentifier(string, startIndex);
    if nextIndex == startIndex then
      syntaxError(string, startIndex, "an identifier is expected. " + message);
    end if;
  end scanIdentifier;

  function scanDelimiter "One of some delimiters in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where it begins, white space before it is skipped";
    input String requiredDelimiters[:] = {","} "delimiters";
    input String message = "" "end of the text of the error";
    output String delimiter "the one that is there";
    output Integer nextIndex "character behind it";
  protected
    Integer first = Advanced.skipWhiteSpace(string, startIndex) "first character that is no white space";
    Integer n "number of characters of a delimiter";
  algorithm
    nextIndex := 0;
    delimiter := "";
    for wanted in requiredDelimiters loop
      n := length(wanted);
      if nextIndex == 0 and first + n - 1 <= length(string) then
        if n == 0 or isEqual(substring(string, first, first + n - 1), wanted) then
          delimiter := wanted;
          nextIndex := first + n;
        end if;
      end if;
    end for;
    if nextIndex == 0 then
      syntaxError(string, startIndex, "a delimiter is expected. " + message);
    end if;
  end scanDelimiter;

  function scanNoToken "An error unless nothing but white space is left"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer startIndex(min = 1) = 1 "where the rest begins";
    input String message = "" "end of the text of the error";
  algorithm
    if Advanced.skipWhiteSpace(string, startIndex) <= length(string) then
      syntaxError(string, startIndex, "the end of the text is expected. " + message);
    end if;
  end scanNoToken;

  function syntaxError "An error that shows a place in a text"
    extends Modelica.Icons.Function;
    input String string "text";
    input Integer index "place";
    input String message = "" "what is wrong";
  algorithm
    Streams.error("Error at character " + String(index) + " of \"" + string + "\": " + message);
  end syntaxError;
  package Advanced "Scanning without errors: the next character is the first one where nothing is found"
    extends Modelica.Icons.FunctionsPackage;

    function scanReal "A real number in a text"
      extends Modelica.Icons.Function;
      input String string "text";
      input Integer startIndex(min = 1) = 1 "where it begins";
      input Boolean unsigned = false "no number has a sign";
      output Integer nextIndex "character behind it";
      output Real number "the number";
    external "C" ModelicaStrings_scanReal(string, startIndex, unsigned, nextIndex, number);
    end scanReal;

    function scanInteger "An integer in a text"
      extends Modelica.Icons.Function;
      input String string "text";
      input Integer startIndex(min = 1) = 1 "where it begins";
      input Boolean unsigned = false "no number has a sign";
      output Integer nextIndex "character behind it";
      output Integer number "the number";
    external "C" ModelicaStrings_scanInteger(string, startIndex, unsigned, nextIndex, number);
    end scanInteger;

    function scanString "A text between quotation marks in a text"
      extends Modelica.Icons.Function;
      input String string "text";
      input Integer startIndex(min = 1) = 1 "where it begins";
      output Integer nextIndex "character behind it";
      output String string2 "text without the quotation marks";
    external "C" ModelicaStrings_scanString(string, startIndex, nextIndex, string2);
    end scanString;

    function scanIdentifier "An identifier in a text"
      extends Modelica.Icons.Function;
      input String string "text";
      input Integer startIndex(min = 1) = 1 "where it begins";
      output Integer nextIndex "character behind it";
      output String identifier "identifier";
    external "C" ModelicaStrings_scanIdentifier(string, startIndex, nextIndex, identifier);
    end scanIdentifier;

    function skipWhiteSpace "First character that is no white space"
      extends Modelica.Icons.Function;
      input String string "text";
      input Integer startIndex(min = 1) = 1 "where the search begins";
      output Integer nextIndex "character; one behind the last if there is none";
    external "C" nextIndex = ModelicaStrings_skipWhiteSpace(string, startIndex);
    end skipWhiteSpace;
  end Advanced;
  annotation(Documentation(info = "<html>
<p>A function that scans skips white space and reads what is behind it; where something else is
there, it is an error.</p>
</html>"));
end Strings;
