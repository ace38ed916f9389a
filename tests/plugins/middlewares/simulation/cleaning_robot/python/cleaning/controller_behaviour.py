"""Lets an arm grasp where the way has an odd number of poses, the other one where it has an even one."""

from ..data import cleaning_robot_msgs


class ControllerBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        self.component.wheels.send(f"torque {len(self.component.arms.fresh())}")
        if not self.component.way.is_fresh():
            return
        poses = len(self.component.way.latest().poses)
        arm = self.component.left if poses % 2 else self.component.right
        arm.send(cleaning_robot_msgs.Grasp(force=poses * 2.5))
