model First
  Integer n(start = 0, fixed = true);
  Integer first(start = 0, fixed = true);
  Integer turns(start = 0, fixed = true);
  constant Integer limits[4] = {2, 4, 6, 8};
algorithm
  when sample(0.5, 1) then
    n := pre(n) + 1;
    first := 0;
    turns := 0;
    for i in 1:4 loop
      turns := turns + 1;
      if limits[i] > n then
        first := i;
        break;
      end if;
      turns := turns + 10;
    end for;
  end when;
end First;
