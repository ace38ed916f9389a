"""What is said of a chain beyond its bound: what is left, the run in which it is late, what would prove it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.emit.terminal import chain_remedies, timing_text
from archgen.frozen import replace
from archgen.timing.analysis import LateRun
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.search.proposals import Proposal, TriedConfiguration
from tests.timing.search.trials import bound_with
from tests.timing.sketches import read_sketch

MS = Fraction(10**6)


@pytest.mark.parametrize(
    ("deadline", "text"),
    [(", deadline: 110 ms", "9 ms left"), (", deadline: 100 ms", "1 ms above it"), ("", "")],
)
def test_what_is_left_of_a_deadline(deadline: str, text: str) -> None:
    nodes = {"a @p": "period: 96 ms, wcet: 2 ms", "b @p": "wcet: 3 ms"}
    model = read_sketch(nodes, "a>b", f"hosts: {{p: {{cores: 1}}}}\nchains: {{c: {{through: [a, b]{deadline}}}}}")
    assert timing_text.describe_slack(bound_with(model)["c"]) == text


def test_a_witness_is_told_with_the_command_that_repeats_it() -> None:
    result = bound_with(
        read_sketch({"a @p": "period: 96 ms"}, "", "hosts: {p: {cores: 1}}\nchains: {c: {through: [a]}}")
    )["c"]
    assert timing_text.describe_late_run(replace(result, late_run=LateRun(17, 60, 163 * MS))) == (
        "seen in `archgen simulate --chain c --seed 17 --seconds 60`: 163 ms"
    )
    assert not timing_text.describe_late_run(result)


def _propose(bounds: list[dict[str, int | None]], hopeless: dict[str, Fraction] | None = None) -> Proposal:
    """Return a proposal of configurations in which the chains `a` and `b` take so long, in ms; both may take 100 ms."""
    tried = []
    for number, each in enumerate(bounds):
        late = tuple(name for name, bound in each.items() if bound is None or bound > 100)
        figures = {name: None if bound is None else bound * MS for name, bound in each.items()}
        changes = tuple(TriedChange("n", "timing.priority", str(at)) for at in range(number))
        tried.append(TriedConfiguration(f"way {number}", changes, figures, late, Fraction(len(late))))
    return Proposal({"a": 100 * MS, "b": 100 * MS}, hopeless or {}, tuple(tried))


def test_a_chain_that_the_best_configuration_proves_is_told_with_its_bound() -> None:
    proposal = _propose([{"a": 120, "b": 90}, {"a": 80, "b": 95}])
    assert list(chain_remedies.list_remedy_rows(proposal)) == [
        ("way 1 (`archgen timing --propose`)",),
        ("a", "then at most 80 ms"),
    ]


def test_a_chain_that_nothing_proves_is_told_with_what_was_tried() -> None:
    assert list(chain_remedies.list_remedy_rows(_propose([{"a": 120, "b": 90}, {"a": 120, "b": 90}]))) == [
        ("a", "nothing of what was tried (1 configuration)")
    ]
    better = _propose([{"a": 150, "b": None}, {"a": 120, "b": 90}])
    assert [row[1] for row in list(chain_remedies.list_remedy_rows(better))[1:]] == [
        "then at most 120 ms, which is not enough",
        "then at most 90 ms",
    ]
    assert list(chain_remedies.list_remedy_rows(None)) == []


def test_a_floor_above_the_deadline_is_said_first() -> None:
    proposal = _propose([{"a": 120, "b": 90}], {"a": 110 * MS})
    assert chain_remedies.describe_remedy(proposal, "a") == (
        "with nobody in its way it takes 110 ms: nothing but other rates, triggers or execution times can prove it "
        "(`archgen timing --budget a`)"
    )


def test_all_that_was_tried_is_a_table_and_the_best_is_marked() -> None:
    proposal = _propose([{"a": 150, "b": None}, {"a": 120, "b": 90}])
    lines = [" ".join(line.split()) for line in chain_remedies.format_proposal(proposal)]
    assert lines[1:] == [
        "changes met a b above configuration",
        "0 0 of 2 150 ms no bound 200 % way 0",
        "-> 1 1 of 2 120 ms 90 ms ok 100 % way 1",
        "",
        "Proposed: way 1.",
        "Not proven then: a 120 ms, 20 ms above its deadline.",
        (
            "Priorities are those of processes under SCHED_FIFO: launch files, scripts, units and compose files of "
            "`archgen generate` start each with its own, which needs CAP_SYS_NICE, or `rtprio 99` in /etc/security/limits.d."
        ),
    ]
    worse = list(chain_remedies.format_proposal(_propose([{"a": 120, "b": 90}, {"a": 110, "b": 101}])))
    assert worse[-1] == "Nothing of what was tried is better than what is written."
    *_, nothing, missing = chain_remedies.format_proposal(_propose([{"a": None, "b": 120}, {"a": None, "b": 130}]))
    assert nothing == worse[-1]
    assert missing == (
        "No bound in any of them: a. `archgen timing` says which figures are missing, or what has more work than it can do."
    )


def test_where_none_is_late_what_lacks_figures_is_named() -> None:
    met = _propose([{"a": 90, "b": 80}])
    assert list(chain_remedies.format_proposal(met)) == ["Each chain with a deadline is met."]
    (line,) = chain_remedies.format_proposal(replace(met, unjudged=("c", "d")))
    assert line == (
        "Nothing can be proposed for c and d: figures are missing, which `archgen timing` names; the other 2 are met."
    )
