"""Weakened promises, other versions and deprecations: what is told of them, and whom they break by what."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared

ROBOT = """\
partners: {eye: Eye Lab, nav: Nav Lab, arm: Arm Lab}
groups:
  sensing:
    owner: eye
    components:
      camera:
        outputs:
          rows: {type: Rows, promise: {rate: 10 Hz, max_gap: 150 ms, max_age: 200 ms, unit: m, frame: base, range: [0, 30]}, version: 2, deprecated: {until: 2999-06-01, use: rows_v2}}
          rows_v2: {type: Rows}
      head:
        outputs: {rows: {from: lens.rows}, slow: {from: lens.rows, promise: {rate: 5 Hz}}}
        components: {lens: {outputs: {rows: {type: Heads, promise: {rate: 20 Hz}}}}}
      wheel: {is: motor}
  driving: {owner: nav, components: {plan: {inputs: {rows: camera.rows, heads: head.rows}}}}
  grasping: {owner: arm, components: {reach: {inputs: {rows: camera.rows_v2, heads: head.slow}}, left: {is: motor}}}
frames: {base: , map: }
component_types: {motor: {version: 1}}
types: {Rows: {message: std_msgs/msg/Bool, version: 3}, Heads: std_msgs/msg/Int8}
"""
READ = "`driving.plan.rows` of Nav Lab reads it"


@pytest.mark.parametrize(
    ("old", "new", "told_text", "broken"),
    [
        (
            "rate: 10 Hz",
            "rate: 5 Hz",
            "`sensing.camera.rows`: promised rate `10 Hz` → `5 Hz`",
            [f"nav promise: promises for `sensing.camera.rows` a rate of 5 Hz instead of 10 Hz; {READ}"],
        ),
        ("rate: 10 Hz", "rate: 20 Hz", "`sensing.camera.rows`: promised rate `10 Hz` → `20 Hz`", []),
        (
            "max_gap: 150 ms, ",
            "",
            "`sensing.camera.rows`: promised largest gap no longer given (it was `150 ms`)",
            [f"nav promise: promises for `sensing.camera.rows` no largest gap any more (it was 150 ms); {READ}"],
        ),
        (
            "max_age: 200 ms",
            "max_age: 0.3 s",
            "`sensing.camera.rows`: promised greatest age `200 ms` → `0.3 s`",
            [f"nav promise: promises for `sensing.camera.rows` a greatest age of 0.3 s instead of 200 ms; {READ}"],
        ),
        (
            "range: [0, 30]",
            "range: [-1, .inf]",
            "`sensing.camera.rows`: promised range `0 to 30` → `-1 to no limit`",
            [f"nav promise: promises for `sensing.camera.rows` values of -1 to no limit m instead of 0 to 30 m; {READ}"],
        ),
        ("range: [0, 30]", "range: [1, 2]", "`sensing.camera.rows`: promised range `0 to 30` → `1 to 2`", []),
        (
            "unit: m",
            "unit: mm",
            "`sensing.camera.rows`: promised unit `m` → `mm`",
            [f"nav meaning: gives `sensing.camera.rows` in `mm` instead of `m`; {READ}"],
        ),
        (
            "frame: base",
            "frame: map",
            "`sensing.camera.rows`: promised frame `base` → `map`",
            [f"nav meaning: gives `sensing.camera.rows` in the frame `map` instead of `base`; {READ}"],
        ),
        (
            "version: 2,",
            "version: 3,",
            "`sensing.camera.rows`: version `2` → `3`",
            [f"nav meaning: gives `sensing.camera.rows` the version `3` instead of `2`; {READ}"],
        ),
        (
            "2999-06-01",
            "2999-05-31",
            "`sensing.camera.rows`: last day `2999-06-01` → `2999-05-31`",
            [f"nav promise: keeps `sensing.camera.rows` until 2999-05-31 instead of 2999-06-01; {READ}"],
        ),
        ("2999-06-01", "2999-06-02", "`sensing.camera.rows`: last day `2999-06-01` → `2999-06-02`", []),
        (", deprecated: {until: 2999-06-01, use: rows_v2}", "", None, []),
        (
            "rows_v2: {type: Rows}",
            "rows_v2: {type: Rows, deprecated: {until: 2999-01-01}}",
            "`sensing.camera.rows_v2` is deprecated now, until `2999-01-01`",
            ["arm promise: keeps `sensing.camera.rows_v2` until 2999-01-01 only; `grasping.reach.rows` of Arm Lab reads it"],
        ),
        (
            "rows_v2: {type: Rows}",
            "rows_v2: {type: Rows, promise: {rate: 1 Hz}, version: 1}",
            None,
            [],
        ),
        (
            "rate: 20 Hz",
            "rate: 10 Hz",
            "`sensing.head.lens.rows`: promised rate `20 Hz` → `10 Hz`",
            ["nav promise: promises for `sensing.head.rows` a rate of 10 Hz instead of 20 Hz; `driving.plan.heads` of Nav Lab reads it"],
        ),
        (
            "rate: 5 Hz",
            "rate: 4 Hz",
            "`sensing.head`: promised rate of the output `slow` `5 Hz` → `4 Hz`",
            ["arm promise: promises for `sensing.head.slow` a rate of 4 Hz instead of 5 Hz; `grasping.reach.heads` of Arm Lab reads it"],
        ),
        (
            "Bool, version: 3",
            "Bool, version: 4",
            "type `Rows`: version `3` → `4`",
            ["arm meaning: gives `Rows` the version `4` instead of `3`; Arm Lab and Nav Lab use it", "nav meaning: gives `Rows` the version `4` instead of `3`; Arm Lab and Nav Lab use it"],
        ),
        (
            "motor: {version: 1}",
            "motor: {version: 1, deprecated: {use: m2}}, m2: {}",
            None,
            ["arm promise: deprecates `motor` without a day, and names `m2` instead; Arm Lab and Eye Lab use it", "eye promise: deprecates `motor` without a day, and names `m2` instead; Arm Lab and Eye Lab use it"],
        ),
    ],
)  # fmt: skip
def test_what_is_told_and_whom_it_breaks(
    compared: Compared, old: str, new: str, told_text: str | None, broken: list[str]
) -> None:
    assert old in ROBOT
    changes = compared(ROBOT, ROBOT.replace(old, new, 1)).changes
    assert told_text is None or [change.text for change in changes] == [told_text]
    assert [f"{each.partner} {each.category}: {each.reason}" for change in changes for each in change.breaks] == broken


def test_a_reader_that_goes_in_the_same_change_is_broken_all_the_same(compared: Compared) -> None:
    gone = ROBOT.replace("rate: 5 Hz", "rate: 4 Hz").replace(", heads: head.slow", "")
    reasons = [each.reason for change in compared(ROBOT, gone).changes for each in change.breaks]
    assert reasons == [
        "promises for `sensing.head.slow` a rate of 4 Hz instead of 5 Hz; `grasping.reach.heads` of Arm Lab reads it"
    ]
