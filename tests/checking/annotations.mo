package annotations "literals of the enumerations of graphics, in annotations of every kind"
  type Smooth = enumeration(Rough, Fine) "another enumeration of a name of graphics";

  partial model Base
    annotation(Icon(graphics={Rectangle(extent={{-1,-1},{1,1}}, fillPattern=FillPattern.Soild)}));
  end Base;

  model Derived
    extends Base annotation(IconMap(extent={{-1,-1},{1,1}}, pattern=LinePattern.Dahs));
    Real x annotation(Dialog(enable=BorderPattern.Rased <> BorderPattern.None));
    Real y annotation(choices(choice=Smooth.Rough));
  equation
    x = 1 annotation(Line(arrow={Arrow.None, Arrow.Fild}));
    y = 2;
    if false then
      assert(x > 0, "x") annotation(Text(textStyle={TextStyle.Bold, TextStyle.Bald}));
    end if;
  end Derived;

  function f
    input Real u;
    output Real y;
  algorithm
    y := u annotation(Text(horizontalAlignment=TextAlignment.Middle));
    annotation(Icon(graphics={Ellipse(closure=EllipseClosure.Radial, fillPattern=FillPattern.Sphere)}));
  end f;

  type Short = Real annotation(Icon(graphics={Line(pattern=LinePattern.Dasch)}));
end annotations;
