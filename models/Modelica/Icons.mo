within Modelica;
package Icons "Classes without content that say what a class is for"
  partial class Information "Base class of general information" end Information;
  partial class Contact "Base class of authors" end Contact;
  partial class ReleaseNotes "Base class of changes" end ReleaseNotes;
  partial class References "Base class of literature" end References;
  partial package ExamplesPackage "Base class of executable examples" end ExamplesPackage;
  partial model Example "Base class of an executable example" end Example;
  partial package Package "Base class of a package" end Package;
  partial package BasesPackage "Base class of base classes" end BasesPackage;
  partial package VariantsPackage "Base class of variants" end VariantsPackage;
  partial package InterfacesPackage "Base class of connectors and partial classes" end InterfacesPackage;
  partial package SourcesPackage "Base class of sources" end SourcesPackage;
  partial package SensorsPackage "Base class of sensors" end SensorsPackage;
  partial package UtilitiesPackage "Base class of auxiliary classes" end UtilitiesPackage;
  partial package TypesPackage "Base class of types" end TypesPackage;
  partial package FunctionsPackage "Base class of functions" end FunctionsPackage;
  partial package IconsPackage "Base class of icons" end IconsPackage;
  partial package InternalPackage "Base class of classes that are not for users" end InternalPackage;
  partial package MaterialPropertiesPackage "Base class of properties of materials" end MaterialPropertiesPackage;
  partial package RecordsPackage "Base class of records" end RecordsPackage;
  partial class MaterialProperty "Base class of a property of a material" end MaterialProperty;
  partial class RoundSensor "Base class of a round sensor" end RoundSensor;
  partial class RectangularSensor "Base class of a rectangular sensor" end RectangularSensor;
  partial function Function "Base class of a function" end Function;
  partial record Record "Base class of a record" end Record;
  partial class UnderConstruction "Base class of a class that is not finished" end UnderConstruction;
  partial class ObsoleteModel "Base class of a class that is kept for older models" end ObsoleteModel;
  partial package Library "Base class of a package (name until version 3)" end Library;
  partial package Library2 "Base class of a package (name until version 3)" end Library2;
  partial class Info "Base class of general information (name until version 3)" end Info;
  partial class TranslationalSensor "Base class of a sensor of a distance (name until version 3)" end TranslationalSensor;
  partial class RotationalSensor "Base class of a sensor of an angle (name until version 3)" end RotationalSensor;
  partial class GearIcon "Base class of a gear" end GearIcon;
  partial class MotorIcon "Base class of a motor" end MotorIcon;
  partial class Enumeration "Base class of an enumeration (name of version 2)" end Enumeration;
  type TypeReal = Real "Base of types of real numbers";
  type TypeInteger = Integer "Base of types of integers";
  type TypeBoolean = Boolean "Base of types of truth values";
  type TypeString = String "Base of types of texts";

  expandable connector SignalBus "Base of buses"
  end SignalBus;

  expandable connector SignalSubBus "Base of buses within buses"
  end SignalSubBus;
  annotation(Documentation(info = "<html>
<p>In a graphical editor these classes draw the pictures of the library. Here they have neither
content nor graphics: classes that extend them keep the meaning that the name gives.</p>
</html>"));
end Icons;
