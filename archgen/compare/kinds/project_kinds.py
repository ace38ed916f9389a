"""The project itself, its chapters, partners, use cases and requirements."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.element_likeness import letter_pairs, word_set
from archgen.compare.kinds.key_spec import Effect, KeySpec, ReadContext
from archgen.compare.kinds.kind_spec import FeatureSpec, KindSpec, make_section_kind, text_feature, users_feature
from archgen.compare.normal_values import freeze_value, normalize_text, unordered_values
from archgen.frozen import replace
from archgen.model.architecture import ProjectInfo
from archgen.model.element_annotations import describe_range
from archgen.model.path_resolver import title_from_id


def _read_review(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    review = context.architecture.review
    texts_by_element: dict[str, list[str]] = {}
    for entry in review.accepted:
        text = f"{entry.reason} ({entry.key})" if entry.key else entry.reason
        texts_by_element.setdefault(entry.element, []).append(text)
    return {
        "main": review.main,
        "breaking": review.breaking and str(review.breaking),
        "backends": unordered_values(review.backends),
        "passes": unordered_values(review.passes),
        **{f"accepted.{name}": "; ".join(texts) for name, texts in texts_by_element.items()},
    }


def _read_agreements(_project: ProjectInfo, context: ReadContext) -> Mapping[str, object]:
    """Return the terms in words, and under which tag what was signed; what left it is told by itself."""
    values: dict[str, object] = {}
    for agreement in context.architecture.agreements.values():
        terms = {"": agreement.terms, **{f"{key}.": texts for key, texts in agreement.interfaces.items()}}
        values |= {
            f"{agreement.id}.{key}{name}": normalize_text(text)
            for key, texts in terms.items()
            for name, text in texts.items()
        }
        if agreement.signed:
            values[f"{agreement.id}.signed"] = ", ".join(
                [
                    agreement.signed.tag or "without a tag",
                    *(f"{each} by {who}" for each, who in agreement.signed.by.items()),
                ]
            )
    return values


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


# Sections, and parts of sections, that belong to no other element.
_SETTING_KEYS = (
    KeySpec("distro", lambda _, context: context.architecture.distro, noun="ROS distribution"),
    KeySpec(
        "environment.", lambda _, context: {each.name: each.value for each in context.architecture.ros_environment}
    ),
    KeySpec("discovery", lambda _, context: context.architecture.ros_discovery),
    KeySpec("shared_topics", lambda _, context: unordered_values(context.architecture.shared_topics)),
    KeySpec(
        "parameters.",
        lambda _, context: {value.name: freeze_value(value.value) for value in context.architecture.ros_parameters},
    ),
    KeySpec("layout", lambda _, context: context.architecture.layout.direction, Effect.TEXT),
    KeySpec("chapters", lambda _, context: context.version.chapter_order),
    KeySpec("review.", _read_review),
    KeySpec("agreements.", _read_agreements, noun="agreement"),
    KeySpec("site.", _read_site, Effect.TEXT),
    KeySpec("properties.", _read_declared_properties),
    KeySpec(
        "glossary.",
        lambda _, context: {each.term: normalize_text(each.text) for each in context.architecture.glossary.values()},
        Effect.TEXT,
    ),
    KeySpec("rules.", lambda _, context: context.version.rule_settings),
)
PROJECT = KindSpec(
    "project",
    "Project",
    _SETTING_KEYS,
    elements=lambda version: {version.architecture.project.id: version.architecture.project},
)
CHAPTER = KindSpec(
    "chapter",
    "Chapters",
    (KeySpec("text", lambda text, _: normalize_text(text), is_prose=True),),
    Effect.TEXT,
    lambda version: version.chapters,
)
PARTNER = replace(
    make_section_kind(
        "partner",
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
USE_CASE = make_section_kind("use_case", users_feature("use_case", 3, "requirement"), names=_NUMBERED_FEATURES)
REQUIREMENT = make_section_kind("requirement", users_feature("requirement", 3, "component"), names=_NUMBERED_FEATURES)
PROJECT_KINDS = (PROJECT, CHAPTER, PARTNER, USE_CASE, REQUIREMENT)
