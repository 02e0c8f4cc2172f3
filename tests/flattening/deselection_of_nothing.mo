// MLS §7.4: a deselection matches at least one element, and only models, blocks and connectors are
// left out.
package deselection_of_nothing
  connector Pin
    Real v;
    flow Real i;
  end Pin;
  model Base
    Pin a, b;
    Real x = 1;
  equation
    connect(a, b);
  end Base;
  model Other
    extends Base(break connect(a, a));
  end Other;
  model Variable
    extends Base(break x);
  end Variable;
  model Missing
    extends Base(break c);
  end Missing;
  model Main
    Other other;
    Variable variable;
    Missing missing;
  end Main;
end deselection_of_nothing;
