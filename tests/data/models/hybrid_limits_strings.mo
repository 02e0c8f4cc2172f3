model Label
  type Mode = enumeration(low, middle, high);
  Mode mode(start = Mode.low, fixed = true);
  String label;
  String last(start = "none", fixed = true);
  String word = if label == "low" then "small" else "large";
  Real x(start = 0, fixed = true);
  Integer changes(start = 0, fixed = true);
  Integer code;
  Boolean fresh;
equation
  der(x) = 1;
  mode = if x > 2 then Mode.high elseif x > 1 then Mode.middle else Mode.low;
  label = if mode == Mode.high then "high" elseif mode == Mode.middle then "mid" else "low";
  when change(label) then
    last = pre(label);
    changes = pre(changes) + 1;
  end when;
  fresh = last == "none";
  code = (if label == "high" then 100 elseif "mid" == label then 200 else 300)
    + (if last == "mid" then 10 elseif last == "low" then 20 else 30)
    + (if word <> "large" then 1 else 2);
end Label;
