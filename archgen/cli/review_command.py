"""`archgen review`: what the review of a change needs, in one folder. A CI job calls it, and so may you."""

from __future__ import annotations

import functools
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, finding_documents, shared_options
from archgen.diagnostics import Severity, make_visible, sort_gravest_first
from archgen.frozen import replace
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject, VersionCache
    from archgen.products.check_findings import ReportedFindings
    from archgen.products.reviewed_change import ReviewedChange
    from archgen.products.trusted_backends import TrustedRevision

REVIEW_FOLDER = "archgen-out/review"


@click.command("review")
@functools.partial(shared_options.project_argument, envvar="ARCHGEN_PROJECT")
@click.option(
    "--base",
    metavar="REV",
    envvar="ARCHGEN_BASE",
    help="Say what changed since the branch left this revision (in a workflow: the branch that is merged into).",
)
@click.option("--strict", is_flag=True, envvar="ARCHGEN_STRICT", help="Count warnings as errors in the exit status.")
@click.option(
    "--baseline",
    metavar="FILE",
    type=click.Path(path_type=Path, exists=True, dir_okay=False),
    envvar="ARCHGEN_BASELINE",
    help="Keep the findings that FILE knows quiet.",
)
@click.option(
    "--all-findings",
    is_flag=True,
    envvar="ARCHGEN_ALL_FINDINGS",
    help="With --base, print old findings too, not only what the change brings and what makes the check fail.",
)
@click.option(
    "--build/--no-build",
    default=True,
    envvar="ARCHGEN_BUILD",
    help="Make report, site, diagrams and packed file too.  [default: build]",
)
@click.option(
    "--backend",
    metavar="NAME",
    multiple=True,
    envvar="ARCHGEN_BACKENDS",
    help="Make this backend's output too. With --base, the project's own run only if `review.backends` of REV names them and their folders are as in REV.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, file_okay=False),
    envvar="ARCHGEN_OUTPUT",
    help=f"The folder to write to.  [default: {REVIEW_FOLDER} in the project]",
)
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    base: str | None,
    strict: bool,
    baseline: Path | None,
    all_findings: bool,
    build: bool,
    backend: tuple[str, ...],
    output: Path | None,
) -> None:
    """Check PROJECT, say what a change of it means, and make its outputs: all that a reviewer needs, in one folder.

    It prints findings, as annotations in a workflow of GitHub: with --base what the change breaks and what is new, and of the
    rest only what makes the check fail. It writes findings.sarif and findings.xml (JUnit) with all findings and, with
    --base, comment.md (for the pull request), diff.json and diff.html; below outputs/ the report, the site, the diagrams and
    the packed file. Every option can be set by the environment: ARCHGEN_PROJECT, ARCHGEN_BASE, ARCHGEN_STRICT and so on.

    The exit status is 0 if all is well, 1 with errors or with a breaking change that the project does not accept, 2 for
    wrong usage; where the change cannot be compared, comment.md says why.
    """
    from archgen.pipeline import VersionCache
    from archgen.products import check_findings
    from archgen.views.changes.breaking_verdict import describe_obstacle

    version_cache = VersionCache()
    with _explain_in_comment(output or (project or Path()) / REVIEW_FOLDER, base):
        checked_project = command_support.check_or_exit(project, version_cache)
    target = output or checked_project.root / REVIEW_FOLDER
    reported = check_findings.report_findings(checked_project, baseline)
    try:
        with _explain_in_comment(target, base):
            merge_target = _find_merge_target(project, base)
            trusted_revision = (
                command_support.find_trusted_revision(project, merge_target, version_cache) if build else None
            )
            change = (
                _compare_change(checked_project, project, merge_target, target, version_cache) if merge_target else None
            )
    except click.UsageError:
        # The change cannot be judged: what was found is worth its files and annotations all the same.
        _write_findings(reported, checked_project, target, strict=strict)
        _print_review_findings(reported, checked_project, strict=strict)
        raise
    breaks = (*change.breaks, *change.code.differences) if change else ()
    for obstacle in change.code.obstacles if change else ():
        command_support.print_warning(obstacle)
    whole_report = replace(reported, findings=(*breaks, *reported.findings))
    _print_review(change if not all_findings else None, whole_report, checked_project, baseline, strict=strict)
    if change and (obstacle := describe_obstacle(change.comparison)):
        # Under `error` this alone makes the job fail.
        command_support.print_warning(obstacle)
    _write_findings(whole_report, checked_project, target, strict=strict)
    with command_support.explain_write_errors():
        if change:
            _write_comparison(change, target)
        if build:
            _build_outputs(checked_project, target / "outputs", backend, trusted_revision)
    is_refused = change.comparison.is_refused if change else bool(merge_target) and _refuses_breaks(checked_project)
    sys.exit(command_support.exit_status(whole_report.findings, strict=strict) | int(is_refused))


