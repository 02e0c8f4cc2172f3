model Priority "elsewhen branches in order"
  Integer which(start = 0, fixed = true);
  Integer first(start = 0, fixed = true);
equation
  when time >= 1 then
    which = 1;
  elsewhen {time >= 1, time >= 2} then
    which = 2;
  elsewhen time >= 3 then
    which = 3;
  end when;
  when {initial(), time >= 2.5} then
    first = pre(first) + 1;
  end when;
end Priority;
