within Ordered;
model Second
  extends First;
end Second;
