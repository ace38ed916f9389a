"""`archgen simulate`: run the modelled architecture, and show what was seen beside the bounds."""

from __future__ import annotations

import json
import sys
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity, did_you_mean, join_first, make_visible
from archgen.diagnostics.text_columns import find_width, wrap_line

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.simulation import SimulationResult
    from archgen.timing.analysis import Analysis


@click.command("simulate")
@shared_options.project_argument
@shared_options.variant_option
@click.option("--seconds", type=click.IntRange(1, 86_400), default=60, show_default=True, help="Simulated time.")
@click.option("--seeds", type=click.IntRange(1, 10_000), default=20, show_default=True, help="How many runs.")
@click.option("--seed", type=click.IntRange(0), metavar="N", help="Only the run with this number, as one of --seeds.")
@click.option("--chain", "asked", multiple=True, metavar="ID", help="Only this chain; may be repeated.")
@click.option(
    "--trace",
    "trace_file",
    metavar="FILE",
    type=click.Path(path_type=Path, dir_okay=False),
    help="With one --chain: write the run in which it was latest, for ui.perfetto.dev.",
)
@shared_options.format_option("text", "json")
def command(  # noqa: PLR0913, PLR0917 - one for each option
    project: Path | None,
    seconds: int,
    seeds: int,
    seed: int | None,
    asked: tuple[str, ...],
    trace_file: Path | None,
    form: str,
) -> None:
    """Simulate PROJECT: activities on their hosts, samples on their way, from random phases and execution times.

    What is seen is a lower bound on the worst case; `archgen timing` gives the bounds from above. The same seeds give
    the same figures; --seed N repeats one run.
    """
    from archgen import simulation
    from archgen.simulation import chain_witnesses, simulation_json
    from archgen.simulation import simulation_text as words
    from archgen.simulation.event_loop import EventFloodError
    from archgen.timing.chains.chain_bounds import bound_all_chains
    from archgen.timing.run_analysis import analyse_architecture

    if trace_file is not None and len(set(asked)) != 1:
        raise click.UsageError("--trace shows one chain: name it with --chain")
    checked_project = command_support.check_or_exit(project)
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    architecture = checked_project.architecture
    _require_chains(asked, tuple(architecture.chains))
    analysis = analyse_architecture(architecture)
    # Events that trigger one another in a ring: their simulation would not come to an end.
    if analysis.endless:
        ways = "; ".join(" > ".join((*ring, ring[0])) for ring in analysis.endless)
        raise click.ClickException(
            make_visible(f"events would go round for ever in {ways}: see `archgen explain endless-trigger`")
        )
    chain_results = {
        key: one for key, one in bound_all_chains(analysis, architecture).items() if not asked or key in asked
    }
    waypoints = {key: one.through for key, one in chain_results.items()}
    try:
        observations = simulation.simulate_system(
            analysis.system,
            seconds,
            seeds if seed is None else range(seed, seed + 1),
            waypoints,
            chain_witnesses.find_publish_pauses(analysis),
            progress=command_support.make_progress_printer("simulated runs"),
        )
    except EventFloodError as flood:
        raise click.ClickException(_describe_flood(flood.gave_up_at)) from None
    if trace_file is not None:
        _write_trace(checked_project, analysis, observations, asked[0], trace_file)
    if form == "json":
        click.echo(
            json.dumps(
                simulation_json.simulation_to_json(observations, analysis, chain_results), ensure_ascii=False, indent=2
            )
        )
    else:
        text = words.format_simulation(make_visible(architecture.project.title), observations, analysis, chain_results)
        width = find_width(sys.stdout)
        for line in text.splitlines():
            click.echo("\n".join(wrap_line(line, width)))
    command_support.exit_by_findings(checked_project)


def _write_trace(
    checked_project: CheckedProject, analysis: Analysis, observations: SimulationResult, chain_id: str, target: Path
) -> None:
    """Write the run in which a chain was latest."""
    from archgen.emit.data.trace_events import format_trace
    from archgen.products.product_writing import write_product_file
    from archgen.simulation.chain_witnesses import find_publish_pauses
    from archgen.simulation.schedule_log import record_schedule

    observed = observations.chains[chain_id]
    pauses, seed = find_publish_pauses(analysis), observed.latest_seed
    schedule = (
        record_schedule(analysis.system, observed.through, seed, observations.seconds, pauses)
        if seed is not None
        else None
    )
    if schedule is None:
        raise click.ClickException(f"nothing passed along the chain {chain_id} in these runs: there is no run to write")
    with command_support.explain_write_errors():
        write_product_file(checked_project, target, format_trace(chain_id, schedule))
    # Not on standard output, where JSON may stand.
    click.echo(f"wrote {command_support.shorten_path(target)}", err=True)


def _describe_flood(time: Fraction) -> str:
    from archgen.timing.figures.figure_wording import format_duration

    return (
        f"given up after {format_duration(time)} of simulated time: each event makes more than one other, or far more is asked for "
        "than is ever done. `archgen timing` shows hosts and links with too much load"
    )


def _require_chains(asked_ids: tuple[str, ...], chain_ids: tuple[str, ...]) -> None:
    for name in asked_ids:
        if name not in chain_ids:
            guess = did_you_mean(name, chain_ids)
            existing = f"the chains are {join_first(chain_ids)}" if chain_ids else "the project has no chains"
            raise click.UsageError(make_visible(f"there is no chain '{name}'; {guess or existing}"))
