"""What derivation takes over from another version: what follows from the same nodes, and nothing else."""

from collections.abc import Callable
from dataclasses import replace

from archgen.derivation import derive_low_level
from archgen.derivation.derived_parts import DerivedParts
from archgen.model.architecture import Architecture

_ROBOT = """
archgen: 1
ros: {distro: jazzy}
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      lidar: {outputs: {points: sensor_msgs/msg/PointCloud2}}
      mapper: {inputs: {image: camera.image, points: lidar.points}}
nodes:
  camera: {implements: camera, package: p, executable: c}
"""


def test_what_is_derived_again_is_the_same(derived: Callable[[str], Architecture]) -> None:
    written = replace(derived(_ROBOT), endpoints=(), topics={})
    memory = DerivedParts()
    first, second = derive_low_level(written, memory), derive_low_level(written, memory)
    assert first == second == derive_low_level(written)
    assert all(map(lambda one, other: one is other, first.endpoints, second.endpoints))
    assert all(first.topics[name] is topic for name, topic in second.topics.items())


def test_what_another_type_changes_is_derived_anew(derived: Callable[[str], Architecture]) -> None:
    memory = DerivedParts()
    first = derive_low_level(derived(_ROBOT), memory)
    assert first.topics["/sensing/camera/image"].messages == ("sensor_msgs/msg/Image",)
    mapped = {name: replace(each, message="std_msgs/msg/String") for name, each in first.types.items()}
    second = derive_low_level(replace(first, types=mapped), memory)
    assert second.topics["/sensing/camera/image"].messages == ("std_msgs/msg/String",)


def test_a_reader_follows_a_writer_that_has_another_topic(derived: Callable[[str], Architecture]) -> None:
    memory = DerivedParts()
    first = derive_low_level(derived(_ROBOT), memory)
    moved = derive_low_level(
        derived(_ROBOT.replace("executable: c}", "executable: c, publishes: {image: /front}}")), memory
    )
    assert "/front" not in first.topics
    assert [reader.component for reader in moved.topics["/front"].readers] == ["sensing.mapper"]
