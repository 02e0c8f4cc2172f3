model M
  function shortened
    input String text;
    input Boolean is_short;
    output Boolean ok;
  protected
    String start;
  algorithm
    if is_short then
      start := text;
    else
      start := "long: " + text;
    end if;
    ok := start == "long: 2 kPa" or start == "1 kPa";
  end shortened;
  function f
    input Real x;
    output Boolean ok;
  algorithm
    ok := shortened(String(x) + " kPa", x < 1.5);
  end f;
  discrete Real k(start = 0, fixed = true);
equation
  when sample(1, 1) then
    k = if f(time) then 1 else 2;
  end when;
end M;
