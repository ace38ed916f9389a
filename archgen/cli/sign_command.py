"""`archgen sign`: sign the agreement of two partners: its document, a tag of git, and the file that reviews hold changes against."""

from __future__ import annotations

from pathlib import Path

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible
from archgen.products.output_options import OutputOptions, refuse_leaving_links


@click.command("sign")
@click.argument("first", metavar="PARTNER")
@click.argument("second", metavar="PARTNER")
@click.option(
    "--by",
    "signers",
    nargs=2,
    multiple=True,
    required=True,
    metavar="PARTNER NAME",
    help="Who signs, and for which of the two; twice where both do.",
)
@click.option("--date", "day", metavar="YYYY-MM-DD", help="The day of the signature.  [default: today]")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path, dir_okay=False),
    help="The document to write: .docx, .md, .html or .json.  [default: archgen-out/interfaces/A-B.docx in the project]",
)
@shared_options.project_option
def command(  # noqa: PLR0913 - one for each option
    first: str,
    second: str,
    *,
    signers: tuple[tuple[str, str], ...],
    day: str | None,
    output: Path | None,
    project: Path | None,
) -> None:
    """Sign what flows between two partners, as the last commit has it.

    Writes the document, a tag `signed/A-B/DAY`, and `agreements/A-B.yaml` with the version of each interface. Commit that file and
    push the tag: from then on each review says where a change would leave what both signed. One partner may sign first and
    the other one later; after a change, sign again. `archgen sign certh sssa --by certh "M. Rossi" --by sssa "G. Bianchi"`
    """
    from datetime import datetime

    from archgen.git import GitError
    from archgen.products import agreement_documents, agreement_signing

    form = command_support.choose_format(None, output, agreement_documents.FORMAT_BY_ENDING, "docx")
    checked_project = command_support.check_before_writing(project, keep_going=False)
    options = OutputOptions(progress=command_support.make_progress_printer(), warn=command_support.print_warning)
    with command_support.explain_wrong_usage(
        agreement_documents.PartnersError, agreement_signing.SigningError, GitError, ValueError
    ):
        day = agreement_documents.parse_issue_date(day) if day else datetime.now().astimezone().date().isoformat()
        agreement = agreement_documents.make_project_agreement(
            checked_project, first, second, issue_date=day, signers=dict(signers)
        )
        prepared = agreement_signing.prepare_signature(
            checked_project, (first, second), agreement.content.records, dict(signers), day
        )
        target = output or checked_project.output_folder / "interfaces" / f"{prepared.agreement.id}.{form}"
        with command_support.explain_write_errors():
            refuse_leaving_links(checked_project, target)
            agreement_documents.write_agreement(agreement, form, target, options)
            agreement_signing.record_signature(checked_project, prepared)
    command_support.print_written(target)
    command_support.print_written(checked_project.root / prepared.file)
    tag = prepared.signature.tag
    lines = [f"made the tag {tag}: commit {prepared.file}, and `git push origin {tag}`"]
    if prepared.missing_partners:
        lines.append(f"it binds nobody before `{prepared.missing_partners[0]}` has signed, too")
    for line in lines:
        click.echo(make_visible(line), err=True)
