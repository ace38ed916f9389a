"""The wording of a changed key."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from archgen.compare.comparison import Change
from archgen.diagnostics.common_wording import join_words

_MAX_LENGTH = 80
_PROSE_KEYS = frozenset({"functionality", "description", "comment", "text", "external"})
_KEY_VERBS = {
    "owner": "belongs to",
    "host": "runs on",
    "container": "runs in the container",
    "message": "is",
    "deadline": "must end within",
    "role": "is a",
    "status": "is",
    "version": "is version",
}
"""Keys with a verb of their own: `x` VERB new value instead of old value."""
_KEY_NAMES = {
    "timing.rate": "rate",
    "timing.wcet": "worst case execution time",
    "timing.bcet": "best case execution time",
    "timing.response": "stated response time",
    "use_cases": "use cases",
    "co_owners": "further owners",
    "latency.best": "best latency",
    "latency.worst": "worst latency",
    "forbid.from": "forbidden source",
    "forbid.to": "forbidden target",
    "show": "selector",
    "shared_topics": "shared topics",
    "distro": "ROS distribution",
    "parameter_files": "parameter files",
    "execution_time": "execution time",
}
_LIST_VERBS = {
    "implements": ("now implements", "no longer implements"),
    "requirements": ("now serves", "no longer serves"),
    "tags": ("now has the tag", "no longer has the tag"),
    "connects": ("now connects", "no longer connects"),
    "through": ("now leads through", "no longer leads through"),
    "use_cases": ("now belongs to", "no longer belongs to"),
    "kind": ("is now", "is no longer"),
}
"""List keys, with what the element does with added and with removed items."""
_PATH_KINDS = frozenset({"component", "input", "output", "connection", "port"})
"""Kinds whose ids are paths that need no kind in front of them."""
_KIND_NAMES = {"use_case": "use case", "message": "message", "port": "port"}


def describe_key_change(change: Change) -> str:
    """Describe how the value of a key changed."""
    key, before, after = change.key or "", change.before, change.after
    name = f"`{shorten_text(change.element_id)}`"
    subject = (
        name
        if "." in change.element_id and change.element_kind in _PATH_KINDS
        else f"{_KIND_NAMES.get(change.element_kind, change.element_kind)} {name}"
    )
    if change.element_kind == "project":
        subject = "the project"
    if key == "qos" and isinstance(before, Mapping) and isinstance(after, Mapping):
        return f"{subject}: QoS {join_words([f'{_spell_out(k)} {format_value(before[k])} → {format_value(after[k])}' for k in before])}"
    if key in _PROSE_KEYS and (key == "text" or not (_is_brief(before) and _is_brief(after))):
        return f"the {_spell_out(key)} of {subject} {_rewrite_phrase(before, after)}"
    if change.element_kind in {"input", "output"} and key in {"type", "optional"}:
        return f"{subject} {_port_phrase(change)}"
    if key in _KEY_VERBS and _has_verb_form(key, before, after):
        return f"{subject} {_verb_phrase(key, before, after)}"
    if key == "topic" and (".serves." in change.element_id or ".calls." in change.element_id):
        # What is called a topic in the files is the name of a service or action here.
        key = "name"
    if isinstance(before, list) or isinstance(after, list):
        return f"{subject}{_list_phrase(key, before, after)}"
    return f"{subject}: {_value_phrase(_key_name(key), before, after)}"


def _has_verb_form(key: str, before: object, after: object) -> bool:
    return key == "container" or (before is not None and after is not None)


def _verb_phrase(key: str, before: object, after: object) -> str:
    if after is None:
        return f"no longer {_KEY_VERBS[key]} {format_value(before)}"
    return f"now {_KEY_VERBS[key]} {_instead_phrase(before, after, '')}"


def _port_phrase(change: Change) -> str:
    if change.key == "optional":
        return "is optional now" if change.after else "is no longer optional"
    verb = "carries" if change.element_kind == "output" else "expects"
    return f"now {verb} {_instead_phrase(change.before, change.after, 'nothing named')}"


def _key_name(key: str) -> str:
    if key.startswith("rules."):
        rule, _, option = key.removeprefix("rules.").partition(".")
        return f"`{option}` of the rule `{rule}`" if option else f"severity of the rule `{rule}`"
    if key.startswith("parameters."):
        return f"parameter `{shorten_text(key.removeprefix('parameters.'))}`"
    return _KEY_NAMES.get(key) or _spell_out(key.removeprefix("timing.").replace(".", " "))


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
    # Lines are counted, not quoted: a sentence must stay on one line.
    if isinstance(before, str) and isinstance(after, str) and "\n" in before + after:
        old_lines, new_lines = Counter(before.splitlines()), Counter(after.splitlines())
        counts = ((new_lines - old_lines).total(), "added"), ((old_lines - new_lines).total(), "removed")
        words = [f"{n} line{'s' if n > 1 else ''} {verb}" for n, verb in counts if n]
        return f"changed: {' and '.join(words)}" if words else "has its lines in another order"
    if before is None:
        return "is new"
    return "is gone" if after is None else "is rewritten"


def _list_phrase(key: str, before: object, after: object) -> str:
    """Describe what a list gained and lost, with the key's own verbs if it has any."""
    old_items = before if isinstance(before, list) else []
    new_items = after if isinstance(after, list) else []
    name = f": {_key_name(key)}"
    if len(old_items) == len(new_items) == 1:
        return f"{name} {format_value(old_items[0])} → {format_value(new_items[0])}"
    gained = [format_value(item) for item in new_items if item not in old_items]
    lost = [format_value(item) for item in old_items if item not in new_items]
    if not gained and not lost:
        return f"{name} are now {join_words([format_value(item) for item in new_items])}, in this order"
    if key in _LIST_VERBS:
        words = [
            f" {verb} {join_words(_limit_items(items))}"
            for verb, items in zip(_LIST_VERBS[key], (gained, lost), strict=True)
            if items
        ]
        return " and".join(words)
    words = [
        f" {join_words(_limit_items(items))} {verb}" for verb, items in (("added", gained), ("removed", lost)) if items
    ]
    return name + ",".join(words)


def _limit_items(items: Sequence[str]) -> list[str]:
    limit = 6
    return [*items] if len(items) <= limit else [*items[:limit], f"{len(items) - limit} more"]


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
