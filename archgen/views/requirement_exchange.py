"""The requirements of a project as other tools take them over: objects, a tree, relations."""

from __future__ import annotations

from collections.abc import Collection, Mapping

from archgen.frozen import dataclass
from archgen.model.requirement import Requirement, walk_tree
from archgen.views.lookup import Lookup
from archgen.views.requirement_servers import list_server_words
from archgen.views.tables.requirement_tables import shown_requirements


@dataclass(frozen=True, slots=True)
class ExchangedRequirement:
    """A requirement with what verifies it, as (kind, text), and what serves it, in words."""

    id: str
    title: str
    description: str
    kind: str
    priority: str
    rationale: str
    source: str
    tags: tuple[str, ...]
    parents: tuple[str, ...]
    use_cases: tuple[str, ...]
    verified_by: tuple[tuple[str, str], ...]
    served_by: str
    state: str
    foreign_identifier: str = ""
    """What the other tool calls its object, empty where it comes from none."""
    foreign_id: str = ""
    """The id that people read in the other tool, where it is another one than here."""


@dataclass(frozen=True, slots=True)
class RequirementExchange:
    """Requirements in their order, the tree as (id, depth), and the titles of the use cases that they name."""

    project_id: str
    title: str
    requirements: tuple[ExchangedRequirement, ...]
    tree: tuple[tuple[str, int], ...]
    use_cases: tuple[tuple[str, str], ...]


def make_requirement_exchange(lookup: Lookup) -> RequirementExchange:
    """Return the requirements that are shown, without parents and parts that are not."""
    architecture = lookup.architecture
    shown = {requirement.id: requirement for requirement in shown_requirements(lookup)}
    named_cases = {name for each in shown.values() for name in each.use_cases}
    named_cases |= {v.text for each in shown.values() for v in each.verified_by if v.kind == "use_case"}
    return RequirementExchange(
        architecture.project.id,
        architecture.project.title,
        tuple(_exchange_requirement(lookup, requirement, shown.keys()) for requirement in shown.values()),
        tuple((row.id, row.depth) for row in walk_tree(shown)),
        tuple((each.id, each.title) for each in architecture.use_cases.values() if each.id in named_cases),
    )


def _exchange_requirement(lookup: Lookup, requirement: Requirement, shown_ids: Collection[str]) -> ExchangedRequirement:
    return ExchangedRequirement(
        requirement.id,
        requirement.title,
        requirement.description or "",
        requirement.kind or "",
        requirement.priority or "",
        requirement.rationale or "",
        requirement.source or "",
        requirement.tags,
        tuple(parent for parent in requirement.parents if parent in shown_ids),
        requirement.use_cases,
        tuple((each.kind, each.text) for each in requirement.verified_by),
        "; ".join(list_server_words(lookup, requirement)),
        lookup.requirement_trace.judge(requirement.id),
        _read_hint(requirement, "identifier"),
        _read_hint(requirement, "id"),
    )


def _read_hint(requirement: Requirement, key: str) -> str:
    """Return what an import noted of the other tool: a word in the hints of the requirement."""
    hints = requirement.annotations.hints.get("reqif")
    name = hints.get(key) if isinstance(hints, Mapping) else None
    # Whoever writes `id: 12` by hand means the text.
    return "" if name is None or isinstance(name, (list, dict)) else str(name)
