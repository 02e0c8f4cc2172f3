// MLS §4.9, §4.9.5.1, §4.9.5.2, §4.9.5.3, §4.9.7.1: attributes of predefined types and enumerations,
// conversions between enumerations and Integer, `stateSelect`.
package predefined_types
  type Mode = enumeration(off "none", on, both);
  model Main
    parameter Mode start = Mode.on;
    Mode mode(start = Mode.both, fixed = true) = if time < 1 then start else Mode(3);
    Integer number = Integer(mode);
    String name = String(Mode.off);
    Mode least = Mode.off, greatest(min = Mode.on) = Mode(i + 1), third = Mode(i);
    Real x(quantity = "Length", unit = "m", displayUnit = "mm", min = -1, max = 1, start = 0.5,
      fixed = true, nominal = 0.1, stateSelect = StateSelect.prefer);
    Boolean b(start = true, quantity = "switch") = x > 0;
    Integer i(min = 0, max = 3) = 2;
    String text(quantity = "label") = "a";
  equation
    der(x) = -x;
  end Main;
end predefined_types;
