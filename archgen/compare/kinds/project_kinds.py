"""The project itself, its chapters, partners, use cases and requirements."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.kind_spec import Effect, FeatureSpec, KeySpec, KindSpec, ReadContext
from archgen.compare.kinds.shared_keys import (
    ANNOTATIONS,
    DESCRIPTION,
    NAME_FEATURES,
    TAGS,
    TITLE,
    URLS,
    prose_key,
    text_feature,
)
from archgen.compare.normal_values import freeze_value, normalize_text, unordered_values
from archgen.model.architecture import ProjectInfo, UseCase
from archgen.model.element_annotations import describe_range
from archgen.model.path_resolver import title_from_id
from archgen.model.port_media import ROS
from archgen.model.requirement import Requirement
from archgen.model.review_settings import ReviewSettings
from archgen.model.use_case_steps import StepEnd


def _read_review(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    review = context.architecture.review
    return {
        "main": review.main,
        "breaking": review.breaking and str(review.breaking),
        "backends": unordered_values(review.backends),
        "passes": unordered_values(review.passes),
        **{f"accepted.{name}": "; ".join(texts) for name, texts in _group_accepted(review).items()},
    }


def _read_parameters(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    return {value.name: freeze_value(value.value) for value in context.architecture.ros_parameters}


def _read_declared_properties(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    """Return what is declared of properties: that there is one by its id, what is said of it by `id:key`."""
    values: dict[str, object] = {}
    for name, declared in context.architecture.properties.items():
        values[name] = "declared"
        facets = {
            "title": None if declared.title in {title_from_id(name), name} else declared.title,
            "description": normalize_text(declared.description),
            "of": ", ".join(declared.of) or None,
            "type": declared.type,
            "unit": declared.unit,
            "range": describe_range(declared) or None,
            "choices": ", ".join(declared.choices) or None,
            "required": declared.required or None,
        }
        values |= {f"{name}:{key}": freeze_value(value) for key, value in facets.items() if value is not None}
    return values


def _read_glossary(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    return {each.term: normalize_text(each.text) for each in context.architecture.glossary.values()}


def _read_site(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    repository = context.architecture.repository
    if repository is None:
        return {}
    return {
        "repository": repository.address,
        "branch": repository.branch,
        "folder": repository.folder,
        "forge": repository.forge,
    }


def _group_accepted(review: ReviewSettings) -> Mapping[str, list[str]]:
    """Return what is accepted of each element; several partners may accept the same change."""
    texts_by_element: dict[str, list[str]] = {}
    for entry in review.accepted:
        text = f"{entry.reason} ({entry.key})" if entry.key else entry.reason
        texts_by_element.setdefault(entry.element, []).append(text)
    return texts_by_element


def _read_named(key: str, context: ReadContext, value: str) -> str | None:
    """Return the id or title of the project, None if the project does not write it."""
    return None if key in context.version.unnamed_keys else value


PROJECT = KindSpec(
    "project",
    "Project",
    (
        KeySpec("id", lambda project, context: _read_named("id", context, project.id)),
        KeySpec("title", lambda project, context: _read_named("title", context, project.title), Effect.TEXT),
        KeySpec("version", verb="is version"),
        DESCRIPTION,
        KeySpec(
            "middleware", lambda project, _: None if project.middleware == ROS else project.middleware, Effect.TIMING
        ),
        KeySpec("distro", lambda _, context: context.architecture.distro, noun="ROS distribution"),
        KeySpec("shared_topics", lambda _, context: unordered_values(context.architecture.shared_topics)),
        KeySpec("parameters.", _read_parameters),
        KeySpec("layout", lambda _, context: context.architecture.layout.direction, Effect.TEXT),
        KeySpec("chapters", lambda _, context: context.version.chapter_order),
        KeySpec("review.", _read_review),
        KeySpec("site.", _read_site, Effect.TEXT),
        KeySpec("properties.", _read_declared_properties),
        KeySpec("glossary.", _read_glossary, Effect.TEXT),
        KeySpec("rules.", lambda _, context: context.version.rule_settings),
    ),
    Effect.SYSTEM,
    lambda version: {version.architecture.project.id: version.architecture.project},
)


def _list_chapters(version: ArchitectureVersion) -> Mapping[str, str]:
    return version.chapters


CHAPTER = KindSpec(
    "chapter",
    "Chapters",
    (KeySpec("text", lambda text, _: normalize_text(text), is_prose=True),),
    Effect.TEXT,
    _list_chapters,
)
PARTNER = KindSpec(
    "partner",
    "Partners",
    (
        TITLE,
        DESCRIPTION,
        KeySpec("contact"),
        KeySpec("reviewers", lambda partner, _: unordered_values(partner.reviewers)),
        *ANNOTATIONS,
    ),
    Effect.SYSTEM,
    lambda version: version.architecture.partners,
    (
        *NAME_FEATURES,
        FeatureSpec("owns", 4, lambda relations, partner: frozenset(relations.elements_by_owner[partner.id])),
    ),
    owner=lambda partner, context: context.common_id("partner", partner.id),
)
# Unlike elsewhere the title weighs more than the id: ids of requirements and use cases are mostly numbers.
_NUMBERED_FEATURES = (
    FeatureSpec("name", 1, lambda _, element: letter_pairs(element.id)),
    FeatureSpec("title", 4, lambda _, element: word_set(element.title), lambda element: element.title == element.id),
    text_feature(2, "description"),
)


def _read_steps(use_case: UseCase, context: ReadContext) -> tuple[str, ...]:
    """Return the steps as one line each, with the ids of the second version."""
    return tuple(
        f"{_name_end(step.source, context)} → {_name_end(step.target, context)}"
        + (f": {' '.join(step.say.split())}" if step.say else "")
        for step in use_case.steps
    )


def _name_end(end: StepEnd, context: ReadContext) -> str:
    is_element = end.kind in {"component", "output"}
    return context.matched_ids.common_id(end.kind, end.id) if is_element else end.id


USE_CASE = KindSpec(
    "use_case",
    "Use cases",
    (
        TITLE,
        DESCRIPTION,
        KeySpec(
            "actors.",
            lambda use_case, _: {actor.id: actor.title for actor in use_case.actors.values()},
            noun="actor",
        ),
        KeySpec("steps", _read_steps, list_verbs=("now has the step", "no longer has the step"), noun="steps"),
        *ANNOTATIONS,
    ),
    Effect.TEXT,
    lambda version: version.architecture.use_cases,
    (
        *_NUMBERED_FEATURES,
        FeatureSpec(
            "users",
            3,
            lambda relations, use_case: relations.common_ids(
                "requirement", relations.users_by_element[f"use_case:{use_case.id}"]
            ),
        ),
    ),
    word="use case",
)


def _read_verifications(requirement: Requirement, context: ReadContext) -> frozenset[str]:
    """Return what verifies a requirement; use cases and chains by their common ids."""
    return frozenset(
        str(context.common_id(each.kind, each.text)) if each.kind in {"use_case", "chain"} else each.text
        for each in requirement.verified_by
    )


REQUIREMENT = KindSpec(
    "requirement",
    "Requirements",
    (
        TITLE,
        DESCRIPTION,
        KeySpec(
            "parent",
            lambda requirement, context: context.common_ids("requirement", requirement.parents),
            refers_to="requirement",
            list_verbs=("is now part of", "is no longer part of"),
            new_verb="is part of",
        ),
        KeySpec("kind", noun="kind"),
        KeySpec("priority", noun="priority"),
        prose_key("rationale"),
        KeySpec("source", effect=Effect.TEXT),
        KeySpec(
            "verified_by",
            _read_verifications,
            list_verbs=("is now verified by", "is no longer verified by"),
            new_verb="is verified by",
        ),
        KeySpec(
            "use_cases",
            lambda requirement, context: context.common_ids("use_case", requirement.use_cases),
            refers_to="use_case",
            list_verbs=("now belongs to", "no longer belongs to"),
            new_verb="belongs to",
        ),
        TAGS,
        URLS,
        *ANNOTATIONS,
    ),
    Effect.SYSTEM,
    lambda version: version.architecture.requirements,
    (
        *_NUMBERED_FEATURES,
        FeatureSpec(
            "users",
            3,
            lambda relations, requirement: relations.common_ids(
                "component", relations.users_by_element[f"requirement:{requirement.id}"]
            ),
        ),
    ),
)
PROJECT_KINDS = (PROJECT, CHAPTER, PARTNER, USE_CASE, REQUIREMENT)
