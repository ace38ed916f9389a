"""`archgen timing`: rates, latency, load; why, what if, what decides."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import Severity

if TYPE_CHECKING:
    from archgen.model.architecture import Architecture

ANY_PROPOSAL = "any"
"""What `--propose` stands for alone."""


@click.command("timing")
@shared_options.project_argument
@shared_options.variant_option
@shared_options.format_option("text", "json")
@click.option("--all", "shows_all", is_flag=True, help="Show services, elements and loops on a terminal, too.")
@click.option("--chain", metavar="ID", help="Show a chain term by term.")
@click.option(
    "--why",
    metavar="ID",
    help="Show the reasoning behind the figures of an element, topic, chain, host, link, resource.",
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
    "--budget",
    metavar="CHAIN",
    help="How long each element may take, how rarely it may work, and what each partner may take, until a chain is late.",
)
@click.option(
    "--propose",
    metavar="[settings]",
    is_flag=False,
    flag_value=ANY_PROPOSAL,
    type=click.Choice([ANY_PROPOSAL, "settings"]),
    help="Look for processes, priorities, cores and triggers with which the chains that are late meet their deadlines, and show all "
    "that was tried, and a patch. `--propose settings` leaves triggers, and with them all programs, as they are.",
)
@click.option("--apply", "applies", is_flag=True, help="With --propose: write the patch into the files.")
@click.option(
    "--measured",
    "recordings",
    metavar="FILE",
    multiple=True,
    type=click.Path(path_type=Path),
    help="Hold recordings against the design: a trace (text of babeltrace2), tables of CARET, logs of `ros2 topic hz` and "
    "`delay`, metadata.yaml of a bag, or figures (YAML, CSV); may be repeated.",
)
@click.option(
    "--adopt",
    metavar="[FILE]",
    is_flag=False,
    flag_value=shared_options.MEASURED_SLICE,
    type=click.Path(path_type=Path),
    help="With --measured: write the longest and shortest execution times into a slice, wherever no other file has one.  "
    "[default: measured.yaml in the project]",
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
    recordings: tuple[Path, ...],
    adopt: Path | None,
    budget: str | None,
    propose: str | None,
    *,
    applies: bool,
    shows_all: bool,
) -> None:
    """Show how often everything in PROJECT works, how long its chains take, and what hosts and links carry.

    All bounds are safe; what is not known is said, and never taken for zero.
    """
    asked = [
        q for q in (chain, why, source or target, sensitivity, budget, propose, recordings or None) if q is not None
    ]
    if (source is None) != (target is None):
        raise click.UsageError("--from and --to belong together")
    if len(asked) > 1:
        raise click.UsageError(
            "--chain, --why, --from, --sensitivity, --budget, --propose and --measured are questions of their own: "
            "ask one at a time"
        )
    _refuse_writing(written, recordings, adopt, propose, applies=applies)
    checked_project = command_support.check_or_exit(project)

    from archgen.cli import timing_printing

    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    request = timing_printing.TimingRequest(
        checked_project, _apply_overrides(checked_project.architecture, written), form == "json", written, shows_all
    )
    if chain is not None:
        timing_printing.print_chain(request, chain)
    elif why is not None:
        timing_printing.print_reasons(request, why)
    elif source is not None and target is not None:
        timing_printing.print_paths(request, source, target, most)
    elif sensitivity is not None:
        timing_printing.print_sensitivity(request, sensitivity)
    elif budget is not None:
        timing_printing.print_budget(request, budget)
    elif propose is not None:
        timing_printing.print_proposal(request, keep_triggers=propose != ANY_PROPOSAL, applies=applies)
    elif recordings:
        from archgen.cli import measured_recordings

        measured_recordings.answer_recordings(
            checked_project, request.architecture, recordings, adopt, as_json=request.as_json
        )
    else:
        timing_printing.print_timing_summary(request)
    command_support.exit_by_findings(checked_project)


def _refuse_writing(
    written: tuple[str, ...], recordings: tuple[Path, ...], adopt: Path | None, propose: str | None, *, applies: bool
) -> None:
    if adopt is not None and (written or not recordings):
        raise click.UsageError("--adopt writes what --measured reads, and goes with no --set")
    if (propose is not None and written) or (applies and propose is None):
        msg = "--propose is about what the files say, and goes with no --set; --apply writes what it proposes"
        raise click.UsageError(msg)


def _apply_overrides(architecture: Architecture, overrides: tuple[str, ...]) -> Architecture:
    from archgen.link.process_overrides import OverrideError
    from archgen.link.timing_overrides import apply_overrides

    with command_support.explain_wrong_usage(OverrideError):
        return apply_overrides(architecture, overrides) if overrides else architecture
