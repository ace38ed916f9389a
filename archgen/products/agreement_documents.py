"""From a checked project to an interface agreement: between whom, since when, in which format, and where to."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from datetime import date
from pathlib import Path
from typing import Literal

from archgen.diagnostics import did_you_mean
from archgen.emit import file_tree
from archgen.emit.picture import Picture
from archgen.frozen import replace
from archgen.git.project_revision import find_revision, find_revision_date
from archgen.link.timing_overrides import apply_overrides
from archgen.model.agreed_terms import Signature, find_agreement
from archgen.model.partner_interfaces import find_interfaces_between
from archgen.pipeline import CheckedProject
from archgen.products import project_views, signed_agreements
from archgen.products.compared_versions import ProjectVersion
from archgen.products.outline_markdown import render_outline_markdown
from archgen.products.output_options import OutputOptions
from archgen.products.product_writing import draw_or_warn
from archgen.timing.analysis import ChainResult
from archgen.timing.chains.measured_comparison import Observation
from archgen.timing.search.chain_budgets import MAX_SHARE_TRIES, SharedBudget, UnknownBudgetError, share_chain_budget
from archgen.timing.search.change_trials import ChangeTrials
from archgen.views import inline_text
from archgen.views.agreement.general_sections import BudgetFinder
from archgen.views.agreement.interface_record import SignedTag
from archgen.views.agreement.partner_agreement import PartnerAgreement, make_agreement
from archgen.views.lookup import Lookup
from archgen.views.picture_shapes import Graph
from archgen.views.shapes import Paragraph
from archgen.views.tables.finding_tables import describe_severities
from archgen.views.timing.timing_lookup import complete_with_chains

AgreementFormat = Literal["docx", "markdown", "html", "json"]
FORMAT_BY_ENDING: Mapping[str, AgreementFormat] = {
    ".docx": "docx",
    ".md": "markdown",
    ".markdown": "markdown",
    ".html": "html",
    ".htm": "html",
    ".json": "json",
}
"""The format by the ending of a file's name."""
_MAX_LISTED = 8
"""At most this many partners are named in a message."""


class PartnersError(ValueError):
    """Two partners cannot have an agreement; the text says why and what can be done."""


def make_project_agreement(  # noqa: PLR0913 - what may be printed instead of what git says
    checked_project: CheckedProject,
    first: str,
    second: str,
    earlier_version: ProjectVersion | None = None,
    printed_revision: str | None = None,
    *,
    issue_date: str | None = None,
    signed_version: ProjectVersion | None = None,
    observations: Sequence[Observation] = (),
    signers: Mapping[str, str] | None = None,
) -> PartnerAgreement:
    """Make the agreement of two partners.

    Changes since `earlier_version` are marked; `printed_revision` and `issue_date` are printed instead of git's last commit
    and its day. `signers` are named where they sign. `observations` stand beside what is promised. `signed_version` is what was signed; without it, that is looked for among the repository's tags. Raise
    PartnersError where there can be no agreement.
    """
    _check_partners(checked_project, first, second)
    signed_tags = signed_agreements.find_signed_tags(checked_project.root, first, second)
    signature = find_agreement(checked_project.architecture.agreements, first, second).binding_signature
    if signed_version is None:
        signed_version = signed_agreements.read_last_signed(checked_project, signature, signed_tags)
    is_recorded = signature is not None and signed_version is not None and signed_version.commit == signature.revision
    is_readable = signed_version is not None and not signed_version.checked_project.structural_errors
    earlier_revision = (
        (earlier_version.title, make_timed_lookup(earlier_version.checked_project)) if earlier_version else None
    )
    signed_revision = None
    if signed_version and is_readable:
        is_earlier = signed_version is earlier_version
        signed_revision = (
            earlier_revision
            if is_earlier
            else (signed_version.title, make_timed_lookup(signed_version.checked_project))
        )
    lookup = make_timed_lookup(checked_project)
    partner_agreement = make_agreement(
        lookup,
        first,
        second,
        revision=find_revision(checked_project.root, checked_project.input_files)
        if printed_revision is None
        else printed_revision,
        earlier_revision=earlier_revision,
        issue_date=find_revision_date(checked_project.root, checked_project.input_files)
        if issue_date is None
        else issue_date,
        signed_tags=signed_tags,
        signed_revision=signed_revision,
        signed_rules=signature.rules if signature and is_recorded else 1,
        notices=(
            *_error_notices(checked_project, earlier_version),
            *([] if is_readable or not (signature or signed_tags) else [_unreadable_notice(signature, signed_tags)]),
        ),
        find_budget=_make_budget_finder(lookup),
        observations=observations,
        signers=signers,
        standing=checked_project.steps,
        variants={name: make_timed_lookup(variant) for name, variant in checked_project.variants.items()},
    )
    # Without interfaces there may still be removed ones to agree on.
    if not partner_agreement.interface_count and not (
        partner_agreement.changes and partner_agreement.changes.removed_records
    ):
        raise PartnersError(_explain_no_interfaces(checked_project, first, second))
    return partner_agreement


def parse_issue_date(text: str) -> str:
    """Return a day as `2026-03-31`, if it is one. Raise ValueError with what to write."""
    try:
        # Other forms that Python reads (20260331, 2026-W14) are not what people write below a contract.
        is_day = len(text) == len("2026-03-31") and date.fromisoformat(text).isoformat() == text
    except ValueError:
        is_day = False
    if not is_day:
        raise ValueError(f"`{text}` is no date: write year, month and day, such as 2026-03-31")
    return text


