// MLS §4.2, §4.9, §4.9.5.1: elements are declared once and not named like predefined types,
// literals not like attributes of enumerations.
package reserved_names
  type E = enumeration(min, b, b);
  model Main
    Real Real = 1;
    model A
    end A;
    A A;
    E e;
  end Main;
end reserved_names;
