"""Read the description of the language in `language/`, and derive the JSON Schema of a project from it.

A *part* says what may stand somewhere: a kind has `keys`, a type has none. `language/README.md` names the words that a part
may have. Nothing here decides anything about single kinds or keys: what a part says is data.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from archgen.diagnostics.diagnostic import Rule
from archgen.diagnostics.rule_options import RuleOption
from archgen.syntax.yaml_parser import parse_yaml
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, YamlNode

Part = dict[str, Any]
PlainData = Any
"""What YAML and JSON can hold."""
FOLDER = Path(__file__).resolve().parents[1] / "language"
KIND_FILES = ("project", "functional", "ros", "system", "timing")
SLICE = "slice"
"""The kind whose keys are the sections of a file."""

_SCHEMA_MEMBERS = {
    "title": "title",
    "says": "description",
    "accepts": "type",
    "values": "enum",
    "least": "minimum",
    "most": "maximum",
    "shortest": "minLength",
    "longest": "maxLength",
    "pattern": "pattern",
    "pattern_help": "patternErrorMessage",
    "fewest_items": "minItems",
    "most_items": "maxItems",
}
"""The words of a part that are members of its schema, in the schema's order."""
_OTHER_WORDS = frozenset(
    {
        *("as", "type", "keys", "schema", "open", "example", "examples", "snippet", "snippets"),
        *(
            "word",
            "id",
            "like",
            "without",
            "offers",
            "order",
            "bare",
            "data",
            "supporting",
            "declares",
            "also_entries",
            "short",
            "listed",
            "named_by_id",
            "element",
            "see",
            "unit",
            "unrecorded",
            "common_word",
            "section",
            "place",
        ),
        *("effect", "worse", "form", "attribute", "default", "names", "told", "noun", "verb", "verbs", "new_verb"),
    }
)
"""The words of a part that the schema does not show as they are; `language/README.md` says what each means."""
LIST_ORDERS = frozenset({"counts", "free", "gathered", "headed"})
_NESTED_MEMBERS = {"ids": "propertyNames", "items": "items", "entries": "additionalProperties"}
"""Words of a part whose value is a part, or the name of one."""


class DescriptionError(Exception):
    """The description contradicts itself, or says something that no generated file can hold."""


@dataclass(frozen=True)
class Description:
    """The whole language: parts by name. `common` are keys that several kinds have."""

    common: Mapping[str, Part]
    types: Mapping[str, Part]
    kinds: Mapping[str, Part]
    """As written: `keys_of` completes the keys."""
    other_words: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """What people call the keys of a kind elsewhere: the key by such a word."""

    @cached_property
    def parts(self) -> Mapping[str, Part]:
        """Return kinds and types by name."""
        return {**self.kinds, **self.types}

    def keys_of(self, kind: str) -> Mapping[str, Part]:
        """Return the keys of a kind, common and inherited ones written out."""
        return {name: self._complete_key(kind, name, key) for name, key in self._written_keys(kind).items()}

    def _written_keys(self, kind: str) -> Mapping[str, Part | str]:
        """Return the keys of a kind as written, those of the kind that it is like first."""
        part = self.kinds[kind]
        inherited = self._written_keys(part["like"]) if "like" in part else {}
        missing = part.get("without", ())
        return {**{name: key for name, key in inherited.items() if name not in missing}, **part["keys"]}

    def _complete_key(self, kind: str, name: str, key: Part | str) -> Part:
        own = {"as": key} if isinstance(key, str) else dict(key)
        if "as" in own:
            shared_name = own.pop("as")
            if shared_name not in self.common:
                message = f"{kind}.{name}: common.yaml has no key `{shared_name}`"
                raise DescriptionError(message)
            shared = self.common[shared_name]
            own = {**_without_rivals(shared, own), **own}
            own["says"] = own["says"].replace("KIND", self.word_of(kind))
        return {"title": name.replace("_", " ").capitalize(), **own}

    def kinds_with(self, part: str) -> list[str]:
        """Return the kinds of elements with a key at which a part stands; not those that say a part of another element."""
        kinds = (kind for kind, body in self.kinds.items() if body.get("element", True))
        return [kind for kind in kinds if any(key.get("type") == part for key in self.keys_of(kind).values())]

    def word_of(self, kind: str) -> str:
        """Return what sentences call an element of a kind."""
        return str(self.kinds[kind].get("word", kind.replace("_", " ")))

    def type_of(self, key: Part) -> Part:
        """Return the part that a key names as its type; the key itself where it says all by itself."""
        return self.parts[key["type"]] if "type" in key else key


