"""`archgen interfaces`: write what flows between two partners, as a document that both can sign."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.products.output_options import OutputOptions, refuse_leaving_links

if TYPE_CHECKING:
    from archgen.pipeline import CheckedProject
    from archgen.products.agreement_documents import AgreementFormat
    from archgen.products.compared_versions import ProjectVersion
    from archgen.views.agreement.partner_agreement import PartnerAgreement

_AGREEMENT_FORMATS = ("markdown", "html", "docx", "json")


@click.command("interfaces")
@shared_options.project_argument
@shared_options.variant_option
@click.option(
    "--between", "pair", nargs=2, metavar="PARTNER PARTNER", required=True, help="The ids of the two partners."
)
@shared_options.file_option(
    "The file to write; its ending (.docx, .md, .html, .json) says the format.  [default: Markdown to the terminal, else "
    "archgen-out/interfaces/ in the project]"
)
@click.option(
    "--format",
    "form",
    type=click.Choice(_AGREEMENT_FORMATS),
    help="The format, where the file's ending does not say it.",
)
@click.option("--since", metavar="REV", help="Mark what changed since a git revision (or a folder or packed file).")
@click.option(
    "--signed",
    metavar="REV",
    help="As --since, with the revision that was signed, such as a tag; end with 1 where terms or promises are others now.",
)
@click.option(
    "--date",
    "issue_date",
    metavar="YYYY-MM-DD",
    help="The date of issue.  [default: the day of git's last commit of the project, none if files differ from it]",
)
@click.option(
    "--measured",
    "recordings",
    multiple=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Show what was measured beside what is promised: figures, a trace, a bag or log as for `archgen timing --measured`.",
)
@shared_options.revision_option
@shared_options.keep_going_option
def command(  # noqa: PLR0913 - one for each option
    *,
    project: Path | None,
    pair: tuple[str, str],
    output: Path | None,
    form: AgreementFormat | None,
    since: str | None,
    signed: str | None,
    issue_date: str | None,
    recordings: tuple[Path, ...],
    revision: str | None,
    keep_going: bool,
) -> None:
    """Write the interface agreement of two partners of PROJECT: what flows between them, both ways.

    Each topic, service and action with its version, its message, what is promised and what is only expected of it, chains,
    requirements, open points, and who serves and who reads it. `archgen interfaces --between certh sssa -o certh-sssa.docx`
    """
    from archgen.cli import measured_recordings
    from archgen.products import agreement_documents

    if since and signed:
        raise click.UsageError("--signed marks what changed as --since does: give one of them")
    form = command_support.choose_format(form, output, agreement_documents.FORMAT_BY_ENDING, "markdown")
    if issue_date is not None:
        issue_date = _check_date(issue_date)
    checked_project = command_support.check_before_writing(project, keep_going=keep_going)
    earlier_version = _read_earlier(since, "--since", checked_project, project) if since else None
    if signed:
        earlier_version = _read_earlier(signed, "--signed", checked_project, project)
    observations = measured_recordings.read_recorded_files(checked_project, recordings) if recordings else ()
    with command_support.explain_wrong_usage(agreement_documents.PartnersError):
        agreement = agreement_documents.make_project_agreement(
            checked_project,
            *pair,
            earlier_version,
            revision,
            issue_date=issue_date,
            signed_version=earlier_version if signed else None,
            observations=observations,
        )
    output_options = OutputOptions(progress=command_support.make_progress_printer(), warn=command_support.print_warning)
    with command_support.explain_write_errors():
        if form in {"markdown", "json"} and output is None:
            sys.stdout.write(agreement_documents.render_agreement_text(agreement, form))
            _exit_by_terms(checked_project, agreement, earlier_version if signed else None)
        endings = {"markdown": "md", "html": "html", "docx": "docx", "json": "json"}
        target = output or checked_project.output_folder / "interfaces" / f"{pair[0]}-{pair[1]}.{endings[form]}"
        refuse_leaving_links(checked_project, target)
        agreement_documents.write_agreement(agreement, form, target, output_options)
    command_support.print_written(
        target, f"{agreement.interface_count} interfaces" if agreement.interface_count != 1 else "1 interface"
    )
    _exit_by_terms(checked_project, agreement, earlier_version if signed else None)


def _check_date(text: str) -> str:
    from archgen.products.agreement_documents import parse_issue_date

    try:
        return parse_issue_date(text)
    except ValueError as error:
        raise click.UsageError(make_visible(f"--date: {error}")) from None


def _exit_by_terms(
    checked_project: CheckedProject, agreement: PartnerAgreement, signed_version: ProjectVersion | None
) -> NoReturn:
    """End with the status of the findings; with 1 where terms are not as signed, which is said on the error stream."""
    from archgen.git.project_revision import find_revision
    from archgen.views.agreement.signed_terms import has_departures, list_launch_notes, write_verdict

    if signed_version is None or agreement.changes is None:
        command_support.exit_by_findings(checked_project)
    _refuse_unsound(signed_version.checked_project, f"at {signed_version.title}")
    _refuse_unsound(checked_project, "now")
    if find_revision(checked_project.root, checked_project.input_files).endswith("+"):
        click.echo("note: this is about the working tree, which has changes that are not committed", err=True)
    for line in write_verdict(agreement.changes):
        click.echo(make_visible(line), err=True)
    for note in list_launch_notes(agreement.content):
        command_support.print_warning(note)
    sys.exit(1 if has_departures(agreement.changes) else command_support.exit_status(checked_project.findings))


def _refuse_unsound(checked_project: CheckedProject, when: str) -> None:
    """End with 1 where a state cannot be read whole, and say what is wrong with it first."""
    if checked_project.structural_errors:
        error = checked_project.structural_errors[0]
        reason = f"{error.span.file}:{error.span.line}: {error.message}"
        message = f"cannot be judged: the architecture cannot be read whole {when} ({reason})"
        click.echo(make_visible(message), err=True)
        sys.exit(1)


def _read_earlier(revision: str, option: str, checked_project: CheckedProject, project: Path | None) -> ProjectVersion:
    """Read the project as it was. A revision that cannot be read is wrong usage."""
    from archgen.git import GitError
    from archgen.products.signed_agreements import read_agreed_version
    from archgen.project import ProjectNotFoundError

    try:
        return read_agreed_version(revision, checked_project, project)
    except (GitError, ProjectNotFoundError) as error:
        raise click.UsageError(make_visible(f"{option}: {error}")) from None
