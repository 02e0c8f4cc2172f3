// MLS §7.1.3: a connector may extend a type.
package connector_of_type
  type Base = output Real(unit = "V");
  connector Derived
    extends Base(start = 2);
  end Derived;
  model Main
    Derived d = 1;
  end Main;
end connector_of_type;
