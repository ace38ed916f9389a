"""Which change made a figure worse: the nearest one, and never one that has nothing to do with it."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from archgen.compare import Change
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.matched_ids import MatchedIds
from tests.compare.conftest import Compared
from tests.compare.elements import pair
from tests.compare.losses.test_losses import broken
from tests.compare.losses.test_missed_deadlines import BASE, LATE_START, both

# A radio on a computer of its own: it changes in every case below, and is never the cause.
ROBOT = (
    BASE.replace("components:\n      camera", "components:\n      radio: {outputs: {sound: Sound}}\n      camera")
    .replace("nodes:\n", "nodes:\n  ear: {implements: radio, timing: {rate: 1 Hz, wcet: 1 ms}, host: far}\n")
    .replace("hosts: {", "hosts: {far: , ")
)
RADIO = ("wcet: 1 ms}, host: far", "wcet: 3 ms}, host: far")
UNCHAINED = ROBOT[: ROBOT.index("chains:")]
FAN = (
    ROBOT.replace(*LATE_START)
    .replace(
        "nodes:\n", "nodes:\n  wind: {implements: fan, timing: {rate: 10 Hz, wcet: 1 ms, priority: 9}, host: pc}\n"
    )
    .replace("      tracker: {", "      fan: {outputs: {wind: Wind}}\n      tracker: {")
)
BOX = (
    ROBOT.replace("pc: {cores: 1, scheduling: fixed_priority}", "pc: {cores: 2, scheduling: fixed_priority}")
    .replace("wcet: 2 ms}, host: pc", "wcet: 30 ms}, container: box")
    .replace("behaviour: event, wcet: 20 ms}, host: pc", "behaviour: event, jitter: 1 us, wcet: 20 ms}, container: box")
    + "containers: {box: {host: pc, threads: 2}}\n"
)
FIRED = UNCHAINED.replace("{image: Colour image}", "{image: Colour image, extra: Colour image}").replace(
    "10 Hz", "30 Hz"
)
OTHER = ROBOT.replace("      tracker: {", "      other: {outputs: {o: O}}\n      tracker: {")
SCREEN = ROBOT.replace("      camera: {", "      screen: {inputs: {picture: camera.image}}\n      camera: {")
RENAMED = [("image: Colour", "images: Colour"), ("picture: camera.image", "picture: camera.images")]
NODE_OWNED = ("owner: sssa", "title: T"), ("mind: {", "mind: {owner: sssa, ")

MET = "chain `react`, which met its deadline of 250 ms with"
ALL = "`eye` of CERTH, `mind` of SSSA and `feet` of TUM are on it"
SEEN = "makes the chain `react` miss its deadline of 250 ms"
LATE = "takes away the proof that the chain `react` meets its deadline of 250 ms"
CASES = {
    "who is fired by another host": (
        UNCHAINED.replace("wcet: 2 ms}, host: pc", "wcet: 2 ms}, host: base"),
        [("rate: 10 Hz", "rate: 60 Hz")],
        ["sensing.camera/timing.rate sssa: overloads the host `pc` (120 % of its core), where `mind` of SSSA runs"],
    ),
    "who shares the host": (
        FAN,
        [("wcet: 1 ms, priority", "wcet: 70 ms, priority")],
        both("tracking.fan/timing.wcet", f"leaves the {MET} ~154 ms, without a bound; `eye` of CERTH and `feet` of TUM are on it", "certh", "tum"),
    ),
    "the cores of the host": (
        ROBOT.replace("pc: {cores: 1, scheduling: fixed_priority}", "pc: {cores: 2, scheduling: fixed_priority}").replace(*LATE_START).replace("wcet: 20 ms", "wcet: 80 ms"),
        [("pc: {cores: 2, scheduling: fixed_priority}", "pc: {cores: 1, scheduling: fixed_priority}")],
        both("pc/cores", f"leaves the {MET} ~190 ms, without a bound; {ALL}", "certh", "sssa", "tum"),
    ),
    "the threads of the container": (
        BOX,
        [("threads: 2", "threads: 1")],
        both("box/threads", f"{LATE} (~158 ms → ~253 ms); {ALL}", "certh", "sssa", "tum"),
    ),
    "the link on the way": (
        ROBOT,
        [("worst: 2 ms", "worst: 200 ms")],
        both("lan/latency.worst", f"{SEEN} (129 ms → 337 ms); {ALL}", "certh", "sssa", "tum"),
    ),
    "a source more": (
        FIRED,
        [("image: camera.image", "image: [camera.image, camera.extra]")],
        ["tracking.tracker.image certh: overloads the host `pc` (126 % of its core), where `eye` of CERTH runs"],
    ),
    "an input more": (
        FIRED,
        [("image: camera.image", "image: camera.image, extra: camera.extra")],
        ["tracking.tracker.extra certh: overloads the host `pc` (126 % of its core), where `eye` of CERTH runs"],
    ),
    "a node that leaves its component": (
        OTHER,
        [("mind: {implements: tracker", "mind: {implements: other"), ("feet: {implements: planner", "feet: {package: p, implements: planner")],
        [
            "mind/implements tum: takes the topic `/tracking/tracker/tracks` from TUM (`feet`); nobody offers it under that name any more",
            *both("mind/implements", f"leaves the {MET} 129 ms, without a bound; `eye` of CERTH and `feet` of TUM are on it", "certh", "tum"),
        ],
    ),
    "a node that is removed": (
        ROBOT,
        [("  mind: {implements: tracker, timing: {behaviour: event, wcet: 20 ms}, host: pc}\n", "")],
        [
            "mind tum: takes the topic `/tracking/tracker/tracks` from TUM (`feet`); nobody offers it under that name any more",
            *both("mind", f"leaves the {MET} 129 ms, without a bound; `eye` of CERTH and `feet` of TUM are on it", "certh", "tum"),
        ],
    ),
    "an output that the reader does not follow": (
        SCREEN,
        RENAMED,
        [
            "sensing.camera.images sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); it is `/sensing/camera/images` now",
            "sensing.camera.images sssa: renames what SSSA reads: `sensing.camera.image` is `sensing.camera.images` now; `tracking.tracker.image` has to follow",
            *both("sensing.camera.images", f"cuts the {MET} 129 ms; `mind` of SSSA and `feet` of TUM are on it", "sssa", "tum"),
        ],
    ),
    "an output that is renamed while its reader turns away": (
        SCREEN,
        [*RENAMED, ("inputs: {image: camera.image}, ", "")],
        [
            "sensing.camera.images sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); it is `/sensing/camera/images` now",
            f"tracking.tracker.image tum: cuts the {MET} 129 ms; `feet` of TUM is on it",
        ],
    ),
    "a node of a partner for a component of nobody": (
        ROBOT.replace(*NODE_OWNED[0]).replace(*NODE_OWNED[1]),
        [("rate: 10 Hz", "rate: 4 Hz")],
        both("sensing.camera/timing.rate", f"{SEEN} (129 ms → 279 ms); `mind` of SSSA and `feet` of TUM are on it", "sssa", "tum"),
    ),
    "a node of a partner that is cut off, for a component of nobody": (
        SCREEN.replace(*NODE_OWNED[0]).replace(*NODE_OWNED[1]),
        RENAMED,
        [
            "sensing.camera.images sssa: takes the topic `/sensing/camera/image` from SSSA (`mind`); it is `/sensing/camera/images` now",
            *both("sensing.camera.images", f"cuts the {MET} 129 ms; `mind` of SSSA and `feet` of TUM are on it", "sssa", "tum"),
        ],
    ),
    "a step that is added on the way": (
        ROBOT,
        [
            ("camera: {outputs: {image: Colour image}}", "camera: {outputs: {image: Colour image}}\n      mend: {inputs: {image: camera.image}, outputs: {image: Colour image}}"),
            ("{image: camera.image}, outputs: {tracks", "{image: mend.image}, outputs: {tracks"),
            ("nodes:\n", "nodes:\n  mender: {implements: mend, timing: {behaviour: event, wcet: 50 ms}, host: far}\n"),
        ],
        both("sensing.mend", f"leaves the {MET} 129 ms, without a bound; `mind` of SSSA and `feet` of TUM are on it", "sssa", "tum"),
    ),
}  # fmt: skip


@pytest.mark.parametrize(("project", "edits", "said"), CASES.values(), ids=CASES.keys())
def test_the_nearest_change_is_the_cause(
    compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]
) -> None:
    assert broken(compared, project, [*edits, RADIO]) == said


def test_without_a_cut_the_first_change_on_the_way_is_the_cause() -> None:
    nodes = {name: SimpleNamespace(written=True) for name in ("eye", "mind")}
    activities = {name: SimpleNamespace(node=name, component=f"g.{name}", inputs=()) for name in nodes}
    changes = [
        Change("changed", "node", "mind", key="host"),
        Change("changed", "component", "g.eye", key="timing.rate"),
    ]
    before, after = cast("Any", SimpleNamespace(nodes=nodes)), cast("Any", None)
    pair_of_systems = cast(
        "Any", SimpleNamespace(before=SimpleNamespace(system=SimpleNamespace(activities=activities)))
    )
    causes = TimingCauses(ChangeContext(before, after, MatchedIds(), pair({}, {}), changes), pair_of_systems)
    assert causes.find_cuts(["eye", "mind"]) == ([1], ["eye", "mind"])
    assert causes.find_cuts(["mind", "eye"]) == ([0], ["mind", "eye"])
    cut = [*changes, Change("removed", "node", "mind")]
    causes = TimingCauses(ChangeContext(before, after, MatchedIds(), pair({}, {}), cut), pair_of_systems)
    assert causes.find_cuts(["eye", "mind"]) == ([2], ["mind"])
