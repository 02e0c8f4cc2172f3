within ;
package Library "Elements of the outermost package are not indented"
extends Icons.Package;
import SI = Modelica.Units.SI;

package Part
extends Icons.Package;
model A Real x;
end A;
end Part;

annotation (version="1.0",
uses(Modelica(version="4.0.0")));
end Library;
