package NeedsVersioned
  model M
    extends Versioned.M;
  end M;
  annotation(uses(Versioned(version = "2.0.0")));
end NeedsVersioned;
