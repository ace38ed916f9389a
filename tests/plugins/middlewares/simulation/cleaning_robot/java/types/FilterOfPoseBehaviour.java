package cleaning_robot.types;

import cleaning_robot.data.geometry_msgs.PoseStamped;

/** Gives on each pose that is no jump. */
final class FilterOfPoseBehaviour implements FilterOfPose.Behaviour {
    private final FilterOfPose component;
    private double last;

    FilterOfPoseBehaviour(FilterOfPose component) {
        this.component = component;
    }

    @Override
    public void fire() {
        for (PoseStamped pose : component.raw.fresh()) {
            double x = pose.pose().position().x();
            if (x - last < 0.05) {
                component.clean.send(pose);
            }
            last = x;
        }
    }
}