@contextmanager
def _explain_in_comment(target: Path, base: str | None) -> Iterator[None]:
    """Write why a change cannot be judged into comment.md: the job that posts it would fail without the file."""
    try:
        yield
    except click.UsageError as error:
        if base:
            with command_support.explain_write_errors():
                _write_unjudged(target, error.message)
        raise


def _refuses_breaks(checked_project: CheckedProject) -> bool:
    """Whether the project's policy is to fail: then it fails, too, where nobody can say what a change breaks."""
    policy = checked_project.architecture.review.breaking
    return policy is not None and policy.gravest is Severity.ERROR


def _write_unjudged(target: Path, reason: str) -> None:
    from archgen.emit.markdown.comparison_markdown import write_unjudged_markdown

    comment = write_unjudged_markdown(reason)
    _write_document(target / "comment.md", comment)
    _add_to_summary(comment)


def _find_merge_target(project: Path | None, base: str | None) -> str | None:
    """Return the revision that the change is merged into, or None. What cannot be found is wrong usage."""
    from archgen import git
    from archgen.forge.reviewed_request import find_reviewed_request
    from archgen.products.reviewed_change import find_merge_target

    with command_support.explain_wrong_usage(git.GitError):
        return find_merge_target(project, base, find_reviewed_request()) if base else None


def _compare_change(
    checked_project: CheckedProject, project: Path | None, merge_target: str, target: Path, version_cache: VersionCache
) -> ReviewedChange | None:
    """Compare with what the change is merged into; None where the project did not exist there, which the comment says.

    What cannot be compared is wrong usage.
    """
    from archgen import git
    from archgen.forge.reviewed_request import find_request_authors, find_reviewed_request
    from archgen.products.reviewed_change import compare_change
    from archgen.project import NotAtRevisionError
    from archgen.project.project_tracking import UnclearMoveError

    try:
        request, authors = find_reviewed_request(), find_request_authors()
        return compare_change(checked_project, project, merge_target, request, version_cache, authors)
    except UnclearMoveError as error:
        # The policy of the project that it was is not known, and the branch's own cannot be trusted.
        raise click.UsageError(make_visible(str(error))) from None
    except NotAtRevisionError as error:
        reason = f"{error}: there is nothing to compare with"
    except git.GitError as error:
        raise click.UsageError(make_visible(str(error))) from None
    command_support.print_warning(reason)
    with command_support.explain_write_errors():
        _write_unjudged(target, reason)
    return None


def _write_findings(
    reported_findings: ReportedFindings, checked_project: CheckedProject, target: Path, *, strict: bool
) -> None:
    """Write all findings for code scanning and test reports."""
    with command_support.explain_write_errors():
        for name, form in (("findings.sarif", "sarif"), ("findings.xml", "junit")):
            document = finding_documents.render_findings(form, reported_findings, checked_project, strict=strict)
            _write_document(target / name, document)


def _write_document(path: Path, document: str | bytes) -> None:
    from archgen.emit import file_tree

    file_tree.write_file(path, document if isinstance(document, bytes) else document.encode())
    command_support.print_written(path)


