"""What a chain lacks is named as what it is: a figure that nobody wrote, a link that is missing, a search that failed."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.terminal.timing_text import format_timing
from archgen.pipeline import check_project
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.missing_figures import describe_gaps
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some

ROBOT = """\
hosts: {pc: {cores: 2, scheduling: round_robin}, auto: {cores: 1}, far: {}}
links: {cable: {connects: [pc, far], latency: 1 ms}}
groups:
  g:
    components:
      s: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 30 Hz, wcet: 1 ms}}
      e: {inputs: {i: s.o}, outputs: {o: std_msgs/msg/Empty}, timing: {wcet: 300 us}}
      f: {inputs: {i: e.o}, outputs: {o: std_msgs/msg/Empty}, timing: {wcet: 1 ms}}
      p: {outputs: {o: {type: std_msgs/msg/Empty, external: X}}, timing: {rate: 50 Hz, wcet: 1 ms}}
nodes: {s: {implements: s, host: pc}, e: {implements: e, host: auto}, f: {implements: f, host: pc}, p: {implements: p, host: pc}}
chains: {k: {through: [g.s, g.e, g.f], deadline: 200 ms}, after: {through: [g.e, g.f]}}
"""


def gaps_of(folder: Path, text: str, chain: str = "k") -> str:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    architecture = check_project(folder / "robot.yaml").architecture
    analysis = analyse_architecture(architecture)
    return describe_gaps(bound_all_chains(analysis, architecture)[chain], analysis)


@pytest.mark.parametrize(
    ("old", "new", "gaps"),
    [
        ("", "", "no link joins auto and pc"),
        ("wcet: 300 us", "rate: 10 Hz", "execution time of e unknown; no link joins auto and pc"),
        ("connects: [pc, far]", "connects: [pc, auto]", ""),
        ("connects: [pc, far], latency: 1 ms", "connects: [pc, auto]", "latency of cable unknown"),
    ],
)
def test_a_missing_link_is_no_missing_execution_time(tmp_path: Path, old: str, new: str, gaps: str) -> None:
    described_gaps = gaps_of(tmp_path, ROBOT.replace(old, new))
    assert described_gaps.partition("no bound: ")[2] == gaps


def test_a_chain_behind_a_missing_link_names_it(tmp_path: Path) -> None:
    text = ROBOT.replace("host: auto", "host: pc").replace(
        "s: {implements: s, host: pc}", "s: {implements: s, host: auto}"
    )
    assert gaps_of(tmp_path, text, "after").partition("no bound: ")[2] == "no link joins auto and pc"


# `e` and `f` may start a little late: so they are no part of a run, and each makes the next one wait without end.
HEAVY = """\
hosts: {pc: {cores: 1, scheduling: round_robin}}
groups:
  g:
    components:
      s: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 30 Hz, wcet: 8 ms}}
      e: {inputs: {i: s.o}, outputs: {o: std_msgs/msg/Empty}, timing: {wcet: 8 ms, jitter: 1 us}}
      f: {inputs: {i: e.o}, outputs: {o: std_msgs/msg/Empty}, timing: {wcet: 8 ms, jitter: 1 us}}
      p: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 50 Hz, wcet: 1 ms}}
      q: {outputs: {o: std_msgs/msg/Empty}, timing: {rate: 50 Hz, wcet: 1 ms}}
nodes: {s: {implements: s, host: pc}, e: {implements: e, host: pc}, f: {implements: f, host: pc}, p: {implements: p, host: pc}, q: {implements: q, host: pc}}
chains: {k: {through: [g.s, g.e, g.f], deadline: 200 ms}}
"""


@pytest.mark.parametrize(
    ("cores", "cost", "place"),
    try_some(
        [
            (1, "8 ms", "on pc at a load of 82 % (in any order)"),
            (2, "12 ms", "on pc at a load of 59 % (several cores in any order)"),
        ],
        1,
    ),
)
def test_a_search_that_found_nothing_says_where_and_misses_no_figure(
    tmp_path: Path, cores: int, cost: str, place: str
) -> None:
    gaps = gaps_of(tmp_path, HEAVY.replace("cores: 1", f"cores: {cores}").replace("8 ms", cost))
    assert gaps == f"(periods only) no bound found {place}"


@pytest.mark.parametrize(("cores", "cost"), try_some([(1, "8 ms"), (2, "12 ms")], 1))
def test_where_no_bound_was_found_is_said_on_one_core_and_on_several(tmp_path: Path, cores: int, cost: str) -> None:
    text = HEAVY.replace("cores: 1", f"cores: {cores}").replace("8 ms", cost)
    (tmp_path / "robot.yaml").write_text(text, encoding="utf-8")
    architecture = check_project(tmp_path / "robot.yaml").architecture
    lines = list(format_timing(analyse_architecture(architecture), {}, ()))
    assert lines[-1] == "no bound was found for s, e, f, p, q"


def test_a_search_that_found_nothing_names_the_host_where_that_begins(tmp_path: Path) -> None:
    """What reads on `far` has no bound either, but for no fault of its own: it works at a load of 3 %."""
    text = (
        HEAVY.replace("round_robin}}", "round_robin}, far: {cores: 1}}")
        .replace("f: {implements: f, host: pc}", "f: {implements: f, host: pc}, r: {implements: r, host: far}")
        .replace("      p: {", "      r: {inputs: {i: f.o}, timing: {wcet: 1 ms}}\n      p: {")
        .replace("through: [g.s, g.e, g.f]", "through: [g.f, g.r]")
    )
    text += "links: {cable: {connects: [pc, far], latency: 1 ms}}\n"
    assert gaps_of(tmp_path, text).endswith("no bound found on pc at a load of 82 % (in any order)")


def test_an_overloaded_host_is_named(tmp_path: Path) -> None:
    assert gaps_of(tmp_path, HEAVY.replace("8 ms", "12 ms")) == "pc is overloaded"


def test_several_cores_that_have_bounds_are_not_said_to_lack_them(tmp_path: Path) -> None:
    light = HEAVY.replace("cores: 1", "cores: 2").replace("8 ms", "1 ms")
    (tmp_path / "robot.yaml").write_text(light, encoding="utf-8")
    analysis = analyse_architecture(check_project(tmp_path / "robot.yaml").architecture)
    assert {response.tier for response in analysis.responses.values()} == {"cores"}
    assert analysis.diverged == ()
    assert "no bound" not in list(format_timing(analysis, {}, ()))[-1]
