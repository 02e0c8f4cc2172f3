package Versioned
  model M
    Real x = time;
  end M;
  annotation(version = "1.4.0");
end Versioned;
