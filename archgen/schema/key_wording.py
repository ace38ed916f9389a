"""Phrase what is wrong with a key: one that its place does not have, or that cannot be an id."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from archgen.diagnostics import Diagnostic, did_you_shorten, find_closest, join_words
from archgen.schema import key_places
from archgen.schema.schema_wording import (
    ErrorPlace,
    add_article,
    diagnose_odd_character,
    element_of_path,
    join_quoted,
    suggest_ids,
)
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

if TYPE_CHECKING:
    from collections.abc import Iterator

_LANGUAGE_WORDS = ("true", "false", "null", "any", "all", "none", "self")
"""Words that the pattern of ids leaves out."""
_SERVED = "what a component serves is an output whose type is a service or an action: `outputs: {{NAME: PACKAGE/{part}/TYPE}}`"
_CALLED = "what a component calls is an input that reads it: `inputs: {NAME: GROUP.COMPONENT.OUTPUT}`"
_GIVEN = "what a component gives is an output; topics stand at nodes: `outputs: {NAME: PACKAGE/msg/TYPE}`"
_TAKEN = "what a component takes is an input; topics stand at nodes: `inputs: {NAME: GROUP.COMPONENT.OUTPUT}`"
_COMPONENT_WORDS = {
    **dict.fromkeys(("service", "services", "serves", "provides", "servers"), _SERVED.format(part="srv")),
    **dict.fromkeys(("action", "actions", "action_servers"), _SERVED.format(part="action")),
    **dict.fromkeys(("call", "calls", "clients", "service_clients", "action_clients"), _CALLED),
    **dict.fromkeys(("publish", "publishes", "publishers", "topics"), _GIVEN),
    **dict.fromkeys(("subscribe", "subscribes", "subscribers", "subscriptions"), _TAKEN),
}
_NODE_WORDS = {
    **dict.fromkeys(
        ("topics", "interfaces"), "a node sends and hears: `publishes: {PORT: /topic}`, `subscribes: {PORT: /topic}`"
    ),
    **dict.fromkeys(
        ("depends", "depend", "dependencies", "exec_depend"),
        "on which packages it depends follows from what it publishes, subscribes to, serves and calls",
    ),
    **dict.fromkeys(
        ("launch", "launch_file", "launch_files"),
        "what a launch file starts is imported by `archgen import launch FILE`; to start the file itself, write "
        "`kind: program, command: [ros2, launch, PACKAGE, FILE]`",
    ),
}
_HOST_WORDS = {
    **dict.fromkeys(("runs", "nodes", "programs"), "a node says where it runs: `nodes: {NODE: {host: HOST}}`"),
    **dict.fromkeys(
        ("components", "groups"), "the nodes of components say where they run: `nodes: {NODE: {host: HOST}}`"
    ),
    **dict.fromkeys(
        ("gpu", "gpus", "fpga"), "what nodes share beside the cores is a resource: `resources: {gpu: HOST}`"
    ),
}
_SENTENCES_BY_TITLE = {
    "Component": _COMPONENT_WORDS, "Component type": _COMPONENT_WORDS, "ROS node": _NODE_WORDS, "Host": _HOST_WORDS,
}  # fmt: skip
"""What people write at an element of a kind, by the kind's title in the schema, and what says it instead."""


def diagnose_unknown_keys(
    place: ErrorPlace, keys: tuple[str, ...], schema_part: dict[str, Any]
) -> Iterator[Diagnostic]:
    """Report the keys of a mapping that the schema does not have at its place.

    Several that all belong to one other kind of element are a single mistake, and one finding.
    """
    entries = [place.node.entries[key] for key in keys] if isinstance(place.node, MappingNode) else []
    foreign_kind = key_places.find_common_kind(keys)
    if foreign_kind and place.path and place.entry is not None:
        yield _diagnose_foreign_keys(place, keys, schema_part, foreign_kind)
        return
    for entry in entries:
        yield diagnose_unknown_key(entry, schema_part, place.path)


def _diagnose_foreign_keys(
    place: ErrorPlace, keys: tuple[str, ...], schema_part: dict[str, Any], foreign_kind: str
) -> Diagnostic:
    entry = place.node.entries[keys[0]] if isinstance(place.node, MappingNode) else place.entry
    quoted_keys = join_words([f"`{key}`" for key in keys], "or")
    message = f"{add_article(schema_part['title'])} has no keys {quoted_keys}"
    help_line = key_places.find_key_home(keys[0], place.path, schema_part["title"])
    # A component beside its group instead of below it: its own column is wrong, not its keys.
    if schema_part["title"] == "Functional group" and foreign_kind == "component":
        help_line = f"if `{place.path[-1]}` is a component, indent it below `components:` of its group"
    span = entry.key_span if entry else place.node.span
    return Diagnostic("unknown-key", message, span, help=help_line, element=element_of_path(place.path))


