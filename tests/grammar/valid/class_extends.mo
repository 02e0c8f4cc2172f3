package P
  extends Q;
  redeclare model extends M(a = 1, redeclare B b) "more"
    Real y;
  equation
    y = x;
  end M;
  redeclare replaceable function extends f
  algorithm
    y := 2;
  end f;
end P;
