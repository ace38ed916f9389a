"""`archgen check`: find mistakes in the architecture."""

from __future__ import annotations

import functools
import os
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from archgen.cli import command_support, finding_documents, shared_options
from archgen.diagnostics import Diagnostic, Severity, make_visible
from archgen.frozen import replace

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from archgen.pipeline import CheckedProject, VersionCache
    from archgen.products.check_findings import ReportedFindings

_MAX_CURED_LINES = 20
"""This many lines for cured findings; the rest is counted."""


@click.command("check")
@click.argument("paths", metavar="[PROJECT | FILE...]", nargs=-1, type=click.Path(path_type=Path))
@shared_options.project_option
@shared_options.format_option("text", *finding_documents.DOCUMENT_FORMATS)
@click.option(
    "--variant",
    metavar="NAMES",
    help="Show only what holds in these variants: `simulation`, `base,home`; `base` is the project itself.",
)
@click.option(
    "--select",
    metavar="WORDS",
    help="Show only what is about the selected components and nodes: `owner:certh`, `sensing`, `tag:safety -x`.",
)
@click.option(
    "--fix",
    is_flag=True,
    help="Mend what can mean only one thing (quotes, case, separators, odd signs), and show what is left.",
)
@click.option("--watch", is_flag=True, help="Check again whenever a file is saved, until Ctrl-C.")
@shared_options.strict_option
@click.option("-q", "--quiet", is_flag=True, help="Show only what makes the check fail, and count the rest.")
@click.option(
    "--baseline", metavar="FILE", type=click.Path(path_type=Path), help="Keep the findings that FILE knows quiet."
)
@click.option("--update-baseline", is_flag=True, help="Write a baseline that knows all findings of now.")
@click.option(
    "--changed-since",
    metavar="REV",
    help="Show only findings that were not there at a git revision; `main...` is where the branch left main.",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    paths: tuple[Path, ...],
    project: Path | None,
    form: str,
    variant: str | None,
    select: str | None,
    fix: bool,
    watch: bool,
    strict: bool,
    quiet: bool,
    baseline: Path | None,
    update_baseline: bool,
    changed_since: str | None,
) -> None:
    """Find mistakes in the architecture of PROJECT, or in those FILEs of it.

    PROJECT is a folder or a single file; left out, it is the project around the current folder. Of files of a project, the
    whole project is checked, and what lies in these files is shown; --select shows what is about some components and
    nodes, and errors that keep a file from being read. The exit status goes by what is shown: 0
    without errors, 1 with errors (with --strict also with warnings, and with findings of the baseline that are cured),
    2 for wrong usage. A project with variants is checked in each of them; a finding that does not hold in all of them says
    in which. --update-baseline writes the --baseline, or archgen-baseline.yaml in the project.
    """
    project, files = command_support.find_asked_files(paths, project)
    if update_baseline:
        _refuse_partial_baseline(
            {"--format": form != "text", "--changed-since": changed_since, "--variant": variant, "--select": select}
            | {"FILE": files, "--fix": fix, "--watch": watch}
        )
        _update_baseline(command_support.check_or_exit(project), baseline)
    _refuse_wrong_use({"--fix": fix, "--watch": watch}, form=form, baseline=baseline)
    from archgen.pipeline import VersionCache

    check_once = functools.partial(
        _check_once,
        *(project, files),
        # A single check is the quicker for what need not be kept for another one.
        kept_versions=VersionCache() if watch or changed_since is not None else None,
        form=form,
        variant=variant,
        select=select,
        fix=fix,
        strict=strict,
        quiet=quiet,
        baseline=baseline,
        changed_since=changed_since,
    )
    if watch:
        _watch(project, check_once)  # with what the check before found out about files that are as they were
    else:
        sys.exit(check_once())


def _watch(project: Path | None, check_once: Callable[[], int]) -> None:
    """Check, and check again whenever a file below the project is saved."""
    from archgen.live import file_watch
    from archgen.project.project_search import ProjectNotFoundError, find_project

    with command_support.explain_wrong_usage(ProjectNotFoundError):
        places = file_watch.WatchedPlaces((find_project(project)[0],))

    def check_again() -> None:
        click.echo(click.style("--- a file was saved", dim=True))
        try:
            check_once()
        except click.ClickException as error:  # a selector that names nothing by now, for instance
            error.show()

    check_once()
    file_watch.watch_files(lambda: places, check_again, threading.Event())


