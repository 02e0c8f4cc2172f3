// The modifiers of a constraining clause hold for the original class too, not only for what
// replaces it (MLS §7.3.2).
model constraining_clause_default
  model Partial
    parameter Boolean cooling;
    parameter Real q;
    Real x = if cooling then 1 else q;
  end Partial;
  model Simple
    extends Partial(q = 7);
  end Simple;
  replaceable model Cycle = Simple(q = 3) constrainedby Partial(final cooling = false);
  Cycle cycle;
  replaceable model Long
    extends Partial(q = 5);
  end Long constrainedby Partial(cooling = true);
  Long long;
end constraining_clause_default;
