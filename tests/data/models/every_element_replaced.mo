package Replaced
  partial package Medium
    constant Real d = 1;
    replaceable partial function h input Real T; output Real y; end h;
    replaceable record State Real p; end State;
    replaceable partial model Base State state; end Base;
  end Medium;
  package Water extends Medium(d = 1000);
    redeclare function extends h algorithm y := 4.2*T; end h;
    redeclare model extends Base equation state.p = 1; end Base;
  end Water;
  partial model Law Real x; end Law;
  model Linear extends Law; equation x = time; end Linear;
  model Square extends Linear; end Square;
  model Plant
    replaceable package M = Water constrainedby Medium;
    replaceable model L = Linear constrainedby Law;
    replaceable Linear law(x(start = 1)) constrainedby Law;
    replaceable function f = M.h;
    replaceable type T = Real(unit = "K");
    replaceable connector C = Real;
    L inside[2];
    M.Base base;
    T y = f(time) + inside[1].x + law.x;
  end Plant;
  model Larger extends Plant(redeclare replaceable model L = Square); end Larger;
  model Whole Plant plant; Larger larger; end Whole;
end Replaced;
