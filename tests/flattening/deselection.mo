// MLS §7.4: `break f` leaves out a component and all connections with it or with its parts, `break
// connect(a, b)` a connection as it is written, in either order; loops and branches included.
package deselection
  connector Flange
    Real phi;
    flow Real tau;
  end Flange;
  connector Signal = Real;
  connector In = input Real;
  connector Out = output Real;
  partial model Friction
    Flange flange_a;
  end Friction;
  block Gain
    In u;
    Out y;
    parameter Real k = 2;
  equation
    y = k*u;
  end Gain;
  block Step
    Out y = 1;
  end Step;
  model Plant
    In u;
    Out y;
    Flange flange_a;
    Flange chain[3];
  equation
    y = u;
    flange_a.phi = 0;
    for i in 1:3 loop
      chain[i].phi = i;
    end for;
  end Plant;
  model Controller
    In u_s, u_m;
    Out y;
  equation
    y = u_s - u_m;
  end Controller;
  model System
    parameter Boolean connected = true;
    Plant plant;
    Friction friction;
    Controller controller;
    Step reference;
  equation
    connect(reference.y, controller.u_s);
    connect(plant.y, controller.u_m);
    connect(controller.y, plant.u);
    connect(friction.flange_a, plant.flange_a);
    for i in 1:2 loop
      connect(plant.chain[i], plant.chain[i + 1]);
    end for;
  end System;
  model Frictionless
    extends System(
      break friction,
      break connect(plant.chain[i + 1], plant.chain[i]),
      plant(y(start = 3)));
  end Frictionless;
  model Main
    extends Frictionless(break connect(controller.u_m, plant.y));
    Gain gain;
  equation
    connect(plant.y, gain.u);
    connect(gain.y, controller.u_m);
  end Main;
end deselection;
