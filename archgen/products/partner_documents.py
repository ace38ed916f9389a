"""From a checked project to what rests on a partner, and what he has to do: for a terminal, as Markdown, for programs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from archgen.diagnostics import format_json
from archgen.emit.data.partner_json import impact_to_json, tasks_to_json
from archgen.emit.terminal.outline_text import write_outline_lines
from archgen.model.architecture import Partner
from archgen.pipeline import CheckedProject
from archgen.products.agreement_documents import make_timed_lookup
from archgen.products.compared_versions import WORKING_TREE_NAME, ProjectVersion, compare_named_versions
from archgen.products.outline_markdown import render_outline_markdown
from archgen.timing.chains.element_index import unknown_name_text
from archgen.views.agreement.exchange_tables import gather_exchanges
from archgen.views.elements import element_names
from archgen.views.lookup import Lookup
from archgen.views.reliance import impact_outline, partner_impact, partner_tasks
from archgen.views.shapes import Outline

DocumentFormat = Literal["text", "markdown", "json"]


class ComponentsError(ValueError):
    """Components that were asked for are none, or are not the partner's; the text says why and what can be done."""


def write_impact(  # noqa: PLR0913 - what may be asked
    checked_project: CheckedProject,
    partner: Partner | None,
    words: Sequence[str],
    form: DocumentFormat,
    *,
    width: int | None = None,
    until: str | None = None,
) -> str:
    """Write what rests on a partner, or on those of his components that words name; without a partner on any components. Of
    the milestones those before a day.

    Raise ComponentsError where a word names no component, or none of his.
    """
    lookup = make_timed_lookup(checked_project)
    late = partner_impact.find_parts_of(lookup, partner) if partner else None
    if words:
        chosen = partner_impact.make_parts(lookup, _find_components(lookup, words))
        if late and not chosen.components <= late.components:
            foreign = ", ".join(sorted(chosen.components - late.components))
            msg = f"`{partner.id if partner else ''}` owns {foreign} not: leave `--partner` away, or name others"
            raise ComponentsError(msg)
        late = chosen
    if late is None:
        raise ComponentsError("name who or what is late: `--partner ID`, `--component ID`")
    impact = partner_impact.find_impact(lookup, gather_exchanges(lookup), late, until=until)
    if form == "json":
        return format_json(impact_to_json(impact))
    return _render_outline(impact_outline.make_impact_outline(lookup, impact), form, width)


def write_tasks(
    checked_project: CheckedProject,
    partner: Partner,
    earlier_version: ProjectVersion | None,
    form: DocumentFormat,
    width: int | None = None,
) -> str:
    """Write what a partner has to do, with what others changed for him since an earlier version."""
    lookup = make_timed_lookup(checked_project)
    exchanges = gather_exchanges(lookup)
    impact = partner_impact.find_impact(lookup, exchanges, partner_impact.find_parts_of(lookup, partner))
    new_version = ProjectVersion(WORKING_TREE_NAME, checked_project)
    comparison = compare_named_versions(earlier_version, new_version) if earlier_version else None
    tasks = partner_tasks.find_tasks(lookup, exchanges, impact, comparison)
    if form == "json":
        return format_json(tasks_to_json(tasks))
    return _render_outline(partner_tasks.make_task_outline(lookup, tasks), form, width)


def _find_components(lookup: Lookup, words: Sequence[str]) -> list[str]:
    names: list[str] = []
    for word in words:
        found = [name for kind, name in element_names.find_elements(lookup, word) if kind in {"component", "composed"}]
        if not found:
            raise ComponentsError(unknown_name_text(word, element_names.kinds_by_id(lookup)))
        names += found
    return names


def _render_outline(outline: Outline, form: DocumentFormat, width: int | None) -> str:
    if form == "markdown":
        return render_outline_markdown(outline)
    return "".join(f"{line}\n" for line in write_outline_lines(outline, width))
