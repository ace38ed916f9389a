"""`archgen conform`: hold the project against a robot that exists."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, finding_documents, shared_options
from archgen.diagnostics import Severity, did_you_mean, fit_lines, join_first, make_visible
from archgen.frozen import replace

if TYPE_CHECKING:
    from archgen.conformance.observed_robot import ObservedRobot
    from archgen.conformance.robot_comparison import ComparedPart, RobotComparison
    from archgen.importers.robot_observation import ObservationOptions
    from archgen.pipeline import CheckedProject
    from archgen.products.robot_conformance import ConformanceReport

_MAX_UNREAD = 10
"""So many lines for what could not be read of a robot; the rest is counted."""


@click.command("conform")
@shared_options.project_argument
@click.option(
    "--against",
    "paths",
    metavar="PATH",
    type=click.Path(path_type=Path),
    multiple=True,
    help="What says how the robot is: a workspace, a dump of its running graph, a recording; several may be given.  "
    "[default: `conform.against` in the project]",
)
@click.option(
    "--recorder",
    "wants_recorder",
    is_flag=True,
    help="Print a program for the robot: `python3 recorder.py > graph.txt` there, for ROS 1 and ROS 2.",
)
@shared_options.variant_option
@click.option(
    "--host", "hosts", metavar="HOST", multiple=True, help="Expect only the nodes of this host; may be repeated."
)
@click.option("--only", "rules", metavar="RULE", multiple=True, help="Show only what this rule finds; may be repeated.")
@click.option(
    "--launch",
    "launch_files",
    metavar="PACKAGE/FILE",
    multiple=True,
    help="The launch file of a workspace that starts the robot; several where several are started.",
)
@click.option(
    "--argument",
    "arguments",
    metavar="NAME:=VALUE",
    multiple=True,
    help="An argument of the launch files of a workspace.",
)
@click.option(
    "--env", "variables", metavar="NAME=VALUE", multiple=True, help="A variable of the environment of launch files."
)
@shared_options.format_option("text", *finding_documents.DOCUMENT_FORMATS)
@shared_options.strict_option
@click.option(
    "--baseline",
    metavar="FILE",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    help="Keep the findings that FILE knows quiet.",
)
@click.option(
    "--adopt",
    "adopts",
    is_flag=True,
    help="Write into PROJECT what the robot knows and the design does not say; with --only, what differs there, too.",
)
@click.option("--dry-run", "is_dry_run", is_flag=True, help="Print what --adopt would write as a patch.")
@click.option(
    "--keep",
    "kept_name",
    metavar="NAME",
    help="Keep in PROJECT what came out, under this name of the robot, for the site and `archgen stats`.",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    paths: tuple[Path, ...],
    hosts: tuple[str, ...],
    rules: tuple[str, ...],
    launch_files: tuple[str, ...],
    arguments: tuple[str, ...],
    variables: tuple[str, ...],
    form: str,
    strict: bool,
    baseline: Path | None,
    wants_recorder: bool,
    adopts: bool,
    is_dry_run: bool,
    kept_name: str | None,
) -> None:
    """Hold PROJECT against the robot that exists, and show where both differ.

    Nodes, what they publish, subscribe to, serve and call, types, quality of service and parameters are compared; of
    recordings types, what was offered, and what outputs promise. What
    is planned, what the variant takes away, optional inputs and what nobody can see there are no differences. The first
    line for each --against says what was looked at. The exit status is 0 where both agree, 1 with errors (with --strict
    also with warnings), 2 for wrong usage, such as a file that says nothing of a robot.
    """
    if wants_recorder:
        from archgen.installed_plugins import load_reader

        click.echo(load_reader("the recorder of graphs")().encode(), nl=False)
        return
    from archgen.conformance.robot_comparison import ComparedPart
    from archgen.products import robot_conformance

    _refuse_unknown_rules(rules)
    _refuse_wrong_adoption(form, adopts=adopts, is_dry_run=is_dry_run)
    checked_project = command_support.check_or_exit(project)
    for host in hosts:
        command_support.require_host(checked_project.architecture, host)
    options = _read_options(checked_project, launch_files, arguments, variables)
    robots = [_observe_or_exit(path, checked_project, options) for path in paths or _list_named_paths(checked_project)]
    command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    if adopts:
        checked_project = _adopt_remedies(checked_project, robots, ComparedPart(hosts), rules, is_dry_run=is_dry_run)
        if is_dry_run:
            return
    report = robot_conformance.hold_against_robots(checked_project, robots, ComparedPart(hosts), baseline)
    findings = [each for each in report.reported.findings if not rules or each.rule in rules]
    lines = [line for comparison in report.comparisons for line in _describe_comparison(comparison)]
    lines += [f"accepted differences: {report.accepted_count}"] if report.accepted_count else []
    for line in lines:
        click.echo(make_visible(line), err=form != "text")
    if form != "text":
        reported = replace(report.reported, findings=tuple(findings))
        document = finding_documents.render_findings(form, reported, checked_project, strict=strict)
        click.echo(document.encode(), nl=False)
    elif findings:
        command_support.print_findings(findings, checked_project, sys.stdout)
    else:
        click.echo("no differences")
    if kept_name is not None:
        _keep_report(checked_project, report, kept_name)
    _print_what_is_left(report, baseline, adopts=adopts)
    sys.exit(max(command_support.exit_status(findings, strict=strict), int(checked_project.has_errors)))


def _print_what_is_left(report: ConformanceReport, baseline: Path | None, *, adopts: bool) -> None:
    gap_count = sum(each.is_gap for comparison in report.comparisons for each in comparison.remedies)
    if gap_count and not adopts:
        click.echo(f"left open in the design, and told by the robot: {gap_count}; `--adopt` writes that", err=True)
    if report.reported.known_findings:
        count = command_support.summarise_counts(report.reported.known_findings)
        click.echo(make_visible(f"not shown: {count} that {baseline} knows"), err=True)


def _keep_report(checked_project: CheckedProject, report: ConformanceReport, name: str) -> None:
    """Write what came out into the record of the project."""
    from archgen.conformance.seen_record import RECORD_FILE, SeenRecordError
    from archgen.emit import file_tree, new_files
    from archgen.products.robot_conformance import keep_report

    path = checked_project.root / RECORD_FILE
    try:
        text = keep_report(checked_project, report, " ".join(name.split()))
    except SeenRecordError as error:
        raise click.ClickException(make_visible(f"nothing was kept: {error}")) from None
    with command_support.explain_write_errors():
        new_files.refuse_outside(path.parent, checked_project.root)
        file_tree.write_file(path, text.encode())
    click.echo(f"wrote {make_visible(str(command_support.shorten_path(path)))}", err=True)


def _refuse_wrong_adoption(form: str, *, adopts: bool, is_dry_run: bool) -> None:
    if is_dry_run and not adopts:
        raise click.UsageError("--dry-run shows what --adopt would write: give both")
    if adopts and (form != "text" or shared_options.find_asked_variants()):
        msg = "--adopt is for people, and writes what counts in all variants: no --format, no --variant"
        raise click.UsageError(msg)


def _adopt_remedies(
    checked_project: CheckedProject,
    robots: Sequence[ObservedRobot],
    part: ComparedPart,
    rules: Sequence[str],
    *,
    is_dry_run: bool,
) -> CheckedProject:
    """Write what the robots know, or print it as a patch; return the project with it."""
    from archgen import pipeline
    from archgen.products.robot_conformance import adopt_remedies

    adoption = adopt_remedies(checked_project, robots, part, rules)
    for remedy, reason in adoption.left_out:
        command_support.print_warning(f"not adopted: {remedy.message}: {reason}")
    for edit in adoption.edits:
        if is_dry_run:
            # What is piped into `git apply` has to be exact.
            patch = "".join(edit.unified_diff())
            click.echo(make_visible(patch) if sys.stdout.isatty() else patch, nl=False)
        else:
            command_support.write_edit(checked_project.root, edit, "as on the robot")
    click.echo(f"adopted: {len(adoption.adopted)}", err=True)
    if is_dry_run or not adoption.edits:
        return checked_project
    return pipeline.check_project(checked_project.root / checked_project.loaded_project.first_file)


def _refuse_unknown_rules(names: Sequence[str]) -> None:
    from archgen.conformance.conformance_rules import RULE_NAMES

    for name in names:
        if name not in RULE_NAMES:
            guess = did_you_mean(name, RULE_NAMES) or f"rules are {', '.join(sorted(RULE_NAMES))}"
            raise click.UsageError(make_visible(f"no rule of a comparison is called `{name}`; {guess}"))


def _list_named_paths(checked_project: CheckedProject) -> list[Path]:
    """Return the paths that the project names. They lie in its repository: what others wrote is read, and shown in findings."""
    repository = command_support.find_repository_folder(checked_project.root)
    paths = [checked_project.root / text for text in checked_project.architecture.conform.against]
    for path in paths:
        if not path.resolve().is_relative_to(repository):
            msg = f"`conform.against` names {path}, which is not in the repository: give it with --against"
            raise click.UsageError(make_visible(msg))
    if not paths:
        msg = "against what? Name a workspace, a dump of a running graph or a recording: `--against src`, or `conform: {against: [../src]}`"
        raise click.UsageError(msg)
    return [command_support.shorten_path(path) for path in paths]


def _read_options(
    checked_project: CheckedProject,
    launch_files: tuple[str, ...],
    arguments: tuple[str, ...],
    variables: tuple[str, ...],
) -> ObservationOptions:
    from archgen.importers.robot_observation import ObservationOptions, list_designed_starts

    return ObservationOptions(
        command_support.split_words(arguments, ":=", "argument", "--argument NAME:=VALUE"),
        command_support.split_words(variables, "=", "variable of the environment", "--env NAME=VALUE"),
        launch_files or checked_project.architecture.conform.launch,
        checked_project.architecture.distro or "",
        tuple(list_designed_starts(checked_project.architecture)),
    )


def _observe_or_exit(path: Path, checked_project: CheckedProject, options: ObservationOptions) -> ObservedRobot:
    """Read what says how the robot is. What cannot be read is wrong usage: nothing was compared then."""
    from archgen.importers.foreign_import import ForeignFileError
    from archgen.importers.robot_observation import observe_robot

    if not path.exists():
        raise click.UsageError(make_visible(f"there is no {path}"))
    try:
        with command_support.explain_write_errors():
            return observe_robot(path, checked_project.root, options)
    except ForeignFileError as error:
        place = error.span.file if error.span.file != "." else str(path)
        raise click.UsageError(make_visible(f"{place}: {error.message}; {error.help_line}")) from None


def _describe_comparison(comparison: RobotComparison) -> Iterator[str]:
    """Yield what was looked at, and what could not be."""
    robot = comparison.robot
    if robot.kind == "recording":
        count = sum(topic.count for topic in robot.topics)
        topics = f"{comparison.seen_topics} of {comparison.topics} topics of the design"
        yield f"{robot.origin} (recording): {topics}; {count:,} messages of {len(robot.topics)} topics"
        yield from _list_unread(robot)
        return
    parts = [
        f"{comparison.seen_nodes} of {comparison.nodes} nodes, {comparison.seen_endpoints} of {comparison.endpoints} endpoints seen"
    ]
    parts += [f"{comparison.untold} cannot be told"] if comparison.untold else []
    parts += [f"{comparison.unknown} of its names unknown"]
    parts += [f"{comparison.compared_parameters} parameters compared"] if comparison.compared_parameters else []
    parts += ["names, remaps and parameters as the design starts them"] if robot.has_designed_starts else []
    yield f"{robot.origin} ({robot.kind}): {'; '.join(parts)}"
    if comparison.early_nodes:
        yield f"  planned, and running already: {join_first(comparison.early_nodes)}"
    yield from _list_unread(robot)


def _list_unread(robot: ObservedRobot) -> Iterator[str]:
    for line in fit_lines(robot.unread, _MAX_UNREAD):
        yield f"  not read: {line}"
