// Forms of libraries from before Modelica 2 (FuelCellLib among them): imports of the root used in
// nested classes, outer parameters with bindings, connections that reach through components beside
// those made inside them, Real parameters compared to choose equations.
encapsulated package old_forms
  import Old = old_forms.Pins;
  package Pins
    connector Pin
      Real v;
      flow Real i;
    end Pin;
  end Pins;
  package Parts
    model Port
      Old.Pin exa1;
      Old.Pin exa2;
    equation
      exa1.v = exa2.v;
      exa1.i + exa2.i = 0;
    end Port;
    model Layer
      outer parameter Real da = 7;
      Port tp1;
      Port tp2;
      Real width = da;
    equation
      connect(tp1.exa2, tp2.exa1);
    end Layer;
    model Load
      Old.Pin p;
      parameter Real Hyp = 1;
    equation
      if not Hyp == 1 then
        p.i = 0;
      else
        p.v = 2*p.i;
      end if;
    end Load;
    model Source
      Old.Pin p;
    equation
      p.v = 1;
    end Source;
  end Parts;
  model Main
    inner parameter Real da = 0.5;
    Parts.Layer c[2];
    Parts.Load load;
    Parts.Source source;
  equation
    connect(source.p, c[1].tp1.exa1);
    for i in 1:1 loop
      connect(c[i].tp2.exa2, c[i + 1].tp1.exa1);
    end for;
    connect(c[2].tp2.exa2, load.p);
  end Main;
end old_forms;
