"""Remembers where it was, and goes on."""

import math

from ..data import nav_msgs


class NavigationBehaviour:
    def __init__(self, component):
        self.component = component
        self.cells = []

    def fire(self):
        poses = self.component.pose.fresh()
        self.cells += [math.floor(each.pose.position.x * 100 + 0.5) % 100 for each in poses]
        self.component.map.send(nav_msgs.OccupancyGrid(data=self.cells))
        self.component.way.send(nav_msgs.Path(poses=poses))
