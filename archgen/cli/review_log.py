"""What the log of a review shows: why a job is red, and what is new, before all else."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, finding_documents
from archgen.diagnostics.diagnostic import sort_gravest_first

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.products.check_findings import ReportedFindings
    from archgen.products.reviewed_change import ReviewedChange


def print_review(
    change: ReviewedChange | None,
    report: ReportedFindings,
    checked_project: CheckedProject,
    baseline: Path | None,
    *,
    strict: bool,
) -> None:
    """Print a report: of a change what it brings and what fails the check, without one all; count what is left out."""
    shown_report = _choose_shown(change, report, baseline, strict=strict) if change else report
    print_review_findings(shown_report, checked_project, strict=strict)
    shown_findings = set(shown_report.findings)
    left_out = [finding for finding in report.findings if finding not in shown_findings]
    if left_out:
        counted = command_support.summarise_counts(left_out)
        click.echo(f"not shown, since they were there before: {counted}; `--all-findings` shows all", err=True)


def print_review_findings(report: ReportedFindings, checked_project: CheckedProject, *, strict: bool) -> None:
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
        *sort_gravest_first(new_report.findings),
        *sort_gravest_first(failing_findings),
    )
    return replace(new_report, findings=tuple(dict.fromkeys(shown_findings)))
