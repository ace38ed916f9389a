"""The QoS profiles of ROS 2's middleware interface, and their values.

Source: rmw/include/rmw/qos_profiles.h, https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from archgen.model.node import Qos, Use

# What a profile does not set has the default of `Qos`, which is that of `default`.
PROFILES: Mapping[str, Qos] = {
    "default": Qos("default"),
    "sensor_data": Qos("sensor_data", reliability="best_effort", depth=5),
    "services": Qos("services"),
    "parameters": Qos("parameters", depth=1000),
    "parameter_events": Qos("parameter_events", depth=1000),
    "system_default": Qos("system_default", depth=None),
}


def profile(name: str, use: Use) -> Qos:
    """Return the values of a profile for one side. An unknown profile counts as `default`.

    `system_default` is the middleware's choice: DDS defaults to reliable for writers and best effort for readers.
    """
    found = PROFILES.get(name, PROFILES["default"])
    if name == "system_default" and use == "subscribes":
        return replace(found, reliability="best_effort")
    return found
