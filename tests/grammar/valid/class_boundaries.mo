within ;
// model InComment
encapsulated package Boundaries "a \"quoted\" word; end Boundaries;" + " and more"
  /* package InComment
     end Boundaries; */
  type Length = Real(final unit = "m", min = 0) "end Length;";
  type Colour = enumeration(red "end", green) annotation(Icon());
  type Open = enumeration(:);
  function df = der(f, x, y);
  connector Input = input Real;
  model 'end'"a name in quotes"
    Real 'model'[3];
  equation
    'model'[end] = if time > 1 then 1 else 2;
    for k in 1:2 loop
      'model'[k] = k;
    end for;
  end 'end';
  replaceable model M = 'end' constrainedby 'end' "end M;";
  redeclare replaceable model extends N (p = ({1, 2})[1], redeclare model Q = M) "string"
    protected encapsulated partial block Inside end Inside;
  algorithm
    while a loop
      if b then
        a := false;
      end if;
    end while;
  end N;
  operator record Complex
    encapsulated operator 'constructor'
      function fromReal input Real x; output Complex y; end fromReal;
    end 'constructor';
    encapsulated operator function '+'
      input Complex a;
      output Complex b;
    end '+';
    operator function negate = neg;
  end Complex;
  expandable connector Bus end Bus;
  pure function f
    input Real x;
    output Real y = map(function g(a = 1), x);
    external "C" y = f_c(x) annotation(Include = "
      class Cpp { int end; };
      ");
  end f;
  impure function g input Real a; output Real b; end g;
  model Adjacent/* no blank */end Adjacent;
  class OldStyle
    annotation(Coordsys(extent=[-98, 20; 8, -82]), Window(x=0.1));
    extends M(redeclare function h = g);
  equation
    when x then y = 1; elsewhen z then y = 2; end when;
    annotation(Icon(Line(points=[0, 0; 1, 1], style(color=0))));
  end OldStyle;
end Boundaries;
