"""The wording of a changed key, and what sentences about changes are made of: names in backticks, titles, lists that are cut.

How the fields of a message, service or action changed, from the lines that ROS writes: retyped, renamed, added, removed.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence

from archgen.compare.comparison import Change
from archgen.compare.kinds import ELEMENT_KINDS, find_key
from archgen.compare.kinds.key_readers import NO_DAY
from archgen.compare.text_meaning import cut_text, describe_text_difference
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics import fit_lines, join_words, keep_first
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.node import DEFAULT_PHASE, PHASES

_PART_SEPARATOR = "---"
FieldPlace = tuple[int, str]
"""The part of a service or action, and the field's name."""


class FieldChanges(NamedTuple):
    """What became of fields; `added` and `removed` as lines, the others by name."""

    retyped: Mapping[str, tuple[str, str]]
    """The old and the new type."""
    renamed: Mapping[str, str]
    """The new name: the same type in the same place, and nothing else came or went."""
    added: list[str]
    removed: list[str]


def compare_field_lines(before: object, after: object) -> FieldChanges:
    """Compare the lines of two definitions."""
    old_types, new_types = read_field_types(before), read_field_types(after)
    retyped = {
        place[1]: (old_type, new_types[place])
        for place, old_type in old_types.items()
        if new_types.get(place, old_type) != old_type
    }
    gone = [place for place in old_types if place not in new_types]
    new = [place for place in new_types if place not in old_types]
    renamed: dict[str, str] = {}
    if len(gone) == len(new) and all(
        (old_types[old], [*old_types].index(old), old[0]) == (new_types[place], [*new_types].index(place), place[0])
        for old, place in zip(gone, new, strict=True)
    ):
        renamed = {old[1]: place[1] for old, place in zip(gone, new, strict=True)}
        gone, new = [], []
    return FieldChanges(retyped, renamed, _write_lines(new, new_types), _write_lines(gone, old_types))


def read_field_types(lines: object) -> dict[FieldPlace, str]:
    """Return the types of fields by their places, in the order of the lines."""
    types: dict[FieldPlace, str] = {}
    part = 0
    for line in map(str, lines) if isinstance(lines, (list, tuple)) else ():
        if line == _PART_SEPARATOR:
            part += 1
        else:
            field_type, _, name = line.rpartition(" ")
            types[part, name] = field_type
    return types


def _write_lines(places: Iterable[FieldPlace], types: Mapping[FieldPlace, str]) -> list[str]:
    return [f"{types[place]} {place[1]}" for place in places]


_MAX_LENGTH = 80
_NAMED_SECTIONS = {
    "parameters": "parameter",
    "parameter_commands": "command for the parameter",
    "operations": "operation",
    "constants": "constant",
    "fields": "field",
    "defaults": "default of",
    "comments": "what is said of",
    "callback_groups": "callback group",
    "environment": "environment variable",
    "actors": "actor",
    "scheduling": "order on core",
    "properties": "property",
    "hints": "hint",
    "glossary": "term",
    "accepted": "accepted input",
}
"""What sentences call the keys of a section, by the section."""
_PARTS_OF: Mapping[str, frozenset[str]] = {
    "parameters": frozenset(
        {"type", "unit", "range", "choices", "description", "read_only", "visibility", "from", "hints"}
    ),
    "properties": frozenset({"title", "description", "of", "type", "unit", "range", "choices", "required"}),
    "operations": frozenset({"title", "request", "response", "call", "visibility", "description"}),
}
"""Sections whose keys may be parts of what they name, behind a colon."""
_PARTS_OF_TYPES = {"inputs": "input", "outputs": "output", "components": "component", "node": "node"}
"""What sentences call the parts of a component type, by the section."""
_ACCEPTED_PREFIX = "review.accepted."
_TIMING_SECTIONS = {"calls": "calls of", "uses": "use of"}
"""What sentences call the keys below a key of `timing`, by that key."""


