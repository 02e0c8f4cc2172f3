// MLS §5.3.1: a class that nothing declares.
package unknown_class
  model Resistor
    Real v = 1;
  end Resistor;
  model Main
    Resistr r;
  end Main;
end unknown_class;