def diagnose_unknown_key(entry: MappingEntry, schema_part: dict[str, Any], path: tuple[str | int, ...]) -> Diagnostic:
    """Report a key that the schema does not have at its place, with the most likely meaning as help."""
    known_keys = tuple(schema_part.get("properties", ()))
    message = (
        f"no section is called `{entry.key}`"
        if not path
        else f"{add_article(schema_part['title'])} has no key `{entry.key}`"
    )
    element = element_of_path(path)
    odd_character = diagnose_odd_character(entry.key, entry.key_span, "unknown-key", element)
    if odd_character is not None:
        return odd_character
    home = key_places.find_key_home(entry.key, path, schema_part["title"])
    meant = key_places.find_meant_key(entry, schema_part["title"])
    guess = f"did you mean `{meant}`?" if meant else _guess_key(entry, known_keys, path)
    # The surest first: what the key holds, then where else it is a key. Between sections one letter tells more.
    help_line = (
        _find_key_help(entry, known_keys)
        or _SENTENCES_BY_TITLE.get(schema_part["title"], {}).get(entry.key)
        or key_places.find_sibling_help(entry, path, schema_part["title"])
        or (home if home and path and not meant and not _is_one_slip(entry.key, known_keys) else guess or home)
        or f"{'its keys' if path else 'the sections'} are {join_quoted(known_keys)}"
    )
    return Diagnostic("unknown-key", message, entry.key_span, help=help_line, element=element)


def _is_one_slip(key: str, known_keys: tuple[str, ...]) -> bool:
    """Whether only an `s` at the end is missing from a known key, or too much: nobody means a key of another place then."""
    return f"{key}s" in known_keys or (key.endswith("s") and key[:-1] in known_keys)


def _guess_key(entry: MappingEntry, known_keys: tuple[str, ...], path: tuple[str | int, ...]) -> str | None:
    plural = f"{entry.key.removesuffix('y')}ies"  # `policy`: two letters more than a slip
    name = plural if plural in known_keys else find_closest(entry.key, known_keys)
    # `modes` is a word of its own: it means `nodes` only if nodes stand below it.
    is_likely = name is not None and (bool(path) or key_places.may_be_section(entry, name))
    return f"did you mean `{name}`?" if is_likely else did_you_shorten(entry.key, known_keys) if path else None


def _find_key_help(entry: MappingEntry, known_keys: tuple[str, ...]) -> str | None:
    if entry.key in {"name", "id"} and "title" in known_keys:
        return "the key above is the id; write the name for people as `title`"
    if ":" in entry.key:
        before, after = entry.key.split(":", 1)
        if before in known_keys:
            return f"write a blank after the colon: `{before}: {after}`"
    return None


def diagnose_wrong_key(entry: MappingEntry, schema_part: dict[str, Any], path: tuple[str | int, ...]) -> Diagnostic:
    """Report a key that cannot be an id of what it names, with an id that could as help."""
    odd_character = diagnose_odd_character(entry.key, entry.key_span, "wrong-value", element_of_path(path))
    if odd_character is not None:
        return odd_character
    message = f"`{entry.key}` cannot be {add_article(schema_part.get('title', 'key').split(' of ')[0])}"
    if entry.key in _LANGUAGE_WORDS:
        help_line = f"choose another, such as `{entry.key}_parts`: {join_quoted(_LANGUAGE_WORDS)} mean something else"
        return Diagnostic(
            "wrong-value",
            f"{message}: it is a word of the language",
            entry.key_span,
            help=help_line,
            element=element_of_path(path),
        )
    better_key = next(
        (key for key in suggest_ids(entry.key) if re.search(schema_part.get("pattern", r"\Z."), key)), None
    )
    help_line = schema_part.get("patternErrorMessage") or "it is too long"
    if len(entry.key) > schema_part.get("maxLength", len(entry.key)):
        help_line = f"at most {schema_part['maxLength']} characters are allowed"
    elif better_key and better_key != entry.key:
        help_line = f"{help_line}; write `{better_key}`"
    return Diagnostic("wrong-value", message, entry.key_span, help=help_line, element=element_of_path(path))
