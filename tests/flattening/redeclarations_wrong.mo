// MLS §7.3.3, §6.4, §7.1.4: what is not replaceable is not redeclared, what replaces an element is
// compatible with it, and a replaceable class is not extended.
package redeclarations_wrong
  model A
    Real x = 1;
  end A;
  model B
    Boolean x = true;
  end B;
  model Frame
    A fixed;
    replaceable A open;
    replaceable model M = A;
  end Frame;
  model Extends
    replaceable model M = A;
    extends M;
  end Extends;
  model Main
    Frame one(redeclare B fixed);
    Frame two(redeclare B open);
    Extends three;
  end Main;
end redeclarations_wrong;
