partial model Part
  parameter Real p = 1;
  Real y;
end Part;
model First
  extends Part;
  parameter Real k = 1;
equation
  y = p + 100*k;
end First;
model Second
  extends Part;
  parameter Real q = 1;
equation
  y = p + 10*q;
end Second;
partial model Plan
  replaceable Part part;
end Plan;
model One
  extends Plan(redeclare replaceable First part(k = 20, p = 3));
end One;
model Two
  extends One(redeclare Second part(q = 4));
end Two;
model Plain
  extends Plan(part(p = 5));
end Plain;
model Three
  extends Plain(redeclare replaceable First part(k = 20));
end Three;
model Four
  extends Three(redeclare Second part);
end Four;
partial model Kept
  replaceable Part part(p = 6);
end Kept;
model Five
  extends Kept(redeclare replaceable First part(k = 2));
end Five;
model Six
  extends Five(redeclare Second part);
end Six;
model Seven
  extends Three(part(p = 9));
end Seven;
model Eight
  extends Seven(redeclare Second part);
end Eight;
