package cleaning_robot.cleaning;

import cleaning_robot.data.geometry_msgs.PoseStamped;
import cleaning_robot.data.nav_msgs.OccupancyGrid;
import cleaning_robot.data.nav_msgs.Path;
import java.util.ArrayList;
import java.util.List;

/** Remembers where it was, and goes on. */
final class NavigationBehaviour implements Navigation.Behaviour {
    private final Navigation component;
    private final List<Long> cells = new ArrayList<>();

    NavigationBehaviour(Navigation component) {
        this.component = component;
    }

    @Override
    public void fire() {
        List<PoseStamped> poses = component.pose.fresh();
        poses.forEach(each -> cells.add(Math.round(each.pose().position().x() * 100) % 100));
        component.map.send(OccupancyGrid.empty().withData(cells));
        component.way.send(Path.empty().withPoses(poses));
    }
}
