package cleaning_robot.types;

import cleaning_robot.data.builtin_interfaces.Time;
import cleaning_robot.data.geometry_msgs.Point;
import cleaning_robot.data.geometry_msgs.Pose;
import cleaning_robot.data.geometry_msgs.PoseStamped;
import cleaning_robot.data.std_msgs.Header;

/** Takes the laser's pose, and a tenth of the satellites' way from it. */
final class PoseFusionBehaviour implements PoseFusion.Behaviour {
    private final PoseFusion component;

    PoseFusionBehaviour(PoseFusion component) {
        this.component = component;
    }

    @Override
    public void fire() {
        if (component.lp.latest().isEmpty()) {
            return;
        }
        Point laser = component.lp.latest().get().pose().pose().position();
        Point other = component.gp.latest().map(each -> each.pose().pose().position()).orElse(laser);
        Point fused =
                new Point(laser.x() + 0.1 * (other.x() - laser.x()), laser.y() + 0.1 * (other.y() - laser.y()), laser.z());
        Time time = new Time(component.nowNs() / 1_000_000_000, component.nowNs() % 1_000_000_000);
        component.p.send(new PoseStamped(new Header(time, "map \u2603"), Pose.empty().withPosition(fused)));
    }
}
