model Logic "a ring of flip-flops and a full adder"
  Boolean clock = sample(1, 1);
  Boolean q[3](each start = false, each fixed = true);
  Boolean a;
  Boolean b;
  Boolean c;
  Boolean sum;
  Boolean carry;
equation
  when clock then
    q[1] = not pre(q[3]);
    q[2] = pre(q[1]);
    q[3] = pre(q[2]);
  end when;
  a = q[1];
  b = q[2];
  c = q[3];
  sum = (a <> b) <> c;
  carry = a and b or c and (a or b);
end Logic;
