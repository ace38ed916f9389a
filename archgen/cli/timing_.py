"""`archgen timing`: rates, latency, load; why, what if, what decides."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from archgen.cli import options, run
from archgen.frozen import dataclass

if TYPE_CHECKING:
    from archgen.diagnostic import Diagnostic
    from archgen.model.architecture import Architecture
    from archgen.pipeline import Checked
    from archgen.timing.analysis import Analysis, ChainResult


@dataclass(frozen=True, slots=True)
class Asked:
    """What one call asks for."""

    checked: Checked
    architecture: Architecture
    """The architecture with the figures of `--set`."""
    as_json: bool
    written: tuple[str, ...] = ()


@click.command("timing")
@options.project
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
@click.option("--chain", metavar="ID", help="Show a chain term by term.")
@click.option(
    "--why", metavar="ID", help="Show the reasoning behind the figures of an element, topic, chain, host, link."
)
@click.option("--from", "source", metavar="ID", help="With --to: the worst and the best ways between two elements.")
@click.option("--to", "target", metavar="ID", help="See --from.")
@click.option(
    "--worst", "most", metavar="K", type=click.IntRange(1, 10_000), default=1, show_default=True, help="How many ways."
)
@click.option(
    "--set",
    "written",
    metavar="ELEMENT.timing.KEY=VALUE",
    multiple=True,
    help="What if: show the effect, touch no file.",
)
@click.option(
    "--sensitivity", metavar="CHAIN", help="Rank the figures that decide a chain, and those to measure first."
)
@click.option(
    "--measured",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Hold observed figures (YAML, CSV) against the design.",
)
def command(  # noqa: PLR0913, PLR0917 - one for each option
    project: Path | None,
    form: str,
    chain: str | None,
    why: str | None,
    source: str | None,
    target: str | None,
    most: int,
    written: tuple[str, ...],
    sensitivity: str | None,
    measured: Path | None,
) -> None:
    """Show how often everything in PROJECT works, how long its chains take, and what hosts and links carry.

    All bounds are safe; what is not known is said, and never taken for zero.
    """
    if (source is None) != (target is None):
        msg = "--from and --to belong together"
        raise click.UsageError(msg)
    questions = [q for q in (chain, why, source, sensitivity, measured) if q is not None]
    if len(questions) > 1:
        msg = "--chain, --why, --from, --sensitivity and --measured are questions of their own: ask one at a time"
        raise click.UsageError(msg)
    checked = run.check(project)
    from archgen.diagnostic import Severity

    run.report(checked, least=Severity.ERROR)
    asked = Asked(checked, _with(checked.architecture, written), form == "json", written)
    if chain is not None:
        _chain(asked, chain)
    elif why is not None:
        _why(asked, why)
    elif source is not None and target is not None:
        _ways(asked, source, target, most)
    elif sensitivity is not None:
        _sensitivity(asked, sensitivity)
    elif measured is not None:
        _measured(asked, measured)
    else:
        _summary(asked)
    run.finish(checked)


def _summary(asked: Asked) -> None:
    from archgen.findings import timing_asked, timing_json, timing_text
    from archgen.timing.network import Network
    from archgen.timing.rounds import rounds

    present = _computed(asked.checked.architecture)
    if not asked.written:
        if asked.as_json:
            _json(timing_json.document(*present))
        else:
            _lines(timing_text.summary(*present, rounds(Network.of(present[0]))))
        return
    changed = _computed(asked.architecture)
    if asked.as_json:
        documents = {"present": timing_json.document(*present), "changed": timing_json.document(*changed)}
        _json({"version": timing_json.VERSION, "set": list(asked.written), **documents})
    else:
        _lines(timing_asked.changes(present, changed, asked.written))


def _chain(asked: Asked, name: str) -> None:
    from archgen.findings import timing_json, timing_text
    from archgen.timing import chains as chains_of
    from archgen.timing import duerr
    from archgen.timing.network import Network

    analysis, chains = _computed(asked.architecture)
    result = _known(chains, name)
    published = duerr.of_chain(analysis, result.through)
    if asked.as_json:
        _json({"version": timing_json.VERSION, "chain": name, **timing_json.chain(result)})
    else:
        age = chains_of.data_age(Network.of(analysis), result)
        _lines(timing_text.chain(result, age, published))


def _why(asked: Asked, word: str) -> None:
    from archgen.findings import timing_asked
    from archgen.timing import naming
    from archgen.timing.why import explain

    analysis, chains = _computed(asked.architecture)
    names = [word]
    # Chains, hosts and links explain themselves; a node or component stands for its activities.
    if not explain(analysis, chains, word):
        try:
            names = list(naming.activities(asked.architecture, analysis.system, word))
        except naming.UnknownNameError as error:
            _wrong(str(error))
    steps = [line for name in names for line in explain(analysis, chains, name)]
    if asked.as_json:
        _json(timing_asked.why_json(word, steps))
    else:
        _lines(timing_asked.why(steps))


def _ways(asked: Asked, source: str, target: str, most: int) -> None:
    from archgen.findings import timing_json, timing_text
    from archgen.timing import chains, naming
    from archgen.timing.analyse import analyse
    from archgen.timing.network import Network

    analysis = analyse(asked.architecture)
    network = Network.of(analysis)
    try:
        first, last = (naming.waypoint(asked.architecture, analysis.system, word) for word in (source, target))
    except naming.UnknownNameError as error:
        _wrong(str(error))
    worst = chains.between(network, asked.architecture, first, last)
    best = chains.between(network, asked.architecture, first, last, "best")
    found = [tuple(chains.listed(network, w, k)) if w else () for w, k in ((worst, most), (best, 1))]
    count = worst.count if worst else 0
    if asked.as_json:
        _json(timing_json.ways(first.id, last.id, count, *found))
    else:
        _lines(timing_text.ways(first.id, last.id, count, *found))


def _sensitivity(asked: Asked, name: str) -> None:
    from archgen.findings import timing_asked
    from archgen.timing.analyse import for_chains
    from archgen.timing.sensitivity import sensitivity

    _, chains = _computed(asked.architecture)
    result = _known(chains, name)
    found = sensitivity(asked.architecture, asked.architecture.chains[name], for_chains, chains)
    if asked.as_json:
        _json(timing_asked.sensitivity_json(result, found))
    else:
        _lines(timing_asked.sensitivity(result, found))


def _measured(asked: Asked, file: Path) -> None:
    from archgen.findings import timing_asked
    from archgen.project import measured as reading
    from archgen.timing import measured
    from archgen.timing.analyse import analyse

    with run.phrased():
        try:
            text = file.read_bytes().decode("utf-8-sig")
        except UnicodeDecodeError:
            _wrong(f"{file} is not UTF-8 text")
    # So that excerpts below can show the lines of this file too.
    asked.checked.sources.add(str(file), text)
    observed, unread = reading.read(str(file), text)
    compared, unknown = measured.compare(analyse(asked.architecture), observed)
    problems = _settled((*unread, *unknown))
    if problems:
        run.lines(problems, asked.checked, sys.stderr)
    if asked.as_json:
        _json(timing_asked.measured_json(compared))
    else:
        _lines(timing_asked.measured(compared))
    if problems:
        raise click.exceptions.Exit(1)


def _settled(problems: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
    from archgen.diagnostic import settle
    from archgen.findings.rules import by_name
    from archgen.pipeline import ALL_RULES

    return settle(problems, by_name(ALL_RULES), {})


def _with(architecture: Architecture, written: tuple[str, ...]) -> Architecture:
    from archgen.link.override import OverrideError, lay

    try:
        return lay(architecture, written) if written else architecture
    except OverrideError as error:
        _wrong(str(error))


def _computed(architecture: Architecture) -> tuple[Analysis, dict[str, ChainResult]]:
    from archgen.timing.analyse import analyse
    from archgen.timing.chains import chains

    analysis = analyse(architecture)
    return analysis, chains(analysis, architecture)


def _known(chains: dict[str, ChainResult], name: str) -> ChainResult:
    from archgen.suggest import did_you_mean
    from archgen.timing.wording import listed

    if name not in chains:
        there = f"there are: {listed(tuple(chains), 12)}" if chains else "the project has none: write it under `chains`"
        _wrong(f"there is no chain `{name}`; {did_you_mean(name, chains) or there}")
    return chains[name]


def _wrong(text: str) -> NoReturn:
    from archgen.findings.escape import visible

    raise click.UsageError(visible(text))


def _json(document: object) -> None:
    from archgen.findings.escape import json_text

    click.echo(json_text(document), nl=False)


def _lines(lines: Iterable[str]) -> None:
    from archgen.findings.escape import visible

    for line in lines:
        click.echo(visible(line))
