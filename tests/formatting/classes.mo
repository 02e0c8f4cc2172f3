within  Cells ;
  // License: at the beginning.


package Stack "A stack of cells"   extends Icons.Package ; import SI=Modelica.Units.SI;
  // Section of models
model Cell "One cell"
    parameter SI.Resistance R ( min = 0 )=0.3 "Ohmic resistance"annotation(Dialog(group="Losses"));
  parameter Real table[:,2]=[0,1 ;1 , 2]; Real x , y [ 3 ];
   replaceable model Losses = Empty constrainedby Base annotation( choicesAllMatching=true );
  Real d if use_d and not (a or b);   // trailing
                                      // and its second line
/* before the section */
protected Real z; /* a */ Real w; 
initial equation
x=1 ;
equation
    der (x)=- x+ 2*y[1]^ -2;



  if x>0 then y[1]=1; elseif(x<-1) then
    y[1] = 2;
  else if z > 0 then y[1] = 3; end if; end if;
  for i in {1,2} loop y[i]=if i==1 then 0 else
                       1;
    // last of the loop
  end for;
  when{initial (), sample(0,1)}then reinit(x,0);elsewhen time>2 then
     reinit( x , 1 ); end when;
//  y[1] = 5;
  connect (a.p,b.n) annotation(Line(points={{0,0},
{1, 1}}, color={0,0,255}));
algorithm
while(w<1)loop w:=w+1; end while;
annotation (
Icon(graphics={Text(extent={{-100,100},
                   {100,-100}}, textString="a
  b")}));
end Cell ;

  function f input Real u; output Real y; external "C" y=c_f(u) annotation(Library="c"); end f;
  function g extends f ( u = 2 ) ; algorithm y:= .Modelica.Math.sin (u); return; end g;
  type Kind=enumeration ( a "first", b );
  model extends M ( p=1 ) "Extended" Real q;end M;
  package Empty end Empty;
  function d = der ( f, u );
  Modelica.Fluid.Machines.PrescribedPump pump(m_flow_start=10, redeclare package Medium = Modelica.Media.Water.StandardWater, checkValve=true, rho_nominal=1000) "A pump" annotation (Placement(transformation(extent={{-10,-10},{10,10}})));
end Stack;
