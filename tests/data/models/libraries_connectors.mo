connector Pin
    Real v;
    flow Real i;
  end Pin;
  connector RealInput = input Real;
  connector RealOutput = output Real;
  record Angle
    Real gamma;
    function equalityConstraint
      input Angle a;
      input Angle b;
      output Real residue[0];
    algorithm
      assert(abs(a.gamma - b.gamma) < 1e-9, "different angles");
    end equalityConstraint;
  end Angle;
  connector Phasor
    Real v;
    flow Real i;
    Angle reference;
  end Phasor;
  model World
    parameter Real g = 9.81;
  end World;
