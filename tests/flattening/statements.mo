// MLS §11.2, §11.2.4, §11.2.5, §10.3, §10.3.3, §10.3.4, §10.4.3, §3.5, §3.7.4.4: loops, `break` and `return` in functions,
// constructors of arrays, ranges of Boolean, the name of an instance.
package statements
  function count
    input Real x[:];
    output Integer n = 0;
  algorithm
    for i in 1:size(x, 1) loop
      if x[i] < 0 then
        break;
      end if;
      n := n + 1;
    end for;
    while n > 3 loop
      n := n - 1;
      if n == 5 then
        return;
      end if;
    end while;
  end count;
  model Part
    parameter String name = getInstanceName();
  end Part;
  model Main
    parameter Integer n = count({1, 2, -3, 4});
    Real x[n] = fill(time, n), unit[2, 2] = identity(2), empty[0] = zeros(0);
    Boolean both[2] = {not b for b in false:true};
    Real total = sum(x) + product({1, 2}) + max(x) + min({time, 1});
    Boolean and_or = total > 1 and not total < 0 or false;
    Part part;
  end Main;
end statements;
