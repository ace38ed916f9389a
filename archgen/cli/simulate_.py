"""`archgen simulate`: run the modelled architecture, and show what was seen beside the bounds."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path

import click

from archgen.cli import options, run


@click.command("simulate")
@options.project
@click.option("--seconds", type=click.IntRange(1, 86_400), default=60, show_default=True, help="Simulated time.")
@click.option("--seeds", type=click.IntRange(1, 10_000), default=20, show_default=True, help="How many runs.")
@click.option("--chain", "asked", multiple=True, metavar="ID", help="Only this chain; may be repeated.")
@click.option("--format", "form", type=click.Choice(["text", "json"]), default="text", show_default=True)
def command(project: Path | None, seconds: int, seeds: int, asked: tuple[str, ...], form: str) -> None:
    """Simulate PROJECT: activities on their hosts, samples on their way, from random phases and execution times.

    What is seen is a lower bound on the worst case; `archgen timing` gives the bounds from above. The same seeds give
    the same figures.
    """
    from archgen import simulation
    from archgen.findings.escape import visible
    from archgen.simulation import compared, record
    from archgen.simulation import text as words
    from archgen.simulation.engine import FloodError
    from archgen.timing.analyse import analyse
    from archgen.timing.chains import chains

    checked = run.check(project)
    run.report(checked, least=run.ERROR)
    architecture = checked.architecture
    _known(asked, tuple(architecture.chains))
    analysis = analyse(architecture)
    # Events that trigger one another in a ring: their simulation would not come to an end.
    if analysis.endless:
        raise click.ClickException(visible(_endless(analysis.endless)))
    found = {key: one for key, one in chains(analysis, architecture).items() if not asked or key in asked}
    through = {key: one.through for key, one in found.items()}
    try:
        seen = simulation.simulate(analysis.system, seconds, seeds, through, compared.pauses(analysis))
    except FloodError as flood:
        raise click.ClickException(_flooded(flood.at)) from None
    if form == "json":
        click.echo(json.dumps(record.plain(seen, analysis, found), ensure_ascii=False, indent=2))
    else:
        click.echo(words.text(visible(architecture.project.title), seen, analysis, found), nl=False)
    run.finish(checked)


def _endless(rings: tuple[tuple[str, ...], ...]) -> str:
    ways = "; ".join(" > ".join((*ring, ring[0])) for ring in rings)
    return f"events would go round for ever in {ways}: see `archgen explain endless-trigger`"


def _flooded(at: Fraction) -> str:
    from archgen.timing.wording import duration

    return (
        f"given up after {duration(at)} of simulated time: each event makes more than one other, or far more is asked for "
        "than is ever done. `archgen timing` shows hosts and links with too much load"
    )


def _known(asked: tuple[str, ...], chains: tuple[str, ...]) -> None:
    from archgen.findings.escape import visible
    from archgen.suggest import did_you_mean
    from archgen.timing.wording import listed

    for name in asked:
        if name not in chains:
            guess = did_you_mean(name, chains)
            there = f"the chains are {listed(chains)}" if chains else "the project has no chains"
            raise click.UsageError(visible(f"there is no chain '{name}'; {guess or there}"))
