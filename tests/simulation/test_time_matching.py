"""Matching by time: sets of stamps worked out by hand, from the documentation of message_filters."""

from __future__ import annotations

import pytest

from archgen.simulation import simulate_system
from archgen.simulation.time_matching import make_matcher
from tests.simulation.systems import arc, event, jobs, system, timed


def sets(text: str, within: int, depth: int = 10) -> list[list[int]]:
    """Give the sets that a matcher makes of stamps like `a0 b3 a10`, in their order of arrival."""
    names = sorted({word[0] for word in text.split()})
    matcher = make_matcher([depth] * len(names), within)
    found = [
        one
        for word in text.split()
        for one in matcher.add_sample(names.index(word[0]), (int(word[1:]), names.index(word[0]), 0))
    ]
    return [[stamp for stamp, _, _ in one] for one in found]


@pytest.mark.parametrize(
    ("stamps", "within", "expected"),
    [
        # The same times, each once; what has no partner is left behind.
        ("a0 b0 a10 a20 b20", 0, [[0, 0], [20, 20]]),
        # A set that is complete leaves older ones behind: b10 comes too late.
        ("a10 a20 b20 b10", 0, [[20, 20]]),
        ("a0 b1", 0, []),
        # The pivot is b4: nobody knows yet whether an `a` nearer to 4 comes. a10 is farther away than a0.
        ("a0 b4", 30, []),
        ("a0 b4 a10", 30, [[0, 4]]),
        # a5 is nearer to b4 than a0; and with b14 nobody can be nearer to a5.
        ("a0 b4 a5 b14", 30, [[5, 4]]),
        # At most 3 apart: a0 and b4 are no set, and a0 is left behind.
        ("a0 b4 a10 b11 a20 b21", 3, [[10, 11]]),
        # Sets do not share a message: b5 goes with a4, and a6 waits for another.
        ("a4 b5 a6 b15 a16", 30, [[4, 5], [16, 15]]),
    ],
)
def test_sets(stamps: str, within: int, expected: list[list[int]]) -> None:
    assert sets(stamps, within) == expected


def test_the_same_times_make_a_set_at_once() -> None:
    assert sets("a0 b0", 30) == [[0, 0]]


def test_a_set_does_not_depend_on_when_its_messages_arrive() -> None:
    stamps = "a0 b4 a10 b14 a20 b24 a30 b34"
    late = "a0 a10 b4 b14 a20 a30 b24 b34"
    assert sets(stamps, 30) == sets(late, 30) != []


def test_what_no_longer_fits_into_the_queue_is_lost() -> None:
    assert sets("a0 a10 a20 b1 b11 b21", 5, depth=10) == [[0, 1], [10, 11]]
    assert sets("a0 a10 a20 b1 b11 b21 a30 b31", 5, depth=2)[:1] != [[0, 1]]


def test_a_reader_works_on_what_is_of_one_time() -> None:
    # image 0, 20, 40 (2 ms of work), cloud 3, 23, 43 (1 ms): fused when it is sure, at the end of the next image.
    nodes = [timed("image", 20, 2), timed("cloud", 20, 1), event("fuse", 4, "image", "cloud", mode="match", within=15)]
    arcs = [arc("image", "fuse"), arc("cloud", "fuse")]
    found = jobs(system(nodes, arcs), 50)["fuse"]
    # All phases are zero: the stamps are equal, and a set is complete when the slower one is there.
    assert found == [(2, 2, 6), (22, 22, 26), (42, 42, 46)]


def test_how_old_and_how_far_apart_is_what_is_fused() -> None:
    # Both are activated together; the image takes 7, and the job begins at once.
    nodes = [
        timed("clock", 20, 0),
        event("image", 7, "clock"),
        event("cloud", 1, "clock"),
        event("fuse", 4, "image", "cloud", mode="match", within=0),
    ]
    arcs = [arc("clock", "image"), arc("clock", "cloud"), arc("image", "fuse"), arc("cloud", "fuse")]
    seen = simulate_system(system(nodes, arcs), 1, 4).activities["fuse"]
    assert (seen.fused_age, seen.fused_spread) == (7 * 10**6, 0)


def test_what_is_fused_is_never_farther_apart_than_is_written() -> None:
    nodes = [timed("image", 33, 7), timed("cloud", 50, 1), event("fuse", 4, "image", "cloud", mode="match", within=12)]
    arcs = [arc("image", "fuse"), arc("cloud", "fuse")]
    seen = simulate_system(system(nodes, arcs), 10, 6)
    fused = seen.activities["fuse"]
    assert fused.jobs > 300
    assert fused.fused_spread is not None
    assert 10 * 10**6 < fused.fused_spread <= 12 * 10**6
    assert seen.drops["fuse", "image", "/image"] > 0
