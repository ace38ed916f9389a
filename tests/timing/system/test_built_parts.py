"""Activities are taken over from another version where all that they are built from is the same."""

from collections.abc import Callable
from dataclasses import replace

from archgen.model.architecture import Architecture
from archgen.timing.system.activity_builder import BuiltParts
from archgen.timing.system.system_builder import build_system

_ROBOT = """
archgen: 1
ros: {distro: jazzy}
hosts: {pc: {cores: 2}}
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      viewer: {inputs: {image: camera.image}, outputs: {light: {medium: physical, external: A person}}}
nodes:
  camera: {implements: camera, host: pc, timing: {rate: 10 Hz, wcet: 3 ms}}
  viewer: {implements: viewer, host: pc, timing: {wcet: 4 ms}}
"""


def test_an_activity_is_built_once_for_the_same_node(derived: Callable[[str], Architecture]) -> None:
    architecture, memory = derived(_ROBOT), BuiltParts()
    first, _ = build_system(architecture, memory)
    second, _ = build_system(architecture, memory)
    assert all(first.activities[name] is activity for name, activity in second.activities.items())
    other_node = replace(architecture.nodes["camera"], host=None)
    changed = replace(architecture, nodes={**architecture.nodes, "camera": other_node})
    third, _ = build_system(changed, memory)
    assert third.activities["camera"].host is None
    assert third.activities["viewer"] is first.activities["viewer"]


def test_another_unit_of_durations_builds_them_anew(derived: Callable[[str], Architecture]) -> None:
    architecture, memory = derived(_ROBOT), BuiltParts()
    first, _ = build_system(architecture, memory)
    more_cores = replace(architecture, hosts={"pc": replace(architecture.hosts["pc"], cores=7)})
    second, _ = build_system(more_cores, memory)
    assert (first.tick, second.tick) != (first.tick, first.tick)
    assert second.activities == build_system(more_cores)[0].activities
    again, _ = build_system(architecture, memory)
    assert again.activities["camera"] is first.activities["camera"]
