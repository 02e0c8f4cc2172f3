package Arguments "what is converted, and what a call is for each element of"
  type Mode = enumeration(off, on);

  record Base
    Real x;
  end Base;

  record Extended
    extends Base;
    Integer n;
  end Extended;

  function scaled
    input Real u;
    input Integer times = 2;
    output Real y = u*times;
  end scaled;

  function tripled
    extends scaled(times = 3);
  end tripled;

  function level
    input Mode mode = Mode.on;
    input Integer v[:] = {1, 2};
    output Integer n = Integer(mode) + sum(v);
  end level;

  function norm
    input Base b;
    output Real y = abs(b.x);
  end norm;

  model M
    parameter Integer n = 3;
    Extended e = Extended(x = 1, n = 2);
    Real a = scaled(n) + tripled(1, times = n) + scaled(times = 2, u = time);
    Real b[3] = scaled({1, 2, 3}, times = n);
    Integer c = level(v = {n, n + 1}) + level(if n > 2 then Mode.off else Mode.on);
    Real d = if n > 2 then 1 else time;
    Real f = min(n, 2.5) + b[integer(2.5)] + b[Integer(Mode.on)] + sum({scaled(i) for i in 1:n});
    Real g = norm(e);
    Integer k(start = 1, fixed = true, min = 0);
  equation
    when time > 0.5 then
      k = pre(k) + div(n, 2);
    end when;
  end M;
end Arguments;