def describe_key_change(change: Change) -> str:
    """Describe how the value of a key changed."""
    key, before, after = change.key or "", change.before, change.after
    kind, spec = ELEMENT_KINDS[change.element_kind], find_key(change.element_kind, key)
    name = f"`{shorten_text(change.element_id)}`"
    subject = name if "." in change.element_id and kind.has_path_id else f"{kind.kind_word} {name}"
    if change.element_kind == "project":
        subject = "the project"
    if isinstance(before, Mapping) and isinstance(after, Mapping):
        values = [f"{_spell_out(name)} {format_value(before[name])} → {format_value(after[name])}" for name in before]
        return f"{subject}: {spec.noun} {join_words(values)}"
    if spec.is_prose and (key == "text" or not (_is_brief(before) and _is_brief(after))):
        phrase = _count_lines(before, after) if key == "text" else _rewrite_phrase(before, after)
        return f"the {_spell_out(key)} of {subject} {phrase}"
    if (
        port_phrase := _deprecation_phrase(change) or _name_new_port(change)
        if change.element_kind == "component_type"
        else _deprecation_phrase(change) or _port_phrase(change, spec.verb)
    ):
        return f"{subject} {port_phrase}"
    if spec.verb and (key == "container" or (before is not None and after is not None)):
        return f"{subject} {_verb_phrase(spec.verb, before, after)}"
    if key == "topic" and (".serves." in change.element_id or ".calls." in change.element_id):
        # What is called a topic in the files is the name of a service or action here.
        noun = "name"
    else:
        noun = _part_noun(change.element_kind, key) or spec.noun or _key_noun(key)
    if isinstance(before, list) or isinstance(after, list):
        fields_phrase = _fields_phrase(before, after) if (change.element_kind, key) == ("message", "fields") else ""
        return subject + (fields_phrase or _list_phrase(noun, spec.list_verbs, before, after))
    return f"{subject}: {_value_phrase(noun, before, after)}{_order_phrase(key, before, after)}"


def _order_phrase(key: str, before: object, after: object) -> str:
    """Return whether another phase of a start-up comes earlier or later; empty for any other key."""
    if key not in {"start.phase", "node.start.phase"}:
        return ""
    places = [PHASES.index(phase) if phase in PHASES else PHASES.index(DEFAULT_PHASE) for phase in (before, after)]
    if places[0] == places[1]:
        return ", as before"
    return ", so earlier than before" if places[1] < places[0] else ", so later than before"


def name_key(kind: str, key: str) -> str:
    """Return what sentences call a key of a kind of element."""
    return _part_noun(kind, key) or find_key(kind, key).noun or _key_noun(key)


def _part_noun(kind: str, key: str) -> str:
    """Return what sentences call what a component type, or a composed component, says of a part; empty for other keys."""
    section, _, path = key.partition(".")
    part_kind = _PARTS_OF_TYPES.get(section) if kind in {"component_type", "composed"} and path else None
    if part_kind is None:
        return ""
    if part_kind == "node":
        return f"{name_key('node', path)} of the node"
    part, _, part_key = path.partition(":")
    return f"{name_key(_inner_kind(part_kind, part_key), part_key or 'type')} of the {part_kind} `{shorten_text(part)}`"


def _name_new_port(change: Change) -> str:
    """Return that a component type has a port now, or no longer; empty for any other key."""
    section, _, name = (change.key or "").partition(".")
    if section not in {"inputs", "outputs"} or not name or ":" in name or None not in {change.before, change.after}:
        return ""
    verb = "now has" if change.before is None else "no longer has"
    return f"{verb} the {_PARTS_OF_TYPES[section]} `{shorten_text(name)}`"


def _inner_kind(part_kind: str, part_key: str) -> str:
    """Return the kind whose words a key takes: a part of a part is named as a type's own part is."""
    is_nested = part_kind == "component" and part_key.partition(".")[0] in _PARTS_OF_TYPES
    return "component_type" if is_nested else part_kind


def _deprecation_phrase(change: Change) -> str:
    """Return that something is going away now, or stays; empty for any other change."""
    if change.key != "deprecated.until" or None not in {change.before, change.after}:
        return ""
    if change.after is None:
        return f"is no longer deprecated (it was, {_until_phrase(change.before)})"
    return f"is deprecated now, {_until_phrase(change.after)}"


