within CaseStudies.Water;
model ActiveElement "Gases, liquid water, protons and electrons in an active layer"
  extends PoreElement;
  extends Currents.Element;
end ActiveElement;
