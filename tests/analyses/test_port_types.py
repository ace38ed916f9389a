"""Tests of the comparison of types."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.port_types import medium_mismatch, type_mismatch

Found = Callable[..., list[str]]


def test_another_conceptual_type_is_a_mismatch_even_in_the_same_message(found: Found) -> None:
    text = """
        type "Robot pose" geometry_msgs/msg/PoseStamped
        type "Object pose" geometry_msgs/msg/PoseStamped
        out a.localisation.pose type="Robot pose"
        in a.gripper.target from=a.localisation.pose type="Object pose"
        in a.base.pose from=a.localisation.pose type="Robot pose"
        in a.log.pose from=a.localisation.pose
    """
    assert found(type_mismatch, text) == [
        "4: the input `target` of `a.gripper` expects `Object pose`, but `a.localisation.pose` sends `Robot pose`"
    ]


def test_a_type_written_as_a_message_is_compared_by_message(found: Found) -> None:
    text = """
        type "Robot pose" geometry_msgs/msg/PoseStamped
        out a.localisation.pose type="Robot pose"
        out a.stub.pose type="Not mapped"
        in a.base.pose from=a.localisation.pose type=geometry_msgs/PoseStamped
        in a.base.other from=a.localisation.pose type=geometry_msgs/msg/Pose
        in a.base.unknown from=a.stub.pose type=geometry_msgs/msg/Pose
    """
    assert found(type_mismatch, text) == [
        "5: the input `other` of `a.base` expects `geometry_msgs/msg/Pose`, but `a.localisation.pose` sends `Robot pose`"
    ]


def test_an_unknown_type_fits_everything(found: Found) -> None:
    assert found(type_mismatch, "out a.camera.image\nin a.screen.image from=a.camera.image type=Picture") == []


def test_a_reference_to_a_component_reports_its_outputs_together(found: Found) -> None:
    text = """
        out a.camera.image type=Picture
        out a.camera.depth type=Depth
        out a.camera.info type=Info
        out a.camera.cloud type=Cloud
        in a.screen.image from=a.camera type=Picture
    """
    assert found(type_mismatch, text) == [
        (
            "5: the input `image` of `a.screen` expects `Picture`, but `a.camera.depth` sends `Depth`"
            " and `a.camera.info` sends `Info` (and 1 more)"
        )
    ]


def test_a_caller_may_expect_what_a_service_answers(found: Found) -> None:
    text = """
        type "Plan on request" ramcip_msgs/action/Plan request=Target response="Grasp plan"
        out a.planner.plan type="Plan on request"
        in a.hand.plan from=a.planner.plan type="Grasp plan"
        in a.arm.plan from=a.planner.plan type="Plan on request"
        in a.base.plan from=a.planner.plan type=Path
    """
    assert found(type_mismatch, text) == [
        "5: the input `plan` of `a.base` expects `Path`, but `a.planner.plan` sends `Plan on request`"
    ]


def test_a_physical_input_is_not_fed_by_messages(found: Found) -> None:
    text = """
        out a.voice.words
        out a.voice.sound physical
        in a.ear.words from=a.voice.words physical
        in a.ear.sound from=a.voice.sound physical
        in a.ear.plain from=a.voice.sound
    """
    assert found(medium_mismatch, text) == [
        "3: the input `words` of `a.ear` is physical, but `a.voice.words` sends messages"
    ]
