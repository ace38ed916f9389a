"""Types and component types that have another version, or are going away."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.losses.message_users import MessageUsers
from archgen.compare.losses.weakened_words import compare_deprecations
from archgen.model.component import ComponentType
from archgen.model.message_types import ConceptualType
from archgen.model.review_settings import BreakCategory

_Lives = Mapping[str, ConceptualType] | Mapping[str, ComponentType]


def find_deprecated_types(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find types and component types with another version, or that are deprecated now, and the partners who use them."""
    message_users: MessageUsers | None = None
    before, after = context.before, context.after
    pairs: tuple[tuple[str, _Lives, _Lives], ...] = (
        ("type", before.types, after.types),
        ("component_type", before.component_types, after.component_types),
    )
    for kind, old_types, new_types in pairs:
        for name, old in old_types.items():
            common_id = context.matched_ids.common_id(kind, name)
            new = new_types.get(common_id)
            if new is None or (old.version is None and old.deprecated == new.deprecated):
                continue
            for words, key, category in _compare_lives(old, new):
                if kind == "type":
                    message_users = message_users or MessageUsers(context)
                    partners = message_users.partners_using_type(common_id)
                else:
                    partners = _list_instance_owners(context, name)
                indices = context.change_indices(kind, common_id, key) or [
                    index
                    for index, change in context.find_changes(kind, common_id)
                    if change.key and change.key.startswith(key.partition(".")[0])
                ]
                reason_text = f"{words.replace('{}', tick_name(name), 1)}; {{}} it"
                yield from context.losses_of_users(indices, partners, reason_text, "uses", category)


def _compare_lives(
    old: ConceptualType | ComponentType, new: ConceptualType | ComponentType
) -> Iterator[tuple[str, str, BreakCategory]]:
    if old.version is not None and old.version != new.version:
        after = f"the version {tick_name(new.version)}" if new.version else "no version any more"
        yield f"gives {{}} {after} instead of {tick_name(old.version)}", "version", "meaning"
    for weakening in compare_deprecations(old.deprecated, new.deprecated):
        yield weakening.words, weakening.key, weakening.category


def _list_instance_owners(context: ChangeContext, type_name: str) -> list[str]:
    """Return the partners who own instances of a component type, or of types that are made from it, sorted."""
    owners = {
        context.matched_ids.common_id("partner", component.owner)
        for component in context.before.list_described_components()
        if component.owner and any(base.id == type_name for base in context.before.list_bases(component.type_name))
    }
    return sorted(owners)