def make_timed_lookup(checked_project: CheckedProject) -> Lookup:
    """Build the look-ups of the whole project, with timing."""
    return replace(
        project_views.make_scoped_lookup(checked_project, OutputOptions()),
        timing=complete_with_chains(checked_project.analysis, checked_project.architecture),
    )


def _make_budget_finder(lookup: Lookup) -> BudgetFinder:
    """Return what finds the budget of a chain of a project."""

    def find_budget(result: ChainResult) -> SharedBudget | None:
        if lookup.timing is None:
            return None
        trials = ChangeTrials(lookup.architecture, lookup.timing.analysis, apply_overrides, MAX_SHARE_TRIES)
        try:
            return share_chain_budget(trials, result)
        except UnknownBudgetError:
            return None

    return find_budget


def _check_partners(checked_project: CheckedProject, first: str, second: str) -> None:
    """Raise PartnersError unless both ids are declared and different."""
    partners = checked_project.architecture.partners
    if not partners:
        msg = "the project has no partners: declare them below `partners`, and name them as `owner` of groups or components"
        raise PartnersError(msg)
    for name in (first, second):
        if name not in partners:
            guess = did_you_mean(name, partners)
            available_names = ", ".join(list(partners)[:_MAX_LISTED]) + (", ..." if len(partners) > _MAX_LISTED else "")
            raise PartnersError(f"there is no partner `{name}`; {guess or f'there are {available_names}'}")
    if first == second:
        raise PartnersError(f"an agreement is between two partners, and `{first}` was given twice")


def _explain_no_interfaces(checked_project: CheckedProject, first: str, second: str) -> str:
    """Explain that two partners share no interface, and with whom they do."""
    architecture = checked_project.architecture
    owners = [item.owners for item in architecture.components.values()] + [
        item.owners for item in architecture.nodes.values()
    ]
    # A partner without elements is the more basic reason, so it is named before neighbours are searched.
    for name in (first, second):
        if not any(name in item for item in owners):
            return f"nothing flows between `{first}` and `{second}`: `{name}` owns no component and no node"
    lookup, sentences = project_views.make_scoped_lookup(checked_project, OutputOptions()), []
    for name in (first, second):
        neighbours = [
            partner_id
            for partner_id in architecture.partners
            if partner_id != name and find_interfaces_between(lookup.architecture, name, partner_id)
        ]
        sentences.append(f"`{name}` has interfaces with {', '.join(neighbours) or 'nobody'}")
    return f"nothing flows between `{first}` and `{second}`; {'; '.join(sentences)}"


def _error_notices(checked_project: CheckedProject, earlier_version: ProjectVersion | None) -> Iterator[Paragraph]:
    for version_suffix, noticed_project in (
        ("", checked_project),
        *(((f" at {earlier_version.title}", earlier_version.checked_project),) if earlier_version else ()),
    ):
        if noticed_project.has_errors:
            message = f"The architecture{version_suffix} has errors ({describe_severities(noticed_project.findings)}). What is sound is shown all the same."
            yield Paragraph(inline_text.to_inlines(message), "error")


def _unreadable_notice(signature: Signature | None, signed_tags: Sequence[SignedTag]) -> Paragraph:
    tag_name = signature.tag if signature else signed_tags[0].name
    message = f"What was signed at {tag_name} cannot be read, so nothing is said of its versions."
    return Paragraph(inline_text.to_inlines(message), "warning")


def render_agreement_text(partner_agreement: PartnerAgreement, agreement_format: AgreementFormat) -> str:
    """Write an agreement as Markdown or JSON."""
    if agreement_format == "markdown":
        return render_outline_markdown(partner_agreement.outline, (partner_agreement.graph,))
    from archgen.emit.data.agreement_json import write_agreement_json

    return write_agreement_json(partner_agreement.content)


def render_agreement_html(partner_agreement: PartnerAgreement, options: OutputOptions) -> bytes:
    """Write an agreement as one self-contained HTML page."""
    from archgen.emit.site import standalone_page

    return standalone_page.write_standalone_page(
        partner_agreement.outline, _draw_graph(partner_agreement.graph, ("svg",), options)
    )


def render_agreement_docx(partner_agreement: PartnerAgreement, options: OutputOptions) -> bytes:
    """Write an agreement as a Word document."""
    from archgen.emit import docx as emitter

    pictures = _draw_graph(partner_agreement.graph, ("png", "svg_outlines"), options)
    # An agreement has no chapters, hence no pictures of chapters.
    document, warnings = emitter.write(partner_agreement.outline, pictures, chapter_files=lambda _path: None)
    for warning in warnings:
        options.warn(warning)
    return document


def _draw_graph(graph: Graph, formats: tuple[str, ...], options: OutputOptions) -> Mapping[str, Picture]:
    return draw_or_warn((graph,), formats, options)


def write_agreement(
    partner_agreement: PartnerAgreement,
    agreement_format: AgreementFormat,
    target: Path,
    options: OutputOptions | None = None,
) -> None:
    """Write an agreement into a file."""
    options = options or OutputOptions()
    if agreement_format in {"markdown", "json"}:
        document = render_agreement_text(partner_agreement, agreement_format).encode()
    else:
        render = render_agreement_html if agreement_format == "html" else render_agreement_docx
        document = render(partner_agreement, options)
    file_tree.write_file(target, document)
