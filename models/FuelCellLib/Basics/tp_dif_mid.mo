within FuelCellLib.Basics;
model tp_dif_mid "Half transport element at the boundary of a diffusion layer"
  parameter Integer node = 2 "the side that is a control volume: 1 or 2" annotation(Evaluate = true);
  extends tp_dif(part = 0.5, g1 = if node == 1 then 1 else 0);
end tp_dif_mid;
