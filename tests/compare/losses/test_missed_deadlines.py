"""Chains, hosts and links: which change makes them worse, and whom that breaks."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.compare.losses.fallen_figures import _bound_has_grown as bound_has_grown
from archgen.compare.losses.fallen_figures import _format_bound as format_bound
from archgen.timing.figures.timing_values import TimingValue
from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import broken
from tests.property_sizes import try_some

BASE = """\
partners: {certh: CERTH, sssa: SSSA, tum: TUM}
groups:
  sensing:
    owner: certh
    components:
      camera: {outputs: {image: Colour image}}
  tracking:
    owner: sssa
    components:
      tracker: {inputs: {image: camera.image}, outputs: {tracks: Tracks}}
  moving:
    owner: tum
    components:
      planner: {inputs: {tracks: tracker.tracks}}
types: {Colour image: {size: 1 MB}, Tracks: {message: x_msgs/msg/Tracks, size: 10 kB}}
nodes:
  eye: {implements: camera, timing: {rate: 10 Hz, wcet: 2 ms}, host: pc}
  mind: {implements: tracker, timing: {behaviour: event, wcet: 20 ms}, host: pc}
  feet: {implements: planner, timing: {behaviour: event, wcet: 5 ms}, host: base}
hosts: {pc: {cores: 1, scheduling: fixed_priority}, base: {cores: 1, scheduling: fixed_priority}}
links: {lan: {connects: [pc, base], bandwidth: 10 Mbit/s, latency: {best: 1 ms, worst: 2 ms}}}
chains: {react: {through: [camera, tracker, planner], deadline: 250 ms}}
"""
CHAINS = BASE[BASE.index("chains:") :]
# It may start a little late: so it is part of no run, and its response and that of what fires it make each other longer.
LATE_START = ("behaviour: event, wcet: 20 ms", "behaviour: event, jitter: 1 us, wcet: 20 ms")
# Three cores, which three fans share with the others.
CROWDED = (
    BASE.replace("pc: {cores: 1, scheduling: fixed_priority}", "pc: {cores: 3, scheduling: fixed_priority}")
    .replace("rate: 10 Hz, wcet: 2 ms", "rate: 5 Hz, wcet: 10 ms")
    .replace(
        "      tracker: {",
        "      one: {outputs: {x: X}}\n      two: {outputs: {y: Y}}\n      three: {outputs: {z: Z}}\n      tracker: {",
    )
    .replace(
        "nodes:\n",
        "nodes:\n  fan: {implements: one, timing: {rate: 10 Hz, wcet: 1 ms}, host: pc}\n"
        "  gan: {implements: two, timing: {rate: 10 Hz, wcet: 0.1 ms}, host: pc}\n"
        "  van: {implements: three, timing: {rate: 10 Hz, wcet: 30 ms}, host: pc}\n",
    )
)
LATE = "takes away the proof that the chain `react` meets its deadline of 250 ms"
SEEN = "makes the chain `react` miss its deadline of 250 ms"
RATE = ("rate: 10 Hz", "rate: 4 Hz")
ALL = "`eye` of CERTH, `mind` of SSSA and `feet` of TUM are on it"
EVERYBODY = ("certh", "sssa", "tum")
SHORT_CUT = BASE.replace(
    "inputs: {tracks: tracker.tracks}", "inputs: {tracks: tracker.tracks, image: camera.image}"
).replace("10 Mbit/s", "1 Gbit/s")


def both(element: str, why: str, *partners: str) -> list[str]:
    """Give one line for each partner."""
    return [f"{element} {partner}: {why}" for partner in partners]


TABLE = {
    "a rate that is too low": (
        BASE,
        [RATE],
        [
            *both(
                "sensing.camera/timing.rate",
                SEEN + " (129 ms → 279 ms); `mind` of SSSA and `feet` of TUM are on it",
                "sssa",
                "tum",
            ),
        ],
    ),
    "a rate that is still high enough": (BASE, [("rate: 10 Hz", "rate: 8 Hz")], []),
    "a rate that is higher": (BASE, [("rate: 10 Hz", "rate: 12 Hz")], []),
    "a rate without a deadline": (BASE.replace(", deadline: 250 ms", ""), [RATE], []),
    "a chain of one's own": (
        BASE.replace("owner: sssa", "owner: certh").replace("owner: tum", "owner: certh"),
        [RATE],
        [],
    ),
    "a better rate beside a longer execution": (
        BASE,
        [("rate: 10 Hz", "rate: 11 Hz"), ("wcet: 5 ms", "wcet: 145 ms")],
        both(
            "moving.planner/timing.wcet",
            "makes the chain `react` miss its deadline of 250 ms (129 ms → no bound); `eye` of CERTH and `mind` of SSSA are on it",
            "certh",
            "sssa",
        ),
    ),
    "a tighter deadline": (
        BASE,
        [("deadline: 250 ms", "deadline: 100 ms")],
        both(
            "react/deadline",
            "makes the chain `react` miss its deadline of 100 ms (it takes 129 ms); `eye` of CERTH, `mind` of SSSA and `feet` of TUM are on it",
            "certh",
            "sssa",
            "tum",
        ),
    ),
    "a longer deadline": (
        BASE,
        [("deadline: 250 ms", "deadline: 300 ms")],
        both("react/deadline", f"relaxes the deadline of the chain `react` from 250 ms to 300 ms; {ALL}", *EVERYBODY),
    ),
    "a share of the reactions that gets more time": (
        BASE.replace("deadline: 250 ms", "deadline: {always: 250 ms, 95 %: 150 ms}"),
        [("95 %: 150 ms", "95 %: 200 ms")],
        both(
            "react/deadline.95 %",
            f"relaxes the deadline of the chain `react` for 95 % of its reactions from 150 ms to 200 ms; {ALL}",
            *EVERYBODY,
        ),
    ),
    "a share of the reactions of which nothing is asked any more": (
        BASE.replace("deadline: 250 ms", "deadline: {95 %: 150 ms}"),
        [(", deadline: {95 %: 150 ms}", "")],
        both(
            "react/deadline.95 %",
            f"takes the deadline of 150 ms for 95 % of its reactions from the chain `react`; {ALL}",
            *EVERYBODY,
        ),
    ),
    "a share of the reactions of which more of them ask as much": (
        BASE.replace("deadline: 250 ms", "deadline: {always: 250 ms, 95 %: 150 ms}"),
        [("95 %: 150 ms", "99 %: 140 ms")],
        [],
    ),
    "a longer deadline of a chain of one's own": (
        BASE.replace("owner: sssa", "owner: certh").replace("owner: tum", "owner: certh"),
        [("deadline: 250 ms", "deadline: 300 ms")],
        [],
    ),
    "a longer deadline of a chain that nobody else owns a part of, but not all of it": (
        BASE.replace("owner: sssa", "owner: certh").replace("owner: tum", "title: Moving"),
        [("deadline: 250 ms", "deadline: 300 ms")],
        both(
            "react/deadline",
            "relaxes the deadline of the chain `react` from 250 ms to 300 ms; `eye` and `mind` of CERTH are on it",
            "certh",
        ),
    ),
    "a longer deadline that a lower rate needs": (
        BASE,
        [RATE, ("deadline: 250 ms", "deadline: 400 ms")],
        [
            *both(
                "sensing.camera/timing.rate",
                "takes away the proof that the chain `react` meets the deadline of 250 ms that it had before (129 ms → 279 ms); "
                "`mind` of SSSA and `feet` of TUM are on it",
                "sssa",
                "tum",
            ),
            *both(
                "react/deadline", f"relaxes the deadline of the chain `react` from 250 ms to 400 ms; {ALL}", *EVERYBODY
            ),
        ],
    ),
    "a longer deadline of a chain that names what is not there": (
        BASE.replace("tracker, planner]", "tracker, planner, nobody]"),
        [("deadline: 250 ms", "deadline: 300 ms")],
        both(
            "react/deadline",
            "relaxes the deadline of the chain `react` from 250 ms to 300 ms; `sensing.camera` of CERTH, "
            "`tracking.tracker` of SSSA and `moving.planner` of TUM are on it",
            *EVERYBODY,
        ),
    ),
    "a chain that leads past a part that is still there": (
        SHORT_CUT,
        [("[camera, tracker, planner]", "[camera, planner]"), ("inputs: {tracks: tracker.tracks, ", "inputs: {")],
        both("react/through", f"leads the chain `react` with its deadline past `mind`; {ALL}", *EVERYBODY),
    ),
    "a chain that ends sooner": (
        BASE,
        [("[camera, tracker, planner]", "[camera, tracker]")],
        both("react/through", f"leads the chain `react` with its deadline past `feet`; {ALL}", *EVERYBODY),
    ),
    "a chain that leads past a part that its own partner takes away": (
        SHORT_CUT,
        [
            ("[camera, tracker, planner]", "[camera, planner]"),
            ("inputs: {tracks: tracker.tracks, ", "inputs: {"),
            ("      tracker: {inputs: {image: camera.image}, outputs: {tracks: Tracks}}\n", "      lamp: Lamp\n"),
            ("  mind: {implements: tracker, timing: {behaviour: event, wcet: 20 ms}, host: pc}\n", ""),
        ],
        [
            "tracking.tracker tum: takes `tracking.tracker.tracks` from TUM (`moving.planner.tracks`); the same change takes the reader away"
        ],
    ),
    "a chain that was late already": (BASE.replace("250 ms", "100 ms"), [("wcet: 5 ms", "wcet: 6 ms")], []),
    "a chain that is less late": (BASE.replace("250 ms", "100 ms"), [("wcet: 5 ms", "wcet: 4 ms")], []),
    "a figure that is not known any more": (
        BASE,
        [("behaviour: event, wcet: 20 ms", "behaviour: event")],
        both(
            "tracking.tracker/timing.wcet",
            "leaves the chain `react`, which met its deadline of 250 ms with 129 ms, without a bound; "
            "`eye` of CERTH and `feet` of TUM are on it",
            "certh",
            "tum",
        ),
    ),
    "an input that was the way": (
        BASE,
        [("inputs: {image: camera.image}, ", "")],
        [
            "tracking.tracker.image tum: cuts the chain `react`, which met its deadline of 250 ms with 129 ms; `feet` of TUM is on it"
        ],
    ),
    "a step more on the way": (
        BASE,
        [
            (
                "outputs: {image: Colour image}}",
                "outputs: {image: Colour image}}\n      mend: {inputs: {image: camera.image}, outputs: {image: Colour image}}",
            ),
            ("{inputs: {image: camera.image}, outputs: {tracks", "{inputs: {image: mend.image}, outputs: {tracks"),
            (
                "nodes:\n",
                "nodes:\n  mender: {implements: mend, timing: {behaviour: event, jitter: 1 us, wcet: 50 ms}, host: pc}\n",
            ),
        ],
        both(
            "sensing.mend",
            "leaves the chain `react`, which met its deadline of 250 ms with 129 ms, without a bound; `mind` of SSSA and `feet` of TUM are on it",
            "sssa",
            "tum",
        ),
    ),
    "a step more on the way that is too much for its host": (
        BASE,
        [
            (
                "outputs: {image: Colour image}}",
                "outputs: {image: Colour image}}\n      mend: {inputs: {image: camera.image}, outputs: {image: Colour image}}",
            ),
            ("{inputs: {image: camera.image}, outputs: {tracks", "{inputs: {image: mend.image}, outputs: {tracks"),
            ("nodes:\n", "nodes:\n  mender: {implements: mend, timing: {behaviour: event, wcet: 90 ms}, host: pc}\n"),
        ],
        [
            *both(
                "sensing.mend",
                "makes the chain `react` miss its deadline of 250 ms (129 ms → no bound); `mind` of SSSA and `feet` of TUM are on it",
                "sssa",
                "tum",
            ),
            "sensing.mend sssa: overloads the host `pc` (112 % of its core), where `mind` of SSSA runs",
        ],
    ),
    "a chain that is removed": (
        BASE,
        [RATE, (CHAINS, "")],
        both("react", f"takes away the chain `react` with its deadline of 250 ms; {ALL}", *EVERYBODY),
    ),
    "a chain without a deadline that is removed": (
        BASE.replace(", deadline: 250 ms", ""),
        [("chains: {react: {through: [camera, tracker, planner]}}\n", "")],
        [],
    ),
    "a chain that is new": (BASE.replace(CHAINS, ""), [RATE, ("links:", CHAINS + "links:")], []),
    "a deadline that is dropped": (
        BASE,
        [RATE, (", deadline: 250 ms", "")],
        [
            *both(
                "sensing.camera/timing.rate",
                "takes away the proof that the chain `react` meets the deadline of 250 ms that it had before (129 ms → 279 ms); "
                "`mind` of SSSA and `feet` of TUM are on it",
                "sssa",
                "tum",
            ),
            *both("react/deadline", f"takes the deadline of 250 ms from the chain `react`; {ALL}", *EVERYBODY),
        ],
    ),
    "a deadline that is new": (
        BASE.replace(", deadline: 250 ms", ""),
        [RATE, ("planner]", "planner], deadline: 250 ms")],
        [],
    ),
    "a longer way": (
        BASE.replace("deadline: 250 ms", "deadline: 125 ms").replace("tracker, planner]", "tracker]"),
        [("tracker]", "tracker, planner]")],
        both(
            "react/through",
            "makes the chain `react` miss its deadline of 125 ms (122 ms → 129 ms); `eye` of CERTH, `mind` of SSSA and `feet` of TUM are on it",
            "certh",
            "sssa",
            "tum",
        ),
    ),
    "cores that others take for themselves": (
        CROWDED,
        [("wcet: 1 ms", "core: 1, wcet: 1 ms"), ("wcet: 0.1 ms", "core: 2, wcet: 0.1 ms")],
        [
            line
            for fan in ("one", "two")
            for line in both(
                f"tracking.{fan}/timing.core",
                f"{LATE} (~238 ms → 267 ms); `tracking.one` (core) of SSSA and `tracking.two` (core) of SSSA together: "
                "without either it holds; `eye` of CERTH and `feet` of TUM are on it",
                "certh",
                "tum",
            )
        ],
    ),
    "a host that shares its core": (
        BASE.replace("chains: {react: {through: [camera, tracker, planner], deadline: 250 ms}}\n", ""),
        [("wcet: 20 ms", "wcet: 120 ms")],
        ["tracking.tracker/timing.wcet certh: overloads the host `pc` (122 % of its core), where `eye` of CERTH runs"],
    ),
    "a host with a core less": (
        BASE[: BASE.index("chains:")]
        .replace("pc: {cores: 1, scheduling: fixed_priority}", "pc: {cores: 2, scheduling: fixed_priority}")
        .replace("wcet: 20 ms", "wcet: 99 ms"),
        [("pc: {cores: 2, scheduling: fixed_priority}", "pc: {cores: 1, scheduling: fixed_priority}")],
        both(
            "pc/cores",
            "overloads the host `pc` (101 % of its core), where `eye` of CERTH and `mind` of SSSA run",
            "certh",
            "sssa",
        ),
    ),
    "a rate that overloads who is fired by it": (
        BASE[: BASE.index("chains:")],
        [("rate: 10 Hz", "rate: 46 Hz")],
        ["sensing.camera/timing.rate sssa: overloads the host `pc` (101.2 % of its core), where `mind` of SSSA runs"],
    ),
    "a host that was overloaded before": (
        BASE[: BASE.index("chains:")].replace("20 ms", "99 ms"),
        [("99 ms", "120 ms")],
        [],
    ),
    "what runs on another host": (BASE[: BASE.index("chains:")], [("wcet: 5 ms", "wcet: 120 ms")], []),
    "a link with less bandwidth": (
        BASE[: BASE.index("chains:")],
        [("10 Mbit/s", "500 kbit/s")],
        both(
            "lan/bandwidth",
            "asks the link `lan` for 160 % of its bandwidth; `mind` of SSSA and `feet` of TUM use it",
            "sssa",
            "tum",
        ),
    ),
    "larger messages": (
        BASE[: BASE.index("chains:")],
        [("size: 10 kB", "size: 130 kB")],
        [
            *both(
                "Tracks/size",
                "asks the link `lan` for 104 % of its bandwidth; `mind` of SSSA and `feet` of TUM use it",
                "sssa",
                "tum",
            ),
        ],
    ),
}


@pytest.mark.parametrize(("project", "edits", "said"), try_some(TABLE.values(), 19), ids=TABLE.keys())
def test_late_and_full(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said


def bound(text: str) -> TimingValue:
    """Read `5` (a bound), `5+` (at least that much) and `?` (nothing known)."""
    number = text.removesuffix("+")
    return TimingValue(None if number == "?" else Fraction(number), complete=not text.endswith("+"))


@pytest.mark.parametrize(
    ("before", "after", "grown"),
    [
        ("5", "6", True),
        ("5", "5", False),
        ("5", "4", False),
        ("5", "5+", True),
        ("5+", "5+", False),
        ("5+", "5", False),
        ("5+", "6+", True),
        ("?", "5", True),
        ("5", "?", True),
        ("?", "?", False),
    ],
)
def test_which_terms_of_a_bound_have_grown(before: str, after: str, grown: bool) -> None:  # noqa: FBT001
    assert bound_has_grown(bound(before), bound(after)) is grown


def test_bounds_in_sentences() -> None:
    milliseconds = TimingValue(Fraction(5 * 10**6))
    assert [format_bound(each) for each in (milliseconds, replace(milliseconds, complete=False), bound("?"), None)] == [
        "5 ms",
        "at least 5 ms",
        "no bound",
        "no bound",
    ]


# With a priority `eye` waits for nobody: it is done after 2 ms, `mind` after 22 ms.
DIRECT = SHORT_CUT.replace(
    "[camera, tracker, planner], deadline: 250 ms", "[camera, planner], deadline: 120 ms"
).replace("wcet: 2 ms", "wcet: 2 ms, priority: 9")


def test_a_way_round_that_nobody_meant_is_no_chain(compared: Compared) -> None:
    edits = [("tracks: tracker.tracks, image: camera.image", "tracks: tracker.tracks")]
    said = broken(compared, DIRECT, edits)
    # `mind` is on the way round alone: its partner had no part in the chain.
    assert said == [
        "moving.planner.image certh: cuts the chain `react`: `eye` no longer reaches `feet` directly; `eye` of CERTH is on it"
    ]


def test_what_is_put_between_two_parts_makes_the_chain_later(compared: Compared) -> None:
    edits = [
        ("image: camera.image}}", "image: filter.image}}\n      filter: {inputs: {image: camera.image}, outputs: {image: Colour image}}"),
        ("hosts:", "  sieve: {implements: filter, timing: {behaviour: event, wcet: 90 ms}, host: base}\nhosts:"),
    ]  # fmt: skip
    assert "cuts" not in " ".join(broken(compared, DIRECT, edits))
