package cleaning_robot.types;

import cleaning_robot.data.sensor_msgs.JointState;
import java.util.List;

/** Turns at most as fast as its parameter says. */
final class MotorBehaviour implements Motor.Behaviour {
    private final Motor component;

    MotorBehaviour(Motor component) {
        this.component = component;
    }

    @Override
    public void fire() {
        double target = component.target.latest().orElseThrow().position();
        double turned = Math.min(target, component.parameters.maxSpeed());
        component.torque.send(component.parameters.joint() + " turns");
        component.state.send(
                JointState.empty().withName(List.of(component.parameters.joint())).withPosition(List.of(turned)));
    }
}
