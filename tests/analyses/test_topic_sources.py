"""Tests of topics: what they bring against what components say."""

from __future__ import annotations

from collections.abc import Callable

from archgen.analyses.topic_sources import unaccounted_topic, unnamed_source

Found = Callable[..., list[str]]

_BASE = """
    out a.planner.command
    out a.joystick.command
    in a.base.command from=a.planner.command
    node planner implements=a.planner
    node joystick implements=a.joystick
    node base implements=a.base
"""


def test_a_shared_topic_brings_all_that_is_published_there(found: Found) -> None:
    text = f"""{_BASE}
        end planner publishes /cmd_vel port=a.planner.command
        end joystick publishes /cmd_vel port=a.joystick.command
        end base subscribes /cmd_vel port=a.base.command
    """
    assert found(unnamed_source, text) == [
        "10: `/cmd_vel` also brings `a.joystick.command`, which no input of `a.base` names"
    ]


def test_any_input_of_the_component_may_name_the_source(found: Found) -> None:
    text = f"""{_BASE}
        in a.base.manual from=a.joystick
        end planner publishes /cmd_vel port=a.planner.command
        end joystick publishes /cmd_vel port=a.joystick.command
        end base subscribes /cmd_vel port=a.base.command
    """
    assert found(unnamed_source, text) == []


def test_topics_for_everybody_are_left_out(found: Found) -> None:
    text = f"""{_BASE}
        end planner publishes /tf port=a.planner.command shared
        end joystick publishes /tf port=a.joystick.command shared
        end base subscribes /tf port=a.base.command shared written
        end base subscribes /tf internal shared
    """
    assert found(unnamed_source, text) == []
    assert found(unaccounted_topic, text) == []


def test_a_topic_that_a_reader_writes_must_be_among_its_sources(found: Found) -> None:
    text = f"""{_BASE}
        end planner publishes /cmd_vel port=a.planner.command
        end base subscribes /cmd_val port=a.base.command written
    """
    assert found(unaccounted_topic, text) == [
        "9: no source of `command` publishes on `/cmd_val`: they use `/cmd_vel`",
    ]


def test_the_topic_of_another_output_is_reported_once(found: Found) -> None:
    text = f"""{_BASE}
        end planner publishes /cmd_vel port=a.planner.command
        end joystick publishes /joy port=a.joystick.command
        end base subscribes /joy port=a.base.command written
    """
    assert found(unaccounted_topic, text) == []
    assert found(unnamed_source, text) == [
        "10: `/joy` also brings `a.joystick.command`, which no input of `a.base` names"
    ]


def test_a_topic_of_an_input_from_outside_is_its_own(found: Found) -> None:
    text = """
        in a.base.command external
        node base implements=a.base
        end base subscribes /cmd_vel port=a.base.command written
    """
    assert found(unaccounted_topic, text) == []


def test_internal_topics_connect_the_nodes_of_one_component(found: Found) -> None:
    text = f"""{_BASE}
        node filter implements=a.base
        end filter publishes /base/filtered internal
        end filter publishes /base/debug internal
        end base subscribes /base/filtered internal
        end base subscribes /base/missing internal
        end planner publishes /secret internal
        end base subscribes /secret internal
        end joystick publishes /joy port=a.joystick.command
        end base subscribes /joy internal
        end base calls /base/reset internal
        end base calls /planner/get_parameters internal
    """
    assert found(unaccounted_topic, text) == [
        "12: `base` uses the internal topic `/base/missing`, and no node of its component publishes it",
        "14: the internal topic `/secret` comes from `planner`, which is no node of `a.base`",
        "16: the internal topic `/joy` comes from `joystick`, which is no node of `a.base`",
        "17: `base` uses the internal service `/base/reset`, and no node of its component serves it",
    ]


def test_a_node_without_component_is_not_asked(found: Found) -> None:
    assert found(unaccounted_topic, "node relay\nend relay subscribes /in internal") == []


def test_a_topic_that_nobody_wrote_is_not_compared(found: Found) -> None:
    text = f"""{_BASE}
        end planner publishes /cmd_vel port=a.planner.command
        end base subscribes /other port=a.base.command
    """
    assert found(unaccounted_topic, text) == []
    written = text.replace("port=a.base.command", "port=a.base.command written")
    assert len(found(unaccounted_topic, written)) == 1
