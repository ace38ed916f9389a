"""What is said of a chain beyond its bound: what is left, the run in which it is late, what would prove it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.emit.terminal import chain_gaps
from archgen.simulation.seeded_runs import LateRun
from archgen.timing.chains.chain_advice import ChainAdvice
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.search.change_trials import TriedChange
from archgen.timing.search.proving_changes import ChainRemedy
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
    assert chain_gaps.describe_slack(bound_with(model)["c"]) == text


def test_a_witness_is_told_with_the_command_that_repeats_it() -> None:
    assert chain_gaps.describe_witness("c", LateRun(17, 60, 163 * MS)) == (
        "seen in `archgen simulate --seed 17 --chain c --seconds 60`: 163 ms"
    )
    assert chain_gaps.describe_witness("c", None) == ""


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ((TriedChange("a", "timing.core", "3"),), ("--set a.timing.core=3", "then at most 40 ms")),
        (
            (TriedChange("box", "threads", "2"), TriedChange("x y", "callback_groups.g", "c")),
            ("--set box.threads=2 --set 'x y.callback_groups.g=c'", "then at most 40 ms"),
        ),
        (
            (),
            ("nothing of what was tried: priority of a, b, c, d and 1 more; callback group of n; more could be tried",),
        ),
    ],
)
def test_what_would_prove_a_chain(changes: tuple[TriedChange, ...], text: tuple[str, ...]) -> None:
    tried = (("priority", ("a", "b", "c", "d", "e")), ("callback_groups", ("n",)), ("reentrant", ("n",)))
    remedy = ChainRemedy("c", changes, TimingValue(40 * MS), tried, is_cut=True)
    assert chain_gaps.describe_chain_remedy(remedy) == text


@pytest.mark.parametrize(
    ("changes", "first_step"),
    [
        (
            (TriedChange("a", "timing.core", "3"),),
            "This would prove it, found by trying: --set a.timing.core=3 (then at most 40 ms).",
        ),
        ((), "Give it up."),
    ],
)
def test_the_change_that_proves_a_chain_is_the_one_thing_to_do(
    changes: tuple[TriedChange, ...], first_step: str
) -> None:
    advice = ChainAdvice("It may take long.", "The largest part: all.", "Give it up.")
    remedy = ChainRemedy("c", changes, TimingValue(40 * MS), (), is_cut=False)
    assert chain_gaps.replace_advice(advice, remedy) == advice._replace(first_step=first_step)
    assert chain_gaps.replace_advice(advice, None) == advice