def _without_rivals(shared: Part, own: Part) -> Part:
    """Leave out what a common key says in the other number: `example` beside an own `examples`."""
    rivals = {word for each in ("example", "snippet") if own.keys() & {each, f"{each}s"} for word in (each, f"{each}s")}
    return {word: value for word, value in shared.items() if word not in rivals}


def load_description(folder: Path = FOLDER) -> Description:
    """Read the files of the description. Raise DescriptionError for YAML that cannot be read."""
    kinds: dict[str, Part] = {}
    for name in KIND_FILES:
        for kind, part in read_description_file(folder / f"{name}.yaml").items():
            if kind in kinds:
                message = f"{name}.yaml: the kind `{kind}` stands in another file, too"
                raise DescriptionError(message)
            kinds[kind] = part
    types = read_description_file(folder / "types.yaml")
    for kind, part in kinds.items():
        _add_section(kind, part, kinds["slice"], types)
    other_words = _read_other_words(folder / "other_words.yaml")
    description = Description(read_description_file(folder / "common.yaml"), types, kinds, other_words)
    for part in description.types.values():
        _list_named_kinds(part, description)
    if twice := description.types.keys() & kinds.keys():
        message = f"a kind and a type at once: {', '.join(sorted(twice))}"
        raise DescriptionError(message)
    return description


def _read_other_words(path: Path) -> dict[str, dict[str, str]]:
    words = read_description_file(path) if path.is_file() else {}
    pairs = {kind: [(word, key) for key, text in keys.items() for word in text.split()] for kind, keys in words.items()}
    for kind, keys_by_word in pairs.items():
        if len(dict(keys_by_word)) < len(keys_by_word):
            message = f"{path.name}: {kind}: a word stands at two keys"
            raise DescriptionError(message)
    return {kind: dict(keys_by_word) for kind, keys_by_word in pairs.items()}


def _add_section(kind: str, part: Part, slice_part: Part, types: dict[str, Part]) -> None:
    """Give the elements of a kind with `section` their mapping by id, and files a section of that name."""
    if "section" not in part:
        return
    section, title = part["section"], part["section"].replace("_", " ").capitalize()
    says = f"{title}, by id."
    snippet = {f"main_{kind}": part.get("snippet", part.get("example"))}
    mapping = {"title": title, "says": says, "accepts": "object null", "ids": "id", "entries": kind, "snippet": snippet}
    types.setdefault(section, mapping)
    slice_part["keys"].setdefault(section, {"type": section, "says": says})


def _list_named_kinds(part: Part, description: Description) -> None:
    """Write out `values: {kinds_with: PART}`, at the part or at the items of a list."""
    if isinstance(part.get("values"), dict):
        part["values"] = description.kinds_with(part["values"]["kinds_with"])
    if isinstance(part.get("items"), dict):
        _list_named_kinds(part["items"], description)


def read_description_file(path: Path) -> Part:
    """Return what a file of the description says. Raise DescriptionError for YAML that cannot be read."""
    document, diagnostics = parse_yaml(path.name, path.read_text(encoding="utf-8"))
    if diagnostics or document is None:
        message = "\n".join(f"{each.span}: {each.message}" for each in diagnostics)
        raise DescriptionError(message)
    plain = read_plain_value(document.root)
    if not isinstance(plain, dict):
        message = f"{path.name}: a mapping of names is expected"
        raise DescriptionError(message)
    return plain


