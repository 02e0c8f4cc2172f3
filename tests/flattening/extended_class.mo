// `model extends` without `redeclare` is a class of its own beside the inherited one (MLS 7.3.1).
package extended_class
  model Base
    replaceable model Part
      Real x = 1;
    end Part;
    model Same
      parameter Real k = 2;
    end Same;
    Part inherited;
  end Base;

  model Main
    extends Base;
    model extends Part
      Real y = 2;
    end Part;
    model Same
      parameter Real k = 2;
    end Same;
    Part own;
    Same same;
  end Main;

end extended_class;
