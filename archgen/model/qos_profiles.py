"""The QoS profiles of ROS 2's middleware interface, and their values.

Source: rmw/include/rmw/qos_profiles.h, https://docs.ros.org/en/jazzy/Concepts/Intermediate/About-Quality-of-Service-Settings.html
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from archgen.model.node import Qos, UseKind

# What a profile does not set has the default of `Qos`, which is that of `default`.
QOS_PROFILES: Mapping[str, Qos] = {
    "default": Qos("default"),
    "sensor_data": Qos("sensor_data", reliability="best_effort", depth=5),
    "services": Qos("services"),
    "parameters": Qos("parameters", depth=1000),
    "parameter_events": Qos("parameter_events", depth=1000),
    "system_default": Qos("system_default", depth=None),
}


def qos_profile(name: str, use: UseKind) -> Qos:
    """Return the values of a profile for one side. An unknown profile counts as `default`.

    `system_default` is the middleware's choice: DDS defaults to reliable for writers and best effort for readers.
    """
    qos = QOS_PROFILES.get(name, QOS_PROFILES["default"])
    if name == "system_default" and use == "subscribes":
        return replace(qos, reliability="best_effort")
    return qos
