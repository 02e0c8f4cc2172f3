within Ordered.Inner;
model Unlisted
  Real x = 1;
end Unlisted;
