"""Drive Systems' own: the wheels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nav_msgs.msg import Odometry

if TYPE_CHECKING:
    from garden_base.wheels_contract import WheelsPorts
    from geometry_msgs.msg import Twist


class Wheels:
    """Drives, and counts how far."""

    def __init__(self, node: WheelsPorts) -> None:
        """Remember the node. The robot stands where it was switched on."""
        self.node = node
        self.speed = 0.0
        self.driven = 0.0

    def receive_velocity(self, message: Twist) -> None:
        """Remember how fast to drive."""
        self.speed = message.linear.x

    def on_timer(self) -> None:
        """Drive for one period, and say where the robot is."""
        self.driven += self.speed * 0.05
        odometry = Odometry()
        odometry.header.frame_id = "odom"
        odometry.header.stamp = self.node.get_clock().now().to_msg()
        odometry.pose.pose.position.x = self.driven
        odometry.twist.twist.linear.x = self.speed
        self.node.publish_odometry(odometry)
