package Tanks
  model Tank parameter Real height = 1; parameter Real area = 1; end Tank;
  model OpenTank extends Tank; end OpenTank;
  function cube input Real x; output Real y; algorithm y := x^3; end cube;
  function cubeSlope input Real x; input Real dx; output Real y; algorithm y := 3*x^2*dx; end cubeSlope;
  annotation(version = "2.0", conversion(noneFromVersion = "1.6",
    from(version = {"0.9", "1.0"}, to = "1.5", change = {
      convertClass("Tanks.Box", "Tanks.Vessel"),
      convertElement("Tanks.Box", {"high", "s"}, {"level", "size.area"}),
      convertModifiers("Tanks.Box", {"double=1"}, {"level=2*%double%"})}),
    from(version = "1.5", to = "1.6", change = {
      convertClass({"Tanks.Vessel", "Tanks.third", "Tanks.thirdSlope"}, {"Tanks.Tank", "Tanks.cube", "Tanks.cubeSlope"}),
      convertClassIf("Tanks.Vessel", "lid", "false", "Tanks.OpenTank"),
      convertElement("Tanks.Vessel", {"level", "size.area"}, {"height", "area"}),
      convertMessage("Tanks.Vessel", "tanks have no colour", "colour")}),
    from(version = "0.1", to = "0.2", change = {convertClass("Tanks.Box", "Tanks.Tub")}),
    from(version = "0.3", to = "0.3", change = {convertClass("Tanks.Box", "Tanks.Tub")}),
    from(version = "0.4", change = {convertTanks("Tanks.Box")})));
end Tanks;