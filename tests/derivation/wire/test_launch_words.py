"""Which words of a command line are rules for names."""

from __future__ import annotations

import pytest

from archgen.derivation.wire.wire_names import list_rule_words
from archgen.model.node import Node


@pytest.mark.parametrize(
    ("words", "rules"),
    [
        ("--ros-args -r x:=y --remap a:=b", "x:=y a:=b"),
        ("x:=y --ros-args -r a:=b -- c:=d", "x:=y? a:=b c:=d?"),
        ("--ros-args x:=y", "x:=y!"),
        ("--ros-args -p rate:=5 --params-file a:=b --log-level n:=debug -e /x:=y", ""),
        ("--ros-args -r", "<nothing>"),
        ("-r x:=y --rate 5", "x:=y?"),
    ],
)
def test_ros_2_reads_rules_behind_its_word_and_single_ones_before_it(words: str, rules: str) -> None:
    """`?`: where it is no rule, the program gets it; `!`: ROS refuses it."""
    found = list_rule_words(Node("n", "N", arguments=tuple(words.split())), ros_1=False)
    marks = [(each.text or "<nothing>") + "?" * each.is_optional + "!" * each.is_refused for each in found]
    assert " ".join(marks) == rules


def test_ros_1_reads_every_word_with_a_joint_but_parameters() -> None:
    node = Node("n", "N", arguments=("x:=y", "_rate:=5", "__ns:=b", "--ros-args", "-r", "a:=b", "word"))
    assert [each.text for each in list_rule_words(node, ros_1=True)] == ["x:=y", "__ns:=b", "a:=b"]


def test_what_a_container_of_ros_2_loads_has_no_command_line() -> None:
    node = Node("n", "N", arguments=("x:=y",), container="box")
    assert list(list_rule_words(node, ros_1=False)) == []
    assert [each.text for each in list_rule_words(node, ros_1=True)] == ["x:=y"]
