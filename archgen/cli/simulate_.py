"""`archgen simulate`: run the modelled architecture, and show what was seen beside the bounds."""

from __future__ import annotations

import json
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
    from archgen.simulation import compared
    from archgen.timing.analyse import analyse
    from archgen.timing.chains import chains

    checked = run.check(project)
    run.report(checked, least=run.ERROR)
    architecture = checked.architecture
    _known(asked, tuple(architecture.chains))
    analysis = analyse(architecture)
    found = {key: one for key, one in chains(analysis, architecture).items() if not asked or key in asked}
    through = {key: one.through for key, one in found.items()}
    seen = simulation.simulate(analysis.system, seconds, seeds, through, compared.pauses(analysis))
    if form == "json":
        click.echo(json.dumps(compared.plain(seen, analysis, found), ensure_ascii=False, indent=2))
    else:
        click.echo(compared.text(visible(architecture.project.title), seen, analysis, found), nl=False)
    run.finish(checked)


def _known(asked: tuple[str, ...], chains: tuple[str, ...]) -> None:
    from archgen.findings.escape import visible
    from archgen.suggest import did_you_mean

    for name in asked:
        if name not in chains:
            guess = did_you_mean(name, chains)
            raise click.UsageError(visible(f"there is no chain '{name}'" + (f"; {guess}" if guess else "")))
