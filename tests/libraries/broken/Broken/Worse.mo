within Broken;
model Worse
  Real x = (1;
end Worse;
