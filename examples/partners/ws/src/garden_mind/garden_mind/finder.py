"""The university's own: which plant is dry."""

from __future__ import annotations

from typing import TYPE_CHECKING

from geometry_msgs.msg import PointStamped

if TYPE_CHECKING:
    from garden_mind.finder_contract import FinderPorts
    from sensor_msgs.msg import Image


class Finder:
    """Finds the plant that looks driest."""

    def __init__(self, node: FinderPorts) -> None:
        """Remember the node."""
        self.node = node

    def receive_image(self, message: Image) -> None:
        """Say how far the next dry plant is: the darker the picture, the farther."""
        sample = message.data[::997]
        if not sample:
            return
        dry = PointStamped(header=message.header)
        dry.point.x = 1.0 - sum(sample) / (255 * len(sample))
        self.node.publish_dry(dry)
