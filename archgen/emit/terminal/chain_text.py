"""One chain term by term, and the ways between two elements, for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.diagnostics.text_columns import TextRow, align_rows
from archgen.emit.terminal import chain_remedies
from archgen.emit.terminal.chain_gaps import describe_gaps
from archgen.emit.terminal.figure_text import format_figure, format_missing
from archgen.simulation.chain_evidence import NO_EVIDENCE, ChainEvidence
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_advice import advise_on_chain
from archgen.timing.chains.chain_bounds import BoundedPath
from archgen.timing.chains.chain_verdicts import VERDICT_WORDS
from archgen.timing.figures import figure_wording
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.figures.value_arithmetic import list_assumptions


def format_chain(  # noqa: PLR0913, PLR0917 - what is shown of one chain
    result: ChainResult,
    analysis: Analysis,
    age: TimingValue,
    published: tuple[Fraction, Fraction] | None = None,
    width: int | None = None,
    evidence: ChainEvidence = NO_EVIDENCE,
) -> Iterator[str]:
    """Yield a chain term by term, with the reason and the place of each; `age` is its largest data age."""
    yield f"{result.id}: {' > '.join(result.through)}"
    if result.terms:
        yield from align_rows(_term_rows(result.terms), width)
        yield ""
    rows: list[TextRow] = [
        (
            "largest reaction time = largest data age",
            format_figure(result.bound),
            describe_gaps(result, analysis) or "hold it against the deadline",
        )
    ]
    if age != result.bound:
        rows = [
            (
                "largest reaction time"
                if analysis.system.activities[result.through[0]].behaviour == "periodic"
                else "largest reaction time, from the event on",
                format_figure(result.bound),
                describe_gaps(result, analysis) or "hold it against the deadline",
            ),
            ("largest data age, until the next one replaces it", format_figure(age), format_missing(age)),
        ]
    rows += [
        (
            "reduced reaction time (from the first sample on)",
            format_figure(result.reduced_reaction),
            "hold it against a stopwatch, or a trace that begins with the sample",
        ),
        (
            "reduced data age (when the last element sends)",
            format_figure(result.reduced_age),
            "hold it against the age of the stamps in what the last element sends",
        ),
        ("best case", format_figure(result.best), "the shortest time that a trace may show"),
    ]
    if result.spread is not None:
        spread = figure_wording.format_duration(result.spread)
        rows.append(("best to worst", spread, "how much the end of the chain may jitter (actuation jitter)"))
    if published:
        rows.append(
            (
                "with priorities and implicit communication (Duerr): reaction",
                figure_wording.format_duration(published[0]),
                "",
            )
        )
        rows.append(("    reduced data age", figure_wording.format_duration(published[1]), ""))
    if result.deadline:
        verdict_text = ", ".join(filter(None, (VERDICT_WORDS[result.verdict], chain_remedies.describe_slack(result))))
        rows.append(("deadline", format_figure(result.deadline), verdict_text))
    rows += [(share.strip(), limit, verdict) for share, _, limit, verdict in chain_remedies.list_share_rows(result)]
    yield from align_rows(rows, width)
    if result.id in evidence.witnesses:
        yield f"  {chain_remedies.describe_witness(result.id, evidence.witnesses[result.id])}"
    advice, remedy = advise_on_chain(analysis, result), evidence.remedies.get(result.id)
    if advice is not None:
        yield ""
        yield from (f"  {sentence}" for sentence in chain_remedies.replace_advice(advice, remedy) if sentence)
    if remedy is not None and (advice is None or not remedy.changes):
        yield f"  what would prove it: {', '.join(chain_remedies.describe_chain_remedy(remedy))}"
    for assumption in list_assumptions(result.bound) if result.terms else ():
        yield f"  assumes: {assumption}"


def _term_rows(terms: Iterable[ChainTerm]) -> Iterator[TextRow]:
    yield "element", "link", "waits", "response", "why"
    for term in terms:
        place = f" ({term.at})" if term.at.file else ""
        link = format_figure(term.link) if term.link.value != 0 else "-"
        yield term.activity, link, format_figure(term.sampling), format_figure(term.response), f"{term.why}{place}"


def format_ways(
    source: str, target: str, count: int, worst: Iterable[BoundedPath], best: Iterable[BoundedPath]
) -> Iterator[str]:
    """Yield the ways between two elements."""
    yield f"{source} to {target}: {count} way{'s' if count != 1 else ''}"
    if not count:
        yield "  nothing that leaves the first reaches the second; ask the other way round?"
    for title, listed_ways in (("worst", worst), ("best case", best)):
        for number, way in enumerate(listed_ways, 1):
            yield f"  {title} {number}: {format_figure(way.bound)}   {' > '.join(way.through)}"
            if not way.bound.complete:
                yield f"      no bound: {format_missing(way.bound)}"
