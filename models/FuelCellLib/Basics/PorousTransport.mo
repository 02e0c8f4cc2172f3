within FuelCellLib.Basics;
partial model PorousTransport "Gases, liquid water and electrons in a porous layer"
  extends Transport;
  outer parameter Units.volpore Es;
  outer parameter Units.factor tau;
  outer parameter Units.Conductivity ks;
  outer parameter Units.Density ros;
  outer parameter Units.c_diff D1;
  outer parameter Units.c_diff D2;
  outer parameter Units.c_diff D12o;
  outer parameter Units.Pressure pAref;
  outer parameter Units.Temp_K Tref;
  outer parameter Units.volpore Ego;
  outer parameter Units.Wload XsTransport;
  final parameter Units.factor theta_o = Ego/tau^2 "pores by tortuosity, without water";
  final parameter Units.c_diff D12ref = D12o*(T/Tref)^1.5 "binary diffusion at pAref";
  Units.factor theta "free pores by tortuosity";
  Units.Pressure p "oxygen of the element";
  Real DpA(final unit = "Pa.m2/s", nominal = 1) "binary diffusion coefficient times pressure";
equation
  p = if corrections.mesh then g1*exa1.p + (1 - g1)*exa2.p elseif noEvent(exa1.j > 0) then exa1.p else exa2.p;
  theta = theta_o*(1 - Xs/XsTransport);
  DpA = if corrections.gasTransport then D12ref*pAref else D12ref*(p + pwg)^2/pAref*Es/tau;
  theta*(exa2.p - exa1.p)/dx =
    -corrections.R*T*((exa1.j*pwg - exa1.jwg*p)/DpA + exa1.j/D1);
  (if corrections.gasTransport then theta else Es/tau^2)*(exa2.pwg - exa1.pwg)/dx =
    -corrections.R*T*((exa1.jwg*p - exa1.j*pwg)/DpA + exa1.jwg/D2);
  exa1.je = ks*(exa2.vs - exa1.vs)/dx;
  annotation(Documentation(info = "<html>
<p>Oxygen (p) and water vapour (w) diffuse through each other (Stefan, Maxwell) and along the walls
of the pores (Knudsen); Bevers et al. 1997:</p>
<pre>
theta dp/dx = -R T [(j w - jwg p)/(D12 pA) + j/D1]
theta dw/dx = -R T [(jwg p - j w)/(D12 pA) + jwg/D2]
theta = Ego (1 - Xs/Xsmax)/tau^2,   D12 pA = D12o pAref (T/Tref)^1.5
</pre>
<p>Ohm's law for the electrons, whose flux runs against the current: <code>je = ks dvs/dx</code>.</p>
</html>"));
end PorousTransport;
