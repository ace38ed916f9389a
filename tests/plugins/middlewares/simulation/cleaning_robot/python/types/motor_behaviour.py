"""Turns at most as fast as its parameter says."""

from ..data import sensor_msgs


class MotorBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        parameters = self.component.parameters
        turned = min(self.component.target.latest().position, parameters.max_speed)
        self.component.torque.send(f"{parameters.joint} turns")
        self.component.state.send(sensor_msgs.JointState(name=[parameters.joint], position=[turned]))
