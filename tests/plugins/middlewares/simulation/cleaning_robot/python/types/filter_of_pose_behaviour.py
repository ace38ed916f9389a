"""Each pose that is no jump is given on."""


class FilterOfPoseBehaviour:
    def __init__(self, component):
        self.component = component
        self.last = 0.0

    def fire(self):
        for pose in self.component.raw.fresh():
            if pose.pose.position.x - self.last < 0.05:
                self.component.clean.send(pose)
            self.last = pose.pose.position.x
