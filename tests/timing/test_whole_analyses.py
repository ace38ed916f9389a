"""Small systems with all that follows from them, and with the reasons: the figures of every room of timing.

A case is a project and, below `---`, what `timing` computes and `--why` says of it; `--update-golden` writes that (read
it). Whatever is an equation there is computed again.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.chain_verdicts import find_read_ages
from archgen.timing.chains.element_index import MeasuredBasis
from archgen.timing.chains.fused_inputs import find_fused_inputs
from archgen.timing.figures.figure_wording import format_duration
from archgen.timing.run_analysis import analyse_architecture
from tests.property_sizes import try_some
from tests.timing.hand_reader import read_equations
from tests.timing.printed import show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import (
    explain,
    list_chains,
    list_edges,
    list_hosts,
    list_links,
    list_outputs,
    list_paces,
    list_reasons,
    list_responses,
    list_services,
    list_topics,
)

CASES = sorted((Path(__file__).parent / "cases").glob("*.txt"))


@pytest.mark.parametrize("case", try_some(CASES, 20), ids=lambda case: case.stem)
def test_all_that_follows_from_a_system(case: Path, request: pytest.FixtureRequest) -> None:
    text = case.read_text(encoding="utf-8").partition("---\n")[0]
    lines = list(list_everything(architecture(text)))
    if request.config.getoption("--update-golden"):
        case.write_text(f"{text}---\n" + "".join(f"{line}\n" for line in lines), encoding="utf-8")
    assert lines == case.read_text(encoding="utf-8").partition("---\n")[2].splitlines()
    # The reader with a calculator does not know where the name of a callback that stores an input ends.
    readable = [line for line in lines if " stores " not in line]
    assert [line for line in readable for each in read_equations(line) if not each.holds] == []


def list_everything(model: Architecture) -> Iterator[str]:
    """Yield all figures of an architecture, then the reasons of each word."""
    analysis = analyse_architecture(model)
    chains = bound_all_chains(analysis, model)
    for heading, lines in (
        ("works", list_paces(analysis)),
        ("because", list_reasons(analysis)),
        ("sends", list_outputs(analysis)),
        ("takes", list_responses(analysis)),
        ("stores", [f"{name} waits {show_ms(wait)}" for name, wait in analysis.storing_waits.items()]),
        ("hosts", list_hosts(analysis)),
        ("links", list_links(analysis)),
        ("topics", list_topics(analysis)),
        ("edges", list_edges(analysis)),
        ("services", list_services(analysis)),
        ("ages", list(_list_ages(analysis))),
        ("chains", list_chains(analysis, model)),
        ("advice", list(_list_advice(analysis, chains))),
    ):
        yield from (f"{heading}: {line}" for line in lines)
    words = (*chains, *analysis.hosts, *analysis.links, *analysis.topics, *analysis.system.activities)
    for word in dict.fromkeys(words):
        yield f"--why {word}"
        yield from (f"  {line.rpartition(' @')[0]}" for line in explain(analysis, model, word))


def _list_ages(analysis: Analysis) -> Iterator[str]:
    for read in find_read_ages(analysis):
        yield f"{read.arc.input} is {show_ms(read.age)} old at most: {read.state}"
    for fused in find_fused_inputs(analysis):
        ages = ", ".join(f"{key} {show_ms(age)}" for key, age in fused.ages.items())
        yield f"{fused.activity} every {show_ms(fused.gap)}, apart {show_ms(fused.apart)}: {ages}"


def _list_advice(analysis: Analysis, chains: Mapping[str, ChainResult]) -> Iterator[str]:
    for result in chains.values():
        if basis := MeasuredBasis(analysis).describe([term.activity for term in result.terms]):
            yield f"{result.id}: {basis}"
        if result.spread is not None:
            yield f"{result.id}: its end may jitter by {format_duration(result.spread)}"
        yield from (f"{result.id}: {sentence}" for sentence in advise_on_chain(analysis, result) or () if sentence)
