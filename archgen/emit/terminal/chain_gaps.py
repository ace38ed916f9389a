"""What is said of chains beside or beyond their bound: what is left, deadlines of shares, the run in which one is late."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.diagnostics import make_visible
from archgen.diagnostics.text_columns import TextRow
from archgen.simulation.drawn_orders import describe_orders
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.figures import figure_wording


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


def describe_late_run(result: ChainResult) -> str:
    """Return how to see a chain late, empty where no run is known."""
    run = result.late_run
    if run is None:
        return ""
    orders_text = describe_orders(run.orders)
    longest_text = figure_wording.format_duration(run.longest)
    return make_visible(
        f"seen in `{run.write_command(result.id)}`: {longest_text}{f' ({orders_text})' if orders_text else ''}"
    )
