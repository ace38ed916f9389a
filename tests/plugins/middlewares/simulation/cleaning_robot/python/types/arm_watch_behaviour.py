"""Says that the hand holds something as soon as both joints have turned."""

from ..data import cleaning_robot_msgs


class ArmWatchBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        modes = cleaning_robot_msgs.ArmMode
        mode = modes.HOLDING if len(self.component.joints.fresh()) == 2 else modes.IDLE
        self.component.state.send(cleaning_robot_msgs.ArmState(mode=modes(value=mode)))
