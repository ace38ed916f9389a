"""Tests of where a node's ports stand."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.topic_sources import wrong_section

Found = Callable[..., list[str]]


def test_messages_say_in_which_section_a_port_stands(found: Found) -> None:
    text = """
        type Check std_srvs/srv/Trigger
        type Plan demo_msgs/action/Plan
        type Image sensor_msgs/msg/Image
        out a.s.check type=Check
        out a.s.plan type=Plan
        out a.s.image type=Image
        out a.s.new type="Not mapped"
        out a.s.light physical
        in a.c.check from=a.s.check
        in a.c.image from=a.s
        in a.c.both from=a.s.check,a.s.image
        node s implements=a.s
        node c implements=a.c
        use s publishes check port=a.s.check
        use s publishes plan port=a.s.plan
        use s serves image port=a.s.image
        use s serves new port=a.s.new
        use s publishes light port=a.s.light
        use c subscribes check port=a.c.check
        use c calls image port=a.c.image
        use c calls both port=a.c.both
        use c subscribes both port=a.c.both
        use c publishes debug message=std_srvs/srv/Empty
        use c publishes debug message=std_msgs/msg/Empty
    """
    assert found(wrong_section, text) == [
        "14: `check` of the node `s` is a service, but stands below `publishes`",
        "15: `plan` of the node `s` is an action, but stands below `publishes`",
        "16: `image` of the node `s` is a topic, but stands below `serves`",
        "18: `light` of the node `s` is physical and does not stand below `publishes`",
        "19: `check` of the node `c` is a service, but stands below `subscribes`",
        "20: `image` of the node `c` is a topic, but stands below `calls`",
        "23: `debug` of the node `c` is a service, but stands below `publishes`",
    ]
