"""A receiver of satellites: the more it hears, the better."""

from ..data import geometry_msgs


class GpsBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        heard = len(self.component.signals.fresh())
        pose = geometry_msgs.Pose(position=geometry_msgs.Point(x=1 / (1 + heard), y=-heard, z=1e-7))
        covered = geometry_msgs.PoseWithCovariance(pose=pose)
        self.component.p.send(geometry_msgs.PoseWithCovarianceStamped(pose=covered))
