// MLS §5.3.2: a called function must be declared; the nearest name is suggested.
package unknown_functions
  package Tools
    function double
      input Real x;
      output Real y = 2*x;
    algorithm
    end double;
  end Tools;
  model Main
    Real a = Tools.doubel(time);
    Real b = Nowhere.f(time);
  end Main;
end unknown_functions;
