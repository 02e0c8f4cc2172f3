within Ordered;
model First
  extends Inner.M(p = 1);
end First;
