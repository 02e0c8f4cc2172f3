within FuelCellLib.Basics;
model tp_act_mid "Half transport element at the boundary of a catalytic layer"
  parameter Integer node = 2 "the side that is a control volume: 1 or 2" annotation(Evaluate = true);
  extends tp_act(part = 0.5, g1 = if node == 1 then 1 else 0, sign = -1);
end tp_act_mid;
