model Calibrated "Identified parameters of Source"
  extends Source(
    k = 1);
end Calibrated;
