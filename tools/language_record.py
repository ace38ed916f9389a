"""Derive the resolved record from the description of the language: its JSON Schema, and the tables by which it is written.

What is the record's own stands in `language/record.yaml`; all else follows from the kinds, their keys and the types of these.
A key of the language is in the record unless it says by `unrecorded` why not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from language_description import (
    FOLDER,
    SLICE,
    Description,
    DescriptionError,
    Part,
    PlainData,
    list_accepted,
    read_description_file,
)

_PART_WORDS = frozenset(
    {
        *("type", "kind", "like", "without", "keys", "order", "defined"),
        *("says", "required", "always", "values", "accepts", "items", "entries", "unit", "either", "section", "schema"),
    }
)
"""The words of a part in `record.yaml`; `language/README.md` says what each means."""
_VALUE_WORDS = ("type", "values", "accepts", "items", "entries", "unit", "either", "section", "schema")
"""Words that say what stands at a key."""


@dataclass(frozen=True)
class ResolvedRecord:
    """The record: its sections, and what is said of its parts beside what the language says of them."""

    description: Description
    own: Part

    @property
    def sections(self) -> Mapping[str, Part]:
        """Return the members of the record in their order: what a section of the language is, it is here, too."""
        own_sections: Mapping[str, Part] = self.own["sections"]
        written = self.description.keys_of(SLICE)
        recorded = {name: key for name, key in written.items() if "unrecorded" not in key}
        return {
            **{name: _lay_over(recorded.get(name, {}), section) for name, section in own_sections.items()},
            **{
                name: {**_drop_words(key), "says": key["says"]}
                for name, key in recorded.items()
                if name not in own_sections
            },
        }

    def find_own(self, name: str) -> Part:
        """Return what the record says of a part; with what it says of the one that the part is like."""
        own: Part = self.own["parts"].get(name, {})
        if "like" not in own:
            return own
        base = self.find_own(own["like"])
        return {**base, **own, "keys": {**base.get("keys", {}), **own.get("keys", {})}}

    def find_kind(self, name: str) -> str | None:
        """Return the kind of the language that a part of the record is, None for one of the record's own."""
        own = self.find_own(name)
        kind = own.get("kind", own.get("like", name))
        return kind if kind in self.description.kinds else None

    def keys_of(self, name: str) -> Mapping[str, Part]:
        """Return the keys of a part in their order; none for a part without keys."""
        own = self.find_own(name)
        kind = self.find_kind(name)
        written = self.description.keys_of(kind) if kind else {}
        left_out = {key for keys in own.get("without", {}).values() for key in keys}
        recorded = {key: part for key, part in written.items() if "unrecorded" not in part and key not in left_out}
        own_keys = {
            key: {"type": part} if isinstance(part, str) else part
            for key, part in own.get("keys", {}).items()
            if key not in left_out
        }
        keys = {key: _lay_over(recorded.get(key, {}), own_keys.get(key, {})) for key in {**recorded, **own_keys}}
        if "title" in recorded:
            keys["title"]["required"] = True
        first = [key for key in own.get("order", ()) if key not in left_out]
        return {key: keys[key] for key in dict.fromkeys([*first, *keys])}

    def has_keys(self, name: str) -> bool:
        """Whether a part is written by keys that are known."""
        return not self.find_own(name).keys() & {*_VALUE_WORDS} and bool(
            "keys" in self.find_own(name) or self.find_kind(name)
        )

    def find_value(self, part: Part) -> Part:
        """Return what says what stands at a key: the part that its type is, where that is not one with keys."""
        while "type" in part and not self.has_keys(part["type"]):
            name = part["type"]
            part = {**_lay_over(self.description.types.get(name, {}), self.find_own(name)), "named": name}
            if "defined" in part:
                break
        return part


def _lay_over(written: Part, own: Part) -> Part:
    """Return what stands at a key of the record: as the language has it, unless the record says something else."""
    shared = {} if own.keys() & {*_VALUE_WORDS} else _drop_words(written)
    return {**shared, **own, **({"flag": True} if written.get("type") == "flag" else {})}


def _drop_words(written: Part) -> Part:
    """Return a part of the language without what is said for people who write, and without its JSON Schema."""
    kept = {word: value for word, value in written.items() if word in {*_VALUE_WORDS, "order"} - {"schema"}}
    return {word: _drop_words(value) if isinstance(value, dict) else value for word, value in kept.items()}


def load_record(description: Description, folder: Path = FOLDER) -> ResolvedRecord:
    """Read what is the record's own. Raise DescriptionError for what contradicts the language."""
    record = ResolvedRecord(description, read_description_file(folder / "record.yaml"))
    if faults := list(find_faults(record)):
        raise DescriptionError("\n".join(faults))
    return record


def find_faults(record: ResolvedRecord) -> Iterator[str]:
    """Yield what is wrong with `record.yaml`, a sentence each."""
    known_names = {*record.description.parts, *_list_texts(record.own)}
    yield from (f"record.yaml: nothing names `{name}`" for name in record.own["parts"] if name not in known_names)
    for name, part in record.own["parts"].items():
        own_keys = {key: {} if isinstance(own, str) else own for key, own in part.get("keys", {}).items()}
        for place, words in ((name, part), *((f"{name}.{key}", own) for key, own in own_keys.items())):
            yield from (f"record.yaml: {place}: `{word}` is no word of a part" for word in words.keys() - _PART_WORDS)
        kind = record.find_kind(name)
        written = record.description.keys_of(kind) if kind else {}
        inherited = record.find_own(part["like"]).get("keys", {}) if "like" in part else {}
        left_out = [key for keys in part.get("without", {}).values() for key in keys]
        for key in (*part.get("order", ()), *left_out):
            if key not in {**written, **own_keys, **inherited}:
                yield f"record.yaml: {name}: there is no key `{key}`"
        for key, own in own_keys.items():
            if key not in {**written, **inherited} and part["keys"][key] == own and not own.keys() & {*_VALUE_WORDS}:
                yield f"record.yaml: {name}.{key}: no key of the language, and nothing says what stands there"
    for section, words in record.own["sections"].items():
        yield from (f"record.yaml: {section}: `{word}` is no word of a part" for word in words.keys() - _PART_WORDS)


