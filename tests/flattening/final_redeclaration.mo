// A final redeclaration cannot be replaced; components of the class that it puts there can be modified.
model final_redeclaration
  partial model Flow
    parameter Real k = 1;
    Real y;
  end Flow;
  model Linear
    extends Flow;
  equation
    y = k*time;
  end Linear;
  model Square
    extends Flow;
  equation
    y = k*time^2;
  end Square;
  model Straight
    replaceable model FlowModel = Linear constrainedby Flow;
  end Straight;
  model Pipe
    extends Straight;
    FlowModel flowModel(k = 3);
  end Pipe;
  model Exchanger
    replaceable model Own = Linear constrainedby Flow;
    Pipe pipe(redeclare final model FlowModel = Own);
  end Exchanger;
  Exchanger exchanger(redeclare model Own = Square);
end final_redeclaration;
