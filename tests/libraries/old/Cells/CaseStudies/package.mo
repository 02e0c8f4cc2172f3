package casestudies
  extends Basics.Loads;
end casestudies;
