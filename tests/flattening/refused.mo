// MLS §5.4, §7.4: what is not translated yet says so at its place.
package refused
  model Inner
    inner outer Real t = 1;
  end Inner;
  model Main
    inner Real t = 1;
    Inner i;
  end Main;
end refused;