def read_plain_value(node: YamlNode) -> PlainData:
    """Return what a node says as plain data."""
    if isinstance(node, MappingNode):
        return {entry.key: read_plain_value(entry.value) for entry in node}
    if isinstance(node, ScalarNode):
        return node.value
    return [read_plain_value(item) for item in node.items]


def make_schema(description: Description) -> Part:
    """Return the JSON Schema of a project's files."""
    top = dict(description.kinds[SLICE])
    schema = _make_kind_schema(description, SLICE)
    definitions = {
        name: _make_kind_schema(description, name) if name in description.kinds else _make_part_schema(part)
        for name, part in sorted(description.parts.items())
        if name != SLICE
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "$id": top["id"],
        **schema,
        "$defs": definitions,
    }


def _make_kind_schema(description: Description, kind: str) -> Part:
    keys = {name: _make_key_schema(description, key) for name, key in description.keys_of(kind).items()}
    return _make_part_schema(description.kinds[kind], keys)


def _make_key_schema(description: Description, key: Part) -> Part:
    if "type" not in key:
        return _make_part_schema(key)
    shared = description.type_of(key)
    inherited = {"examples": _list_examples(shared), "snippets": _list_snippets(shared)}
    if key.keys() & {"example", "examples"}:
        inherited.pop("examples")
    if key.keys() & {"snippet", "snippets"}:
        inherited.pop("snippets")
    return _make_part_schema({**key, **inherited})


def _make_part_schema(part: Part, keys: Mapping[str, Part] | None = None) -> Part:
    """Return the schema of a part; its members are always in the same order."""
    if keys is None and "keys" in part:
        keys = {
            name: _make_part_schema({"title": name.replace("_", " ").capitalize(), **key})
            for name, key in part["keys"].items()
        }
    schema = {member: _make_member(word, part) for word, member in _SCHEMA_MEMBERS.items() if word in part}
    schema |= part.get("schema", {})
    schema |= {member: _make_nested(part[word]) for word, member in _NESTED_MEMBERS.items() if word in part}
    if keys is not None:
        if "entries" not in part and not part.get("open"):
            schema["additionalProperties"] = False
        schema["properties"] = dict(keys)
    if examples := _list_examples(part):
        schema["examples"] = examples
    if snippets := _list_snippets(part):
        schema["defaultSnippets"] = [{"body": body} for body in snippets]
    if "type" in part:
        schema["$ref"] = f"#/$defs/{part['type']}"
    return schema


def _make_member(word: str, part: Part) -> PlainData:
    value = part[word]
    if word == "accepts" and isinstance(value, str):
        accepted = value.split()
        return accepted if len(accepted) > 1 else accepted[0]
    if word == "values":
        return [*value, None] if "null" in part.get("accepts", "") else value
    return value


def _make_nested(part: Part | str) -> Part:
    return {"$ref": f"#/$defs/{part}"} if isinstance(part, str) else _make_part_schema(part)


def _list_examples(part: Part) -> list[PlainData]:
    return [part["example"]] if "example" in part else list(part.get("examples", ()))


def _list_snippets(part: Part) -> list[PlainData]:
    return [part["snippet"]] if "snippet" in part else list(part.get("snippets", ()))


def add_rule_settings(description: Description, rules: Mapping[str, Rule]) -> None:
    """Add a key to the kind `rules` for each rule that has options: what may stand there is what the rule asks for."""
    settings = description.kinds["rules"]["keys"]
    plain_setting = description.kinds["rules"]["entries"]
    for name, rule in sorted(rules.items()):
        if rule.options:
            examples = {option.name: f"{option.example} %" for option in rule.options}
            settings[name] = {
                "title": f"Setting of {name}",
                "says": "`off`, `note`, `warning` or `error`; or a mapping with `severity` and options.",
                **{word: plain_setting[word] for word in ("accepts", "schema", "example")},
                "snippet": {"severity": "note", **examples},
                "keys": {
                    **plain_setting["keys"],
                    **{option.name: _describe_option(option) for option in rule.options},
                },
            }


