package cleaning_robot.types;

import cleaning_robot.data.cleaning_robot_msgs.JointTarget;

/** Turns the shoulder by the force, and the elbow against it. */
final class ArmPlannerBehaviour implements ArmPlanner.Behaviour {
    private final ArmPlanner component;

    ArmPlannerBehaviour(ArmPlanner component) {
        this.component = component;
    }

    @Override
    public void fire() {
        double force = component.target.latest().orElseThrow().force();
        component.shoulder.send(JointTarget.empty().withPosition(force / 3));
        component.elbow.send(JointTarget.empty().withPosition(-force / 7));
    }
}
