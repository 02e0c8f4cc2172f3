within Modelica.Utilities;
package Types "Types of the utilities"
  extends Modelica.Icons.TypesPackage;
  type Compare = enumeration(
    Less "the first comes before the second",
    Equal "they are equal",
    Greater "the first comes behind the second")
    "Order of two texts";
  type FileType = enumeration(
    NoFile "there is nothing of this name",
    RegularFile "a file",
    Directory "a directory",
    SpecialFile "something else")
    "What a name stands for";
  type TokenType = enumeration(RealToken, IntegerToken, BooleanToken, StringToken, IdentifierToken, DelimiterToken, NoToken)
    "Kind of a token";
  record TokenValue "A token"
    extends Modelica.Icons.Record;
    TokenType tokenType "its kind";
    Real real "its value, if it is a real number";
    Integer integer "its value, if it is an integer";
    Boolean boolean "its value, if it is a truth value";
    String string "its text, if it is a string, an identifier or a delimiter";
  end TokenValue;
end Types;