def _check_once(  # noqa: PLR0913 - one for each option
    project: Path | None,
    files: tuple[Path, ...],
    *,
    kept_versions: VersionCache | None,
    form: str,
    variant: str | None,
    select: str | None,
    fix: bool,
    strict: bool,
    quiet: bool,
    baseline: Path | None,
    changed_since: str | None,
) -> int:
    """Check a project, print what is asked for, and return the exit status; `kept_versions` is kept for another check."""
    from archgen.products import check_findings

    checked_project, names = _check_asked(project, files, kept_versions, fix=fix)
    if variant is not None:
        checked_project = _keep_variants(checked_project, variant)
    earlier_project = None
    if kept_versions is not None:
        kept_versions.forget_old_slices(checked_project)
        earlier_project = None if changed_since is None else _check_at_revision(project, changed_since, kept_versions)

    reported = check_findings.report_findings(checked_project, baseline, earlier_project)
    selection = command_support.select_or_exit(checked_project, select)
    all_findings = reported.findings
    is_part = bool(names or selection)
    if is_part:
        reported = check_findings.keep_findings(reported, checked_project, names, selection)
    lowest_severity = "warning" if strict else "error"
    shown_findings = [d for d in reported.findings if not quiet or d.severity in {lowest_severity, "error"}]
    if form != "text":
        _print_findings(form, replace(reported, findings=tuple(shown_findings)), checked_project, strict=strict)
    elif shown_findings:
        command_support.print_findings(shown_findings, checked_project, sys.stdout)
    elif not quiet:
        known = " new" if reported.known_findings or reported.earlier_findings else ""
        click.echo(f"no{known} findings{' there' if is_part else ''}")
    if not quiet:
        _print_known(reported, baseline)
        _print_earlier(reported, changed_since)
    if is_part or (quiet and shown_findings):
        _print_hidden(all_findings, shown_findings)
    _renew_editor_schema(checked_project)
    # With --strict a cured finding fails, so that the baseline is updated and the fault cannot come back unseen.
    return command_support.exit_status(reported.findings, strict=strict) or int(strict and bool(reported.cured_entries))


def _check_asked(
    project: Path | None, files: tuple[Path, ...], version_cache: VersionCache | None, *, fix: bool
) -> tuple[CheckedProject, frozenset[str]]:
    """Check a project; return it with the files that are asked for, as it calls them. Those that it does not read are named.

    A single one that the project does not read is a project by itself.
    """
    checked_project = command_support.check_or_exit(project, version_cache)
    names = command_support.name_files(checked_project, files)
    known_files = {*checked_project.sources.file_names(), *checked_project.loaded_project.broken_files}
    for name in sorted(names.keys() - known_files):
        command_support.print_warning(
            f"{names[name]} is no part of the project in {command_support.shorten_path(checked_project.root)}: "
            + ("it is checked by itself" if len(files) == 1 else "it is not checked")
        )
    read_names = frozenset(names.keys() & known_files)
    if files and not read_names:
        if len(files) > 1:
            sys.exit(0)
        checked_project = command_support.check_or_exit(files[0], version_cache)
    return _apply_fixes(checked_project, read_names) if fix else checked_project, read_names


_MAX_ROUNDS = 20
"""So often a project is checked again by --fix: a syntax error hides what comes behind it."""


def _apply_fixes(checked_project: CheckedProject, names: frozenset[str]) -> CheckedProject:
    """Write the fixes that are certain; return the project with them."""
    from archgen import pipeline
    from archgen.edit.certain_fixes import plan_certain_fixes
    from archgen.project.project_loading import load_from_files

    for _ in range(_MAX_ROUNDS):
        planned = list(plan_certain_fixes(checked_project, names))
        if not planned:
            break
        for edit, count in planned:
            command_support.write_edit(checked_project.root, edit, f"{count} fix{'es' * (count > 1)}")
        loaded_project = checked_project.loaded_project
        loaded_project = load_from_files(loaded_project.files, loaded_project.first_file)
        checked_project = pipeline.check_loaded_project(loaded_project, pipeline.VersionCache())
    return checked_project


def _refuse_wrong_use(told_options: Mapping[str, bool], *, form: str, baseline: Path | None) -> None:
    told = [name for name, is_given in told_options.items() if is_given]
    if told and form != "text":
        raise click.UsageError(f"{told[0]} is for people: no --format")
    if baseline is not None and not os.path.lexists(baseline):
        msg = f"there is no baseline {baseline}: `archgen check --update-baseline --baseline {baseline}` writes one"
        raise click.UsageError(msg)


def _refuse_partial_baseline(options: Mapping[str, object]) -> None:
    refused = [name for name, value in options.items() if value]
    if refused:
        msg = f"--update-baseline takes in all findings of now and says what it wrote: no {', no '.join(refused)}"
        raise click.UsageError(msg)


def _keep_variants(checked_project: CheckedProject, text: str) -> CheckedProject:
    """Return a checked project with the findings that hold in some of its variants."""
    from archgen import pipeline

    names = shared_options.split_variants(text)
    with command_support.explain_wrong_usage(pipeline.UnknownVariantError):
        return pipeline.keep_variant_findings(checked_project, names)


