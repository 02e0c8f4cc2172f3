package record_of_defaults
  record Aging
    parameter Real q = 0;
    parameter Real k = 0.1;
  end Aging;
  record Cell
    parameter Real C0;
    parameter Aging aging;
    parameter Aging others[2];
  end Cell;
  model Main
    parameter Cell cell = Cell(C0 = 5);
    Real x = cell.aging.k*cell.C0 + cell.others[2].k;
  end Main;
end record_of_defaults;