def _write_comparison(change: ReviewedChange, target: Path) -> None:
    """Write what changed, for people, programs and the job's summary."""
    from archgen.emit.markdown.comparison_markdown import add_code_differences
    from archgen.products import comparison_documents

    compared = (change.comparison, change.old_version, change.new_version)
    comment = comparison_documents.render_comparison_markdown(*compared, change.command)
    comment = add_code_differences(comment, change.code.differences)
    _write_document(target / "comment.md", comment)
    _write_document(target / "diff.json", comparison_documents.render_comparison_json(*compared))
    options = OutputOptions(warn=command_support.print_warning)
    _write_document(target / "diff.html", comparison_documents.render_comparison_html(*compared, options))
    _add_to_summary(comment)


def _add_to_summary(comment: str) -> None:
    """Add a comment to the summary of GitHub's job."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if summary:
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(comment)


def _build_outputs(
    checked_project: CheckedProject, target: Path, backends: tuple[str, ...], trusted_revision: TrustedRevision | None
) -> None:
    """Build the outputs of what is sound; they do not decide the status."""
    from archgen.products import full_build
    from archgen.products.product_inputs import ProductInputs

    output_options = OutputOptions(
        progress=command_support.make_progress_printer(),
        warn=command_support.print_warning,
        trusted_revision=trusted_revision,
    )
    trusted_names = _drop_untrusted(checked_project, backends, trusted_revision)
    products = full_build.choose_products(checked_project, (), trusted_names, trusted_revision)
    full_build.build_outputs(
        ProductInputs(checked_project, output_options), products, target, command_support.print_written
    )


def _drop_untrusted(
    checked_project: CheckedProject, backends: tuple[str, ...], trusted_revision: TrustedRevision | None
) -> list[str]:
    """Return the backends that may run; warn of the others: a change of a backend must not cost its review the rest."""
    from archgen.products.backend_choice import choose_backends
    from archgen.products.trusted_backends import UntrustedBackendError

    trusted_names = []
    for name in backends:
        try:
            choose_backends(checked_project, (name,), "documents", trusted_revision)
        except UntrustedBackendError as error:
            command_support.print_warning(f"{error.message}; {error.help}")
        else:
            trusted_names.append(name)
    return trusted_names


def _print_review(
    change: ReviewedChange | None,
    report: ReportedFindings,
    checked_project: CheckedProject,
    baseline: Path | None,
    *,
    strict: bool,
) -> None:
    """Print a report: of a change what it brings and what fails the check, without one all; count what is left out."""
    shown_report = _choose_shown(change, report, baseline, strict=strict) if change else report
    _print_review_findings(shown_report, checked_project, strict=strict)
    shown_findings = set(shown_report.findings)
    left_out = [finding for finding in report.findings if finding not in shown_findings]
    if left_out:
        counted = command_support.summarise_counts(left_out)
        click.echo(f"not shown, since they were there before: {counted}; `--all-findings` shows all", err=True)


def _print_review_findings(report: ReportedFindings, checked_project: CheckedProject, *, strict: bool) -> None:
    """Print findings, as annotations in a workflow of GitHub."""
    if os.environ.get("GITHUB_ACTIONS"):
        sys.stdout.write(finding_documents.render_findings("github", report, checked_project, strict=strict))
    elif report.findings:
        command_support.print_findings(report.findings, checked_project, sys.stdout)
    else:
        click.echo("no new findings" if report.earlier_findings else "no findings")


def _choose_shown(
    change: ReviewedChange, report: ReportedFindings, baseline: Path | None, *, strict: bool
) -> ReportedFindings:
    """Return what a log shows: breaks, then new findings, then old ones that make the check fail; gravest first in each.

    GitHub shows ten annotations of a kind for each step, so that old ones would hide the new one.
    """
    from archgen.products import check_findings

    old_project = change.old_version.checked_project
    if check_findings.find_reading_error(old_project.findings) is not None:
        # What was there before is not known.
        return report
    new_report = check_findings.report_findings(change.new_version.checked_project, baseline, old_project)
    failing_findings = [finding for finding in report.findings if command_support.exit_status([finding], strict=strict)]
    shown_findings = (
        *change.breaks,
        *change.code.differences,
        *sort_gravest_first(new_report.findings),
        *sort_gravest_first(failing_findings),
    )
    return replace(new_report, findings=tuple(dict.fromkeys(shown_findings)))
