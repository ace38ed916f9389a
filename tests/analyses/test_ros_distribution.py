"""A slip in the distribution's name is told once, where it stands, and not at each message."""

from __future__ import annotations

import pytest

from tests.judged_projects import check_text

_TEXT = """\
ros: {distro: %s}
groups: {g: {components: {c: {outputs: {o: {type: sensor_msgs/msg/Imgae, external: Out}}}}}}
nodes: {n: g.c}
"""


@pytest.mark.parametrize(
    ("distro", "told"),
    [
        (
            "humbel",
            [
                "1:15 error unknown-distro did you mean `humble`?",
                "2:51 error unknown-message did you mean `sensor_msgs/msg/Image`?",
            ],
        ),
        (
            "noetik",
            [
                "1:15 error unknown-distro did you mean `noetic`?",
                "2:51 error unknown-message did you mean `sensor_msgs/msg/Image`?",
            ],
        ),
        # A name that is right, though old, is no error.
        (
            "foxy",
            [
                "1:15 warning unknown-distro archgen holds the interfaces of humble, jazzy, kilted, lyrical, noetic, rolling"
            ],
        ),
        (
            "windows",
            [
                "1:15 error unknown-distro archgen holds the interfaces of humble, jazzy, kilted, lyrical, noetic, rolling"
            ],
        ),
        ("humble", ["2:51 error unknown-message did you mean `sensor_msgs/msg/Image`?"]),
    ],
)
def test_a_slip_in_the_distribution(distro: str, told: list[str]) -> None:
    found = check_text(_TEXT % distro)
    messages = [d for d in found if d.rule in {"unknown-distro", "unchecked-message", "unknown-message"}]
    assert [f"{d.span.line}:{d.span.column} {d.severity} {d.rule} {d.help}" for d in messages] == told
