// MLS §5.4: outer components are other names of inner ones; an inner outer one is both.
package inner_outer
  model Deep
    outer Real T;
    Real x = T;
  end Deep;
  model Middle
    inner outer Real T = 10;
    Real seen = T;
    Deep deep;
  end Middle;
  model Main
    inner Real T = 1 + time;
    Middle middle;
    Deep deep;
  end Main;
end inner_outer;
