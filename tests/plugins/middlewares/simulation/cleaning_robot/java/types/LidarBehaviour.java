package cleaning_robot.types;

import cleaning_robot.data.geometry_msgs.Point;
import cleaning_robot.data.geometry_msgs.Pose;
import cleaning_robot.data.geometry_msgs.PoseWithCovariance;
import cleaning_robot.data.geometry_msgs.PoseWithCovarianceStamped;

/** Drives 0.3 m/s along a wall, and sees nothing while it is dark. */
final class LidarBehaviour implements Lidar.Behaviour {
    private final Lidar component;

    LidarBehaviour(Lidar component) {
        this.component = component;
    }

    @Override
    public void fire() {
        if (component.surroundings.latest().orElse("dark").equals("dark")) {
            return;
        }
        Pose pose = Pose.empty().withPosition(new Point(0.3 * component.nowNs() / 1e9, 0.1, 0.0));
        component.p.send(
                PoseWithCovarianceStamped.empty().withPose(PoseWithCovariance.empty().withPose(pose)));
    }
}
