// A constant with a value is no input of its record's constructor (MLS §12.6.1): a record made of
// parameters does not make it one. A record that is another one takes its constants, too.
model M
  record Kind
    constant String name = "base";
    constant Real scale = 2;
    parameter Real z = 1;
  end Kind;
  record Element
    extends Kind;
    parameter Real R = 1;
  end Element;
  record Cell
    parameter Real Ri = 0.1;
    parameter Integer n = 1;
    parameter Element e[n] = fill(Element(), n);
  end Cell;
  model Inner
    parameter Cell c;
    Real y = c.e[2].R * c.e[2].scale;
  end Inner;
  parameter Cell c(n = 2, e = {Element(R = 0.2 * c.Ri), Element(R = 0.1 * c.Ri)});
  Inner inner_(c = c);
  parameter Element a(scale = 3);
  parameter Element b = a;
  Real x = c.e[1].R * b.scale;
end M;
