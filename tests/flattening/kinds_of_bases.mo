// MLS §7.1.3: a model does not extend a package or a function.
package kinds_of_bases
  function f
    input Real u;
    output Real y = u;
  end f;
  model Main
    extends f;
  end Main;
end kinds_of_bases;
