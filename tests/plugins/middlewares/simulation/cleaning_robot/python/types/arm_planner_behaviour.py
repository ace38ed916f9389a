"""Turns the shoulder by the force, and the elbow against it."""

from ..data import cleaning_robot_msgs


class ArmPlannerBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        force = self.component.target.latest().force
        self.component.shoulder.send(cleaning_robot_msgs.JointTarget(position=force / 3))
        self.component.elbow.send(cleaning_robot_msgs.JointTarget(position=-force / 7))