def _renew_editor_schema(checked_project: CheckedProject) -> None:
    """Keep the names that editors offer current for people who work on the project; never in a workflow or a script."""
    if sys.stdout.isatty() and not os.environ.get("CI"):
        from archgen.products import schema_renewal

        schema_renewal.renew_schema(checked_project)


def _check_at_revision(project: Path | None, revision: str, version_cache: VersionCache) -> CheckedProject | None:
    """Check the project at a revision. Return None, with a warning, where it cannot be read there: then everything
    counts.
    """
    from archgen.git import GitError
    from archgen.products import check_findings
    from archgen.project import NotAtRevisionError

    try:
        checked_project = check_findings.check_earlier(project, revision, version_cache)
    except NotAtRevisionError as error:
        command_support.print_warning(f"{error}: all findings are shown")
        return None
    except GitError as error:
        raise click.UsageError(make_visible(str(error))) from None
    unreadable = check_findings.find_reading_error(checked_project.findings)
    if unreadable is not None:
        reason = f"{unreadable.span}: {unreadable.message}" if unreadable.span.file else unreadable.message
        command_support.print_warning(
            f"at `{revision}` the project could not be read whole ({reason}): all findings are shown"
        )
        return None
    return checked_project


def _print_findings(
    format_name: str, reported_findings: ReportedFindings, checked_project: CheckedProject, *, strict: bool
) -> None:
    from archgen.emit.data import sarif_document

    document = finding_documents.render_findings(format_name, reported_findings, checked_project, strict=strict)
    if format_name == "github":  # in what everything else is in that a workflow prints
        sys.stdout.write(document)
    else:
        click.echo(document.encode(), nl=False)  # UTF-8 whatever the terminal has: so it says of itself
    for limit in (
        sarif_document.check_github_limits(document, len(reported_findings.findings)) if format_name == "sarif" else ()
    ):
        command_support.print_warning(limit)


def _print_hidden(findings: Sequence[Diagnostic], shown_findings: Sequence[Diagnostic]) -> None:
    """Count on the error stream what there is besides."""
    known_findings = {*shown_findings}
    hidden_findings = [finding for finding in findings if finding not in known_findings]
    if hidden_findings:
        click.echo(f"not shown: {command_support.summarise_counts(hidden_findings)}", err=True)


def _print_known(reported_findings: ReportedFindings, baseline: Path | None) -> None:
    """Print on the error stream what a baseline did: standard output has findings only."""
    if reported_findings.known_findings:
        click.echo(
            make_visible(
                f"not shown: {command_support.summarise_counts(reported_findings.known_findings)} that {baseline} knows"
            ),
            err=True,
        )
    cured_lines = [
        f"{entry.rule}: {entry.message}{f' ({entry.occurrences} times)' * (entry.occurrences > 1)}"
        for entry in reported_findings.cured_entries
    ]
    count = sum(entry.occurrences for entry in reported_findings.cured_entries)
    _print_cured(cured_lines, count, "the baseline", f": run `archgen check --update-baseline --baseline {baseline}`")


def _print_earlier(reported_findings: ReportedFindings, revision: str | None) -> None:
    """Print what a comparison with a revision left out, and what the change cured."""
    if reported_findings.earlier_findings:
        click.echo(
            make_visible(
                f"not shown: {command_support.summarise_counts(reported_findings.earlier_findings)} that {revision} had already"
            ),
            err=True,
        )
    cured_lines = [f"{finding.rule}: {finding.message}" for finding in reported_findings.healed_findings]
    _print_cured(cured_lines, len(cured_lines), str(revision), "")


def _print_cured(cured_lines: list[str], count: int, origin: str, what_to_do: str) -> None:
    if cured_lines:
        sentence = f"1 finding of {origin} is" if count == 1 else f"{count} findings of {origin} are"
        click.echo(make_visible(f"{sentence} cured{what_to_do}"), err=True)
        for line in cured_lines[:_MAX_CURED_LINES]:
            click.echo(make_visible(f"  {line}"), err=True)
        if len(cured_lines) > _MAX_CURED_LINES:
            click.echo(f"  and {len(cured_lines) - _MAX_CURED_LINES} more", err=True)


def _update_baseline(checked_project: CheckedProject, baseline: Path | None) -> NoReturn:
    """Write the baseline. Errors of reading come first, since what they hide would be missing in it."""
    from archgen.products import check_findings

    if check_findings.find_reading_error(checked_project.findings) is not None:
        command_support.print_findings_above(checked_project, lowest_severity=Severity.ERROR)
        click.echo("No baseline was written: nobody knows what is behind errors of reading. Mend them first.", err=True)
        sys.exit(1)
    with command_support.explain_write_errors():
        update_result = check_findings.update_baseline(
            checked_project, baseline or checked_project.root / check_findings.BASELINE_FILE
        )
    command_support.print_written(
        update_result.path,
        f"{update_result.known_count} known: {update_result.added_count} added, {update_result.cured_count} cured",
    )
    sys.exit(0)
