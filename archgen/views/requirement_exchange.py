"""The requirements of a project as other tools take them over: objects, a tree, relations."""

from __future__ import annotations

from collections.abc import Collection

from archgen.frozen import dataclass
from archgen.model.requirement import Requirement
from archgen.model.requirement_tree import walk_tree
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
    )
