// MLS §7.3: components, short classes, packages and class extends, constrained or not.
package redeclaration
  partial package Medium
    constant Integer n = 1;
    replaceable partial function density
      input Real T;
      output Real d;
    end density;
    replaceable record State
      Real T;
    end State;
  end Medium;
  package Water
    extends Medium(n = 2);
    redeclare function extends density
      algorithm
        d := 1000 - T;
    end density;
    redeclare record extends State
      Real p;
    end State;
  end Water;
  model Tank
    replaceable package M = Medium;
    Real rho = M.density(300);
    Real x[M.n] = fill(rho, M.n);
    M.State state;
  end Tank;
  partial model Law
    Real y;
  end Law;
  model One
    extends Law;
    parameter Real k = 1;
  equation
    y = k;
  end One;
  model Two
    extends Law;
    parameter Real k = 2;
    parameter Real l = 3;
  equation
    y = k*l;
  end Two;
  model User
    replaceable One law(k = 5) constrainedby Law;
    replaceable model L = One;
    L inner_law;
  end User;
  model Main
    Tank tank(redeclare package M = Water, state(T = 1, p = 2));
    User user(redeclare Two law(l = 7), redeclare model L = Two(k = 8));
    User plain;
  end Main;
end redeclaration;
