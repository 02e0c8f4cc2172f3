model Phase "an Integer in the state of a medium, which a function computes between events"
  record State
    Integer phase;
    Real h;
  end State;
  function state
    input Real h;
    output State state;
  algorithm
    state.h := h;
    state.phase := if h > 0.51 then 2 else 1;
  end state;
  State bound = state(time);
  State passed[2] "written before what they pass on";
  State equal;
  Real density = if bound.phase == 2 then 10 else 1000;
equation
  passed = {equal, bound};
  equal = state(2*time);
end Phase;
