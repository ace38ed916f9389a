"""What a word from the command line means, and what is said where it means nothing or several things."""

from __future__ import annotations

import pytest

from archgen.timing.chains.element_index import (
    UnknownNameError,
    ids_ending_in,
    resolve_activities,
    resolve_waypoint,
    unknown_name_text,
)
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture

MODEL = architecture("""
groups:
  g:
    components:
      eye: {outputs: {seen: std_msgs/msg/Empty, shared: std_msgs/msg/Empty}}
      ear: {outputs: {heard: std_msgs/msg/Empty, shared: std_msgs/msg/Empty}}
      mind: {inputs: {a: eye.seen, b: ear.heard}}
  h:
    components:
      ear: {outputs: {shared: std_msgs/msg/Empty}}
      lone: {outputs: {told: std_msgs/msg/Empty}}
nodes:
  head: {implements: [g.eye, g.ear]}
  brain: {implements: g.mind}
""")
SYSTEM = analyse_architecture(MODEL).system


@pytest.mark.parametrize(
    ("word", "kind", "id_"),
    [
        ("head", "node", "head"),
        ("head.eye", "node", "head.eye"),
        ("g.eye", "component", "g.eye"),
        ("g.eye.seen", "output", "g.eye.seen"),
        ("mind", "component", "g.mind"),
        ("eye.seen", "output", "g.eye.seen"),
        ("seen", "output", "g.eye.seen"),
    ],
)
def test_complete_ids_come_before_last_parts(word: str, kind: str, id_: str) -> None:
    point = resolve_waypoint(MODEL, SYSTEM, word)
    assert (point.kind, point.id) == (kind, id_)


@pytest.mark.parametrize(
    ("word", "text"),
    [
        ("shared", "`shared` may mean `g.eye.shared`, `g.ear.shared`, `h.ear.shared`"),
        ("hed", "nothing is called `hed`; did you mean `head`?"),
        ("seem", "nothing is called `seem`; did you mean `seen`?"),
        ("zzzzzz", "nothing is called `zzzzzz`; `archgen list` gives the names of all elements"),
    ],
)
def test_a_word_that_means_nothing_or_several_things(word: str, text: str) -> None:
    with pytest.raises(UnknownNameError) as error:
        resolve_waypoint(MODEL, SYSTEM, word)
    assert str(error.value) == text


@pytest.mark.parametrize(
    ("word", "ids"),
    [
        ("head.eye", ("head.eye",)),
        ("head", ("head.eye", "head.ear")),
        ("g.ear", ("head.ear",)),
        ("brain", ("brain",)),
        ("seen", ("head.eye",)),
    ],
)
def test_activities_of_a_word(word: str, ids: tuple[str, ...]) -> None:
    assert resolve_activities(MODEL, SYSTEM, word) == ids


def test_only_whole_parts_of_ids_count() -> None:
    assert ids_ending_in(["a.b", "b", "a.bb", "ab", "c.a.b"], "b") == ["a.b", "b", "c.a.b"]
    assert ids_ending_in(["c.a.b", "xa.b"], "a.b") == ["c.a.b"]
    assert unknown_name_text("x", []) == "nothing is called `x`; `archgen list` gives the names of all elements"


def test_no_more_than_six_meanings_are_listed() -> None:
    groups = "".join(
        f"  g{number}: {{components: {{eye: {{outputs: {{out: std_msgs/msg/Empty}}}}}}}}\n" for number in range(8)
    )
    model = architecture("groups:\n" + groups)
    with pytest.raises(UnknownNameError) as error:
        resolve_waypoint(model, analyse_architecture(model).system, "out")
    assert str(error.value) == (
        "`out` may mean `g0.eye.out`, `g1.eye.out`, `g2.eye.out`, `g3.eye.out`, `g4.eye.out`, `g5.eye.out` and 2 more"
    )
