package T
  type E = enumeration(low, high);
  record R
    Integer n;
    Real x;
  end R;
  function level
    input Real u;
    output E e;
  algorithm
    e := if u > 0.5 then E.high else E.low;
  end level;
  function described
    input Real u;
    input Integer n;
    output String s;
  protected
    R r;
  algorithm
    s := "";
    for x in {1, 2.5} loop
      s := s + String(x) + ";";
    end for;
    r := R(n, n/2);
    s := s + String(r.n) + ";" + String(r.x) + ";" + String(n/2) + ";";
    s := s + String(max(x for x in {1, n/4})) + ";" + String(level(u)) + ";";
    s := s + String(if u > 0.5 then E.high else E.low);
  end described;
  model M
    parameter Real w[2] = {1, 2.5};
    Integer n = if time > 0.5 then 3 else 2;
    E e = if time > 0.5 then E.high else E.low;
    Boolean up = time > 0.5;
    String s = described(if up then 1 else 0, n);
    String t = String(if up then E.high else E.low) + " " + String(if up then e else E.low);
    String u = String(if up then 2.5 else 1) + " " + String(w[n - 1]) + " " + String(n*w[1]);
  algorithm
    when {time > 0.25, time > 0.75} then
      Modelica.Utilities.Streams.print(s + " | " + t + " | " + u);
    end when;
  end M;
end T;
