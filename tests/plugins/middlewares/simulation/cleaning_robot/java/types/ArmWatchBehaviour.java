package cleaning_robot.types;

import cleaning_robot.data.cleaning_robot_msgs.ArmMode;
import cleaning_robot.data.cleaning_robot_msgs.ArmState;

/** Says that the hand holds something as soon as both joints have turned. */
final class ArmWatchBehaviour implements ArmWatch.Behaviour {
    private final ArmWatch component;

    ArmWatchBehaviour(ArmWatch component) {
        this.component = component;
    }

    @Override
    public void fire() {
        long mode = component.joints.fresh().size() == 2 ? ArmMode.HOLDING : ArmMode.IDLE;
        component.state.send(ArmState.empty().withMode(new ArmMode(mode)));
    }
}
