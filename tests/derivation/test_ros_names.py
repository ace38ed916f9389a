"""Names that follow from the model alone."""

from __future__ import annotations

from archgen.derivation.ros_names import default_port_name, shared_topic_names


def test_a_port_without_a_topic_is_called_by_its_path() -> None:
    assert default_port_name("sensing.camera.image") == "/sensing/camera/image"


def test_topics_that_everybody_may_use() -> None:
    shared = shared_topic_names(("joint_states", "/odom"))
    assert {"/joint_states", "/odom", "/tf", "/clock"} <= shared
    assert "joint_states" not in shared
