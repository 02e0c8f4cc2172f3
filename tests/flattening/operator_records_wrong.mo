// MLS §14.1, §14.2: operator records are not extended by long classes, and the functions of an
// operator have the inputs and the output that it asks for.
package operator_records_wrong
  operator record Pair
    Real a;
    encapsulated operator function '+'
      import operator_records_wrong.Pair;
      input Pair x;
      output Pair y = x;
    algorithm
    end '+';
    encapsulated operator function '*'
      import operator_records_wrong.Pair;
      input Pair x;
      output Pair y = x;
    algorithm
    end '*';
  end Pair;
  record Long
    extends Pair;
    Real b;
  end Long;
  model Main
    Long l;
    Pair p;
  end Main;
end operator_records_wrong;
