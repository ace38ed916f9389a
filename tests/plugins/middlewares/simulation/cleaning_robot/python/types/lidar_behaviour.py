"""A laser scanner: 0.3 m/s along a wall, and nothing while it is dark."""

from ..data import geometry_msgs


class LidarBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        if (self.component.surroundings.latest() or "dark") == "dark":
            return
        position = geometry_msgs.Point(x=0.3 * self.component.now_ns / 1e9, y=0.1)
        pose = geometry_msgs.PoseWithCovariance(pose=geometry_msgs.Pose(position=position))
        self.component.p.send(geometry_msgs.PoseWithCovarianceStamped(pose=pose))
