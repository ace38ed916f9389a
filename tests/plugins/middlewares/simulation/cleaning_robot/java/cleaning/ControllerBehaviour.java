package cleaning_robot.cleaning;

import cleaning_robot.data.cleaning_robot_msgs.Grasp;

/** Lets an arm grasp where the way has an odd number of poses, the other one where it has an even one. */
final class ControllerBehaviour implements Controller.Behaviour {
    private final Controller component;

    ControllerBehaviour(Controller component) {
        this.component = component;
    }

    @Override
    public void fire() {
        component.wheels.send("torque " + component.arms.fresh().size());
        if (!component.way.isFresh()) {
            return;
        }
        int poses = component.way.latest().orElseThrow().poses().size();
        (poses % 2 == 1 ? component.left : component.right).send(Grasp.empty().withForce(poses * 2.5));
    }
}