def _until_phrase(last_day: object) -> str:
    return "without a day" if last_day == NO_DAY else f"until {format_value(last_day)}"


def _verb_phrase(verb: str, before: object, after: object) -> str:
    if after is None:
        return f"no longer {verb} {format_value(before)}"
    return f"now {verb} {_instead_phrase(before, after, '')}"


def _port_phrase(change: Change, verb: str) -> str:
    """Return what a port carries, or whether it may stay without a source; empty for any other key."""
    if change.element_kind not in {"input", "output"} or change.key not in {"type", "optional"}:
        return ""
    if change.key == "optional":
        return "is optional now" if change.after else "is no longer optional"
    return f"now {verb} {_instead_phrase(change.before, change.after, 'nothing named')}"


def _key_noun(key: str) -> str:
    if key.startswith("rules."):
        rule, _, option = key.removeprefix("rules.").partition(".")
        return f"`{option}` of the rule `{rule}`" if option else f"severity of the rule `{rule}`"
    if key.startswith(_ACCEPTED_PREFIX):
        return f"what is accepted of `{shorten_text(key.removeprefix(_ACCEPTED_PREFIX))}`"
    if key.startswith("timing."):
        timing_key, _, part = key.removeprefix("timing.").partition(".")
        if timing_key in _TIMING_SECTIONS and part:
            return f"{_TIMING_SECTIONS[timing_key]} `{shorten_text(part)}`"
    section, _, name = key.removeprefix("start.").partition(".")
    if section in _PARTS_OF and name.rpartition(":")[2] in _PARTS_OF[section]:
        element_name, _, part = name.rpartition(":")
        return f"{_spell_out(part)} of the {_NAMED_SECTIONS[section]} `{shorten_text(element_name)}`"
    if section in _NAMED_SECTIONS and name and (section, name[:5]) != ("scheduling", "fair."):
        return f"{_NAMED_SECTIONS[section]} `{shorten_text(name)}`"
    return _spell_out(key.removeprefix("timing.").replace(".", " "))


def _spell_out(key: str) -> str:
    return shorten_text(key).replace("_", " ")


def _value_phrase(name: str, before: object, after: object) -> str:
    if before is None:
        return f"{name} set to {format_value(after)}"
    if after is None:
        return f"{name} no longer given (it was {format_value(before)})"
    return f"{name} {format_value(before)} → {format_value(after)}"


def _instead_phrase(before: object, after: object, absent_text: str) -> str:
    if after is None:
        return f"{absent_text} instead of {format_value(before)}"
    return format_value(after) if before is None else f"{format_value(after)} instead of {format_value(before)}"


def _is_brief(text: object) -> bool:
    return isinstance(text, str) and len(text) <= _MAX_LENGTH and "\n" not in text


def _rewrite_phrase(before: object, after: object) -> str:
    """Describe how a text that is too long for a sentence changed: by the words that differ."""
    if before is None:
        return f"is new: `{cut_text(str(after))}`"
    if after is None:
        return f"is gone: `{cut_text(str(before))}`"
    # Where texts differ in nothing but lines, no word tells it.
    return (
        f"is rewritten: {difference}"
        if (difference := describe_text_difference(str(before), str(after)))
        else "has its lines broken in another way"
    )


def _count_lines(before: object, after: object) -> str:
    """Describe how a chapter changed: its lines are counted, not quoted."""
    if before is None:
        return "is new"
    if after is None:
        return "is gone"
    if "\n" not in f"{before}{after}":
        return "is rewritten"
    old_lines, new_lines = Counter(str(before).splitlines()), Counter(str(after).splitlines())
    counts = ((new_lines - old_lines).total(), "added"), ((old_lines - new_lines).total(), "removed")
    words = [f"{n} line{'s' if n > 1 else ''} {verb}" for n, verb in counts if n]
    return f"changed: {' and '.join(words)}" if words else "has its lines in another order"


