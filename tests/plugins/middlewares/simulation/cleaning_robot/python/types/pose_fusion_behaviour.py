"""The laser's pose, and a tenth of the satellites' way from it."""

from ..data import builtin_interfaces, geometry_msgs, std_msgs


class PoseFusionBehaviour:
    def __init__(self, component):
        self.component = component

    def fire(self):
        if self.component.lp.latest() is None:
            return
        laser = self.component.lp.latest().pose.pose.position
        satellite = self.component.gp.latest()
        other = satellite.pose.pose.position if satellite else laser
        fused = geometry_msgs.Point(
            x=laser.x + 0.1 * (other.x - laser.x), y=laser.y + 0.1 * (other.y - laser.y), z=laser.z
        )
        now_ns = self.component.now_ns
        time = builtin_interfaces.Time(sec=now_ns // 10**9, nanosec=now_ns % 10**9)
        header = std_msgs.Header(stamp=time, frame_id="map \u2603")
        self.component.p.send(geometry_msgs.PoseStamped(header=header, pose=geometry_msgs.Pose(position=fused)))
