"""Chains and findings of two versions."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.timing.chains import chain_bounds
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Compared
from tests.running import RAMCIP, ROOT

ROBOT = """\
groups:
  g:
    components:
      a: {outputs: {x: sensor_msgs/msg/Image}}
      b: {inputs: {x: a.x}}
nodes:
  na: {implements: a, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  nb: {implements: b, timing: {behaviour: event, wcet: 5 ms}, host: pc}
hosts: {pc: {cores: 1}}
chains: {see: {through: [a, b], deadline: 300 ms}}
"""
MS = 10**6


def bounds(compared: Compared, after: str, before: str = ROBOT) -> list[tuple[str, Fraction | None, Fraction | None]]:
    found = compared(before, after).chains
    return [(c.id, c.before.bound.value if c.before else None, c.after.bound.value if c.after else None) for c in found]


def test_a_bound_that_changed(compared: Compared) -> None:
    assert bounds(compared, ROBOT.replace("10 Hz", "20 Hz")) == [("see", 107 * MS, 57 * MS)]
    assert bounds(compared, ROBOT.replace("wcet: 5 ms", "wcet: 6 ms")) == [("see", 107 * MS, 108 * MS)]


def test_a_deadline_that_changed(compared: Compared) -> None:
    (change,) = compared(ROBOT, ROBOT.replace("300 ms", "100 ms")).chains
    assert change.deadline is not None
    assert change.deadline.value == 100 * MS
    assert [side and side.verdict for side in (change.before, change.after)] == ["met", "missed"]


def test_chains_that_came_went_or_were_renamed(compared: Compared) -> None:
    none = ROBOT.replace("chains: {see: {through: [a, b], deadline: 300 ms}}\n", "")
    assert bounds(compared, none) == [("see", 107 * MS, None)]
    assert bounds(compared, ROBOT, none) == [("see", None, 107 * MS)]
    assert bounds(compared, ROBOT.replace("see:", "look:")) == []
    assert bounds(compared, ROBOT.replace("see:", "look:").replace("10 Hz", "20 Hz")) == [("look", 107 * MS, 57 * MS)]


def test_text_changes_no_bound(compared: Compared) -> None:
    assert bounds(compared, ROBOT.replace("a: {outputs", "a: {title: A camera, tags: [x], outputs")) == []


@pytest.mark.parametrize(
    "project", [RAMCIP, ROOT / "examples" / "reference_system"], ids=["ramcip", "reference_system"]
)
def test_the_analysis_for_rules_bounds_chains_as_the_whole_one_does(project: Path) -> None:
    found = pipeline.check_project(project).architecture
    whole = chain_bounds.bound_all_chains(analyse_architecture(found), found)
    assert whole
    assert chain_bounds.bound_all_chains(analyse_architecture(found, judging=True), found) == whole


def said(compared: Compared, before: str, after: str) -> tuple[list[str], list[str]]:
    found = compared(before, after)
    return [f"{d.rule} {d.element}" for d in found.new_findings], [
        f"{d.rule} {d.element}" for d in found.cured_findings
    ]


def test_findings_that_appeared_and_were_cured(compared: Compared) -> None:
    unread = ROBOT.replace("{x: sensor_msgs/msg/Image}", "{x: sensor_msgs/msg/Image, y: sensor_msgs/msg/Image}")
    assert said(compared, ROBOT, unread) == (["unread-output g.a"], [])
    assert said(compared, unread, ROBOT) == ([], ["unread-output g.a"])


def test_a_finding_that_moved_or_follows_a_rename_is_the_same(compared: Compared) -> None:
    unread = ROBOT.replace("{x: sensor_msgs/msg/Image}", "{x: sensor_msgs/msg/Image, y: sensor_msgs/msg/Image}")
    assert said(compared, unread, "# one line more\n" + unread) == ([], [])
    renamed = (
        unread.replace("a: {outputs", "camera: {outputs")
        .replace("a.x", "camera.x")
        .replace("implements: a,", "implements: camera,")
    )
    assert said(compared, unread, renamed.replace("[a, b]", "[camera, b]")) == ([], [])


def test_a_finding_that_was_silenced_is_not_cured(compared: Compared) -> None:
    unread = ROBOT.replace("a: {outputs: {x: sensor_msgs/msg/Image}}", "a: {outputs: {x: sensor_msgs/msg/Image, y: T}}")
    for quiet in (
        unread.replace("y: T}}", "y: T}} # archgen: ignore[unread-output] later"),
        unread + "rules: {unread-output: off}\n",
    ):
        found = compared(unread, quiet)
        assert [d.rule for d in found.silenced_findings] == ["unread-output"]
        assert (found.new_findings, found.cured_findings) == ((), ())
        assert not found.is_empty
        back = compared(quiet, unread)
        assert [d.rule for d in back.new_findings] == ["unread-output"]
        assert (back.cured_findings, back.silenced_findings) == ((), ())


def test_a_finding_with_another_figure_is_the_same(compared: Compared) -> None:
    late = ROBOT.replace("300 ms", "50 ms")
    assert said(compared, ROBOT, late) == (["late-chain see"], [])
    assert said(compared, late, late.replace("wcet: 5 ms", "wcet: 6 ms")) == ([], [])


SLOW = """\
groups:
  g:
    components:
      a: {outputs: {x: sensor_msgs/msg/Image}}
      b: {inputs: {x: a.x}, outputs: {y: sensor_msgs/msg/Image}}
      c: {inputs: {y: b.y}}
nodes:
  na: {implements: a, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  nb: {implements: b, timing: {behaviour: event, wcet: 5 ms}, host: pc}
  nc: {implements: c, timing: {behaviour: event, wcet: 5 ms}, host: far}
hosts: {pc: {cores: 2}, far: {cores: 1}, idle: {cores: 1}}
chains: {see: {through: [a, c], deadline: 900 ms}}
"""


@pytest.mark.parametrize(
    ("old", "new", "causes"),
    [
        ("rate: 10 Hz", "rate: 5 Hz", ["g.a timing.rate"]),
        ("rate: 10 Hz", "rate: 20 Hz", ["g.a timing.rate"]),
        ("event, wcet: 5 ms}, host: pc", "event, wcet: 2 ms}, host: pc", ["g.b timing.wcet"]),
        ("chains: {see: {through: [a, c]", "chains: {see: {through: [a, b]", ["see through"]),
    ],
)
def test_a_chain_says_what_made_it_longer_or_shorter(compared: Compared, old: str, new: str, causes: list[str]) -> None:
    # The other change has nothing to do with it.
    after = SLOW.replace(old, new).replace("idle: {cores: 1}", "idle: {cores: 2}")
    (chain,) = compared(SLOW, after).chains
    assert [f"{change.element_id} {change.key}" for change in chain.causes] == causes


def test_a_chain_that_is_new_has_no_cause(compared: Compared) -> None:
    after = SLOW.replace("chains: {", "chains: {look: {through: [a, b]}, ").replace("10 Hz", "5 Hz")
    causes = {chain.id: len(chain.causes) for chain in compared(SLOW, after).chains}
    assert causes == {"look": 0, "see": 1}


RIVAL = """\
groups:
  g:
    components:
      a: {outputs: {x: sensor_msgs/msg/Image}}
      b: {inputs: {x: a.x}}
      clock: {outputs: {x: sensor_msgs/msg/Image}}
      rival: {inputs: {x: clock.x}}
nodes:
  na: {implements: a, timing: {rate: 10 Hz, wcet: 2 ms}, host: far}
  nb: {implements: b, timing: {behaviour: event, wcet: 8 ms}, host: pc}
  nclock: {implements: clock, timing: {rate: 100 Hz, wcet: 1 ms}, host: clocks}
  nrival: {implements: rival, timing: {behaviour: event, wcet: 4 ms}, host: pc}
hosts: {pc: {cores: 1}, far: {cores: 1}, clocks: {cores: 1}, idle: {cores: 1}}
links: {net: {connects: [pc, far, clocks], latency: 1 ms}}
chains: {see: {through: [a, b]}}
"""


@pytest.mark.parametrize(("rate", "bound"), [("10 Hz", 115), ("120 Hz", 123)])
def test_who_shares_the_core_and_is_fired_less_or_more_often_leads_to_the_cause(
    compared: Compared, rate: str, bound: int
) -> None:
    """100 + 2 + 1 ms, and `b` with what comes of `rival` meanwhile: 8 + 1, 2 or 3 times 4."""
    after = RIVAL.replace("100 Hz", rate).replace("idle: {cores: 1}", "idle: {cores: 2}")
    (chain,) = compared(RIVAL, after).chains
    assert chain.after is not None
    assert chain.after.bound.value == bound * MS
    assert [f"{change.element_id} {change.key}" for change in chain.causes] == ["g.clock timing.rate"]
