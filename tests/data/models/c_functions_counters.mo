package E
  class Counter
    extends ExternalObject;
    function constructor
      input Real start;
      output Counter c;
      external "C" c = make_counter(start) {code};
    end constructor;
    function destructor
      input Counter c;
      external "C" free_counter(c) {code};
    end destructor;
  end Counter;
  impure function count
    input Counter c;
    input Real by;
    input Real before;
    output Real y;
    external "C" y = count(c, by) {code};
  end count;
  connector Out
    output Counter c;
    output Real before;
  end Out;
  connector In
    input Counter c;
    input Real before;
  end In;
  block Source
    parameter Real start = 3;
    Out out;
  equation
    out.c = Counter(start);
    out.before = 0;
  end Source;
  block Through
    parameter Integer n = 0;
    In inp;
    Out out[n];
    discrete Real y(start = 0, fixed = true);
  equation
    if n == 1 then
      out.c = fill(inp.c, n);
      out.before = fill(y, n);
    end if;
    when sample(1, 1) then
      y = count(inp.c, 2, inp.before);
    end when;
  end Through;
  model Connected
    Source s;
    Through a(n = 1);
    Through b;
  equation
    connect(s.out, a.inp);
    connect(a.out[1], b.inp);
  end Connected;
  model Late
    Integer size;
    Counter c = Counter(size);
    discrete Real y(start = 0, fixed = true);
  equation
    when initial() then
      size = 5;
    end when;
    when sample(1, 1) then
      y = count(c, 2, 0);
    end when;
  end Late;
  model Twice
    Source s;
    Source t;
  equation
    s.out.c = t.out.c;
  end Twice;
end E;
