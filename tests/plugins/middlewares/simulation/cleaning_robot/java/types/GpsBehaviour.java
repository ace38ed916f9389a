package cleaning_robot.types;

import cleaning_robot.data.geometry_msgs.Point;
import cleaning_robot.data.geometry_msgs.Pose;
import cleaning_robot.data.geometry_msgs.PoseWithCovarianceStamped;

/** Knows the pose to a metre, and the better the more satellites it hears. */
final class GpsBehaviour implements Gps.Behaviour {
    private final Gps component;

    GpsBehaviour(Gps component) {
        this.component = component;
    }

    @Override
    public void fire() {
        int heard = component.signals.fresh().size();
        Pose pose = Pose.empty().withPosition(new Point(1.0 / (1 + heard), -heard, 1e-7));
        PoseWithCovarianceStamped message = PoseWithCovarianceStamped.empty();
        component.p.send(message.withPose(message.pose().withPose(pose)));
    }
}