def _list_texts(data: PlainData) -> Iterator[str]:
    """Yield all texts that are no keys."""
    if isinstance(data, str):
        yield data
    for inner in data.values() if isinstance(data, dict) else data if isinstance(data, list) else ():
        yield from _list_texts(inner)


def make_record_schema(record: ResolvedRecord) -> Part:
    """Return the JSON Schema of the record."""
    sections = record.sections
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": record.own["title"],
        "description": record.own["says"],
        "type": "object",
        "properties": {name: _make_schema(record, section) for name, section in sections.items()},
        "required": [name for name, section in sections.items() if section.get("required")],
        "additionalProperties": False,
        "$defs": {
            own["defined"]: _make_body(record, name)
            for name in record.own["parts"]
            if "defined" in (own := record.find_own(name))
        },
    }


def _make_schema(record: ResolvedRecord, part: Part | str) -> Part:
    """Return the schema of what stands at a key, at the items of a list or at the values of a mapping."""
    part = {"type": part} if isinstance(part, str) else part
    value = record.find_value(part)
    name = str(value.get("type", value.get("named", "")))
    defined = record.find_own(name).get("defined")
    says = {"description": part["says"]} if "says" in part else {}
    if defined:
        return {"$ref": f"#/$defs/{defined}", **says}
    return {**(_make_body(record, name) if "type" in value else _make_value_schema(record, value)), **says}


def _make_body(record: ResolvedRecord, name: str) -> Part:
    """Return the schema of a part by itself."""
    own = record.find_own(name)
    says = {"description": own["says"]} if "says" in own else {}
    if not record.has_keys(name):
        return {**says, **_make_value_schema(record, own)}
    keys = record.keys_of(name)
    required = [key for key, part in keys.items() if part.get("required")]
    return {
        **says,
        "type": "object",
        "properties": {key: _make_schema(record, part) for key, part in keys.items()},
        **({"required": required} if required else {}),
        "additionalProperties": False,
    }


def _make_value_schema(record: ResolvedRecord, value: Part) -> Part:
    """Return the schema of a value that has no keys of its own."""
    says = {"description": value["says"]} if "says" in value else {}
    accepted = list_accepted(value)
    if "schema" in value:
        schema = dict(value["schema"])
    elif "section" in value:
        schema = {"$ref": f"#/properties/{value['section']}"}
    elif "either" in value:
        schema = {"anyOf": [_make_schema(record, each) for each in value["either"]]}
    elif "unit" in value:
        schema = {"$ref": "#/$defs/quantity"}
    elif "values" in value:
        schema = {"enum": list(value["values"])}
    elif "entries" in value:
        schema = {"type": "object", "additionalProperties": _make_schema(record, value["entries"])}
    elif "items" in value and value.get("order") != "headed":
        schema = {"type": "array", "items": _make_schema(record, value["items"])}
    else:
        fitting = (each for each in ("string", "number", "integer", "boolean", "object") if each in accepted)
        schema = {"type": next(fitting, "string")}
    return {**schema, **says}


def make_record_tables(record: ResolvedRecord) -> dict[str, PlainData]:
    """Return the tables by which the record is written, by name."""
    names = dict.fromkeys(_list_written(record))
    lasting = (name for name, section in record.sections.items() if section.keys() & {"required", "always"})
    return {
        "RECORD_SECTIONS": {name: _name_form(record, section) for name, section in record.sections.items()},
        "LASTING_SECTIONS": sorted(lasting),
        "RECORD_KEYS": {
            name: {key: _name_form(record, part) for key, part in record.keys_of(name).items()} for name in names
        },
    }


def _list_written(record: ResolvedRecord) -> Iterator[str]:
    """Yield the parts with keys, in the order in which the record comes to them."""
    waiting = [_name_form(record, section).strip("[]{}") for section in record.sections.values()]
    seen: set[str] = set()
    while waiting:
        name = waiting.pop(0)
        if name and name not in seen and record.has_keys(name):
            seen.add(name)
            yield name
            waiting += [_name_form(record, part).strip("[]{}") for part in record.keys_of(name).values()]


def _name_form(record: ResolvedRecord, part: Part) -> str:
    """Return what stands at a key as the tables name it."""
    if part.get("flag") or part.get("accepts") == "boolean":
        return "flag"
    if part.get("type") in {"properties", "hints"}:
        return "annotations"
    value = record.find_value(part)
    if "section" in value:
        return _name_form(record, record.sections[value["section"]])
    return str(value.get("type") or value.get("unit") or _name_inner_form(record, value))


def _name_inner_form(record: ResolvedRecord, value: Part) -> str:
    """Return what a list or mapping by id holds as the tables name it; an empty text where that is plain data."""
    for word, brackets in (("entries", "{}"), ("items", "[]")):
        inner = value.get(word)
        if isinstance(inner, str) and record.has_keys(inner):
            return f"{inner}{brackets}"
        if isinstance(inner, dict) and "unit" in inner:
            return f"{inner['unit']}{brackets}"
    return ""