def _describe_option(option: RuleOption) -> Part:
    range_phrase = f"{option.range_phrase[0].upper()}{option.range_phrase[1:]}"
    return {
        "type": "percentage",
        "says": f"{option.summary} {range_phrase}; without it {option.default} %.",
        "example": f"{option.example} %",
    }


def find_faults(description: Description) -> Iterator[str]:
    """Yield what is wrong with a description, a sentence each: nothing is left to a guess of who reads it."""
    yield from _find_faults_of_words(description)
    for name, part in description.common.items():
        yield from _find_part_faults(f"common.{name}", part, description)
    for name, part in description.types.items():
        yield from _find_part_faults(name, part, description)
        yield from _find_field_faults(name, part)
        yield from _find_words_of_keys(name, part, "place")
    for kind, part in description.kinds.items():
        yield from _find_part_faults(kind, part, description)
        yield from _find_words_of_keys(kind, part, "attribute", "place")
        for name, key in description.keys_of(kind).items():
            yield from _find_part_faults(f"{kind}.{name}", key, description)
            is_known = key.get("type", kind) in description.parts
            if is_known and not _make_key_schema(description, key).keys() & {"examples", "defaultSnippets"}:
                yield f"{kind}.{name}: neither the key nor its type has an `example` or a `snippet`"
            yield from _find_field_faults(f"{kind}.{name}", key)
            if part.get("supporting") and "declares" not in key:
                yield f"{kind}.{name}: `declares` says whether a file that says only this declares a {kind}"


def _find_faults_of_words(description: Description) -> Iterator[str]:
    for kind, keys_by_word in description.other_words.items():
        keys = description.keys_of(kind) if kind in description.kinds else {}
        for word, key in keys_by_word.items():
            if key not in keys:
                yield f"other_words.yaml: there is no key `{kind}.{key}`"
            elif word in keys:
                yield f"other_words.yaml: `{word}` is a key of {kind} itself"


def _find_field_faults(place: str, key: Part) -> Iterator[str]:
    """Yield what is wrong with what a key or a type says of the fields that hold it."""
    attribute, name = key.get("attribute", []), place.rpartition(".")[2]
    names = attribute if isinstance(attribute, list) else [attribute]
    is_told = names not in ([], [name]) and len(set(names)) == len(names) and all(map(_is_field, names))
    if "attribute" in key and not is_told:
        yield f"{place}: `attribute` is the field that holds it where that is called otherwise, or a list of fields"
    if key.get("place", True) is not True:
        yield f"{place}: `place` is `true`, or left out"


def _find_words_of_keys(place: str, part: Part, *words: str) -> Iterator[str]:
    return (f"{place}: `{word}` is a word of keys" for word in words if word in part)


def _is_field(name: PlainData) -> bool:
    return isinstance(name, str) and name.isidentifier() and name.islower()


def _find_part_faults(place: str, part: Part, description: Description) -> Iterator[str]:
    known_words = {*_SCHEMA_MEMBERS, *_NESTED_MEMBERS, *_OTHER_WORDS}
    yield from (f"{place}: `{word}` is no word of a part" for word in sorted(part.keys() - known_words))
    if "says" not in part:
        yield f"{place}: `says` is missing"
    if "type" in part and part["type"] not in description.parts:
        yield f"{place}: there is no type or kind `{part['type']}`"
    if part.get("order", "free") not in LIST_ORDERS:
        yield f"{place}: `order` is one of {', '.join(sorted(LIST_ORDERS))}"
    if "array" in list_accepted(part) and "order" not in part:
        yield f"{place}: it takes a list, and `order` does not say what its order means"
    for word in ("entries", "items", "ids"):
        inner = part.get(word)
        if isinstance(inner, str) and inner not in description.parts:
            yield f"{place}: there is no type or kind `{inner}`"
        if isinstance(inner, dict):
            yield from _find_part_faults(f"{place}.{word}", inner, description)
            yield from _find_words_of_keys(f"{place}.{word}", inner, "attribute", "place")


def list_accepted(part: Part) -> list[str]:
    """Return the kinds of values that a part accepts."""
    accepted = part.get("accepts", "")
    return accepted.split() if isinstance(accepted, str) else list(accepted)
