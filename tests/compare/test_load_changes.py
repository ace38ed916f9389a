"""Loads that changed so much that people should see it, and who is on them."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace
from typing import Any

import pytest

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.asked_limits import TimingPair
from archgen.compare.compare_versions import find_link_users, find_load_changes
from archgen.compare.comparison import LoadChange
from archgen.compare.matched_ids import MatchedIds
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from tests.compare.conftest import Checked

ROBOT = """\
partners: {p: P, q: Q}
groups: {g: {owner: p, components: {a: {outputs: {x: T}}, b: {owner: q, inputs: {x: a.x}}}}}
types: {T: {message: std_msgs/msg/Int8, size: 1 kB}}
nodes: {na: {implements: a, timing: {rate: 10 Hz, wcet: 1 ms}, host: pc}, nb: {implements: b, timing: {wcet: 1 ms}, host: arm}}
hosts: {pc: {cores: 1}, arm: {}}
links: {lan: {connects: [pc, arm], bandwidth: 1 Mbit/s}}
"""
EMPTY: Any = SimpleNamespace(components={})


def percent(text: str) -> TimingValue:
    """Return a share in per cent; `?` is unknown."""
    return TimingValue(None if text == "?" else Fraction(text) / 100)


def read_pair(hosts: tuple[str, str], links: tuple[str, str] = ("", "")) -> TimingPair:
    """Return analyses with nothing but loads: `pc=50 arm=?`, in per cent before and after."""
    return TimingPair(*(_read_analysis(*texts) for texts in zip(hosts, links, strict=True)))


def _read_analysis(hosts: str, links: str) -> Any:  # noqa: ANN401
    system = SimpleNamespace(activities={}, arcs=())
    host_loads = {
        name: SimpleNamespace(share_of_cores=None if text == "-" else percent(text)) for name, text in _words(hosts)
    }
    return SimpleNamespace(
        hosts=host_loads,
        links={name: SimpleNamespace(share=percent(text)) for name, text in _words(links)},
        system=system,
    )


def _words(text: str) -> list[list[str]]:
    return [word.split("=") for word in text.split()]


@pytest.mark.parametrize(
    ("hosts", "expected"),
    [
        # Five in a hundred, or one where it is high before or after.
        (("pc=10", "pc=15"), "pc"),
        (("pc=10", "pc=14"), ""),
        (("pc=15", "pc=10"), "pc"),
        (("pc=79", "pc=80"), "pc"),
        (("pc=80", "pc=79"), "pc"),
        (("pc=78", "pc=79"), ""),
        (("pc=80", "pc=80"), ""),
        (("pc=80", "pc=809/10"), ""),
        # What was not there had nothing on it; of what nobody knew nobody knows what became of it.
        (("", "pc=5"), "pc"),
        (("", "pc=4"), ""),
        (("pc=?", "pc=50"), ""),
        (("pc=50", "pc=?"), ""),
        (("pc=50", ""), ""),
        (("pc=-", "pc=50"), "pc"),
        (("pc=50", "pc=-"), ""),
        (("pc=10 arm=10", "arm=20 pc=20"), "arm pc"),
    ],
)
def test_which_steps_are_noticeable(hosts: tuple[str, str], expected: str) -> None:
    changes = find_load_changes(EMPTY, MatchedIds(), read_pair(hosts))
    assert " ".join(change.id for change in changes) == expected
    assert all(change.kind == "host" for change in changes)


def test_links_come_behind_the_hosts() -> None:
    changes = find_load_changes(EMPTY, MatchedIds(), read_pair(("pc=10", "pc=20"), ("lan=10 can=10", "lan=20 can=11")))
    assert [(change.kind, change.id) for change in changes] == [("host", "pc"), ("link", "lan")]


def test_a_renamed_host_is_compared_with_what_it_was() -> None:
    matched = MatchedIds()
    matched.add_pair("host", "old", "new")
    assert find_load_changes(EMPTY, matched, read_pair(("old=10", "new=12"))) == ()


def test_without_two_analyses_nothing_is_compared() -> None:
    one = read_pair(("", "pc=50"))
    assert find_load_changes(EMPTY, MatchedIds(), None) == ()
    assert find_load_changes(EMPTY, MatchedIds(), TimingPair(one.after, one.after)) == ()


@pytest.mark.parametrize(
    ("before", "after", "concerned"), [("10", "20", "p q"), ("20", "10", ""), ("20", "20", ""), (None, "5", "p q"), (None, "0", ""), ("5", "?", ""), ("0", "1", "p q")]
)  # fmt: skip
def test_a_load_concerns_its_users_where_it_grew(before: str | None, after: str, concerned: str) -> None:
    change = LoadChange("host", "pc", None if before is None else percent(before), percent(after), frozenset("pq"))
    assert " ".join(sorted(change.concerned_partners)) == concerned


def test_the_users_of_a_link_are_those_at_both_ends_in_either_version(checked: Checked) -> None:
    first = _version(checked(ROBOT))
    second = _version(checked(ROBOT.replace("owner: q, ", "")))
    bare = ArchitectureVersion(first.architecture)
    assert find_link_users(first, first, MatchedIds()) == {"lan": {"p", "q"}}
    assert find_link_users(second, second, MatchedIds()) == {"lan": {"p"}}
    assert find_link_users(first, second, MatchedIds()) == {"lan": {"p", "q"}}
    assert find_link_users(second, first, MatchedIds()) == {"lan": {"p", "q"}}
    assert find_link_users(first, bare, MatchedIds()) is None
    assert find_link_users(bare, first, MatchedIds()) is None


def test_the_users_of_a_host_own_what_runs_there(checked: Checked) -> None:
    before, after = (
        analyse_architecture(checked(text)) for text in (ROBOT, ROBOT.replace("wcet: 1 ms", "wcet: 50 ms"))
    )
    changes = find_load_changes(checked(ROBOT), MatchedIds(), TimingPair(before, after))
    assert [(change.id, sorted(change.users)) for change in changes] == [("arm", ["q"]), ("pc", ["p"])]


def _version(architecture: Any) -> ArchitectureVersion:  # noqa: ANN401
    return ArchitectureVersion(architecture, analysis=analyse_architecture(architecture))
