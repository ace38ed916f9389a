"""The university's own: where to drive, and when to pour."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger

if TYPE_CHECKING:
    from garden_mind.guide_contract import GuidePorts
    from geometry_msgs.msg import PointStamped
    from std_msgs.msg import Float32


class Guide:
    """Drives to a dry plant and waters it while there is water."""

    def __init__(self, node: GuidePorts) -> None:
        """Remember the node. The tank is empty until it says something else."""
        self.node = node
        self.level = 0.0

    def receive_dry(self, message: PointStamped) -> None:
        """Drive towards the plant; beside it, pour."""
        velocity = Twist()
        if message.point.x > self.node.get_parameter("reach").value:
            velocity.linear.x = 0.3
        elif self.level > 0.0:
            self.node.call_water(Trigger.Request())
        self.node.publish_velocity(velocity)

    def receive_level(self, message: Float32) -> None:
        """Remember how much water is left."""
        self.level = message.data
