model Breakaway "what breaks away at 2 goes on from 1, and the force falls with it"
  Real force;
  Boolean sliding(start = false, fixed = true);
equation
  force = if sliding then time/1.5 else time;
  sliding = force > 2 or pre(sliding) and force > 1;
end Breakaway;
