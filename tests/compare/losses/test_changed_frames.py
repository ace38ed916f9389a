"""Changed frames: what is told of them, whom they concern, whom they break and by what; and what is no change at all."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared, Told

ROBOT = """\
review: {breaking: {promise: warning}}
partners: {nav: Nav Lab, eye: Eye Lab, arm: Arm Lab}
groups:
  driving:
    owner: nav
    components:
      drive: {outputs: {odometry: {type: Odometry, frame: odom}}}
      localisation: {inputs: {odometry: drive.odometry}, frames: {odom: {parent: map, rate: 20 Hz}}}
  sensing:
    owner: eye
    components:
      lidar: {inputs: {odometry: drive.odometry}, outputs: {scan: Scan}, frames: {laser: {parent: base_link, static: true}}}
  grasping:
    owner: arm
    components:
      planner: {inputs: {scan: {from: lidar.scan, frame: laser}}}
frames: {map: {}, earth: {}, base_link: {parent: odom, by: drive, title: The base}}
types: {Scan: {message: sensor_msgs/msg/LaserScan, frame: laser}, Odometry: nav_msgs/msg/Odometry}
"""


@pytest.mark.parametrize(
    ("old", "new", "told_text", "broken"),
    [
        (
            "parent: odom, by",
            "parent: map, by",
            "frame `base_link` now is placed in `map` instead of `odom`",
            [
                "eye meaning: places the frame `base_link` in `map` instead of `odom`; `grasping.planner.scan` of Arm Lab and `laser` and `sensing.lidar.scan` of Eye Lab use it",
                "arm meaning: places the frame `base_link` in `map` instead of `odom`; `grasping.planner.scan` of Arm Lab and `laser` and `sensing.lidar.scan` of Eye Lab use it",
            ],
        ),
        (
            "by: drive,",
            "by: localisation,",
            "frame `base_link` now is written by `driving.localisation` instead of `driving.drive`",
            ["eye promise: has the frame `base_link` written by `driving.localisation` instead of `driving.drive`; `laser` of Eye Lab uses it"],
        ),
        (
            "rate: 20 Hz",
            "rate: 10 Hz",
            "frame `odom` now is written at `10 Hz` instead of `20 Hz`",
            [],
        ),
        ("base_link, static: true", "base_link", "frame `laser`: static no longer given (it was true)", []),
        ("title: The base", "title: The wheels", "frame `base_link`: title `The base` → `The wheels`", []),
        (
            "frame: odom",
            "frame: map",
            "`driving.drive.odometry` now is given in `map` instead of `odom`; it is read by `driving.localisation.odometry` and `sensing.lidar.odometry`",
            ["eye meaning: gives `driving.drive.odometry` in `map` instead of `odom`; `sensing.lidar.odometry` of Eye Lab reads it"],
        ),
        (
            "LaserScan, frame: laser",
            "LaserScan, frame: base_link",
            "type `Scan` now is given in `base_link` instead of `laser`",
            ["arm meaning: gives `sensing.lidar.scan` in `base_link` instead of `laser`; `grasping.planner.scan` of Arm Lab reads it"],
        ),
        (
            "from: lidar.scan, frame: laser",
            "from: lidar.scan, frame: map",
            "`grasping.planner.scan` now is expected in `map` instead of `laser`",
            [],
        ),
    ],
)  # fmt: skip
def test_what_a_changed_frame_breaks(compared: Compared, old: str, new: str, told_text: str, broken: list[str]) -> None:
    assert old in ROBOT
    (change,) = compared(ROBOT, ROBOT.replace(old, new, 1)).changes
    assert change.text.split("; it is read by")[0] == told_text.split("; it is read by", maxsplit=1)[0]
    losses = sorted(f"{each.partner} {each.category}: {each.reason}" for each in change.breaks)
    assert losses == sorted(broken)


def test_a_lower_rate_breaks_only_where_margins_are_guarded(compared: Compared) -> None:
    arm = "planner: {inputs: {scan: {from: lidar.scan, frame: laser}}}"
    text = ROBOT.replace(arm, f"{arm[:-1]}, frames: {{arm_base: {{parent: odom}}}}}}")
    unguarded = text.removeprefix("review: {breaking: {promise: warning}}\n")
    for before, breaks in ((text, ["arm promise"]), (unguarded, [])):
        (change,) = compared(before, before.replace("rate: 20 Hz", "rate: 10 Hz")).changes
        assert [f"{each.partner} {each.category}" for each in change.breaks] == breaks
        (change,) = compared(before, before.replace("rate: 20 Hz", "rate: 40 Hz")).changes
        assert change.breaks == ()


def test_a_frame_that_is_gone_or_called_otherwise_is_lost_to_its_users(compared: Compared) -> None:
    gone = ROBOT.replace(", frames: {laser: {parent: base_link, static: true}}", "").replace(
        "frame: laser", "frame: base_link"
    )
    breaks = [
        f"{each.partner} {each.category}"
        for change in compared(ROBOT, gone).changes
        for each in change.breaks
        if change.element_kind == "frame"
    ]
    assert breaks == ["arm wire"]
    renamed = compared(ROBOT, ROBOT.replace("laser", "scanner_link"))
    (change,) = renamed.changes
    assert (change.kind, change.old_id, change.element_id) == ("renamed", "laser", "scanner_link")
    assert [each.reason for each in change.breaks] == [
        "calls `scanner_link` what was the frame `laser`; `grasping.planner.scan` of Arm Lab uses it"
    ]


def test_a_new_frame_says_where_it_is_and_who_writes_it(told: Told) -> None:
    assert told(ROBOT, ROBOT.replace("earth: {},", "earth: {}, tool: {parent: map, by: planner},")) == [
        "added frame tool: frame `tool` is added; it is placed in `map` and is written by `grasping.planner`"
    ]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("base_link: {parent: odom, by: drive, title: The base}", "base_link: {parent: odom, by: driving.drive, title: The base}"),
        ("odom: {parent: map, rate: 20 Hz}", "odom: {parent: map, rate: 0.02 kHz, by: localisation, static: false}"),
        ("frames: {map: {}, earth: {}", "frames: {earth: , map: {title: map}"),
        (", frames: {laser: {parent: base_link, static: true}}}", "}"),
    ],
)  # fmt: skip
def test_what_means_the_same_is_no_change(told: Told, old: str, new: str) -> None:
    assert old in ROBOT
    after = ROBOT.replace(old, new)
    if "laser: {" not in after:
        # From the component to the project: who writes it stays.
        after = after.replace("frames: {map", "frames: {laser: {parent: base_link, static: true, by: lidar}, map")
    assert told(ROBOT, after) == []


def test_a_changed_frame_concerns_those_who_use_it(compared: Compared) -> None:
    assert compared(ROBOT, ROBOT.replace("parent: map, rate", "parent: earth, rate")).concerned_owners == (
        "arm",
        "eye",
        "nav",
    )
    assert compared(ROBOT, ROBOT.replace("base_link, static: true", "base_link")).concerned_owners == ("arm", "eye")
    assert compared(ROBOT, ROBOT.replace("title: The base", "title: The wheels")).concerned_owners == ("nav",)
