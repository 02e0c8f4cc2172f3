within FuelCellLib.Basics;
model tp_mem_mid "Half transport element at the boundary of a membrane"
  parameter Integer node = 2 "the side that is a control volume: 1 or 2" annotation(Evaluate = true);
  extends tp_mem(part = 0.5, g1 = if node == 1 then 1 else 0, sign = -1);
end tp_mem_mid;
