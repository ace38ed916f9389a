"""The same bytes mean something else: what is said of outputs, types and fields has other words, units among them."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.compare.comparison import Change
from archgen.compare.key_phrases import format_value
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.loss_wording import tick_name
from archgen.compare.losses.lost_connections import find_output_causes
from archgen.compare.losses.message_users import MessageUsers
from archgen.compare.text_meaning import differs_in_meaning, differs_in_measures, quote_difference

_MEASURE_PARAMETER = re.compile(r"^parameters\.(?:.*[._])?(?:frame|frame_id|units?)$")
_COMPONENT_TEXTS = ("functionality", "description")


def find_changed_meanings(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find texts that partners rely on and that say something else, or nothing any more.

    A text where none was tells what was true already; it concerns those who read it, and breaks nobody.
    """
    yield from _find_rewritten_outputs(context)
    yield from _find_rewritten_components(context)
    yield from _find_changed_frames(context)
    yield from _find_rewritten_definitions(context)


def _find_rewritten_outputs(context: ChangeContext) -> Iterator[PartnerLoss]:
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        words = _compare_texts(*_read_texts(context, ("output", output), ("output", new_output), "description"))
        if words:
            indices = context.change_indices("output", new_output, "description") or find_output_causes(context, output)
            reason_text = f"says of {tick_name(context.old_id('output', output))} {words}; {{}} it"
            yield from context.shared_losses(indices, inputs_by_partner, reason_text, "reads", "meaning")


def _find_rewritten_components(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find components whose text gives other units, frames or numbers: only these say what is in their outputs."""
    for component, readers in _inputs_by_component(context).items():
        key = "component", component
        for text_key in _COMPONENT_TEXTS:
            before, after = _read_texts(context, key, key, text_key)
            words = _compare_texts(before, after) if differs_in_measures(before, after) else ""
            if words:
                indices = context.change_indices(*key, text_key)
                reason_text = f"says of {tick_name(component)} {words}; {{}} it"
                yield from context.shared_losses(indices, readers, reason_text, "reads", "meaning")


def _find_changed_frames(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find parameters of nodes and components that name a frame or a unit, and have another value."""
    changes = [
        (index, change)
        for index, change in enumerate(context.changes)
        if change.element_kind in {"node", "component"}
        and change.before is not None
        and _MEASURE_PARAMETER.search(change.key or "")
    ]
    inputs_by_component = _inputs_by_component(context) if changes else {}
    for index, change in changes:
        element = context.versions.elements_before.get(("node", change.element_id))
        readers: dict[str, list[str]] = defaultdict(list)
        for component in element.component_refs if element else ():
            for partner, inputs in inputs_by_component.get(component, {}).items():
                readers[partner] += inputs
        name = tick_name((change.key or "").removeprefix("parameters."))
        values = f"{format_value(change.after) if change.after is not None else 'nothing'} instead of {format_value(change.before)}"
        reason_text = f"sets {name} of {tick_name(change.element_id)} to {values}; {{}} what it sends"
        yield from context.shared_losses([index], readers, reason_text, "reads", "meaning")


def _inputs_by_component(context: ChangeContext) -> Mapping[str, Mapping[str, list[str]]]:
    """Return for each component the inputs of other partners that read its outputs, by partner."""
    inputs_by_component: dict[str, dict[str, list[str]]] = {}
    for output, new_output, inputs_by_partner in context.lasting_outputs:
        if output == new_output:
            readers = inputs_by_component.setdefault(output.rpartition(".")[0], {})
            for partner, inputs in inputs_by_partner.items():
                readers.setdefault(partner, []).extend(inputs)
    return inputs_by_component


def _find_rewritten_definitions(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find comments of types, messages and their fields that say something else, and types with another unit in their
    name.
    """
    users: MessageUsers | None = None
    for index, change in enumerate(context.changes):
        words = _describe_rewriting(context, change)
        if not words:
            continue
        users = users or MessageUsers(context)
        partners = (
            users.partners_using_type(change.element_id)
            if change.element_kind == "type"
            else users.partners_using_message(change.element_id)
        )
        yield from context.losses_of_users([index], partners, f"{words}; {{}} it", "uses", "meaning")


def _describe_rewriting(context: ChangeContext, change: Change) -> str:
    """Return what a change makes of a type or a message in other words; empty if they mean the same."""
    old_id = change.old_id or ""
    if change.kind == "renamed" and change.element_kind == "type" and differs_in_measures(old_id, change.element_id):
        return f"calls {tick_name(change.element_id)} what was {tick_name(old_id)}"
    subject = _commented_subject(context, change)
    before, after = (value if isinstance(value, str) else "" for value in (change.before, change.after))
    words = _compare_texts(before, after) if subject else ""
    return f"says of {subject} {words}" if words else ""


def _commented_subject(context: ChangeContext, change: Change) -> str:
    """Return what the changed comment speaks of; empty where the change is none of a comment, or of what is gone."""
    if change.kind != "changed" or change.element_kind not in {"type", "message"} or not change.key:
        return ""
    name = tick_name(change.element_id)
    if change.key == "comment":
        return name
    section, _, part = change.key.partition(".")
    definition = context.after.interfaces.definitions.get(change.element_id)
    if section != "comments" or definition is None:
        return ""
    present_names = {each.name for group in definition.parts for each in group}
    present_names |= {each.name for group in definition.constants for each in group}
    return f"{tick_name(part)} in {name}" if part.rpartition(".")[2] in present_names else ""


def _read_texts(
    context: ChangeContext, old_key: tuple[str, str], new_key: tuple[str, str], text_key: str
) -> tuple[str, str]:
    old_element = context.versions.elements_before.get(old_key)
    new_element = context.versions.elements_after.get(new_key)
    before, after = (str(each.values.get(text_key) or "") if each else "" for each in (old_element, new_element))
    return before, after


def _compare_texts(before: str, after: str) -> str:
    """Return the old and the new words; empty if nothing was said, or the same is meant."""
    if not before or not differs_in_meaning(before, after):
        return ""
    old_words, new_words = quote_difference(before, after)
    return f"{tick_name(new_words)} instead of {tick_name(old_words)}" if after else f"no longer {tick_name(old_words)}"
