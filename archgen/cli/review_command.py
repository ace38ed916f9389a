"""`archgen review`: what the review of a change needs, in one folder. A CI job calls it, and so may you."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, finding_documents
from archgen.diagnostics.safe_text import make_visible

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.products.check_findings import ReportedFindings
    from archgen.products.trusted_backends import TrustedRevision

REVIEW_FOLDER = "archgen-out/review"


@click.command("review")
@click.argument("project", required=False, type=click.Path(path_type=Path), envvar="ARCHGEN_PROJECT")
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
    build: bool,
    backend: tuple[str, ...],
    output: Path | None,
) -> None:
    """Check PROJECT, say what a change of it means, and make its outputs: all that a reviewer needs, in one folder.

    It prints the findings, as annotations in a workflow of GitHub, and writes findings.sarif, findings.xml (JUnit) and, with
    --base, comment.md (for the pull request), diff.json and diff.html; below outputs/ the report, the site, the diagrams and
    the packed file. Every option can be set by the environment: ARCHGEN_PROJECT, ARCHGEN_BASE, ARCHGEN_STRICT and so on.

    The exit status is 0 if all is well, 1 with errors or with a breaking change that the project does not accept, 2 for
    wrong usage.
    """
    from archgen.products import check_findings

    checked_project = command_support.check_or_exit(project)
    target = output or checked_project.root / REVIEW_FOLDER
    merge_target = _find_merge_target(base)
    trusted_revision = command_support.read_trusted_revision(project, merge_target)
    reported = check_findings.report_findings(checked_project, baseline)
    exit_status = command_support.exit_status(reported.findings, strict=strict)
    _print_findings(reported, checked_project, strict=strict)
    with command_support.explain_write_errors():
        for name, form in (("findings.sarif", "sarif"), ("findings.xml", "junit")):
            _write_document(
                target / name, finding_documents.render_findings(form, reported, checked_project, strict=strict)
            )
        if merge_target:
            # `REV...` is where the branch left REV. The first parent of GitHub's merge commit needs no dots:
            # HEAD has all of it.
            start = merge_target if merge_target != base else f"{base}..."
            exit_status |= _write_comparison(project, start, target, checked_project)
        if build:
            exit_status |= _build_outputs(checked_project, target / "outputs", backend, trusted_revision)
    sys.exit(exit_status)


def _find_merge_target(base: str | None) -> str | None:
    """Return the revision that the change is merged into, or None.

    GitHub makes a merge commit of a pull request: its first parent is that revision, and what the event names as base
    may be older.
    """
    merge_ref = re.fullmatch(r"refs/pull/\d+/merge", os.environ.get("GITHUB_REF", ""))
    return "HEAD^1" if base and merge_ref else base or None


def _print_findings(reported_findings: ReportedFindings, checked_project: CheckedProject, *, strict: bool) -> None:
    if os.environ.get("GITHUB_ACTIONS"):
        sys.stdout.write(finding_documents.render_findings("github", reported_findings, checked_project, strict=strict))
    elif reported_findings.findings:
        command_support.print_findings(reported_findings.findings, checked_project, sys.stdout)
    else:
        click.echo("no findings")


def _write_document(path: Path, document: str | bytes) -> None:
    from archgen.emit import file_tree

    file_tree.write_file(path, document if isinstance(document, bytes) else document.encode())
    command_support.print_written(path)


def _write_obstacle(checked_project: CheckedProject, obstacle: str, target: Path) -> int:
    """Say in the comment why nothing can be compared. Return the exit status that the project's policy asks for."""
    from archgen.diagnostics.diagnostic import Severity
    from archgen.emit.markdown.comment_sentences import write_sentence

    command_support.print_warning(obstacle)
    comment = f"### Cannot be judged\n\n{write_sentence(obstacle)}\n"
    _write_document(target / "comment.md", comment)
    _add_summary(comment)
    return int(checked_project.architecture.review.breaking is Severity.ERROR)


def _add_summary(comment: str) -> None:
    """Add a comment to the summary of a job of GitHub."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if summary:
        with Path(summary).open("a", encoding="utf-8") as stream:
            stream.write(comment)


def _write_comparison(project: Path | None, start: str, target: Path, checked_project: CheckedProject) -> int:
    """Write what changed. Return the exit status that the project's policy asks for."""
    from archgen import git
    from archgen.products import comparison_documents
    from archgen.products.compared_versions import compare_named_versions, read_versions
    from archgen.products.output_options import OutputOptions
    from archgen.project import NotAtRevisionError

    try:
        old_version, new_version = read_versions(start, None, project)
    except NotAtRevisionError as error:
        return _write_obstacle(checked_project, f"{error}: there is nothing to compare with", target)
    except git.GitError as error:
        raise click.UsageError(make_visible(str(error))) from None
    comparison = compare_named_versions(old_version, new_version)
    comment = comparison_documents.render_comparison_markdown(comparison, old_version, new_version)
    _write_document(target / "comment.md", comment)
    _write_document(
        target / "diff.json",
        comparison_documents.render_comparison_json(comparison, old_version, new_version),
    )
    _write_document(
        target / "diff.html",
        comparison_documents.render_comparison_html(
            comparison, old_version, new_version, OutputOptions(warn=command_support.print_warning)
        ),
    )
    _add_summary(comment)
    return int(comparison.is_refused)


def _build_outputs(
    checked_project: CheckedProject, target: Path, backends: tuple[str, ...], trusted_revision: TrustedRevision | None
) -> int:
    """Build the outputs of what is sound. Return 0: outputs do not decide the status."""
    from archgen.products import full_build
    from archgen.products.output_options import OutputOptions
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
    return 0


def _drop_untrusted(
    checked_project: CheckedProject, backends: tuple[str, ...], trusted_revision: TrustedRevision | None
) -> list[str]:
    """Return the backends that may run; warn of the others: a change of a backend must not cost its review the rest."""
    from archgen.products.backend_products import choose_backends
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
