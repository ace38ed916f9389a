"""What `--why` says of work that several cores share."""

from __future__ import annotations

from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.load.response_terms import ResponseTerms
from archgen.timing.run_analysis import analyse_system
from tests.timing.random_uses import random_use_system
from tests.timing.sketches import analyse_sketch

_REST = "hosts: {pc: {cores: 2}, far: {cores: 1}}\nlinks: {lan: {connects: [pc, far], latency: 1 ms}}"


def test_what_holds_up_storing_ends_with_an_activation_that_comes_too_soon() -> None:
    """`b` may come 2 ms after the job before it, which takes 8: four jobs follow one another without a gap."""
    nodes = {
        "a @far": "period: 30 ms, wcet: 1 ms",
        "b @pc": "period: 10 ms, wcet: 8 ms, jitter: 8 ms, priority: 5",
        "c @pc": "period: 20 ms, wcet: 6 ms",
        "d @pc": "period: 20 ms, wcet: 4 ms",
    }
    lines = [line.text for line in explain_word(analyse_sketch(nodes, "a>b", _REST), {}, "b")]
    assert lines[-6:] == [
        "b: what it only reads may wait 32 ms to be stored, and is missed by an activation until then",
        (
            "the longest t with A + B >= t, until an activation that comes too soon, is 32 ms: A is the work of its own "
            "threads, B the time in which all 2 cores may be busy with others"
        ),
        "4 x 8 ms b = 32 ms, since floor((32 ms + 8 ms) / 10 ms) = 4, its own jobs before the one that comes too soon",
        "A = 32 ms",
        "B = 0 ms: no other thread has work, which cannot keep 2 cores busy all at once",
        "32 ms + 0 ms = 32 ms, A + B until then",
    ]


def test_what_works_only_at_the_start_says_so() -> None:
    """In a thread of two, and beside two threads of their own: 9 ms, and (1 + 1) / 2 ms of others."""
    nodes = {
        "o +box": "behaviour: once, wcet: 5 ms",
        "a +box": "period: 20 ms, wcet: 4 ms",
        "b @pc": "period: 20 ms, wcet: 6 ms",
        "c @pc": "behaviour: event, wcet: 1 ms",
    }
    rest = "hosts: {pc: {cores: 2}}\ncontainers: {box: {threads: 1, host: pc}}"
    lines = [line.text for line in explain_word(analyse_sketch(nodes, "b>c", rest), {}, "o")]
    assert lines[-5:] == [
        "1 x 5 ms o = 5 ms, at the start",
        "A = 4 ms + 5 ms = 9 ms",
        "1 x (6 ms b + 1 ms c) = 7 ms, since ceil(10 ms / 20 ms) = 1, events of b",
        "B = (1 ms b + 1 ms c) / 2 = 1 ms, what each of 2 other threads has to do, but none for longer than B: b (6 ms)",
        "9 ms + 1 ms = 10 ms, A + B",
    ]


def test_no_wait_to_be_stored_is_left_of_cores_that_were_given_up() -> None:
    """The last sweep had one for `a1`, which is below the truth."""
    analysis = analyse_system(random_use_system(56))
    assert analysis.state is not None
    assert "a1" in analysis.diverged
    assert analysis.state.storing_waits["a1"].value is None
    assert ResponseTerms(analysis.state).find_storing_wait("a1") is None
