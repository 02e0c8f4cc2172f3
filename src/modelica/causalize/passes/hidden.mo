model Hidden
  Real u(start = 1, fixed = true, stateSelect = StateSelect.always);
  Real w(stateSelect = StateSelect.always);
  Real i[2];
equation
  3*i[1] + 5*i[2] = u;
  6*i[1] + 10*i[2] = w;
  der(u) = -i[1];
  der(w) = -i[2];
end Hidden;
