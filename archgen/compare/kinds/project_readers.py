"""How what a project says of itself is read for comparing, and its use cases and requirements."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.kinds.key_spec import ReadContext
from archgen.model.architecture import ProjectInfo, UseCase
from archgen.model.requirement import Requirement
from archgen.model.use_case_steps import StepEnd


def read_project_id(project: ProjectInfo, context: ReadContext) -> str | None:
    """Return the id of the project, None if the project does not write it."""
    return None if "id" in context.version.unnamed_keys else project.id


def read_project_title(project: ProjectInfo, context: ReadContext) -> str | None:
    """Return the title of the project, None if the project does not write it."""
    return None if "title" in context.version.unnamed_keys else project.title


def read_actors(use_case: UseCase, _context: ReadContext) -> Mapping[str, str]:
    """Return the titles of those who take part from outside, by id."""
    return {actor.id: actor.title for actor in use_case.actors.values()}


def read_steps(use_case: UseCase, context: ReadContext) -> tuple[str, ...]:
    """Return the steps as one line each, with the ids of the second version."""
    return tuple(
        f"{_name_end(step.source, context)} → {_name_end(step.target, context)}"
        + (f": {' '.join(step.say.split())}" if step.say else "")
        for step in use_case.steps
    )


def _name_end(end: StepEnd, context: ReadContext) -> str:
    is_element = end.kind in {"component", "output"}
    return context.matched_ids.common_id(end.kind, end.id) if is_element else end.id


def read_verifications(requirement: Requirement, context: ReadContext) -> frozenset[str]:
    """Return what verifies a requirement; use cases and chains by their common ids."""
    return frozenset(
        str(context.common_id(each.kind, each.text)) if each.kind in {"use_case", "chain"} else each.text
        for each in requirement.verified_by
    )