def _list_phrase(noun: str, verbs: tuple[str, str] | None, before: object, after: object) -> str:
    """Describe what a list gained and lost, with the key's own verbs if it has any."""
    old_items = before if isinstance(before, list) else []
    new_items = after if isinstance(after, list) else []
    name = f": {noun}"
    if len(old_items) == len(new_items) == 1:
        return f"{name} {format_value(old_items[0])} → {format_value(new_items[0])}"
    gained = [format_value(item) for item in new_items if item not in old_items]
    lost = [format_value(item) for item in old_items if item not in new_items]
    if not gained and not lost:
        return f"{name} are now {join_words([format_value(item) for item in new_items])}, in this order"
    if verbs:
        words = [
            f" {verb} {join_words(keep_first(items, _MAX_NAMES))}"
            for verb, items in zip(verbs, (gained, lost), strict=True)
            if items
        ]
        return " and".join(words)
    words = [
        f" {join_words(keep_first(items, _MAX_NAMES))} {verb}"
        for verb, items in (("added", gained), ("removed", lost))
        if items
    ]
    return name + ",".join(words)


def _fields_phrase(before: object, after: object) -> str:
    """Describe which fields are other than before; empty if these are the same ones in another order."""
    changes = compare_field_lines(before, after)
    phrases = [
        f"{format_value(name)} is {format_value(new_type)} instead of {format_value(old_type)}"
        for name, (old_type, new_type) in changes.retyped.items()
    ]
    phrases += [f"{format_value(name)} is called {format_value(new)} now" for name, new in changes.renamed.items()]
    phrases = keep_first(phrases, _MAX_NAMES)
    if changes.added or changes.removed:
        phrases.append(_list_phrase("fields", None, changes.removed, changes.added).removeprefix(": "))
    return f": {', '.join(phrases)}" if phrases else ""


def format_value(value: object) -> str:
    """Format a value for a sentence."""
    if value is None:
        return "unlimited"
    if isinstance(value, (bool, int, float)):
        return str(value).lower()
    if isinstance(value, list):
        return join_words([format_value(item) for item in value]) or "none"
    return f"`{shorten_text(str(value))}`"


def shorten_text(text: str) -> str:
    """Return a text on one line, at most 80 characters long, without backticks."""
    # A backtick inside would end the code span that sentences put the text into, and let a name pose as our own words.
    line = " ".join(text.replace("`", "'").split())
    return line if len(line) <= _MAX_LENGTH else f"{line[: _MAX_LENGTH - 1]}…"


_MAX_EFFECTS = 3
"""Maximal number of effects in one sentence; all of them are in the parts."""
_MAX_NAMES = 6
"""Maximal number of names in one list; the rest is counted."""


def limit_effects(effects: Sequence[str]) -> Sequence[str]:
    """Return the first effects, and how many more there are."""
    plural = "s" if len(effects) > _MAX_EFFECTS + 1 else ""
    return keep_first(effects, _MAX_EFFECTS, f"and {{}} more such effect{plural}")


def shown_id(kind: str, name: str, versions: VersionPair) -> str:
    """Return the id that readers know: that of the second version, of a removed element that of the first."""
    element = None if (kind, name) in versions.elements_after else versions.elements_before.get((kind, name))
    return element.own_id if element else name


def tick_names(names: Iterable[str], max_names: int = _MAX_NAMES) -> str:
    """Return element names in backticks, the surplus counted."""
    return join_words(fit_lines([f"`{shorten_text(name)}`" for name in names], max_names, "{} more"))


def name_partner(partner: str, partner_names: Mapping[str, str]) -> str:
    """Return what people call a partner; its id where nobody declares it."""
    return partner_names.get(partner) or shorten_text(partner)


def title_partners(before: Architecture, after: Architecture) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    partners = {**before.partners, **after.partners}
    titles = {partner_id: shorten_text(partner.title) for partner_id, partner in partners.items()}
    counts = Counter(titles.values())
    return {
        partner_id: f"{title} (`{shorten_text(partner_id)}`)" if counts[title] > 1 else title
        for partner_id, title in titles.items()
    }
