"""The profiles of quality of service: what each stands for, as ROS 2's middleware interface has them.

Source: rmw/include/rmw/qos_profiles.h, https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from archgen.model.node import Qos, Use

PROFILES: Mapping[str, Qos] = {
    "default": Qos("default"),
    "sensor_data": Qos("sensor_data", reliability="best_effort", depth=5),
    "services": Qos("services"),
    "parameters": Qos("parameters", depth=1000),
    "parameter_events": Qos("parameter_events", depth=1000),
    "system_default": Qos("system_default", depth=None),
}


def profile(name: str, use: Use) -> Qos:
    """Give a profile's values for one side. An unknown profile counts as `default`.

    `system_default` is the middleware's choice; DDS says reliable for those who write and best effort for those who read.
    """
    found = PROFILES.get(name, PROFILES["default"])
    if name == "system_default" and use == "subscribes":
        return replace(found, reliability="best_effort")
    return found
