"""How figures of fair shares come about, line by line."""

from __future__ import annotations

from archgen.timing.chains.figure_explanations import explain_word
from archgen.timing.load.core_terms import FairTerms
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.random_systems import architecture
from tests.timing.sketches import sketch


def test_a_holder_of_terms_has_no_state_of_its_own() -> None:
    assert FairTerms.__slots__ == ("solver", "formulas")


def test_what_others_are_served_adds_up() -> None:
    nodes = {
        "a @h": "behaviour: periodic, period: 1 s, wcet: 2 ms",
        "b @h": "behaviour: periodic, period: 1 s, wcet: 300 ms",
        "c @h": "behaviour: periodic, period: 1 s, wcet: 4 ms",
    }
    text = sketch(nodes, "c>a", "hosts: {h: {cores: 1}}")
    lines = [each.text for each in explain_word(analyse_architecture(architecture(text, is_fair=True)), {}, "a")]
    assert "F = 22 ms b + 4 ms c = 26 ms" in lines
    assert "2 ms + 26 ms = 28 ms, A + F" in lines
    assert "no other thread is served more than 2 ms + 20 ms = 22 ms, A and a lead; more to do have b (300 ms)" in lines
