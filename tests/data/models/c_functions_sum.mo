model M
  class Sum
    extends ExternalObject;
    function constructor
      output Sum s;
      external "C" s = sum_new() annotation(Include = "");
    end constructor;
    function destructor
      input Sum s;
      external "C" sum_free(s) annotation(Include = "");
    end destructor;
  end Sum;
  function add_
    input Sum s;
    input Real x;
    external "C" sum_add(s, x) annotation(Include = "");
  end add_;
  function get_
    input Sum s;
    input Real t;
    output Real y;
    external "C" y = sum_get(s, t) annotation(Include = "");
  end get_;
  function add
    input Sum s;
    input Real x;
    input Real before;
    output Real after;
  algorithm
    add_(s, x);
    after := before;
  end add;
  Sum s = Sum();
  Real t(start = 0, fixed = true);
  Real last(start = 0, fixed = true);
equation
  when sample(0.25, 0.25) then
    t = add(s, 3, time);
    last = get_(s, t);
  end when;
  when sample(0.3, 0.25) then
    assert(abs(last - 3*floor(time/0.25)) < 1e-9, "another sum");
  end when;
end M;
