"""What is said of chains beyond their bounds: the run in which one is late, and what would prove it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from archgen.diagnostics.safe_text import make_visible
from archgen.diagnostics.text_columns import TextRow
from archgen.simulation.chain_evidence import ChainEvidence
from archgen.simulation.drawn_orders import describe_orders
from archgen.simulation.seeded_runs import LateRun
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_advice import ChainAdvice
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.figures import figure_wording
from archgen.timing.search.proving_changes import ChainRemedy

REMEDY_TITLE = "What would prove them, found by trying"
_MAX_NAMED = 4
_KIND_WORDS = {
    "wcet": "execution time",
    "period": "rate",
    "callback_groups": "callback group",
    "reentrant": "callback group",
}


def describe_slack(result: ChainResult) -> str:
    """Return how much of its deadline a chain's bound leaves, or by how much it is above it: `252.1 ms left`."""
    if result.slack is None:
        return ""
    text = figure_wording.format_duration(abs(result.slack))
    return f"{text} left" if result.slack >= 0 else f"{text} above it"


def list_share_rows(result: ChainResult) -> Iterator[TextRow]:
    """Yield the deadlines of shares of a chain's reactions, and what bounds say of them."""
    for each in result.shares:
        verdict = (
            VERDICT_WORDS[each.verdict] if each.verdict != "open" else "only `archgen simulate` and recordings judge it"
        )
        yield f"  {each.name} of reactions", "", f"deadline {figure_wording.format_duration(each.limit)}", verdict


def describe_witness(chain_id: str, witness: LateRun | None) -> str:
    """Return how to see a chain late, empty where no run is known."""
    if witness is None:
        return ""
    command = f"archgen simulate --seed {witness.seed} --chain {chain_id} --seconds {witness.seconds}"
    orders_text = describe_orders(witness.orders)
    longest_text = figure_wording.format_duration(witness.longest)
    return make_visible(f"seen in `{command}`: {longest_text}{f' ({orders_text})' if orders_text else ''}")


def list_remedy_rows(results: Mapping[str, ChainResult], evidence: ChainEvidence) -> Iterator[TextRow]:
    """Yield for each chain that is not met the change that would prove it, or what was tried."""
    yield from ((key, *describe_chain_remedy(remedy)) for key, remedy in evidence.remedies.items() if key in results)


def describe_chain_remedy(remedy: ChainRemedy) -> tuple[str, ...]:
    """Return the change that proves a chain as `--set` writes it, and the bound then; or what was tried."""
    if remedy.changes:
        options = " ".join(f"--set {quote_option(str(change))}" for change in remedy.changes)
        return make_visible(
            options
        ), f"then at most {figure_wording.format_duration(remedy.bound.value or Fraction(0))}"
    more_text = "; more could be tried" if remedy.is_cut else ""
    return (f"nothing of what was tried: {describe_tried(remedy)}{more_text}",)


def replace_advice(advice: ChainAdvice, remedy: ChainRemedy | None) -> ChainAdvice:
    """Return the sentences on a chain, with the change that proves it as what to do, where one was found."""
    if remedy is None or not remedy.changes:
        return advice
    change, bound = describe_chain_remedy(remedy)
    return advice._replace(first_step=f"This would prove it, found by trying: {change} ({bound}).")


def describe_tried(remedy: ChainRemedy) -> str:
    """Return what was tried to prove a chain: `priority of a, b; core of a`."""
    names_by_word: dict[str, dict[str, None]] = {}
    for kind, names in remedy.tried:
        names_by_word.setdefault(_KIND_WORDS.get(kind, kind), {}).update(dict.fromkeys(names))
    phrases = [
        f"{word} of {figure_wording.join_first_names(tuple(names), _MAX_NAMED)}"
        for word, names in names_by_word.items()
    ]
    return "; ".join(phrases) or "nothing there can be changed"


def quote_option(text: str) -> str:
    """Return an option's value as a shell takes it."""
    return text if all(letter.isalnum() or letter in "._-=,/:" for letter in text) else f"'{text}'"
