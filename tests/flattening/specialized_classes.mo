// MLS §4.7, §4.6.2, §4.4.2.2, §15.1: what kinds of classes may contain, what stands alone when it
// is extended, and prefixes.
package specialized_classes
  record R
    Real x;
  equation
    x = 1;
  end R;
  connector C
    flow Boolean on;
    stream Real h;
  end C;
  type Vector = Real[3];
  model M
    extends Vector;
    Real y;
  end M;
  block B
    C c;
    parameter input Real u;
  end B;
  model Main
    R r;
    M m;
    B b;
    stream Real s = 1;
  end Main;
end specialized_classes;
