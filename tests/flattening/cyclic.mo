// A class that contains itself.
model cyclic
  cyclic c;
end cyclic;
