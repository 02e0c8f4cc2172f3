// MLS §4.5.3, §7.2: a type carries attributes, a declaration modifies them.
package types_with_attributes
  type Voltage = Real(final unit = "V", min = -1e3);
  type Small = Voltage(min = -1, max = 1);
  model Main
    Small v(max = 2) = time;
    extends Base(p = 3);
  end Main;
  partial model Base
    parameter Real p;
    Real q = p;
  end Base;
end types_with_attributes;
