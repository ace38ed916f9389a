"""Write the tables of `archgen/language/language_tables.py`: what a run needs to know of the language, without its words."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from language_description import SLICE, Description, Part, list_accepted

_HEAD = '''\
"""The language as tables. Written by `make language` from the description in `language/`: edit that, never this.

A part is a kind (it has keys), a type, or what stands at one key alone: `KIND.KEY`; `PART.*` are the values of a mapping
by id that have no name of their own, `PART[]` the items of such a list.
"""

# fmt: off
from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

'''
WIDTH = 120
_FACTS = ("order", "listed", "bare", "data", "offers")
"""Words by which a key says more of its value than its type."""
_TEXTLESS_KINDS = frozenset({"integer", "boolean", "number"})


_SECTIONS_OF_NO_ELEMENTS = frozenset({"agreements"})
"""Sections by id that say something of several elements: nothing refers to their ids."""


def make_tables(description: Description) -> str:
    """Return the text of the module."""
    parts = _name_parts(description)
    keys = {name: part["keys"] for name, part in parts.items() if "keys" in part}
    entries = {name: part["entries"] for name, part in parts.items() if "entries" in part}
    sections = {
        section: entries[part]
        for section, part in keys[SLICE].items()
        if entries.get(part) in description.kinds and section not in _SECTIONS_OF_NO_ELEMENTS
    }
    orders = {name: part["order"] for name, part in parts.items() if part.get("order", "counts") != "counts"}
    supporting = {
        kind: tuple(sorted(name for name, key in description.keys_of(kind).items() if key["declares"] is False))
        for kind, part in description.kinds.items()
        if part.get("supporting")
    }
    declaring = {
        kind: names
        for kind, part in description.kinds.items()
        if not part.keys() & {"supporting", "like"}
        and (names := tuple(name for name, key in description.keys_of(kind).items() if key.get("declares")))
    }
    modelled = {
        kind: description.keys_of(kind) for kind, part in description.kinds.items() if part.get("element", True)
    }
    tables = "\n".join(
        [
            _format_literal("KindName", description.kinds),
            _format_literal("SectionName", keys[SLICE]),
            "",
            format_table("KEYS", keys, "The part that stands at each key of each kind."),
            format_table("ENTRIES", entries, "Mappings by id: the part of their values."),
            format_table(
                "ITEMS",
                {name: part["items"] for name, part in parts.items() if "items" in part},
                "Lists: the part of their items.",
            ),
            format_table(
                "LIST_ORDERS",
                orders,
                "Lists whose order says nothing. `gathered`: both sides may begin one; `headed`: the first item says more.",
            ),
            format_names("BARE_PARTS", filter(lambda name: _is_bare(parts[name]), parts), "Values that are no text."),
            format_names(
                "DATA_PARTS",
                (name for name, part in parts.items() if part.get("data")),
                "What other programs read: it stays as it was written, whatever its keys are called.",
            ),
            format_table(
                "OFFERS",
                {name: _as_tuple(part["offers"]) for name, part in parts.items() if "offers" in part},
                "Which names of a project fit at a part.",
            ),
            format_names(
                "COMMON_SECTIONS",
                (name for name, key in description.keys_of(SLICE).items() if key.get("common_word")),
                "Sections that files of other programs may have, too.",
            ),
            format_table(
                "WORDS",
                {name: tuple(part["values"]) for name, part in parts.items() if _is_word(part)},
                "The words of which one stands at a part.",
            ),
            format_table(
                "PART_TYPES",
                {name: part["type"] for name, part in parts.items() if "type" in part},
                "The types of the parts that say more than their type.",
            ),
            format_table(
                "ATTRIBUTES",
                {
                    name: _as_tuple(part["attribute"])
                    for name, part in (*description.types.items(), *_name_keys(modelled))
                    if "attribute" in part
                },
                "The fields of the model that hold what stands at a key, or keys of a type, where they are not called as it.",
            ),
            format_table(
                "PLACED_KEYS",
                {
                    kind: names
                    for kind, keys_by_name in modelled.items()
                    if (names := tuple(name for name, key in keys_by_name.items() if "place" in key))
                },
                "Keys whose values keep their places, each in a field `KEY_at`.",
            ),
            format_table("SECTION_KINDS", sections, "Sections whose keys are ids of elements: the kind of these."),
            format_names(
                "LISTED_PARTS",
                (name for name, part in parts.items() if part.get("listed")),
                "Lists in whose place a scalar is a list of one.",
            ),
            format_table(
                "SHORT_KEYS",
                {kind: _as_tuple(part["short"]) for kind, part in description.kinds.items() if "short" in part},
                "The keys that a scalar or a list in the place of an element stands for.",
            ),
            format_table(
                "PLAIN_SECTIONS",
                {kind: section for section, kind in sections.items() if description.kinds[kind].get("named_by_id")},
                "Kinds of elements that are named by their id alone, not by a path, and their sections.",
            ),
            format_table(
                "DECLARING_KEYS",
                declaring,
                "Keys of which a new element has one, where any other key only adds to one.",
            ),
            _format_tuple(
                "ANNOTATED_KINDS",
                description.kinds_with("properties"),
                "Kinds of elements that may have properties and hints.",
            ),
            format_table("OTHER_WORDS", description.other_words, "What people call the keys of a kind elsewhere."),
            format_table("SUPPORTING_KEYS", supporting, "Keys that say something of an element that others declare."),
        ]
    )
    return f"{_HEAD}{tables}\n"


def _name_parts(description: Description) -> dict[str, Part]:
    """Return all parts by name; what they refer to is a name, too."""
    parts: dict[str, Part] = {}
    for name, part in description.types.items():
        parts[name] = _name_references(name, part, description, parts)
    for kind, part in description.kinds.items():
        parts[kind] = _name_references(kind, {**part, "keys": description.keys_of(kind)}, description, parts)
    return parts


def _name_references(place: str, part: Part, description: Description, parts: dict[str, Part]) -> Part:
    """Return a part with a name for each part in it; those that stand here alone are added to `parts`."""

    def name_part(name: str, inner: Part | str) -> str:
        if isinstance(inner, str):
            return inner
        own_facts = {word: inner[word] for word in _FACTS if word in inner}
        if "type" in inner and not own_facts:
            return str(inner["type"])
        # A key that says more than its type of what stands there is a part of its own.
        base = parts_of(inner["type"]) if "type" in inner else inner
        parts[name] = _name_references(name, {**base, **own_facts}, description, parts)
        parts[name] |= {"type": inner["type"]} if "type" in inner else {}
        return name

    def parts_of(name: str) -> Part:
        shared = description.parts[name]
        return {**shared, "keys": description.keys_of(name)} if name in description.kinds else shared

    named = dict(part)
    if "keys" in part:
        named["keys"] = {key: name_part(f"{place}.{key}", inner) for key, inner in part["keys"].items()}
    if "entries" in part:
        named["entries"] = name_part(f"{place}.*", part["entries"])
    if "also_entries" in part:
        named["entries"] = part["also_entries"]
    if "items" in part:
        named["items"] = name_part(f"{place}[]", part["items"])
    return named


def _is_bare(part: Part) -> bool:
    scalars = set(list_accepted(part)) - {"null", "object", "array"}
    return bool(part.get("bare")) or (bool(scalars) and scalars <= _TEXTLESS_KINDS)


def _name_keys(kinds: Mapping[str, Mapping[str, Part]]) -> Iterable[tuple[str, Part]]:
    return ((f"{kind}.{name}", key) for kind, keys in kinds.items() for name, key in keys.items())


def _is_word(part: Part) -> bool:
    return "values" in part and "string" in list_accepted(part)


def _as_tuple(value: str | list[str]) -> tuple[str, ...]:
    return (value,) if isinstance(value, str) else tuple(value)


def _format_literal(name: str, values: Iterable[str]) -> str:
    return "\n".join([f"{name} = Literal[", *wrap_items([f'"{value}"' for value in values], "    "), "]"])


def format_names(name: str, values: Iterable[str], says: str) -> str:
    """Return the text of a set of names."""
    lines = [
        f"{name}: frozenset[str] = frozenset({{",
        *wrap_items([f'"{value}"' for value in sorted(values)], "    "),
        "})",
    ]
    return "\n".join([*lines, f'"""{says}"""'])


def _format_tuple(name: str, values: Iterable[str], says: str) -> str:
    lines = [f"{name}: tuple[str, ...] = (", *wrap_items([f'"{value}"' for value in values], "    "), ")"]
    return "\n".join([*lines, f'"""{says}"""'])


def format_table(name: str, table: Mapping[str, Any], says: str) -> str:
    """Return the text of a table of names, of tuples of them, or of tables of them."""
    first_value = next(iter(table.values()))
    if isinstance(first_value, Mapping):
        annotation = "Mapping[str, str]"
        lines = [line for key, inner in table.items() for line in _format_row(key, inner)]
    else:
        annotation = "str" if isinstance(first_value, str) else "tuple[str, ...]"
        lines = wrap_items([f'"{key}": {_format_value(value)}' for key, value in table.items()], "    ")
    return "\n".join([f"{name}: Mapping[str, {annotation}] = {{", *lines, "}", f'"""{says}"""'])


def _format_row(key: str, inner: Mapping[str, str]) -> list[str]:
    pairs = [f'"{name}": "{part}"' for name, part in inner.items()]
    return [f'    "{key}": {{', *wrap_items(pairs, "        "), "    },"]


def _format_value(value: str | tuple[str, ...]) -> str:
    if isinstance(value, str):
        return f'"{value}"'
    return f"({', '.join(map(_format_value, value))}{',' if len(value) == 1 else ''})"


def wrap_items(items: list[str], indent: str) -> list[str]:
    """Return items behind commas in as few lines as they fit in."""
    lines = [""]
    for item in items:
        if lines[-1] and len(indent) + len(lines[-1]) + len(item) + 2 > WIDTH:
            lines.append("")
        lines[-1] += f"{' ' if lines[-1] else ''}{item},"
    return [f"{indent}{line}" for line in lines if line]
