package Pumps
  package Units type Flow = Real(unit = "m3/s"); package Icons type Length = Real; end Icons; end Units;
  package Machines
    model Pump parameter Real nominal = 1; parameter Real gain = 1; Real rate = gain*nominal; end Pump;
    model FastPump extends Pump; parameter Boolean quick = true; end FastPump;
    model Base parameter Real size = 1; Real level = size; end Base;
    function scaled input Real x; input Real factor = 1; output Real y; algorithm y := x*factor; end scaled;
    type Kind = enumeration(slow, swift);
    package Medium replaceable model State Real level(start = 1); Real size; end State; end Medium;
    package Fluid extends Medium; end Fluid;
  end Machines;
  annotation(version = "2.0", conversion(noneFromVersion = "1.9", from(version = {"1.0", "1.1"},
    script = "modelica://Pumps/Scripts/to2.mos")));
end Pumps;