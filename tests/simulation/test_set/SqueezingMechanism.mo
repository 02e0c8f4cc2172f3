model SqueezingMechanism "Seven bodies in three loops with a spring, driven by a torque (Andrews); index 3"
  constant Real m[7] = {0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498} "Masses";
  constant Real I[7] = {2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5} "Moments of inertia";
  constant Real xa = -0.06934; constant Real ya = -0.00227;
  constant Real xb = -0.03635; constant Real yb = 0.03273;
  constant Real xc = 0.014; constant Real yc = 0.072;
  constant Real d = 0.028; constant Real da = 0.0115; constant Real e = 0.02; constant Real ea = 0.01421;
  constant Real rr = 0.007; constant Real ra = 0.00092;
  constant Real ss = 0.035; constant Real sa = 0.01874; constant Real sb = 0.01043;
  constant Real sc = 0.018; constant Real sd = 0.02;
  constant Real ta = 0.02308; constant Real tb = 0.00916;
  constant Real u = 0.04; constant Real ua = 0.01228; constant Real ub = 0.00449;
  constant Real zf = 0.02; constant Real zt = 0.04; constant Real fa = 0.01421;
  constant Real c0 = 4530 "Stiffness"; constant Real l0 = 0.07785 "Length of the spring without force";
  constant Real torque = 0.033;
  Real beta(start = -0.0617138900142764496358948458001, stateSelect = StateSelect.prefer);
  Real Theta(start = 0, fixed = true);
  Real gamma(start = 0.455279819163070380255912382449);
  Real Phi(start = 0.222668390165885884674473185609);
  Real delta(start = 0.487364979543842550225598953530);
  Real Omega(start = -0.222668390165885884674473185609);
  Real epsilon(start = 1.23054744454982119249735015568);
  Real wb(start = 0, fixed = true); Real wt; Real wg; Real wp; Real wd; Real wo; Real we;
  Real ab; Real at; Real ag; Real ap; Real ad; Real ao; Real ae;
  Real lambda[6] "Forces in the joints";
  Real xd; Real yd; Real length; Real force;
equation
  wb = der(beta); wt = der(Theta); wg = der(gamma); wp = der(Phi); wd = der(delta); wo = der(Omega); we = der(epsilon);
  ab = der(wb); at = der(wt); ag = der(wg); ap = der(wp); ad = der(wd); ao = der(wo); ae = der(we);
  xd = sd*cos(gamma) + sc*sin(gamma) + xb;
  yd = sd*sin(gamma) - sc*cos(gamma) + yb;
  length = sqrt((xd - xc)^2 + (yd - yc)^2);
  force = -c0*(length - l0)/length;
  // closed loops
  rr*cos(beta) - d*cos(beta + Theta) - ss*sin(gamma) = xb;
  rr*sin(beta) - d*sin(beta + Theta) + ss*cos(gamma) = yb;
  rr*cos(beta) - d*cos(beta + Theta) - e*sin(Phi + delta) - zt*cos(delta) = xa;
  rr*sin(beta) - d*sin(beta + Theta) + e*cos(Phi + delta) - zt*sin(delta) = ya;
  rr*cos(beta) - d*cos(beta + Theta) - zf*cos(Omega + epsilon) - u*sin(epsilon) = xa;
  rr*sin(beta) - d*sin(beta + Theta) - zf*sin(Omega + epsilon) + u*cos(epsilon) = ya;
  // torques
  (m[1]*ra^2 + m[2]*(rr^2 - 2*da*rr*cos(Theta) + da^2) + I[1] + I[2])*ab + (m[2]*(da^2 - da*rr*cos(Theta)) + I[2])*at
    = torque - m[2]*da*rr*wt*(wt + 2*wb)*sin(Theta)
    - (-rr*sin(beta) + d*sin(beta + Theta))*(lambda[1] + lambda[3] + lambda[5])
    - (rr*cos(beta) - d*cos(beta + Theta))*(lambda[2] + lambda[4] + lambda[6]);
  (m[2]*(da^2 - da*rr*cos(Theta)) + I[2])*ab + (m[2]*da^2 + I[2])*at
    = m[2]*da*rr*wb^2*sin(Theta) - d*sin(beta + Theta)*(lambda[1] + lambda[3] + lambda[5])
    + d*cos(beta + Theta)*(lambda[2] + lambda[4] + lambda[6]);
  (m[3]*(sa^2 + sb^2) + I[3])*ag
    = force*(xd - xc)*(sc*cos(gamma) - sd*sin(gamma)) + force*(yd - yc)*(sd*cos(gamma) + sc*sin(gamma))
    + ss*cos(gamma)*lambda[1] + ss*sin(gamma)*lambda[2];
  (m[4]*(e - ea)^2 + I[4])*ap + (m[4]*((e - ea)^2 + zt*(e - ea)*sin(Phi)) + I[4])*ad
    = m[4]*zt*(e - ea)*wd^2*cos(Phi) + e*cos(Phi + delta)*lambda[3] + e*sin(Phi + delta)*lambda[4];
  (m[4]*((e - ea)^2 + zt*(e - ea)*sin(Phi)) + I[4])*ap
    + (m[4]*(zt^2 + 2*zt*(e - ea)*sin(Phi) + (e - ea)^2) + m[5]*(ta^2 + tb^2) + I[4] + I[5])*ad
    = -m[4]*zt*(e - ea)*wp*(wp + 2*wd)*cos(Phi) + (e*cos(Phi + delta) - zt*sin(delta))*lambda[3]
    + (e*sin(Phi + delta) + zt*cos(delta))*lambda[4];
  (m[6]*(zf - fa)^2 + I[6])*ao + (m[6]*((zf - fa)^2 - u*(zf - fa)*sin(Omega)) + I[6])*ae
    = -m[6]*u*(zf - fa)*we^2*cos(Omega) - zf*sin(Omega + epsilon)*lambda[5] + zf*cos(Omega + epsilon)*lambda[6];
  (m[6]*((zf - fa)^2 - u*(zf - fa)*sin(Omega)) + I[6])*ao
    + (m[6]*((zf - fa)^2 - 2*u*(zf - fa)*sin(Omega) + u^2) + m[7]*(ua^2 + ub^2) + I[6] + I[7])*ae
    = m[6]*u*(zf - fa)*wo*(wo + 2*we)*cos(Omega) + (u*cos(epsilon) - zf*sin(Omega + epsilon))*lambda[5]
    + (zf*cos(Omega + epsilon) + u*sin(epsilon))*lambda[6];
end SqueezingMechanism;
