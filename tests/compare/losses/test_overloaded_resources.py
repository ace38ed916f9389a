"""Cores and links that are asked for more than they have: from exactly full on, and only what is new."""

from __future__ import annotations

import pytest

from tests.compare.conftest import Compared
from tests.compare.losses.test_losses import broken
from tests.compare.losses.test_missed_deadlines import BASE, both

THREE = """\
partners: {certh: CERTH, sssa: SSSA, tum: TUM}
groups:
  a: {owner: certh, components: {lamp: {outputs: {x: X}}}}
  b: {owner: sssa, components: {drum: {outputs: {y: Y}}}}
  c: {owner: tum, components: {horn: {outputs: {z: Z}}}}
nodes:
  na: {implements: lamp, timing: {rate: 10 Hz, wcet: 10 ms}, host: pc}
  nb: {implements: drum, timing: {rate: 10 Hz, wcet: 30 ms}, host: pc}
  nc: {implements: horn, timing: {rate: 10 Hz, wcet: 40 ms}, host: pc}
hosts: {pc: {cores: 1}, big: {cores: 2}}
"""
FULL = "overloads the host `pc` ({} % of its core), where `na` of CERTH and `nc` of TUM run"
WCET = "b.drum/timing.wcet"
TWO_CORES = THREE.replace("pc: {cores: 1}", "pc: {cores: 2}")
HOSTS = {
    "a core that is exactly full": (THREE, [("wcet: 30 ms", "wcet: 50 ms")], both(WCET, FULL.format(100), "certh", "tum")),
    "a core that is nearly full": (THREE, [("wcet: 30 ms", "wcet: 49.9 ms")], []),
    "a core that was exactly full before": (THREE.replace("30 ms", "50 ms"), [("wcet: 50 ms", "wcet: 60 ms")], []),
    "a core that was nearly full before": (
        THREE.replace("30 ms", "49.9 ms"),
        [("wcet: 49.9 ms", "wcet: 60 ms")],
        both(WCET, FULL.format(110), "certh", "tum"),
    ),
    "a host that has another name": (
        THREE,
        [("wcet: 30 ms", "wcet: 60 ms"), ("pc: {cores", "box: {cores"), ("host: pc", "host: box")],
        both(WCET, FULL.format(110).replace("`pc`", "`box`"), "certh", "tum"),
    ),
    "another share of the same size beside it": (
        THREE,
        [("wcet: 30 ms", "wcet: 60 ms"), ("rate: 10 Hz, wcet: 10 ms", "rate: 20 Hz, wcet: 5 ms")],
        both(WCET, FULL.format(110), "certh", "tum"),
    ),
    "a node that comes from another host": (
        THREE.replace("30 ms}, host: pc", "60 ms}, host: big"),
        [("host: big", "host: pc")],
        both("nb/host", FULL.format(110), "certh", "tum"),
    ),
    "a node that is new": (
        THREE,
        [
            ("{horn:", "{flute: {outputs: {u: U}}, horn:"),
            ("nodes:\n", "nodes:\n  nf: {implements: flute, timing: {rate: 10 Hz, wcet: 20 ms}, host: pc}\n"),
        ],
        both("c.flute", "overloads the host `pc` (100 % of its core), where `na` of CERTH and `nb` of SSSA run", "certh", "sssa"),
    ),
    "a core to which nodes are pinned": (
        TWO_CORES.replace("wcet: 30 ms", "core: 1, wcet: 30 ms").replace("wcet: 40 ms", "core: 1, wcet: 40 ms"),
        [("wcet: 30 ms", "wcet: 60 ms")],
        [f"{WCET} tum: overloads `pc core 1` (100 % of its core), where `nc` of TUM runs"],
    ),
    "a core that somebody takes for himself": (
        TWO_CORES.replace("wcet: 10 ms", "wcet: 70 ms"),
        [("wcet: 30 ms", "core: 1, wcet: 30 ms")],
        both("b.drum/timing.core", FULL.format(110), "certh", "tum"),
    ),
    "two cores": (
        TWO_CORES.replace("10 ms", "70 ms"),
        [("wcet: 30 ms", "wcet: 90 ms")],
        both(WCET, FULL.format(100).replace("its core", "its 2 cores"), "certh", "tum"),
    ),
    "one host beside another of which not all is known any more": (
        THREE.replace("wcet: 10 ms}, host: pc", "wcet: 10 ms, core: 0}, host: big")
        .replace("nodes:\n", "nodes:\n  nd: {implements: gong, timing: {rate: 10 Hz, wcet: 9 ms, core: 0}, host: big}\n")
        .replace("{horn:", "{gong: {outputs: {v: V}}, horn:"),
        [("wcet: 30 ms", "wcet: 60 ms"), ("wcet: 10 ms, core", "core")],
        [f"{WCET} tum: overloads the host `pc` (100 % of its core), where `nc` of TUM runs"],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("project", "edits", "said"), HOSTS.values(), ids=HOSTS.keys())
def test_cores(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said


# The tracker sends 10 kB to the planner, ten times a second: 80 % of the link.
LINKED = BASE[: BASE.index("chains:")].replace("10 Mbit/s", "1 Mbit/s").replace("wcet: 20 ms", "wcet: 1 ms")
MAP = (
    LINKED.replace("{tracks: Tracks}", "{tracks: Tracks, map: Map}")
    .replace("{tracks: tracker.tracks}", "{tracks: tracker.tracks, map: tracker.map}")
    .replace("types: {", "types: {Map: {message: x_msgs/msg/Map, size: 1 kB}, ")
)
ASKS = "asks the link `lan` for {} % of its bandwidth; `mind` of SSSA and `feet` of TUM use it"
LINKS = {
    "a link that is exactly full": (LINKED, [("1 Mbit/s", "800 kbit/s")], both("lan/bandwidth", ASKS.format(100), "sssa", "tum")),
    "a link that is nearly full": (LINKED, [("1 Mbit/s", "801 kbit/s")], []),
    "a link that was full before": (LINKED.replace("1 Mbit", "800 kbit"), [("800 kbit/s", "700 kbit/s")], []),
    "a link that was nearly full before": (
        LINKED.replace("1 Mbit", "801 kbit"),
        [("801 kbit/s", "400 kbit/s")],
        both("lan/bandwidth", ASKS.format(200), "sssa", "tum"),
    ),
    "a link that is new": (
        LINKED.replace("links: {lan:", "links: {other: {connects: [pc, base]}}\n# {lan:"),
        [("links: {other: {connects: [pc, base]}}\n# {lan:", "links: {lan:"), ("1 Mbit/s", "400 kbit/s")],
        [],
    ),
    "a rate of who feeds the sender": (
        LINKED,
        [("rate: 10 Hz", "rate: 20 Hz"), ("wcet: 5 ms", "wcet: 6 ms")],
        both("sensing.camera/timing.rate", ASKS.format(160), "sssa", "tum"),
    ),
    "a topic that somebody else reads where it is sent": (
        LINKED.replace("      camera: {", "      lamp: {inputs: {tracks: tracker.tracks}}\n      camera: {").replace(
            "nodes:\n", "nodes:\n  light: {implements: lamp, host: pc}\n"
        ),
        [("1 Mbit/s", "400 kbit/s")],
        both("lan/bandwidth", ASKS.format(200), "sssa", "tum"),
    ),
    "the size of one topic of two": (
        MAP,
        [("size: 1 kB", "size: 4 kB"), ("size: 10 kB", "size: 9.9 kB"), ("size: 1 MB", "size: 2 MB")],
        [
            *both("Map/size", ASKS.format("111.2"), "sssa", "tum"),
        ],
    ),
    "a topic that is new on the link": (
        LINKED,
        [("{tracks: tracker.tracks}", "{tracks: tracker.tracks, image: camera.image}"), ("cores: 1, scheduling: fixed_priority}, base", "cores: 2, scheduling: fixed_priority}, base")],
        ["moving.planner.image sssa: asks the link `lan` for 8080 % of its bandwidth; `mind` of SSSA uses it"],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("project", "edits", "said"), LINKS.values(), ids=LINKS.keys())
def test_links(compared: Compared, project: str, edits: list[tuple[str, str]], said: list[str]) -> None:
    assert broken(compared, project, edits) == said
