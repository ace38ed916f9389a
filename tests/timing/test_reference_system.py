"""The Autoware-shaped reference system (ros-realtime/reference-system): rates, traffic and load come out as published.

Graph: autoware_system_builder.hpp; periods: timing/default.hpp; all messages 4096 bytes; 10 ms for each processing step.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

from archgen.model.architecture import Architecture
from archgen.timing.run_analysis import analyse_architecture

_SENSORS = {
    "front_lidar": 100,
    "rear_lidar": 100,
    "point_cloud_map": 120,
    "visualizer": 60,
    "lanelet_map": 100,
    "cluster_settings": 25,
}
_TRANSFORMS = {
    "transformer_front": "front_lidar",
    "transformer_rear": "rear_lidar",
    "voxel_grid": "fusion",
    "map_loader": "point_cloud_map",
    "ray_ground": "fusion",
    "cluster_detector": "ray_ground",
    "intersection": "cluster_settings",
    "collision_estimator": "cluster_detector",
    "mpc": "behavior_planner",
    "parking": "lanelet_loader",
    "lane": "lanelet_loader",
}
_FUSIONS = {
    "fusion": ("transformer_front", "transformer_rear"),
    "ndt": ("voxel_grid", "map_loader"),
    "vehicle_interface": ("mpc", "behavior_planner"),
    "global_planner": ("visualizer", "ndt"),
    "lanelet_loader": ("lanelet_map", "global_planner"),
}
_PLANNER = ("collision_estimator", "ndt", "global_planner", "lanelet_loader", "parking", "lane")
_SINKS = {"vehicle_dbw": "vehicle_interface", "intersection_output": "intersection"}
_SLOW = ("ndt", "global_planner", "lanelet_loader", "parking", "lane", "map_loader", "point_cloud_map")
_WORK = "wcet: 10 ms, bcet: 10 ms"


def _text() -> str:
    inputs: dict[str, tuple[str, ...]] = {name: (source,) for name, source in {**_TRANSFORMS, **_SINKS}.items()}
    inputs |= _FUSIONS | {"behavior_planner": _PLANNER}
    names = [*_SENSORS, *inputs]
    lines = [
        "types: {Data: {message: std_msgs/msg/ByteMultiArray, size: 4096 B}}",
        "groups:",
        "  g:",
        "    components:",
    ]
    for name in names:
        ports = ", ".join(f"from_{source}: {source}.out" for source in inputs.get(name, ()))
        out = "" if name in _SINKS else "outputs: {out: Data}"
        lines.append(f"      {name}: {{{', '.join(filter(None, (f'inputs: {{{ports}}}' if ports else '', out)))}}}")
    lines.append("nodes:")
    for name in names:
        timing = f"period: {_SENSORS[name]} ms, wcet: 0 ms, bcet: 0 ms" if name in _SENSORS else _WORK
        timing = f"period: 100 ms, {_WORK}" if name == "behavior_planner" else timing
        timing = "wcet: 0 ms, bcet: 0 ms" if name in _SINKS else timing
        more = ", trigger: all" if name in _FUSIONS else ""
        lines.append(f"  {name}: {{implements: {name}, timing: {{{timing}{more}}}}}")
    return "\n".join(lines) + "\n"


def test_the_reference_system(derived: Callable[[str], Architecture]) -> None:
    found = analyse_architecture(derived(_text()))
    assert len(found.paces) == 25
    special: dict[str, Fraction | int] = {name: Fraction(25, 3) for name in _SLOW}
    special |= {"visualizer": Fraction(50, 3), "cluster_settings": 40, "intersection": 40, "intersection_output": 40}
    assert {name: pace.rate.value for name, pace in found.paces.items()} == {
        name: special.get(name, 10) for name in found.paces
    }
    assert sum(topic.published.value or 0 for topic in found.topics.values()) == 1_167_360
    assert sum(topic.delivered.value or 0 for topic in found.topics.values()) == Fraction(4_157_440, 3)
    assert sum(response.worst.value or 0 for response in found.responses.values()) == 17 * 10 * 10**6
    assert (found.endless, found.deadlocked, found.diverged) == ((), (), ())
